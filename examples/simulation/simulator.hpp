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

struct SimulatorOptions {
  Eigen::Vector3d gravity{0.0, 0.0, -9.81};
  double time_step = 0.01;            ///< h, in seconds
  double activation_distance = 1e-3;  ///< d̂ of the barrier and η of constraints, in metres
  int max_iterations = 60;  ///< of Newton's method, or of adding constraints, in a time step
  /// Newton's method ends when no vertex would move faster than this, in m/s.
  double velocity_tolerance = 5e-3;
};

struct SimulatorStatistics {
  std::uint64_t time_steps = 0;
  std::uint64_t iterations = 0;
  /// Time steps that ended at max_iterations.
  std::uint64_t unfinished = 0;
  /// Line searches that ended without a lower energy.
  std::uint64_t stalled = 0;
  /// Steps under constraints that had to be shortened.
  std::uint64_t shortened = 0;
  std::uint64_t contacts = 0;   ///< summed over iterations
  double linear_seconds = 0.0;  ///< in factorisations and solutions
  double total_seconds = 0.0;
};

/// The simulated world between time steps.
class Simulator {
 public:
  /// Called with the positions after each straight motion.
  using Frame = std::function<void(const Eigen::VectorXd&)>;

  Simulator(const World& world, CollisionDetector& detector, const SimulatorOptions& options);
  Simulator(const Simulator&) = delete;
  Simulator& operator=(const Simulator&) = delete;
  Simulator(Simulator&&) = delete;
  Simulator& operator=(Simulator&&) = delete;
  virtual ~Simulator() = default;

  void take_time_step(const Frame& frame);

  [[nodiscard]] const Eigen::VectorXd& positions() const { return x_; }
  [[nodiscard]] const SimulatorStatistics& statistics() const { return statistics_; }

 protected:
  /// The positions at the end of the time step.
  [[nodiscard]] virtual Eigen::VectorXd next(const Frame& frame) = 0;

  /// E; adds its derivatives.
  double energy(const Eigen::VectorXd& x, Derivatives* derivatives) const;
  /// Removes fixed coordinates from a system of equations: no gradient, and a row of the identity.
  void hold(Derivatives& derivatives) const;

  const World& world_;
  CollisionDetector& detector_;
  SimulatorOptions options_;
  Eigen::VectorXd x_, v_;
  Eigen::VectorXd free_;  ///< x̂
  double time_ = 0.0;     ///< at the end of the time step
  SimulatorStatistics statistics_;
};

class BarrierSimulator final : public Simulator {
 public:
  using Simulator::Simulator;

 private:
  [[nodiscard]] Eigen::VectorXd next(const Frame& frame) override;
  double barrier(const Eigen::VectorXd& x, Derivatives* derivatives);
  double total(const Eigen::VectorXd& x, Derivatives* derivatives);
};

class ConstraintSimulator final : public Simulator {
 public:
  using Simulator::Simulator;

 private:
  [[nodiscard]] Eigen::VectorXd next(const Frame& frame) override;
};

}  // namespace touchstone::simulation
