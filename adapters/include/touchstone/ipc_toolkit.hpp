#pragma once

/// \file
/// The certified solver as an `ipc::NarrowPhaseCCD` of the IPC Toolkit (its
/// `ipc/ccd/narrow_phase_ccd.hpp`, version 1.6).
///
/// Pass an object of this class to any function that takes a narrow phase:
/// `compute_collision_free_stepsize`, `is_step_collision_free`, `Candidates`,
/// `CollisionStencil::ccd`. The toolkit is found by the program that includes this header; link
/// `touchstone::fast`.
///
/// **Answers.** Let d be the distance of the primitives at t=0, in L2, and d_min `min_distance`.
/// - d ≤ d_min: true, with toi = 0. (Decided exactly.)
/// - Else the primitives may come as near as
///
///       d_e = d_min + (1 − conservative_rescaling) (d − d_min),
///
///   rounded, and below d. True if they come that near up to `tmax`: then toi is before that time,
///   by at most 1e-12 of it, and **positive** unless that time is below the least double. False if
///   they do not: then toi is infinity, and the step is free up to tmax.
///
/// A step of size toi leaves at least 1 − conservative_rescaling of the distance, and is never 0.
/// There is no limit for d_e, no tolerance, no number of iterations and no repetition.
/// conservative_rescaling is in [0,1]; at 1, d_e is d_min.
///
/// In two dimensions the third coordinate is 0. A query with a coordinate that is NaN or infinite
/// is a collision at 0, so that nothing moves. All functions are thread-safe.
///
/// **Bad arguments.** A `min_distance` that is negative, NaN or infinite, a `tmax` outside [0,1],
/// and points of which some have two coordinates and others three throw std::invalid_argument, for
/// all points, and leave toi unchanged. (The toolkit has no rule: its classes take a negative
/// distance as its magnitude or as 0, and only assert the rest.)

#include <algorithm>
#include <cmath>
#include <ipc/ccd/narrow_phase_ccd.hpp>
#include <limits>
#include <stdexcept>

#include "touchstone/certified.hpp"
#include "touchstone/contacts.hpp"
#include "touchstone/query.hpp"

namespace touchstone::adapters {

class NarrowPhaseCCD : public ipc::NarrowPhaseCCD {
 public:
  /// \throws std::invalid_argument unless 0 ≤ rescaling ≤ 1.
  explicit NarrowPhaseCCD(double rescaling = 0.8) {
    if (!(rescaling >= 0.0 && rescaling <= 1.0)) {
      throw std::invalid_argument("conservative_rescaling must be in [0,1]");
    }
    conservative_rescaling = rescaling;
  }

  bool point_point_ccd(Eigen::ConstRef<ipc::VectorMax3d> p0_t0,
                       Eigen::ConstRef<ipc::VectorMax3d> p1_t0,
                       Eigen::ConstRef<ipc::VectorMax3d> p0_t1,
                       Eigen::ConstRef<ipc::VectorMax3d> p1_t1, double& toi,
                       const double min_distance = 0.0, const double tmax = 1.0) const override {
    return query_ccd(ContactKind::vertex_face,
                     query(p0_t0, p1_t0, p1_t0, p1_t0, p0_t1, p1_t1, p1_t1, p1_t1), toi,
                     min_distance, tmax);
  }

  bool point_edge_ccd(Eigen::ConstRef<ipc::VectorMax3d> p_t0,
                      Eigen::ConstRef<ipc::VectorMax3d> e0_t0,
                      Eigen::ConstRef<ipc::VectorMax3d> e1_t0,
                      Eigen::ConstRef<ipc::VectorMax3d> p_t1,
                      Eigen::ConstRef<ipc::VectorMax3d> e0_t1,
                      Eigen::ConstRef<ipc::VectorMax3d> e1_t1, double& toi,
                      const double min_distance = 0.0, const double tmax = 1.0) const override {
    return query_ccd(ContactKind::vertex_face,
                     query(p_t0, e0_t0, e1_t0, e0_t0, p_t1, e0_t1, e1_t1, e0_t1), toi, min_distance,
                     tmax);
  }

  bool point_triangle_ccd(
      Eigen::ConstRef<Eigen::Vector3d> p_t0, Eigen::ConstRef<Eigen::Vector3d> t0_t0,
      Eigen::ConstRef<Eigen::Vector3d> t1_t0, Eigen::ConstRef<Eigen::Vector3d> t2_t0,
      Eigen::ConstRef<Eigen::Vector3d> p_t1, Eigen::ConstRef<Eigen::Vector3d> t0_t1,
      Eigen::ConstRef<Eigen::Vector3d> t1_t1, Eigen::ConstRef<Eigen::Vector3d> t2_t1, double& toi,
      const double min_distance = 0.0, const double tmax = 1.0) const override {
    return query_ccd(ContactKind::vertex_face,
                     query(p_t0, t0_t0, t1_t0, t2_t0, p_t1, t0_t1, t1_t1, t2_t1), toi, min_distance,
                     tmax);
  }

  bool edge_edge_ccd(
      Eigen::ConstRef<Eigen::Vector3d> ea0_t0, Eigen::ConstRef<Eigen::Vector3d> ea1_t0,
      Eigen::ConstRef<Eigen::Vector3d> eb0_t0, Eigen::ConstRef<Eigen::Vector3d> eb1_t0,
      Eigen::ConstRef<Eigen::Vector3d> ea0_t1, Eigen::ConstRef<Eigen::Vector3d> ea1_t1,
      Eigen::ConstRef<Eigen::Vector3d> eb0_t1, Eigen::ConstRef<Eigen::Vector3d> eb1_t1, double& toi,
      const double min_distance = 0.0, const double tmax = 1.0) const override {
    return query_ccd(ContactKind::edge_edge,
                     query(ea0_t0, ea1_t0, eb0_t0, eb1_t0, ea0_t1, ea1_t1, eb0_t1, eb1_t1), toi,
                     min_distance, tmax);
  }

  /// The same for a query of this library, such as one of a step's (touchstone/step.hpp).
  bool query_ccd(ContactKind kind, const Query& query, double& toi, double min_distance = 0.0,
                 double tmax = 1.0) const {
    require_valid(min_distance, tmax);
    toi = 0.0;
    if (!is_finite(query)) return true;
    // A test that decides most pairs of a step, with the same answer as below.
    const fast::KeptDistance kept{.part = 1.0 - conservative_rescaling, .least = min_distance};
    if (fast::keeps_distance(kind, query, tmax, kept)) {
      toi = std::numeric_limits<double>::infinity();
      return false;
    }
    const fast::Distance d = fast::distance(kind, query, 0.0, Norm::l2);
    if (d.upper <= min_distance) return true;
    const fast::CertifiedResult result = fast::solve(
        kind, query,
        {.t_max = tmax,
         .separation = {.distance = effective_distance(min_distance, d), .norm = Norm::l2}});
    const bool collides = result.verdict == fast::Verdict::yes;
    toi = collides ? result.toi_lower : std::numeric_limits<double>::infinity();
    return collides;
  }

 private:
  /// \throws std::invalid_argument unless all points have two coordinates, or all three.
  template <class First, class... Others>
  static Query query(const First& first, const Others&... others) {
    Query query{};
    std::size_t next = 0;
    const auto add = [&](const auto& point) {
      if ((point.size() != 2 && point.size() != 3) || point.size() != first.size()) {
        throw std::invalid_argument("points must all have two coordinates, or all three");
      }
      for (Eigen::Index axis = 0; axis < point.size(); ++axis) {
        query.coordinates[next + static_cast<std::size_t>(axis)] = point[axis];
      }
      next += 3;
    };
    add(first);
    (add(others), ...);
    return query;
  }

  /// d_e: at least d_min and below the distance d > d_min, which is between neighbouring doubles.
  [[nodiscard]] double effective_distance(double d_min, const fast::Distance& d) const {
    const double wanted = d_min + (1.0 - conservative_rescaling) * (d.lower - d_min);
    return (std::max)(d_min, (std::min)(wanted, std::nextafter(d.lower, 0.0)));
  }

  static void require_valid(double min_distance, double tmax) {
    if (!is_valid(Separation{.distance = min_distance, .norm = Norm::l2})) {
      throw std::invalid_argument("min_distance must be finite and not negative");
    }
    if (!(tmax >= 0.0 && tmax <= 1.0)) throw std::invalid_argument("tmax must be in [0,1]");
  }
};

}  // namespace touchstone::adapters
