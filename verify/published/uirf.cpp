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
//     small intervals. max_checks bounds them; the answer is then undecided.
//   - It does not support a minimum separation: queries that only come within one are false
//     negatives.

#include <array>

#include "verify/published/interval_search.hpp"
#include "verify/published/published.hpp"

namespace touchstone::verify::published {
namespace {

using Box = ParameterBox<1>;

/// True if p may be on the same side of the line ab as x, in the plane of all four.
bool may_be_inside(const IntervalPoint& p, const IntervalPoint& a, const IntervalPoint& b,
                   const IntervalPoint& x) {
  const IntervalPoint edge = b - a;
  return !(dot(cross(edge, p - a), cross(edge, x - a)).upper < 0.0);
}

bool may_touch_face(const IntervalPoints& points) {
  const auto& [p, v1, v2, v3] = points;
  return may_be_inside(p, v2, v3, v1) && may_be_inside(p, v3, v1, v2) &&
         may_be_inside(p, v1, v2, v3);
}

bool may_touch_edge(const IntervalPoints& points) {
  const auto& [a, b, c, d] = points;
  const IntervalPoint n = cross(b - a, c - a);
  return !(dot(cross(b - d, c - d), n).upper < 0.0) && !(dot(cross(c - d, a - d), n).upper < 0.0) &&
         !(dot(cross(a - d, b - d), n).minus_lower < 0.0);
}

/// f of a query, in intervals, and the inside test.
class Coplanarity {
 public:
  Coplanarity(ContactKind kind, const Query& query) : kind_(kind), query_(query) {}

  [[nodiscard]] bool may_vanish(const Box& box) const {
    const auto [a, b, c, d] = points_at(query_, box[0]);
    const UpwardInterval f = kind_ == ContactKind::vertex_face ? dot(cross(c - b, d - b), a - b)
                                                               : dot(cross(b - a, d - c), c - a);
    return f.sign() == 0;
  }

  [[nodiscard]] static bool reaches_domain(const Box& /*box*/) { return true; }

  [[nodiscard]] bool accepts(const Box& box) const {
    const IntervalPoints points = points_at(query_, box[0]);
    return kind_ == ContactKind::vertex_face ? may_touch_face(points) : may_touch_edge(points);
  }

 private:
  ContactKind kind_;
  const Query& query_;
};

/// Not inlined: its arithmetic must stay where the rounding mode is upward.
[[gnu::noinline]] Answer search(ContactKind kind, const Query& query, double tolerance,
                                const TouchstonePluginOptions& options) {
  const auto [verdict, box] =
      search_box(Coplanarity(kind, query), Box{UpwardInterval{-0.0, options.t_max}},
                 std::array{tolerance}, options.max_checks);
  if (verdict != TOUCHSTONE_YES) return {verdict};
  return {verdict, -box[0].minus_lower};
}

}  // namespace

Answer uirf(ContactKind kind, const Query& query, const TouchstonePluginOptions& options) {
  const double tolerance = options.tolerance / greatest_displacement(query);
  const RoundingMode upward(FE_UPWARD);
  return search(kind, query, tolerance, options);
}

}  // namespace touchstone::verify::published
