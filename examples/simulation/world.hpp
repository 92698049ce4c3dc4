#pragma once

/// \file
/// All bodies of a scene as one system: positions, masses, and the elastic energy with its
/// derivatives.
///
/// **Elements.** A tetrahedron moves its material by a linear map F = Σ x_a b_aᵀ, where the b_a are
/// constants of the element. Its energy density is
///
///     μ/2 (|F|² − 3) − μ (J − 1) + λ/2 (J − 1)²,   J = det F
///
/// ([smith2018], without its last term), a neo-Hookean one that stays finite when an element is
/// turned inside out. Each element's Hessian is projected to the nearest one without negative
/// eigenvalues, so that a Newton step points downhill.

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "examples/simulation/simulated_scene.hpp"
#include "touchstone/step.hpp"

namespace touchstone::simulation {

/// Gradient and Hessian of an energy, as sums of small blocks.
struct Derivatives {
  explicit Derivatives(Eigen::Index coordinates) : gradient(Eigen::VectorXd::Zero(coordinates)) {}

  /// Adds the derivatives of an energy of some vertices: three coordinates each, in their order.
  void add(std::span<const std::int32_t> vertices,
           const Eigen::Ref<const Eigen::VectorXd>& gradient,
           const Eigen::Ref<const Eigen::MatrixXd>& hessian);

  Eigen::VectorXd gradient;
  std::vector<Eigen::Triplet<double>> hessian;
};

/// A tetrahedron with the constants of its material.
struct Element {
  Tetrahedron vertices;
  Eigen::Matrix<double, 3, 4> b;
  double volume = 0.0;
  double mu = 0.0, lambda = 0.0;
};

class World {
 public:
  explicit World(const Scene& scene);

  /// Coordinates of all vertices in turn.
  [[nodiscard]] Eigen::Index coordinates() const { return start_.size(); }
  [[nodiscard]] const Eigen::VectorXd& start() const { return start_; }
  [[nodiscard]] const Eigen::VectorXd& start_velocity() const { return velocity_; }
  /// The mass of each coordinate, in kg; 0 if it is fixed.
  [[nodiscard]] const Eigen::VectorXd& masses() const { return masses_; }
  /// True if the coordinate's vertex belongs to an obstacle.
  [[nodiscard]] bool is_held(Eigen::Index coordinate) const {
    return groups_[static_cast<std::size_t>(coordinate / 3)] == 0;
  }

  /// The energy of elements and pins at positions x and a time; adds its derivatives.
  double energy(const Eigen::VectorXd& x, double time, Derivatives* derivatives = nullptr) const;

  [[nodiscard]] const std::vector<fast::Face>& faces() const { return faces_; }
  /// The step from x0 to x1. Collisions between obstacles are ignored.
  [[nodiscard]] fast::Step step(const Eigen::VectorXd& x0, const Eigen::VectorXd& x1,
                                const Separation& separation = {}) const;

 private:
  void add(const Body& body);

  Eigen::VectorXd start_, velocity_, masses_;
  std::vector<std::int32_t> groups_;  ///< of each vertex: 0 of obstacles, 1 of the others
  std::vector<std::array<std::int32_t, 2>> obstacles_apart_;  ///< group 0, if it has vertices
  std::vector<fast::Face> faces_;
  std::vector<Element> elements_;
  std::vector<Pin> pins_;
};

}  // namespace touchstone::simulation
