// ACCD: additive continuous collision detection ([li2021], as in the public IPC Toolkit).
//
// After subtraction of the mean displacement, no two points of the primitives approach each other
// faster than ℓ, the sum of each primitive's greatest displacement. At distance d they therefore
// do not come within ξ before (d − ξ)/ℓ, and may be moved by a share s = 0.9 of that: times add up
// to a lower bound of the impact that never passes it. It ends with yes if d − ξ is at most a
// share 1 − s of its initial value, and with no if the time is above t_max.
//
// ξ is the distance of fast::MethodOptions::separation; it is Euclidean.
//
// **Promise.** None: nothing bounds the rounding.
//
// **Known defects.**
//   - Queries without collision whose gap shrinks to less than a tenth of its initial value are
//     false positives by design. (A vertex that comes from 1 down to 0.05 over a face.)
//   - The first step is taken without a test, and moves are accumulated point by point: errors
//     grow, the computed d may pass below ξ, and the step then goes back.
//   - For two edges at a computed distance within ξ the least distance of their ends is used
//     instead, as for distant and nearly parallel edges: after a step that arrives by rounding
//     they may pass through each other.
//   - Only fast::MethodOptions::max_checks bounds the steps of grazing motion; the answer is then
//     yes, with max_checks as `checks`.
//   - Degenerate triangles can have a distance that is not a number: then it steps in place, up to
//     max_checks.
//
// **The limited variant** runs on graphics processors and in simulators with a bound of the time:
// s = 0.8, at most 32 steps, and then *no*. It requires primitives that are farther apart than ξ
// at t=0. A contact that takes more steps is a false negative within these terms: an approach that
// is slow beside the motion along the primitives.

#include "verify/baselines/baselines.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>

#include "touchstone/mesh.hpp"
#include "verify/baselines/closest_features.hpp"
#include "verify/baselines/method_support.hpp"

namespace touchstone::baselines {
namespace {

/// The differences of the variants.
struct Rules {
  double step_share;        ///< s
  std::int64_t most_steps;  ///< not positive: no limit
  fast::Verdict at_limit;
};

using Points = std::array<Eigen::Vector3d, moving_points>;

double squared_distance(ContactKind kind, const Points& x) {
  return kind == ContactKind::vertex_face
             ? feature_squared_distance(x[0], Triangle{x[1], x[2], x[3]})
             : feature_squared_distance(Segment{x[0], x[1]}, {x[2], x[3]});
}

/// The quantity used as squared distance while stepping.
double stepping_squared_distance(ContactKind kind, const Points& x, double separation) {
  const double distance = squared_distance(kind, x);
  if (kind == ContactKind::vertex_face || distance - separation * separation > 0.0) return distance;
  return std::min({(x[0] - x[2]).squaredNorm(), (x[0] - x[3]).squaredNorm(),
                   (x[1] - x[2]).squaredNorm(), (x[1] - x[3]).squaredNorm()});
}

/// The displacements, less their mean.
Points centred_displacements(const Query& query) {
  Points displacement;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < moving_points; ++i) {
    displacement[i] = point_of(query, 1, i) - point_of(query, 0, i);
    mean += displacement[i] / static_cast<double>(moving_points);
  }
  for (Eigen::Vector3d& x : displacement) x -= mean;
  return displacement;
}

/// ℓ: an upper bound of the approach of the primitives in [0,1].
double greatest_approach(ContactKind kind, const Points& displacement) {
  const auto length = [&](std::size_t i) { return displacement[i].norm(); };
  return kind == ContactKind::vertex_face
             ? length(0) + std::max({length(1), length(2), length(3)})
             : std::max(length(0), length(1)) + std::max(length(2), length(3));
}

fast::Answer advance(ContactKind kind, const Query& query, const fast::MethodOptions& options,
                     const Rules& rules) {
  const double separation = options.separation.distance;
  Points x;
  for (std::size_t i = 0; i < moving_points; ++i) x[i] = point_of(query, 0, i);
  if (squared_distance(kind, x) <= separation * separation) {
    return {.verdict = fast::Verdict::yes, .toi_lower = 0.0};
  }
  const Points displacement = centred_displacements(query);
  const double approach = greatest_approach(kind, displacement);
  if (approach == 0.0) return {.verdict = fast::Verdict::no};
  // (d² − ξ²)/(d + ξ), which is d − ξ.
  const auto gap_of = [&] {
    const double square = stepping_squared_distance(kind, x, separation);
    return (square - separation * separation) / (std::sqrt(square) + separation);
  };
  double gap = gap_of();
  const double enough = (1.0 - rules.step_share) * gap;
  double toi = 0.0;
  for (std::int64_t steps = 1; rules.most_steps <= 0 || steps <= rules.most_steps; ++steps) {
    const double step = rules.step_share * gap / approach;
    for (std::size_t i = 0; i < moving_points; ++i) x[i] += step * displacement[i];
    gap = gap_of();
    if (toi > 0.0 && gap < enough) {
      return {.verdict = fast::Verdict::yes, .checks = to_checks(steps), .toi_lower = toi};
    }
    toi += step;
    if (toi > options.t_max) return {.verdict = fast::Verdict::no, .checks = to_checks(steps)};
  }
  const bool yes = rules.at_limit == fast::Verdict::yes;
  return {.verdict = rules.at_limit,
          .checks = to_checks(rules.most_steps),
          .toi_lower = yes ? toi : fast::Answer::none};
}

fast::Answer accd(ContactKind kind, const Query& query, const fast::MethodOptions& options) {
  return advance(
      kind, query, options,
      {.step_share = 0.9, .most_steps = options.max_checks, .at_limit = fast::Verdict::yes});
}

fast::Answer accd_limited(ContactKind kind, const Query& query,
                          const fast::MethodOptions& options) {
  return advance(kind, query, options,
                 {.step_share = 0.8, .most_steps = 32, .at_limit = fast::Verdict::no});
}

}  // namespace

std::unique_ptr<fast::Method> accd_method() {
  return baseline_method({.name = "accd", .reference = "li2021", .norms = {Norm::l2}},
                         on_lines<accd>);
}

std::unique_ptr<fast::Method> accd_limited_method() {
  return baseline_method({.name = "accd_limited",
                          .terms = {.starts_apart = 0.0},
                          .reference = "li2021",
                          .variant_of = "accd",
                          .norms = {Norm::l2}},
                         on_lines<accd_limited>);
}

}  // namespace touchstone::baselines
