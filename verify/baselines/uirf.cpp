// UIRF: the univariate interval root finder ([redon2002], for linear paths; as compared by
// [wang2021]).
//
// The four points are in one plane where f(t) = n(t)·q(t) = 0: n the face's normal, or the product
// of the edges, q a vector from one primitive to the other. f is evaluated in intervals over
// intervals of t, bisected earliest first (interval_search.hpp). On an interval narrower than δ
// divided by the greatest displacement whose f may vanish, an inside test in intervals decides:
// for vertex-face that the vertex is on the inner side of each edge, for edge-edge that each edge
// separates the other's ends.
//
// **Promise.** Conservative: the inside tests are closed and rounded outward, so they hold at
// every contact. Intervals come in ascending order, so the lower end of the accepted one is not
// above the time of impact.
//
// **Known defects.**
//   - Nothing bounds u and v: the inside test is as coarse as the motion of the points in that
//     interval.
//   - Degenerate triangles and edges on a line make every product contain 0, and all passes: false
//     positives. The same holds for a motion in one plane wherever the inside test is near 0. (Two
//     edges on one line, far from each other, at rest.)
//   - A pair at rest has no tolerance to reach: [0,1] itself is decided.
//   - f ≡ 0, motion in one plane, makes every interval a candidate: as many checks as there are
//     small intervals. fast::MethodOptions::max_checks bounds them; the answer is then undecided,
//     with max_checks as `checks`.
//   - It does not support a minimum separation: queries that only come within one are false
//     negatives.

#include "verify/baselines/baselines.hpp"

#include <array>

#include "verify/baselines/interval_search.hpp"
#include "verify/baselines/intervals.hpp"
#include "verify/baselines/method_support.hpp"

namespace touchstone::baselines {
namespace {

using Box = ParameterBox<1>;
using Points = std::array<IntervalVector, moving_points>;

/// True if p may be on the same side of the line ab as x, in the plane of all four.
bool may_be_inside(const IntervalVector& p, const IntervalVector& a, const IntervalVector& b,
                   const IntervalVector& x) {
  const IntervalVector edge = minus(b, a);
  return !(dot(cross(edge, minus(p, a)), cross(edge, minus(x, a))).upper() < 0.0);
}

bool may_touch_face(const Points& points) {
  const auto& [p, v1, v2, v3] = points;
  return may_be_inside(p, v2, v3, v1) && may_be_inside(p, v3, v1, v2) &&
         may_be_inside(p, v1, v2, v3);
}

bool may_touch_edge(const Points& points) {
  const auto& [a, b, c, d] = points;
  const IntervalVector n = cross(minus(b, a), minus(c, a));
  return !(dot(cross(minus(b, d), minus(c, d)), n).upper() < 0.0) &&
         !(dot(cross(minus(c, d), minus(a, d)), n).upper() < 0.0) &&
         !(dot(cross(minus(a, d), minus(b, d)), n).lower() > 0.0);
}

/// f of a query, in intervals, and the inside test.
class Coplanarity {
 public:
  Coplanarity(Kind kind, const Query& query) : kind_(kind), motion_(query) {}

  [[nodiscard]] bool may_vanish(const Box& box) const {
    const auto [a, b, c, d] = motion_.at(box[0]);
    return may_be_zero(kind_ == Kind::vertex_face
                           ? dot(cross(minus(c, b), minus(d, b)), minus(a, b))
                           : dot(cross(minus(b, a), minus(d, c)), minus(c, a)));
  }

  [[nodiscard]] static bool reaches_domain(const Box& /*box*/) { return true; }

  [[nodiscard]] bool accepts(const Box& box) const {
    const Points points = motion_.at(box[0]);
    return kind_ == Kind::vertex_face ? may_touch_face(points) : may_touch_edge(points);
  }

 private:
  Kind kind_;
  IntervalMotion motion_;
};

fast::Answer uirf(Kind kind, const Query& query, const fast::MethodOptions& options) {
  const std::array<double, 1> tolerances{options.tolerance / greatest_displacement(query)};
  const auto found = search_box(Coplanarity(kind, query), Box{Interval(0.0, options.t_max)},
                                tolerances, options.max_checks);
  const bool collides = found.verdict == fast::Verdict::yes;
  return {.verdict = found.verdict,
          .checks = to_checks(found.checks),
          .toi_lower = collides ? found.box[0].lower() : fast::Answer::none};
}

}  // namespace

std::unique_ptr<fast::Method> uirf_method() {
  return baseline_method({.name = "uirf",
                          .promise = fast::Promise::conservative,
                          .reference = "redon2002",
                          .is_tolerance_driven = true,
                          .usual_max_checks = 100'000},
                         uirf);
}

}  // namespace touchstone::baselines
