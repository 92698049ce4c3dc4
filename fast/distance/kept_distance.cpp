// The inequality of keeps_distance, and its errors.
//
// Each point of the polygon P (polygon_features.hpp) is a combination of the corners w_i with
// coefficients that do not depend on the time, so it moves by at most M t until t, where M is the
// greatest |w_i(1) − w_i(0)|. For any direction s ≠ 0 the distance d at t=0 is at least
// l = min s·w_i / |s|*, where |s|* is the length in the dual norm: L2 of L2, L1 of L∞. So more
// than a distance e(d) = least + part (d − least) is left up to t_max if  l − t_max M > e(l):
// d − e(d) does not decrease with d.
//
// Let u = 2^-53, S and W the greatest magnitudes of a component of s and of a corner; both are at
// most 2^400, and S is at least 2^-400, so that products do not overflow, and only those that are
// negligible underflow.
// - s is computed, and needs no bound: any s will do.
// - A product s·w_i has a rounded difference, a product and two sums: it is wrong by less than
//   4.01 u times a sum of three products, each at most S W, and by 2^-1073: together by less than
//   16 u S W. |s|*, a root of a sum of three squares or a sum of three magnitudes, is wrong by less
//   than 4 u of it. So l divided by 1 − 16 u, as computed, is not above the true one.
// - A difference of corners is wrong by at most 2.01 u W and u of it: the length of such errors of
//   three components is less than 4 u W. A root adds less than 4 u of it, and the underflow of
//   squares less than 2^-500.
// - Both sides of the inequality have fewer than six operations with results of at most l, each
//   wrong by at most u l, and so has e(d) in a caller's doubles, at most u d each. The margin of
//   2^-49 l, which is 16 u l, covers them, because (1 − part − 8 u) d does not decrease with d
//   where the inequality holds. (docs/theory.md, section 8.6)

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "fast/platform/floating_point_state.hpp"
#include "touchstone/contacts.hpp"
#include "touchstone/filters/polynomial_expressions.hpp"

namespace touchstone::fast {
namespace {

using Vector = filters::Vector3<double>;

double greatest(const Vector& a) {
  return std::max(std::max(std::abs(a[0]), std::abs(a[1])), std::abs(a[2]));
}

/// The length in L2.
double length(const Vector& a) { return std::sqrt(filters::dot(a, a)); }

/// The length of a motion, or its square.
template <Norm norm>
double comparable(const Vector& motion) {
  return norm == Norm::l2 ? filters::dot(motion, motion) : greatest(motion);
}

/// The dual length of a direction.
template <Norm norm>
double dual_size_of(const Vector& direction) {
  if constexpr (norm == Norm::l2) return length(direction);
  return std::abs(direction[0]) + std::abs(direction[1]) + std::abs(direction[2]);
}

constexpr double u = 0x1p-53, least_size = 0x1p-400, greatest_size = 0x1p400;

/// The polygon of a query, and a test of directions.
template <ContactKind kind, Norm norm>
class Polygon {
 public:
  static constexpr auto count = kind == ContactKind::vertex_face ? std::size_t{3} : std::size_t{4};

  explicit Polygon(const Query& query) {
    // NaN and infinity, which comparisons may miss, are in the total.
    double motion = 0.0, total = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const Corner corner = corners(kind)[i];
      Vector moved;
      for (std::size_t k = 0; k < 3; ++k) {
        w_[i][k] = query.at(0, corner.plus, k) - query.at(0, corner.minus, k);
        const double end = query.at(1, corner.plus, k) - query.at(1, corner.minus, k);
        moved[k] = end - w_[i][k];
        size_ = std::max(size_, std::max(std::abs(w_[i][k]), std::abs(end)));
      }
      motion = std::max(motion, comparable<norm>(moved));
      total += filters::dot(moved, moved);
    }
    motion_ = (norm == Norm::l2 ? std::sqrt(motion) : motion) * (1.0 + 16.0 * u) + 8.0 * u * size_ +
              0x1p-500;
    is_usual_ = size_ <= greatest_size && total < std::numeric_limits<double>::infinity();
  }

  /// True if the inequality holds with the l of a direction.
  [[nodiscard]] bool keeps(const Vector& s, double t_max, const KeptDistance& kept) const {
    const double size = greatest(s);
    if (!(is_usual_ && size >= least_size && size <= greatest_size)) return false;
    double lowest = filters::dot(s, w_[0]);
    for (const Vector& corner : w_) lowest = std::min(lowest, filters::dot(s, corner));
    const double l = (lowest - 16.0 * u * size * size_) / dual_size_of<norm>(s) * (1.0 - 16.0 * u);
    if (!(l > kept.least)) return false;
    const double left = (l - t_max * motion_) - 0x1p-49 * l;
    return left > kept.least + kept.part * (l - kept.least);
  }

  [[nodiscard]] Vector sum_of_corners() const {
    Vector sum{};
    for (const Vector& corner : w_)
      sum = {sum[0] + corner[0], sum[1] + corner[1], sum[2] + corner[2]};
    return sum;
  }

  /// The point of the polygon's sides that is nearest to the origin in L2, nearly.
  [[nodiscard]] Vector nearest_of_sides() const {
    Vector nearest = w_[0];
    for (std::size_t i = 0; i < count; ++i) {
      const Vector &from = w_[i], side = minus(w_[(i + 1) % count], from);
      const double part = -filters::dot(from, side) / filters::dot(side, side);
      const double on_side = part > 0.0 ? std::min(part, 1.0) : 0.0;
      const Vector x{from[0] + on_side * side[0], from[1] + on_side * side[1],
                     from[2] + on_side * side[2]};
      if (filters::dot(x, x) < filters::dot(nearest, nearest)) nearest = x;
    }
    return nearest;
  }

  /// The polygon's normal that points away from the origin.
  [[nodiscard]] Vector normal() const {
    const Vector n = filters::cross(minus(w_[1], w_[0]), minus(w_[count - 1], w_[0]));
    return filters::dot(n, w_[0]) > 0.0 ? n : Vector{-n[0], -n[1], -n[2]};
  }

 private:
  static Vector minus(const Vector& a, const Vector& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  }

  std::array<Vector, count> w_;  ///< the corners at t=0, in cyclic order
  double size_ = 0.0;            ///< W
  double motion_ = 0.0;          ///< an upper bound of M
  bool is_usual_ = false;        ///< all is finite, and products do not overflow
};

/// Tries a cheap direction, then that of the nearest point of the sides, then the normal.
template <ContactKind kind, Norm norm>
bool keeps(const Query& query, double t_max, const KeptDistance& kept) {
  const Polygon<kind, norm> polygon(query);
  return polygon.keeps(polygon.sum_of_corners(), t_max, kept) ||
         polygon.keeps(polygon.nearest_of_sides(), t_max, kept) ||
         polygon.keeps(polygon.normal(), t_max, kept);
}

}  // namespace

bool keeps_distance(ContactKind kind, const Query& query, double t_max, const KeptDistance& kept) {
  if (decided_as(kind) != kind) {
    return keeps_distance(decided_as(kind), decided_query(kind, query), t_max, kept);
  }
  const StrictFloatingPoint strict;
  const bool is_l2 = kept.norm == Norm::l2;
  if (kind == ContactKind::vertex_face) {
    return is_l2 ? keeps<ContactKind::vertex_face, Norm::l2>(query, t_max, kept)
                 : keeps<ContactKind::vertex_face, Norm::linf>(query, t_max, kept);
  }
  return is_l2 ? keeps<ContactKind::edge_edge, Norm::l2>(query, t_max, kept)
               : keeps<ContactKind::edge_edge, Norm::linf>(query, t_max, kept);
}

}  // namespace touchstone::fast
