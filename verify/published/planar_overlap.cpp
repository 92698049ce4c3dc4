#include "verify/published/planar_overlap.hpp"

#include <algorithm>
#include <cstddef>

namespace touchstone::verify::published {
namespace {

using Point = std::array<ExactNumber, 2>;
using Segment = std::array<Point, 2>;
using Triangle = std::array<Point, 3>;

/// Twice the signed area of p, q, r.
ExactNumber area(const Point& p, const Point& q, const Point& r) {
  return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
}

/// \pre the three points lie on a line.
bool is_between(const Point& p, const Point& a, const Point& b) {
  return ((p[0] - a[0]) * (p[0] - b[0]) + (p[1] - a[1]) * (p[1] - b[1])).sign() <= 0;
}

bool is_on(const Point& p, const Point& a, const Point& b) {
  return area(a, b, p).sign() == 0 && is_between(p, a, b);
}

/// The areas of p with the edges opposite to the triangle's points.
std::array<ExactNumber, 3> areas_in(const Triangle& triangle, const Point& p) {
  return {area(triangle[1], triangle[2], p), area(triangle[2], triangle[0], p),
          area(triangle[0], triangle[1], p)};
}

bool is_in(const Triangle& triangle, const Point& p) {
  const int orientation = area(triangle[0], triangle[1], triangle[2]).sign();
  if (orientation == 0) {
    return is_on(p, triangle[0], triangle[1]) || is_on(p, triangle[1], triangle[2]) ||
           is_on(p, triangle[2], triangle[0]);
  }
  return std::ranges::all_of(areas_in(triangle, p), [&](const ExactNumber& part) {
    return part.sign() * orientation >= 0;
  });
}

bool cross(const Segment& s, const Point& c, const Point& d) {
  const int c_side = area(s[0], s[1], c).sign(), d_side = area(s[0], s[1], d).sign();
  const int a_side = area(c, d, s[0]).sign(), b_side = area(c, d, s[1]).sign();
  if (c_side * d_side < 0 && a_side * b_side < 0) return true;
  return (c_side == 0 && is_between(c, s[0], s[1])) || (d_side == 0 && is_between(d, s[0], s[1])) ||
         (a_side == 0 && is_between(s[0], c, d)) || (b_side == 0 && is_between(s[1], c, d));
}

/// Writes the weights of a point of the triangle; none if the triangle is degenerate.
void write_inside(const Triangle& triangle, const Point& p, PlanarOverlap& result) {
  const ExactNumber whole = area(triangle[0], triangle[1], triangle[2]);
  if (whole.sign() == 0) return;
  const auto parts = areas_in(triangle, p);
  for (std::size_t i = 0; i < 3; ++i) result.triangle_weights[i] = quotient(parts[i], whole);
}

/// Writes the weights of the point where the segment crosses the edge i; none if they are parallel.
void write_crossing(const Segment& s, const Triangle& triangle, std::size_t i,
                    PlanarOverlap& result) {
  const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
  const Point &c = triangle[i], &d = triangle[j];
  const ExactNumber a_side = area(c, d, s[0]), b_side = area(c, d, s[1]);
  const ExactNumber c_side = area(s[0], s[1], c), d_side = area(s[0], s[1], d);
  if (a_side == b_side || c_side == d_side) return;
  result.segment_weights = {quotient(b_side, b_side - a_side), quotient(a_side, a_side - b_side)};
  const bool writes_wrong_one = i == 0;
  result.triangle_weights[writes_wrong_one ? j : k] = 0.0;
  result.triangle_weights[i] = quotient(d_side, d_side - c_side);
  result.triangle_weights[j] = quotient(c_side, c_side - d_side);
}

bool overlap_in_plane(const Segment& s, const Triangle& triangle, PlanarOverlap& result) {
  for (std::size_t end = 0; end < 2; ++end) {
    if (!is_in(triangle, s[end])) continue;
    result.segment_weights = {end == 0 ? 1.0 : 0.0, end == 0 ? 0.0 : 1.0};
    write_inside(triangle, s[end], result);
    return true;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (!cross(s, triangle[i], triangle[(i + 1) % 3])) continue;
    write_crossing(s, triangle, i, result);
    return true;
  }
  return false;
}

Point projected(const ExactPoint& p, std::size_t axis) {
  return {p[(axis + 1) % 3], p[(axis + 2) % 3]};
}

}  // namespace

PlanarOverlap planar_overlap(const std::array<ExactPoint, 2>& segment,
                             const std::array<ExactPoint, 3>& triangle) {
  PlanarOverlap result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Segment s{projected(segment[0], axis), projected(segment[1], axis)};
    const Triangle t{projected(triangle[0], axis), projected(triangle[1], axis),
                     projected(triangle[2], axis)};
    if (!overlap_in_plane(s, t, result)) return {};
  }
  result.overlaps = true;
  return result;
}

}  // namespace touchstone::verify::published
