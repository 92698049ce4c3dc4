#include "examples/simulation/simulator.hpp"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <mutex>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "examples/simulation/collision_detector.hpp"
#include "touchstone/contacts.hpp"

namespace touchstone::simulation {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::SparseMatrix;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// The difference of a contact's points as a sum over its vertices: first − second = Σ weights[i]
/// x_vertices[i].
struct ContactWeights {
  std::array<std::int32_t, 4> vertices;
  std::array<double, 4> weights;
};

ContactWeights weights_of(const fast::Step& step, const fast::ActiveContact& contact) {
  const double u = contact.u, v = contact.v;
  ContactWeights result{step.vertices_of(contact.kind, contact.pair), {}};
  if (contact.kind == fast::PairKind::edge_edge) {
    result.weights = {1.0 - u, u, v - 1.0, -v};
  } else {
    result.weights = {1.0, u + v - 1.0, -u, -v};
  }
  return result;
}

using Factorisation = Eigen::SimplicialLDLT<SparseMatrix<double>>;

/// Factorises the Hessian, and solves for the step to the minimum of the quadratic model. Adds its
/// time.
VectorXd newton_step(Factorisation& solver, const Derivatives& derivatives, double& seconds) {
  const Stopwatch stopwatch(seconds);
  const Index n = derivatives.gradient.size();
  SparseMatrix<double> hessian(n, n);
  hessian.setFromTriplets(derivatives.hessian.begin(), derivatives.hessian.end());
  solver.compute(hessian);
  if (solver.info() != Eigen::Success) throw std::runtime_error("the Hessian cannot be factorised");
  return solver.solve(-derivatives.gradient);
}

}  // namespace

Simulator::Simulator(const World& world, CollisionDetector& detector,
                     const SimulatorOptions& options)
    : world_(world),
      detector_(detector),
      options_(options),
      x_(world.start()),
      v_(world.start_velocity()) {}

double Simulator::energy(const VectorXd& x, Derivatives* derivatives) const {
  const double h = options_.time_step;
  const VectorXd& masses = world_.masses();
  const VectorXd away = x - free_;
  const double result =
      away.dot(masses.cwiseProduct(away)) / 2.0 + h * h * world_.energy(x, time_, derivatives);
  if (derivatives == nullptr) return result;
  derivatives->gradient = h * h * derivatives->gradient + masses.cwiseProduct(away);
  for (auto& entry : derivatives->hessian)
    entry = {entry.row(), entry.col(), h * h * entry.value()};
  for (Index i = 0; i < x.size(); ++i) {
    derivatives->hessian.emplace_back(static_cast<int>(i), static_cast<int>(i), masses[i]);
  }
  return result;
}

void Simulator::hold(Derivatives& derivatives) const {
  std::erase_if(derivatives.hessian, [&](const auto& entry) {
    return world_.is_held(entry.row()) || world_.is_held(entry.col());
  });
  for (Index i = 0; i < derivatives.gradient.size(); ++i) {
    if (!world_.is_held(i)) continue;
    derivatives.gradient[i] = 0.0;
    derivatives.hessian.emplace_back(static_cast<int>(i), static_cast<int>(i), 1.0);
  }
}

void Simulator::take_time_step(const Frame& frame) {
  const Stopwatch stopwatch(statistics_.total_seconds);
  const double h = options_.time_step;
  time_ += h;
  free_ = x_ + h * v_;
  for (Index i = 0; i < x_.size(); ++i) {
    if (world_.is_held(i)) {
      free_[i] = x_[i];
    } else {
      free_[i] += h * h * options_.gravity[i % 3];
    }
  }
  const VectorXd before = x_;
  x_ = next(frame);
  v_ = (x_ - before) / h;
  ++statistics_.time_steps;
}

// ---- Barrier ----

double BarrierSimulator::barrier(const VectorXd& x, Derivatives* derivatives) {
  const double reach = options_.activation_distance;
  // A vertex of mean mass with the greatest initial speed is stopped at a distance of about d̂/2.
  const double speed = std::max(1.0, world_.start_velocity().lpNorm<Eigen::Infinity>());
  const double stiffness = 100.0 * world_.masses().mean() * reach * options_.time_step * speed;
  const fast::Step rest = world_.step(x, x, {.distance = reach});
  std::vector<fast::ActiveContact> contacts;
  std::mutex mutex;
  rest.candidates([&](const fast::StepCandidates& found) {
    for (const fast::IndexPair& pair : found.pairs) {
      const fast::ActiveContact contact = fast::contact_at(rest, found.kind, pair, 0.0);
      if ((contact.first - contact.second).squaredNorm() >= reach * reach) continue;
      const std::scoped_lock lock(mutex);
      contacts.push_back(contact);
    }
  });
  // Sorted, because sums of doubles depend on their order, and the order of the search on its
  // threads.
  std::ranges::sort(contacts, {},
                    [](const fast::ActiveContact& one) { return std::pair(one.kind, one.pair); });
  double result = 0.0;
  for (const fast::ActiveContact& contact : contacts) {
    const Vector3d difference = contact.first - contact.second;
    const double s = difference.norm() / reach;
    if (!(s > 0.0)) return std::numeric_limits<double>::infinity();
    const double log = std::log(s), from = s - 1.0;
    result -= stiffness * from * from * log;
    if (derivatives == nullptr) continue;
    const double slope = stiffness / reach * (-2.0 * from * log - from * from / s);
    const double curvature =
        stiffness / (reach * reach) * (-2.0 * log - 4.0 * from / s + from * from / (s * s));
    const Vector3d n = difference.normalized();
    const ContactWeights of = weights_of(rest, contact);
    Eigen::Matrix<double, 12, 1> distance_gradient;
    for (std::size_t a = 0; a < 4; ++a)
      distance_gradient.segment<3>(3 * static_cast<Index>(a)) = of.weights[a] * n;
    derivatives->add(of.vertices, slope * distance_gradient,
                     curvature * distance_gradient * distance_gradient.transpose());
  }
  statistics_.contacts += derivatives != nullptr ? contacts.size() : 0;
  return result;
}

double BarrierSimulator::total(const VectorXd& x, Derivatives* derivatives) {
  const double result = energy(x, derivatives) + barrier(x, derivatives);
  if (derivatives != nullptr) hold(*derivatives);
  return result;
}

VectorXd BarrierSimulator::next(const Frame& frame) {
  VectorXd x = x_;
  for (int iteration = 0; iteration < options_.max_iterations; ++iteration) {
    ++statistics_.iterations;
    Derivatives derivatives(x.size());
    const double now = total(x, &derivatives);
    Factorisation solver;
    const VectorXd direction = newton_step(solver, derivatives, statistics_.linear_seconds);
    double step_size = detector_.step_size(world_.step(x, x + direction));
    VectorXd there = x + step_size * direction;
    constexpr double least_step_size = 1e-12;
    while (step_size > least_step_size && !(total(there, nullptr) < now)) {
      step_size /= 2.0;
      there = x + step_size * direction;
    }
    if (step_size <= least_step_size) {
      ++statistics_.stalled;
      return x;
    }
    x = there;
    frame(x);
    if (direction.lpNorm<Eigen::Infinity>() < options_.velocity_tolerance * options_.time_step)
      return x;
  }
  ++statistics_.unfinished;
  return x;
}

// ---- Constraints ----

namespace {

/// J x ≥ η, a row for each contact.
struct Constraints {
  std::vector<ContactWeights> weights;
  std::vector<Vector3d> normals;
  Eigen::MatrixXd responses;  ///< H⁻¹ Jᵀ
  VectorXd multipliers;

  [[nodiscard]] Index size() const { return static_cast<Index>(weights.size()); }

  [[nodiscard]] double gap(Index i, const VectorXd& x) const {
    const ContactWeights& of = weights[static_cast<std::size_t>(i)];
    Vector3d difference = Vector3d::Zero();
    for (std::size_t a = 0; a < 4; ++a)
      difference += of.weights[a] * x.segment<3>(3 * Index{of.vertices[a]});
    return normals[static_cast<std::size_t>(i)].dot(difference);
  }
};

/// The minimum of the quadratic energy around `unconstrained` under the constraints, by projected
/// Gauss-Seidel.
VectorXd solve(Constraints& constraints, const VectorXd& unconstrained, double eta) {
  VectorXd x = unconstrained + constraints.responses * constraints.multipliers;
  VectorXd diagonal(constraints.size());
  for (Index i = 0; i < constraints.size(); ++i)
    diagonal[i] = constraints.gap(i, constraints.responses.col(i));
  constexpr int max_sweeps = 500;
  for (int sweep = 0; sweep < max_sweeps; ++sweep) {
    double change = 0.0;
    for (Index i = 0; i < constraints.size(); ++i) {
      if (!(diagonal[i] > 0.0)) continue;  // no vertex that can move
      const double gap = constraints.gap(i, x);
      const double multiplier =
          std::max(0.0, constraints.multipliers[i] + (eta - gap) / diagonal[i]);
      const double difference = multiplier - constraints.multipliers[i];
      if (difference == 0.0) continue;
      constraints.multipliers[i] = multiplier;
      x += difference * constraints.responses.col(i);
      change = std::max(change, std::abs(difference) * diagonal[i]);
    }
    if (change < 1e-3 * eta) break;
  }
  return x;
}

}  // namespace

VectorXd ConstraintSimulator::next(const Frame& frame) {
  Derivatives derivatives(x_.size());
  energy(x_, &derivatives);
  hold(derivatives);
  Factorisation solver;
  const VectorXd unconstrained = x_ + newton_step(solver, derivatives, statistics_.linear_seconds);

  const double eta = options_.activation_distance;
  VectorXd there = unconstrained;
  Constraints constraints;
  std::set<std::pair<fast::PairKind, fast::IndexPair>> known;
  for (int iteration = 0; iteration < options_.max_iterations; ++iteration) {
    ++statistics_.iterations;
    const fast::Step step = world_.step(x_, there);
    const Index before = constraints.size();
    for (const fast::ActiveContact& contact : detector_.active_set(step, eta)) {
      if (!known.emplace(contact.kind, contact.pair).second) continue;
      constraints.weights.push_back(weights_of(step, contact));
      constraints.normals.push_back(contact.normal);
    }
    if (constraints.size() == before) break;
    if (iteration + 1 == options_.max_iterations) ++statistics_.unfinished;
    const Stopwatch stopwatch(statistics_.linear_seconds);
    constraints.responses.conservativeResize(x_.size(), constraints.size());
    constraints.multipliers.conservativeResize(constraints.size());
    for (Index i = before; i < constraints.size(); ++i) {
      VectorXd row = VectorXd::Zero(x_.size());
      const ContactWeights& of = constraints.weights[static_cast<std::size_t>(i)];
      for (std::size_t a = 0; a < 4; ++a) {
        const Index at = 3 * Index{of.vertices[a]};
        if (!world_.is_held(at))
          row.segment<3>(at) += of.weights[a] * constraints.normals[static_cast<std::size_t>(i)];
      }
      constraints.responses.col(i) = solver.solve(row);
      constraints.multipliers[i] = 0.0;
    }
    there = solve(constraints, unconstrained, eta);
    statistics_.contacts += static_cast<std::uint64_t>(constraints.size() - before);
  }
  const fast::Step step = world_.step(x_, there);
  if (!detector_.active_set(step, 0.0).empty()) {
    ++statistics_.shortened;
    there = x_ + detector_.step_size(step) * (there - x_);
  }
  frame(there);
  return there;
}

}  // namespace touchstone::simulation
