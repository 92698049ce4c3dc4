// IRF: the multivariate interval root finder ([snyder1992]; as compared by [wang2021]).
//
// F(t,u,v) is evaluated in intervals over boxes of parameters, first the points at t, then their
// combination. A box for which a component of F excludes 0 holds no root and is dropped; the
// others are bisected, t, u and v in turn, depth first (interval_search.hpp). A box narrower than
// δ divided by the greatest displacement in t, and by the lengths of the edges in u and v, is a
// collision.
//
// **Promise.** Conservative: rounding is outward and no box that holds a root is dropped.
//
// **Known defects.**
//   - The box that ends the search is small in its parameters and need not hold a root, nor be
//     within δ in F: near misses of δ's order are false positives. (A vertex that passes the side
//     u + v = 1 of a face, δ/16 away.)
//   - With rotating dimensions that box need not be the earliest: its time bounds nothing, so
//     answers have none.
//   - Only max_checks bounds the work: after that number of boxes the answer is undecided. Motion
//   in a plane takes longest if the primitives
//     barely avoid a contact.
//   - It does not support a minimum separation: queries that only come within one are false
//     negatives.

#include <algorithm>
#include <array>

#include "touchstone/mesh.hpp"
#include "verify/published/interval_search.hpp"
#include "verify/published/published.hpp"

namespace touchstone::verify::published {
namespace {

using Box = ParameterBox<3>;

/// The greater of a segment's lengths at t=0 and t=1.
double greatest_length(const Query& query, std::size_t from, std::size_t to) {
  return std::max((point_of(query, 0, to) - point_of(query, 0, from)).norm(),
                  (point_of(query, 1, to) - point_of(query, 1, from)).norm());
}

/// F of a query, in intervals.
class ContactFunction {
 public:
  ContactFunction(ContactKind kind, const Query& query) : kind_(kind), query_(query) {}

  [[nodiscard]] bool may_vanish(const Box& box) const {
    const auto [t, u, v] = box;
    const auto [a, b, c, d] = points_at(query_, t);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const UpwardInterval f =
          kind_ == ContactKind::vertex_face
              ? a[axis] - (b[axis] + u * (c[axis] - b[axis]) + v * (d[axis] - b[axis]))
              : ((b[axis] - a[axis]) * u + a[axis]) - ((d[axis] - c[axis]) * v + c[axis]);
      if (f.sign() != 0) return false;
    }
    return true;
  }

  /// True if the box contains a point with u + v ≤ 1.
  [[nodiscard]] bool reaches_domain(const Box& box) const {
    return kind_ == ContactKind::edge_edge || box[1].minus_lower + box[2].minus_lower >= -1.0;
  }

  [[nodiscard]] static bool accepts(const Box& /*box*/) { return true; }

 private:
  ContactKind kind_;
  const Query& query_;
};

/// δ divided by the greatest change of F for a unit of the parameter. Infinite without a change:
/// that parameter needs no splitting.
std::array<double, 3> parameter_tolerances(ContactKind kind, const Query& query, double tolerance) {
  const bool is_face = kind == ContactKind::vertex_face;
  return {tolerance / greatest_displacement(query),
          tolerance / greatest_length(query, is_face ? 1 : 0, is_face ? 2 : 1),
          tolerance / greatest_length(query, is_face ? 1 : 2, 3)};
}

/// Not inlined: its arithmetic must stay where the rounding mode is upward.
[[gnu::noinline]] TouchstoneVerdict search(ContactKind kind, const Query& query,
                                           const std::array<double, 3>& tolerances,
                                           const TouchstonePluginOptions& options) {
  const Box domain{{{-0.0, options.t_max}, {-0.0, 1.0}, {-0.0, 1.0}}};
  return search_box(ContactFunction(kind, query), domain, tolerances, options.max_checks).verdict;
}

}  // namespace

Answer irf(ContactKind kind, const Query& query, const TouchstonePluginOptions& options) {
  const auto tolerances = parameter_tolerances(kind, query, options.tolerance);
  const RoundingMode upward(FE_UPWARD);
  return {search(kind, query, tolerances, options)};
}

}  // namespace touchstone::verify::published
