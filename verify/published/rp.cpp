// RP: root parity [brochu2012].
//
// **Theorem.** F maps the boundary of its domain (a prism for vertex-face, a cube for edge-edge)
// to a closed surface of triangles and bilinear patches. If 0 is not on it, the number of roots of
// F inside, each counted with its multiplicity, has the parity of the number of times that a ray
// from 0 crosses the surface.
//
// **Algorithm.** If a plane through 0 has all corners of F strictly on one side, the answer is no.
// Otherwise the crossings of a segment from 0 to beyond the corners are counted: with triangles by
// orientations, with a patch by two triangles of its corners' tetrahedron, chosen by the side of
// the patch that 0 is on. Signs come from intervals in upward rounding, and from exact numbers if
// these contain 0. A crossing on a triangle's boundary invalidates the segment; after ten segments
// the answer is yes.
//
// **Answer.** A verdict, without a time of impact (a yes ignores t_max) and without separation.
//
// **Known defects.**
//   - *False negatives*: even numbers of roots, always. In and out again within the step: a fifth
//     of random vertex-face collisions with large deformation, a third of edge-edge. The test
//     separates the queries by their number of roots: even ones are missed, odd ones found.
//   - *False positives*: a flat patch that folds over itself ("hourglass"), in whose plane 0 lies
//     within the hull of the corners but not on the patch; and queries that are still open after
//     ten segments. All segments lie in the plane z = 0, so primitives in that plane can
//     invalidate all of them.
//   - *False positives* where all coordinates are below about 1e-15: the segment is at least 10
//     long, so the weight of a crossing with a face at t=0 or t=1 is rounded to that of 0 itself,
//     which is treated as contact there.
//   - In the coplanar fallback the crossing of one edge is not noticed (planar_overlap.hpp): the
//     parity may then be wrong either way.
//
// **Promise.** None. The directions are drawn from a generator seeded with the query.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <span>
#include <stdexcept>

#include "verify/published/bernstein.hpp"
#include "verify/published/exact_number.hpp"
#include "verify/published/planar_overlap.hpp"
#include "verify/published/published.hpp"
#include "verify/published/upward_interval.hpp"

namespace touchstone::verify::published {
namespace {

using Interval = UpwardInterval;
using IntervalPoint = std::array<Interval, 3>;
using Triangle = std::array<std::size_t, 3>;
/// Bilinear, with the diagonals q0 q3 and q1 q2.
using Patch = std::array<std::size_t, 4>;

/// A value of F: point `plus` less point `minus` at time `end`.
struct ImageCorner {
  std::size_t end, plus, minus;
};

/// The image of the domain's boundary.
struct Boundary {
  std::span<const ImageCorner> corners;
  std::span<const Triangle> caps;
  std::span<const Patch> patches;
  std::span<const Triangle> culling_planes;  ///< corners to which planes through 0 are parallel
};

const Boundary& boundary_of(ContactKind kind) {
  static constexpr std::array<ImageCorner, 6> prism_corners{
      {{0, 0, 1}, {0, 0, 2}, {0, 0, 3}, {1, 0, 1}, {1, 0, 2}, {1, 0, 3}}};
  static constexpr std::array<Triangle, 2> caps{{{0, 1, 2}, {3, 4, 5}}};
  static constexpr std::array<Patch, 3> prism_patches{{{0, 1, 3, 4}, {1, 2, 4, 5}, {0, 2, 3, 5}}};
  static constexpr std::array<Triangle, 5> prism_planes{
      {{0, 1, 2}, {3, 4, 5}, {0, 1, 3}, {1, 2, 4}, {0, 2, 3}}};
  static constexpr Boundary prism{prism_corners, caps, prism_patches, prism_planes};
  // (t,u) around the edge's square, at v = 0 and at v = 1.
  static constexpr std::array<ImageCorner, 8> cube_corners{
      {{0, 0, 2}, {1, 0, 2}, {1, 1, 2}, {0, 1, 2}, {0, 0, 3}, {1, 0, 3}, {1, 1, 3}, {0, 1, 3}}};
  static constexpr std::array<Patch, 6> cube_patches{
      {{0, 1, 3, 2}, {0, 1, 4, 5}, {1, 2, 5, 6}, {2, 3, 6, 7}, {3, 0, 7, 4}, {4, 5, 7, 6}}};
  static constexpr std::array<Triangle, 6> cube_planes{
      {{0, 1, 3}, {0, 1, 4}, {1, 2, 5}, {2, 3, 6}, {3, 0, 7}, {4, 5, 7}}};
  static constexpr Boundary cube{cube_corners, {}, cube_patches, cube_planes};
  return kind == ContactKind::vertex_face ? prism : cube;
}

Interval difference(const Query& query, const ImageCorner& corner, std::size_t axis) {
  return Interval(query.at(corner.end, corner.plus, axis)) -
         Interval(query.at(corner.end, corner.minus, axis));
}

/// a × b · c.
template <class Number>
Number volume(const Vector<Number>& a, const Vector<Number>& b, const Vector<Number>& c) {
  return dot(published::cross(a, b), c);
}

/// The end (x, y, 0) of a segment from 0.
struct SegmentEnd {
  double x, y;
};

/// The volume of `end`, a and b.
template <class Number>
Number volume_with_end(const std::array<Number, 2>& end, const std::array<Number, 3>& a,
                       const std::array<Number, 3>& b) {
  return (end[0] * a[1] - end[1] * a[0]) * b[2] - a[2] * (end[0] * b[1] - end[1] * b[0]);
}

/// A number with its exact sign and an approximate value.
struct Signed {
  int sign;
  double estimate;
};

/// The position of a segment from 0 relative to a triangle.
struct Crossing {
  bool is_there = false;
  double weight_of_origin = 0.5;
  std::array<double, 3> weights{0.5, 0.5, 0.5};

  [[nodiscard]] bool is_on_boundary() const {
    return std::ranges::any_of(weights, [](double x) { return x == 0.0 || x == 1.0; });
  }
};

/// Outcome of a trial with one segment.
enum class Outcome { odd, even, on_surface, spoiled };

/// One segment and the crossings of it.
class Try {
 public:
  Try(const Query& query, const Boundary& boundary, std::span<const IntervalPoint> corners,
      const SegmentEnd& end)
      : query_(query),
        boundary_(boundary),
        corners_(corners),
        end_(end),
        interval_end_{end.x, end.y} {}

  Outcome run() {
    for (const Triangle& cap : boundary_.caps) {
      const Crossing crossing = cross(cap);
      if (crossing.is_there && crossing.weight_of_origin == 1.0) return Outcome::on_surface;
      count(crossing);
    }
    for (const Patch& patch : boundary_.patches) {
      if (!spoiled_ && count_crossings(patch)) return Outcome::on_surface;
    }
    if (spoiled_) return Outcome::spoiled;
    return odd_ ? Outcome::odd : Outcome::even;
  }

 private:
  void count(const Crossing& crossing) {
    if (!crossing.is_there) return;
    if (crossing.is_on_boundary()) spoiled_ = true;
    odd_ = !odd_;
  }

  /// Counts a patch's crossings. True if 0 is on it.
  bool count_crossings(const Patch& q) {
    // The plane functions of two faces have the product V²/4 ≥ 0 in the middle of q0 q3: the
    // positive pair of faces are always those along this diagonal.
    const std::array<Triangle, 2> positive{{{q[0], q[1], q[3]}, {q[0], q[3], q[2]}}};
    const std::array<Triangle, 2> negative{{{q[0], q[1], q[2]}, {q[1], q[3], q[2]}}};
    if (!tetrahedron_holds_origin(q)) {
      for (const Triangle& triangle : positive) count(cross(triangle));
      return false;
    }
    const int side = side_of_patch(q);
    if (side == 0) return true;
    bool is_crossed = false;
    for (const Triangle& triangle : side > 0 ? negative : positive) {
      const Crossing crossing = cross(triangle);
      if (crossing.is_there && crossing.is_on_boundary()) spoiled_ = true;
      is_crossed = is_crossed || crossing.is_there;
    }
    if (is_crossed) odd_ = !odd_;
    return false;
  }

  /// The volumes of 0 with the faces of a patch's tetrahedron, by the corner that is not in the
  /// face.
  template <class Number>
  static std::array<Number, 4> volumes(std::span<const std::array<Number, 3>> x, const Patch& q) {
    return {volume(x[q[1]], x[q[2]], x[q[3]]), -volume(x[q[0]], x[q[2]], x[q[3]]),
            volume(x[q[0]], x[q[1]], x[q[3]]), -volume(x[q[0]], x[q[1]], x[q[2]])};
  }

  /// True if 0 is in the closed tetrahedron of the corners, which may be flat.
  bool tetrahedron_holds_origin(const Patch& q) {
    const auto rough = volumes<Interval>(corners_, q);
    std::array<int, 4> signs{};
    std::ranges::transform(rough, signs.begin(), [](const Interval& x) { return x.sign(); });
    const auto has = [&](int sign) { return std::ranges::find(signs, sign) != signs.end(); };
    if (has(1) && has(-1)) return false;
    if (has(0)) {
      const auto all = volumes<ExactNumber>(exact().corners, q);
      std::ranges::transform(all, signs.begin(), [](const ExactNumber& x) { return x.sign(); });
    }
    if (has(1) || has(-1)) return !(has(1) && has(-1));
    return flat_hull_holds_origin(q);
  }

  bool flat_hull_holds_origin(const Patch& q) {
    const std::span<const ExactPoint> x = exact().corners;
    const std::array<ExactPoint, 2> origin{};
    const auto holds = [&](std::size_t i, std::size_t j, std::size_t k) {
      return planar_overlap(origin, {x[q[i]], x[q[j]], x[q[k]]}).overlaps;
    };
    return holds(0, 1, 2) || holds(0, 1, 3) || holds(0, 2, 3) || holds(1, 2, 3);
  }

  /// The sign of φ = g_012 g_132 − g_013 g_032 at 0, with the plane functions g: 0 on the patch.
  int side_of_patch(const Patch& q) {
    const auto phi = [](const auto& v) { return v[0] * v[3] - v[1] * v[2]; };
    const int rough = phi(volumes<Interval>(corners_, q)).sign();
    return rough != 0 ? rough : phi(volumes<ExactNumber>(exact().corners, q)).sign();
  }

  /// The segment's crossing with a triangle: the affine dependence of the five points, whose
  /// coefficients are volumes; both simplices must have coefficients of one sign.
  Crossing cross(const Triangle& t) {
    std::array<Signed, 3> of_triangle{};
    for (std::size_t i = 0; i < 3; ++i) {
      of_triangle[i] = volume_at_end(t[(i + 1) % 3], t[(i + 2) % 3]);
      for (std::size_t j = 0; j < i; ++j) {
        if (of_triangle[i].sign * of_triangle[j].sign < 0) return {};
      }
    }
    const Signed of_end = end_coefficient(t);
    const Signed of_origin = origin_coefficient(t);
    if (of_origin.sign * of_end.sign < 0) return {};
    const double segment_sum = of_origin.estimate + of_end.estimate;
    const double triangle_sum =
        of_triangle[0].estimate + of_triangle[1].estimate + of_triangle[2].estimate;
    if (segment_sum == 0.0 || triangle_sum == 0.0) return cross_in_plane(t);
    Crossing crossing{true, of_origin.estimate / segment_sum, {}};
    for (std::size_t i = 0; i < 3; ++i) {
      crossing.weights[i] = of_triangle[i].estimate / triangle_sum;
    }
    return crossing;
  }

  Crossing cross_in_plane(const Triangle& t) {
    const auto& [unit, x, end] = exact();
    const auto found = planar_overlap({ExactPoint{}, {end[0], end[1], ExactNumber()}},
                                      {x[t[0]], x[t[1]], x[t[2]]});
    return {found.overlaps, found.segment_weights[0], found.triangle_weights};
  }

  Signed volume_at_end(std::size_t i, std::size_t j) {
    return known(volume_with_end(interval_end_, corners_[i], corners_[j]), [&] {
      const auto& [unit, x, end] = exact();
      return volume_with_end(end, x[i], x[j]);
    });
  }

  Signed end_coefficient(const Triangle& t) {
    return known(-volume(corners_[t[0]], corners_[t[1]], corners_[t[2]]), [&] {
      const auto& x = exact().corners;
      return -volume(x[t[0]], x[t[1]], x[t[2]]);
    });
  }

  /// The coefficients sum to 0.
  Signed origin_coefficient(const Triangle& t) {
    const auto sum = [&t](const auto& x, const auto& end) {
      return volume(x[t[0]], x[t[1]], x[t[2]]) - volume_with_end(end, x[t[1]], x[t[2]]) -
             volume_with_end(end, x[t[2]], x[t[0]]) - volume_with_end(end, x[t[0]], x[t[1]]);
    };
    return known(sum(corners_, interval_end_), [&] { return sum(exact().corners, exact().end); });
  }

  template <class Exactly>
  Signed known(const Interval& rough, const Exactly& exactly) {
    if (rough.sign() != 0) return {rough.sign(), rough.estimate()};
    const ExactNumber value = exactly();
    return {value.sign(), value.estimate(3L * exact().unit)};
  }

  /// Differences below the resolution of interval arithmetic, in units of a power of two.
  struct Exact {
    int unit;  ///< its exponent
    std::array<ExactPoint, 8> corners;
    std::array<ExactNumber, 2> end;
  };

  const Exact& exact() {
    if (exact_) return *exact_;
    const std::array end{end_.x, end_.y};
    const int unit = std::min(common_exponent(query_.coordinates), common_exponent(end));
    const auto scaled = [&](double x) { return scaled_to_integer(x, unit); };
    exact_ = Exact{unit, {}, {scaled(end_.x), scaled(end_.y)}};
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const auto& [at, plus, minus] = boundary_.corners[i];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        exact_->corners[i][axis] =
            scaled(query_.at(at, plus, axis)) - scaled(query_.at(at, minus, axis));
      }
    }
    return *exact_;
  }

  const Query& query_;
  const Boundary& boundary_;
  std::span<const IntervalPoint> corners_;
  SegmentEnd end_;
  std::array<Interval, 2> interval_end_;
  std::optional<Exact> exact_;
  bool odd_ = false;
  bool spoiled_ = false;
};

/// True if all of these are strictly on one side of 0.
template <class SideOf>
bool are_on_one_side(std::span<const IntervalPoint> corners, const SideOf& side_of) {
  const int side = side_of(corners[0]).sign();
  return side != 0 && std::ranges::all_of(corners.subspan(1), [&](const IntervalPoint& x) {
           return side_of(x).sign() == side;
         });
}

/// The planes whose normals have entries −1 and 0.
bool is_culled_by_fixed_planes(std::span<const IntervalPoint> corners) {
  for (unsigned axes = 1; axes < 8; ++axes) {
    const auto side_of = [axes](const IntervalPoint& x) {
      Interval sum;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if ((axes >> axis & 1U) != 0) sum = sum - x[axis];
      }
      return sum;
    };
    if (are_on_one_side(corners, side_of)) return true;
  }
  return false;
}

/// The unit normal of three corners' middles; empty if they lie nearly on a line.
std::optional<std::array<double, 3>> normal_of(std::span<const IntervalPoint> corners,
                                               const Triangle& t) {
  std::array<Vector<double>, 2> edges{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < 2; ++i) {
      edges[i][axis] = corners[t[i + 1]][axis].estimate() - corners[t[0]][axis].estimate();
    }
  }
  Vector<double> n = published::cross(edges[0], edges[1]);
  const double length = std::sqrt(dot(n, n));
  if (!(length > 0.0 && std::isfinite(length))) return std::nullopt;
  for (double& x : n) x /= length;
  return n;
}

bool is_culled_by_own_planes(std::span<const IntervalPoint> corners, const Boundary& boundary) {
  return std::ranges::any_of(boundary.culling_planes, [&](const Triangle& t) {
    const auto normal = normal_of(corners, t);
    return normal && are_on_one_side(corners, [&](const IntervalPoint& x) {
             const auto& n = *normal;
             return Interval(n[0]) * x[0] + Interval(n[1]) * x[1] + Interval(n[2]) * x[2];
           });
  });
}

/// Beyond every corner on every axis.
double reach_of(std::span<const IntervalPoint> corners) {
  double reach = 0.0;
  for (const IntervalPoint& corner : corners) {
    for (const Interval& x : corner) reach = std::max({reach, x.minus_lower, x.upper});
  }
  return reach + 10.0;
}

bool has_odd_crossings(const Query& query, const Boundary& boundary,
                       std::span<const IntervalPoint> corners) {
  constexpr int most_tries = 10;
  const double reach = reach_of(corners), length = reach * std::numbers::sqrt2;
  if (!std::isfinite(length)) throw std::overflow_error("rp: the segment's end is out of range");
  auto random = random_of(query);
  SegmentEnd end{reach, reach};
  for (int i = 0; i < most_tries; ++i) {
    switch (Try(query, boundary, corners, end).run()) {
      case Outcome::odd:
      case Outcome::on_surface:
        return true;
      case Outcome::even:
        return false;
      case Outcome::spoiled:
        break;
    }
    const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
    end = {std::cos(angle) * length, -std::sin(angle) * length};
  }
  return true;
}

/// Not inlined: its arithmetic must stay within upward rounding, which does not affect exact
/// numbers.
[[gnu::noinline]] bool collides_by_parity(ContactKind kind, const Query& query) {
  const Boundary& boundary = boundary_of(kind);
  std::array<IntervalPoint, 8> memory;
  const std::span corners(memory.data(), boundary.corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      corners[i][axis] = difference(query, boundary.corners[i], axis);
    }
  }
  if (is_culled_by_fixed_planes(corners) || is_culled_by_own_planes(corners, boundary))
    return false;
  return has_odd_crossings(query, boundary, corners);
}

}  // namespace

Answer rp(ContactKind kind, const Query& query, const TouchstonePluginOptions& /*options*/) {
  const RoundingMode upward(FE_UPWARD);
  return yes_if(collides_by_parity(kind, query));
}

}  // namespace touchstone::verify::published
