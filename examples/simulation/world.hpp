#pragma once

/// \file
/// All bodies of a scene as one system: positions, masses, and the elastic energy with its
/// derivatives.
///
/// **Elements.** A tetrahedron or a triangle of cloth moves its material by a linear map F, of
/// three or two columns: F = Σ x_a b_aᵀ, where the b_a are constants of the element. Tetrahedra
/// have the energy density
///
///     μ/2 (|F|² − 3) − μ (J − 1) + λ/2 (J − 1)²,   J = det F
///
/// ([smith2018], without its last term), a neo-Hookean one that stays finite when an element is
/// turned inside out. Cloth has that of Saint Venant and Kirchhoff, μ |E|² + λ/2 (tr E)² with E =
/// (FᵀF − I)/2, and bends with the quadratic energy of [bergou2006]. Each element's Hessian is
/// projected to the nearest one without negative eigenvalues, so that a Newton step points
/// downhill.

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

/// An element with Columns columns of F.
template <int Columns>
struct Element {
  std::array<std::int32_t, static_cast<std::size_t>(Columns + 1)> vertices;
  Eigen::Matrix<double, Columns, Columns + 1> b;
  double measure = 0.0;  ///< volume, or area of cloth
  double mu = 0.0, lambda = 0.0;
};

/// Two triangles of cloth with a common edge: the edge's vertices first.
struct Hinge {
  std::array<std::int32_t, 4> vertices;
  Eigen::Vector4d weights;  ///< the energy is |Σ w_a x_a|²/2
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
    return is_held_[static_cast<std::size_t>(coordinate / 3)];
  }

  /// The energy of elements and pins at positions x and a time; adds its derivatives.
  double energy(const Eigen::VectorXd& x, double time, Derivatives* derivatives = nullptr) const;

  [[nodiscard]] const std::vector<fast::Face>& faces() const { return faces_; }
  /// The step from x0 to x1. Collisions between obstacles are ignored.
  [[nodiscard]] fast::Step step(const Eigen::VectorXd& x0, const Eigen::VectorXd& x1,
                                const Separation& separation = {}) const;

 private:
  void add(const Body& body);
  void add_hinges(const Body& body, std::int32_t first);

  Eigen::VectorXd start_, velocity_, masses_;
  std::vector<bool> is_held_;
  std::vector<std::int32_t> groups_;
  std::vector<std::array<std::int32_t, 2>> obstacles_apart_;  ///< group 0, if it has vertices
  std::vector<fast::Face> faces_;
  std::vector<Element<3>> tetrahedra_;
  std::vector<Element<2>> triangles_;
  std::vector<Hinge> hinges_;
  std::vector<Pin> pins_;  ///< with numbers of vertices in the world
};

}  // namespace touchstone::simulation
