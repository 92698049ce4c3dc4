// The inequality of keeps_distance, and its errors.
//
// Each point of the polygon P (polygon_features.hpp) is a combination of the corners w_i with
// coefficients that do not depend on the time, so it moves by at most M t until t, where M is the
// greatest |w_i(1) − w_i(0)|. For any direction s ≠ 0 the distance d at t=0 is at least
// l = min s·w_i / |s|. So more than a distance e(d) = least + part (d − least) is left up to t_max
// if  l − t_max M > e(l):  d − e(d) does not decrease with d.
//
// Let u = 2^-53, S and W the greatest magnitudes of a component of s and of a corner; both are
// between 2^-400 and 2^400, so that products do not overflow, and only those that are negligible
// underflow.
// - s is the computed sum of the corners. It needs no bound: any s will do.
// - A product s·w_i has a rounded difference, a product and two sums: it is wrong by less than
//   4.01 u times a sum of three products, each at most S W, and by 2^-1073: together by less than
//   16 u S W. `length`, a root of a sum of three squares, is wrong by less than 4 u of it. So l
//   divided by 1 − 16 u, as computed, is not above the true one.
// - A difference of corners is wrong by at most 2.01 u W and u of it: the length of such errors of
//   three components is less than 4 u W. The root adds less than 4 u of it, and the underflow of
//   squares less than 2^-500.
// - Both sides of the inequality have fewer than six operations with results of at most l, each
//   wrong by at most u l, and so has e(d) in a caller's doubles, at most u d each. The margin of
//   2^-49 l, which is 16 u l, covers them, because (1 − part − 8 u) d does not decrease with d
//   where the inequality holds. (docs/theory.md, section 8.6)

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "fast/platform/floating_point_state.hpp"
#include "touchstone/contacts.hpp"
#include "touchstone/filters/polynomial_expressions.hpp"

namespace touchstone::fast {
namespace {

using Vector = filters::Vector3<double>;

double greatest(const Vector& a) {
  return std::max(std::max(std::abs(a[0]), std::abs(a[1])), std::abs(a[2]));
}

double length(const Vector& a) { return std::sqrt(filters::dot(a, a)); }

/// A lower bound of the distance at t=0 and an upper bound of M.
struct Bounds {
  double distance = 0.0;
  double motion = 0.0;
};

template <Kind kind>
Bounds bounds_of(const Query& query) {
  constexpr auto count = kind == Kind::vertex_face ? std::size_t{3} : std::size_t{4};
  constexpr double most = 0x1p400, least = 0x1p-400, u = 0x1p-53;
  std::array<Vector, count> start;
  Vector sum{};
  double size = 0.0, motion = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const Corner corner = corners(kind)[i];
    Vector moved;
    for (std::size_t k = 0; k < 3; ++k) {
      start[i][k] = query.at(0, corner.plus, k) - query.at(0, corner.minus, k);
      const double end = query.at(1, corner.plus, k) - query.at(1, corner.minus, k);
      moved[k] = end - start[i][k];
      sum[k] += start[i][k];
      size = std::max(size, std::max(std::abs(start[i][k]), std::abs(end)));
    }
    motion = std::max(motion, length(moved));
  }
  // Written so that NaN, which can be in any of them, fails too.
  const double size_of_sum = greatest(sum);
  if (!(is_finite(query) && size <= most && size_of_sum >= least && size_of_sum <= most)) return {};
  double gap = filters::dot(sum, start[0]);
  for (const Vector& corner : start) gap = std::min(gap, filters::dot(sum, corner));
  return {(gap - 16.0 * u * size_of_sum * size) / length(sum) * (1.0 - 16.0 * u),
          motion * (1.0 + 16.0 * u) + 8.0 * u * size + 0x1p-500};
}

}  // namespace

bool keeps_distance(Kind kind, const Query& query, double t_max, const KeptDistance& kept) {
  const StrictFloatingPoint strict;
  const auto [distance, motion] = kind == Kind::vertex_face ? bounds_of<Kind::vertex_face>(query)
                                                            : bounds_of<Kind::edge_edge>(query);
  if (!(distance > kept.least)) return false;
  const double left = (distance - t_max * motion) - 0x1p-49 * distance;
  return left > kept.least + kept.part * (distance - kept.least);
}

}  // namespace touchstone::fast
