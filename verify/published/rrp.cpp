// RRP: rational root parity, after [brochu2012] with degenerate patches handled ([wang2021]).
//
// **Algorithm.** As RP (rp.cpp), the crossings of a ray from 0 with the image of
// the domain's boundary are counted, everything in rationals. A flat patch is replaced by the
// triangles that it covers. In front of a patch that is not flat stand two faces of its corners'
// tetrahedron, chosen by the side of the patch that 0 is on. A ray that is parallel to a triangle
// or meets its boundary is replaced by another direction; after eight more there is an error, and
// an error is answered with no.
//
// **Answer.** A verdict, without a time of impact (a yes ignores t_max) and without separation.
//
// **Known defects**:
//   - *False negatives*: even numbers of roots, as for RP.
//   - If nothing moves, or all four points move by the same vector, the answer is no without an
//     examination: contact at rest or under a common translation is missed.
//   - A triangle that is degenerate at t=0 or t=1 makes a cap without area, to which every ray is
//     parallel: nine directions, an error, no. Contact with it at any time is missed.
//   - *False positives*: none on published data. But the two triangles in place of a flat patch
//     are hit if either is, and together they are more than the patch where its outline has a
//     reflex corner: the parity may be wrong either way, and 0 may be on a part outside the patch.
//     The test has an example.
//
// **Promise.** None. The directions are drawn from a generator seeded with the query.

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "verify/published/bernstein.hpp"
#include "verify/published/published.hpp"

namespace touchstone::verify::published {
namespace {

using generate::Random;
using Rational = mpq_class;
using Point = Vector<Rational>;
using Triangle = std::array<Point, 3>;
/// Bilinear, its corners in cyclic order.
using Patch = std::array<Point, 4>;

Point operator*(const Rational& x, const Point& a) { return {x * a[0], x * a[1], x * a[2]}; }

bool has_no_area(const Triangle& t) { return cross(t[1] - t[0], t[2] - t[0]) == Point{}; }

/// The number of crossings of a ray from a point with a surface.
enum class Hit { none, crosses, on_surface, bad_luck, error };

bool settles(Hit hit) {
  return hit == Hit::bad_luck || hit == Hit::on_surface || hit == Hit::error;
}

/// The ray from 0 along `direction`.
Hit ray_hit(const Point& direction, const Triangle& triangle) {
  const Point a = triangle[1] - triangle[0], b = triangle[2] - triangle[0];
  const Point n = cross(a, b);
  const Rational determinant = dot(direction, n);
  if (determinant == 0) return Hit::bad_luck;
  // time·direction = triangle[0] + u a + v b, by Cramer's rule.
  const Point moment = cross(direction, triangle[0]);
  const Rational time = dot(triangle[0], n) / determinant;
  const Rational u = -dot(b, moment) / determinant, v = dot(a, moment) / determinant;
  if (time < 0 || u < 0 || v < 0 || u + v > 1) return Hit::none;
  if (time == 0) return Hit::on_surface;
  return u == 0 || v == 0 || u + v == 1 ? Hit::bad_luck : Hit::crosses;
}

/// The proper crossing of segments ab and cd, if any. \pre they lie in a plane.
std::optional<Point> proper_crossing(const Point& a, const Point& b, const Point& c,
                                     const Point& d) {
  const Point ab = b - a, cd = d - c;
  const Point n = cross(ab, cd);
  const Rational square = dot(n, n);
  if (square == 0) return std::nullopt;
  const Rational along_ab = dot(cross(c - a, cd), n) / square;
  const Rational along_cd = dot(cross(c - a, ab), n) / square;
  const auto is_inner = [](const Rational& x) { return x > 0 && x < 1; };
  if (!is_inner(along_ab) || !is_inner(along_cd)) return std::nullopt;
  return a + along_ab * ab;
}

/// The triangles that a flat patch covers.
std::array<Triangle, 2> wings_of(const Patch& q) {
  if (const auto x = proper_crossing(q[0], q[1], q[2], q[3])) {
    return {{{q[0], q[3], *x}, {q[1], q[2], *x}}};
  }
  if (const auto x = proper_crossing(q[1], q[2], q[3], q[0])) {
    return {{{q[0], q[1], *x}, {q[2], q[3], *x}}};
  }
  return {{{q[0], q[1], q[2]}, {q[0], q[2], q[3]}}};
}

bool are_the_same(const Triangle& a, const Triangle& b) {
  return std::ranges::is_permutation(a, b);
}

Hit hit_of_flat_patch(const Point& direction, const Patch& q) {
  if (has_no_area({q[0], q[1], q[2]}) && has_no_area({q[0], q[2], q[3]})) return Hit::none;
  const auto wings = wings_of(q);
  if (are_the_same(wings[0], wings[1])) return Hit::error;
  Hit result = Hit::none;
  bool is_on_surface = false;
  for (const Triangle& wing : wings) {
    if (has_no_area(wing)) continue;
    const Hit hit = ray_hit(direction, wing);
    if (hit == Hit::bad_luck) return hit;
    is_on_surface = is_on_surface || hit == Hit::on_surface;
    if (hit == Hit::crosses) result = hit;
  }
  return is_on_surface ? Hit::on_surface : result;
}

/// The plane function of three points at x.
Rational plane(const Triangle& t, const Point& x) {
  return dot(x - t[0], cross(t[1] - t[0], t[2] - t[0]));
}

/// φ at x: 0 on the patch, of either sign on its sides.
Rational side_of_patch(const Patch& q, const Point& x) {
  return plane({q[0], q[1], q[2]}, x) * plane({q[0], q[3], q[2]}, x) -
         plane({q[1], q[3], q[2]}, x) * plane({q[0], q[1], q[3]}, x);
}

constexpr int most_tries = 8;

Point random_direction(Random& random) {
  Point direction;
  for (Rational& x : direction) x = random.uniform(-1.0, 1.0);
  return direction;
}

/// One ray's count over several surfaces: the parity of their hits, unless one of them decides.
template <class Surfaces, class HitOf>
Hit parity(const Surfaces& surfaces, const HitOf& hit_of) {
  bool is_odd = false;
  for (const auto& surface : surfaces) {
    const Hit hit = hit_of(surface);
    if (settles(hit)) return hit;
    is_odd = is_odd != (hit == Hit::crosses);
  }
  return is_odd ? Hit::crosses : Hit::none;
}

/// Calls `hit_along` with the first direction, and with random ones as long as the direction is
/// degenerate.
template <class HitAlong>
Hit with_luck(Point direction, Random& random, const HitAlong& hit_along) {
  for (int i = 0; i <= most_tries; ++i) {
    const Hit hit = hit_along(direction);
    if (hit != Hit::bad_luck) return hit;
    direction = random_direction(random);
  }
  return Hit::error;
}

/// The rays of a query and their crossings.
class RayParity {
 public:
  explicit RayParity(const Query& query) : random_(random_of(query)) {}

  [[nodiscard]] Hit run(std::span<const Triangle> caps, std::span<const Patch> patches) {
    return with_luck({1, 0, 0}, random_, [&](const Point& direction) {
      const Hit of_caps = parity(caps, [&](const Triangle& t) { return ray_hit(direction, t); });
      if (settles(of_caps)) return of_caps;
      const Hit of_patches = parity(patches, [&](const Patch& q) { return hit_of(direction, q); });
      if (settles(of_patches)) return of_patches;
      return of_caps == of_patches ? Hit::none : Hit::crosses;
    });
  }

 private:
  [[nodiscard]] Hit hit_of(const Point& direction, const Patch& q) {
    if (plane({q[0], q[1], q[2]}, q[3]) == 0) return hit_of_flat_patch(direction, q);
    const std::array<Triangle, 4> faces{
        {{q[0], q[1], q[2]}, {q[1], q[3], q[2]}, {q[0], q[2], q[3]}, {q[1], q[3], q[0]}}};
    const Hit inside = with_luck({0, 0, 1}, random_, [&](const Point& up) {
      return parity(faces, [&](const Triangle& t) { return ray_hit(up, t); });
    });
    if (inside == Hit::error) return inside;
    const int side = inside == Hit::none ? 0 : sgn(side_of_patch(q, Point{}));
    if (inside != Hit::none && side == 0) return Hit::on_surface;
    // Inside: the faces beyond the patch. Outside: those that lie on its positive side.
    std::vector<Triangle> standing;
    for (const Triangle& face : faces) {
      const Point centroid = Rational(1, 3) * (face[0] + face[1] + face[2]);
      const int side_of_face = sgn(side_of_patch(q, centroid));
      if (side_of_face == (inside == Hit::none ? 1 : -side)) standing.push_back(face);
    }
    if (inside == Hit::none) {
      return parity(standing, [&](const Triangle& t) { return ray_hit(direction, t); });
    }
    return any(direction, standing);
  }

  static Hit any(const Point& direction, const std::vector<Triangle>& triangles) {
    Hit result = Hit::none;
    for (const Triangle& triangle : triangles) {
      const Hit hit = ray_hit(direction, triangle);
      if (settles(hit)) return hit;
      if (hit == Hit::crosses) result = hit;
    }
    return result;
  }

  Random random_;
};

/// True if all points move by the same vector, as differences in doubles, in particular at rest.
bool all_move_alike(const Query& query) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto moves_by = [&](std::size_t point) {
      return query.at(1, point, axis) - query.at(0, point, axis);
    };
    for (std::size_t point = 1; point < moving_points; ++point) {
      if (moves_by(point) != moves_by(0)) return false;
    }
  }
  return true;
}

/// F at corner `index` of its domain, at an end of the step.
Point corner_at(ContactKind kind, const Query& query, std::size_t index, std::size_t end) {
  const Corner& corner = corners(kind)[index];
  Point result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result[axis] =
        Rational(query.at(end, corner.plus, axis)) - Rational(query.at(end, corner.minus, axis));
  }
  return result;
}

/// The images of the domain's sides: each swept by an edge of F's polygon from t=0 to t=1.
std::vector<Patch> sides(ContactKind kind, const Query& query) {
  const std::size_t count = corners(kind).size();
  std::vector<Patch> patches;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t next = (i + 1) % count;
    patches.push_back({corner_at(kind, query, i, 0), corner_at(kind, query, next, 0),
                       corner_at(kind, query, next, 1), corner_at(kind, query, i, 1)});
  }
  return patches;
}

bool rrp_collides(ContactKind kind, const Query& query) {
  if (all_move_alike(query)) return false;
  std::vector<Patch> patches = sides(kind, query);
  std::vector<Triangle> caps;
  for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) {
    const auto at = [&](std::size_t i) { return corner_at(kind, query, i, end); };
    if (kind == ContactKind::vertex_face) caps.push_back({at(0), at(1), at(2)});
    if (kind == ContactKind::edge_edge) patches.push_back({at(0), at(1), at(2), at(3)});
  }
  const Hit hit = RayParity(query).run(caps, patches);
  return hit == Hit::crosses || hit == Hit::on_surface;
}

}  // namespace

Answer rrp(ContactKind kind, const Query& query, const TouchstonePluginOptions& /*options*/) {
  return yes_if(rrp_collides(kind, query));
}

}  // namespace touchstone::verify::published
