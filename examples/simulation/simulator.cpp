#include "examples/simulation/simulator.hpp"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "examples/simulation/collision_detector.hpp"
#include "touchstone/contacts.hpp"

namespace touchstone::simulation {
namespace {

using Eigen::Index;
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
  if (contact.kind == ContactKind::edge_edge) {
    result.weights = {1.0 - u, u, v - 1.0, -v};
  } else {
    result.weights = {1.0, u + v - 1.0, -u, -v};
  }
  return result;
}

/// Of Newton's method, or of adding constraints, in a time step.
constexpr int max_iterations = 60;
/// Newton's method ends when no vertex would move faster than this, in m/s.
constexpr double velocity_tolerance = 5e-3;

using Factorisation = Eigen::SimplicialLDLT<SparseMatrix<double>>;

/// Removes fixed coordinates from a system of equations: no gradient, and a row of the identity.
void hold(const World& world, Derivatives& derivatives) {
  std::erase_if(derivatives.hessian, [&](const auto& entry) {
    return world.is_held(entry.row()) || world.is_held(entry.col());
  });
  for (Index i = 0; i < derivatives.gradient.size(); ++i) {
    if (!world.is_held(i)) continue;
    derivatives.gradient[i] = 0.0;
    derivatives.hessian.emplace_back(static_cast<int>(i), static_cast<int>(i), 1.0);
  }
}

/// Factorises the Hessian, and solves for the step to the minimum of the quadratic model.
VectorXd newton_step(Factorisation& solver, const World& world, Derivatives& derivatives) {
  hold(world, derivatives);
  const Index n = derivatives.gradient.size();
  SparseMatrix<double> hessian(n, n);
  hessian.setFromTriplets(derivatives.hessian.begin(), derivatives.hessian.end());
  solver.compute(hessian);
  if (solver.info() != Eigen::Success) throw std::runtime_error("the Hessian cannot be factorised");
  return solver.solve(-derivatives.gradient);
}

}  // namespace

Simulator::Simulator(Scene scene, CollisionDetector& detector, ContactModel model)
    : scene_(std::move(scene)),
      world_(scene_),
      detector_(detector),
      model_(model),
      x_(world_.start()),
      v_(world_.start_velocity()) {}

double Simulator::energy(const VectorXd& x, Derivatives* derivatives) const {
  const double h = scene_.time_step;
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

void Simulator::take_time_step(const Frame& frame) {
  const Stopwatch stopwatch(statistics_.seconds);
  const double h = scene_.time_step;
  time_ += h;
  free_ = x_ + h * v_;
  for (Index i = 0; i < x_.size(); ++i) {
    if (world_.is_held(i)) {
      free_[i] = x_[i];
    } else {
      free_[i] += h * h * scene_.gravity[i % 3];
    }
  }
  const VectorXd before = x_;
  x_ = model_ == ContactModel::barrier ? next_with_barriers(frame) : next_with_constraints(frame);
  v_ = (x_ - before) / h;
  ++statistics_.time_steps;
}

// ---- Barrier ----

double Simulator::barrier(const VectorXd& x, Derivatives* derivatives) {
  const double reach = scene_.activation_distance;
  // A vertex of mean mass with the greatest initial speed is stopped at a distance of about d̂/2.
  const double speed = std::max(1.0, world_.start_velocity().lpNorm<Eigen::Infinity>());
  const double stiffness = 100.0 * world_.masses().mean() * reach * scene_.time_step * speed;
  const fast::Step rest = world_.step(x, x, {.distance = reach});
  double result = 0.0;
  std::uint64_t contacts = 0;
  for (const auto& [kind, pairs] : candidates_of(rest)) {
    for (const fast::IndexPair& pair : pairs) {
      const fast::ActiveContact contact = fast::contact_at(rest, kind, pair, 0.0);
      const Vector3d difference = contact.first - contact.second;
      if (difference.squaredNorm() >= reach * reach) continue;
      ++contacts;
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
  }
  statistics_.contacts += derivatives != nullptr ? contacts : 0;
  return result;
}

double Simulator::total(const VectorXd& x, Derivatives* derivatives) {
  return energy(x, derivatives) + barrier(x, derivatives);
}

VectorXd Simulator::next_with_barriers(const Frame& frame) {
  VectorXd x = x_;
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    Derivatives derivatives(x.size());
    const double now = total(x, &derivatives);
    Factorisation solver;
    const VectorXd direction = newton_step(solver, world_, derivatives);
    double step_size = detector_.step_size(world_.step(x, x + direction));
    VectorXd there = x + step_size * direction;
    constexpr double least_step_size = 1e-12;
    while (step_size > least_step_size && !(total(there, nullptr) < now)) {
      step_size /= 2.0;
      there = x + step_size * direction;
    }
    if (step_size <= least_step_size) {
      ++statistics_.unfinished;
      return x;
    }
    x = there;
    frame(x);
    if (direction.lpNorm<Eigen::Infinity>() < velocity_tolerance * scene_.time_step) return x;
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

VectorXd Simulator::next_with_constraints(const Frame& frame) {
  Derivatives derivatives(x_.size());
  energy(x_, &derivatives);
  Factorisation solver;
  const VectorXd unconstrained = x_ + newton_step(solver, world_, derivatives);

  const double eta = scene_.activation_distance;
  VectorXd there = unconstrained;
  Constraints constraints;
  std::set<std::pair<ContactKind, fast::IndexPair>> known;
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    const fast::Step step = world_.step(x_, there);
    const Index before = constraints.size();
    for (const fast::ActiveContact& contact : detector_.active_set(step, eta)) {
      if (!known.emplace(contact.kind, contact.pair).second) continue;
      constraints.weights.push_back(weights_of(step, contact));
      constraints.normals.push_back(contact.normal);
    }
    if (constraints.size() == before) break;
    if (iteration + 1 == max_iterations) ++statistics_.unfinished;
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
  if (!detector_.active_set(step, 0.0).empty())
    there = x_ + detector_.step_size(step) * (there - x_);
  frame(there);
  return there;
}

}  // namespace touchstone::simulation
