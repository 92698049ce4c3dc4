#pragma once

/// \file
/// Two ways to take a time step of implicit Euler without penetration.
///
/// Both minimise, over the positions x at the end of the time step h,
///
///     E(x) = ½ (x − x̂)ᵀ M (x − x̂) + h² W(x),   x̂ = x0 + h v0 + h² g,
///
/// M the masses and W the elastic energy. They differ in the treatment of contact.
///
/// **Barrier** ([li2020]). Contact costs an energy that grows without bound: with distances d below
/// d̂, κ times the sum of
///
///     b(d) = −(d/d̂ − 1)² log(d/d̂).
///
/// Newton's method with a line search: collision detection limits the step such that there is no
/// collision, and the step is then halved until the energy decreases. The Hessian of a barrier
/// omits the term with the curvature of d, which has negative eigenvalues. Every Newton step is a
/// straight motion, and one frame.
///
/// **Constraints** ([verschoor2019], [wang2021], section 6.1). Where the unconstrained step comes
/// within η, the contact points must be at least η apart along the contact normal at the end of the
/// step, to first order. One Newton step of E under these constraints is a quadratic program,
/// solved by projected Gauss-Seidel on its dual; collision detection of the result adds
/// constraints, until there are none to add. Constraints treat triangles as planes and edges as
/// lines, so they may be insufficient or contradictory: a step that still has a collision is
/// shortened as by a line search. A time step is one straight motion, and one frame.

#include <Eigen/Core>

#include <cstdint>
#include <functional>

#include "examples/simulation/collision_detector.hpp"
#include "examples/simulation/world.hpp"

namespace touchstone::simulation {

enum class ContactModel : std::uint8_t { barrier, constraint };

struct SimulatorStatistics {
  std::uint64_t time_steps = 0;
  /// Time steps that ended before their minimum: without a lower energy, or after all iterations.
  std::uint64_t unfinished = 0;
  std::uint64_t contacts = 0;  ///< summed over iterations
  double seconds = 0.0;
};

/// The simulated world between time steps.
class Simulator {
 public:
  /// Called with the positions after each straight motion.
  using Frame = std::function<void(const Eigen::VectorXd&)>;

  /// \param detector must outlive the simulator.
  Simulator(Scene scene, CollisionDetector& detector, ContactModel model);

  void take_time_step(const Frame& frame);

  [[nodiscard]] const World& world() const { return world_; }
  [[nodiscard]] const SimulatorStatistics& statistics() const { return statistics_; }

 private:
  /// The positions at the end of the time step.
  [[nodiscard]] Eigen::VectorXd next_with_barriers(const Frame& frame);
  [[nodiscard]] Eigen::VectorXd next_with_constraints(const Frame& frame);

  /// E; adds its derivatives.
  double energy(const Eigen::VectorXd& x, Derivatives* derivatives) const;
  double barrier(const Eigen::VectorXd& x, Derivatives* derivatives);
  /// E and the barrier.
  double total(const Eigen::VectorXd& x, Derivatives* derivatives);

  Scene scene_;
  World world_;
  CollisionDetector& detector_;
  ContactModel model_;
  Eigen::VectorXd x_, v_;
  Eigen::VectorXd free_;  ///< x̂
  double time_ = 0.0;     ///< at the end of the time step
  SimulatorStatistics statistics_;
};

}  // namespace touchstone::simulation
