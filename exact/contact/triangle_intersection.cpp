#include "exact/contact/triangle_intersection.hpp"

#include <algorithm>
#include <cstddef>

namespace touchstone::exact {
namespace {

Rational dot_product(const RationalPoint& a, const RationalPoint& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

RationalPoint cross_product(const RationalPoint& a, const RationalPoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

RationalPoint difference(const RationalPoint& to, const RationalPoint& from) {
  return {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
}

bool vanishes(const RationalPoint& a) { return dot_product(a, a) == 0; }

/// The points x with normal · x − offset ≥ 0.
struct HalfSpace {
  RationalPoint normal;
  Rational offset;

  /// The half-space with the point on its boundary.
  HalfSpace(RationalPoint direction, const RationalPoint& point)
      : normal(std::move(direction)), offset(dot_product(normal, point)) {}

  [[nodiscard]] Rational operator()(const RationalPoint& x) const {
    return dot_product(normal, x) - offset;
  }
};

/// The plane through a point.
void add_plane(std::vector<HalfSpace>& to, const RationalPoint& normal,
               const RationalPoint& point) {
  to.emplace_back(normal, point);
  to.emplace_back(difference({}, normal), point);
}

std::vector<HalfSpace> half_spaces_of(const RationalTriangle& triangle) {
  std::vector<HalfSpace> result;
  const RationalPoint normal =
      cross_product(difference(triangle[1], triangle[0]), difference(triangle[2], triangle[0]));
  if (!vanishes(normal)) {
    add_plane(result, normal, triangle[0]);
    for (std::size_t i = 0; i < 3; ++i) {
      const RationalPoint side = difference(triangle[(i + 1) % 3], triangle[i]);
      result.emplace_back(cross_product(normal, side), triangle[i]);
    }
    return result;
  }
  const auto [least, greatest] = std::ranges::minmax(triangle);
  const RationalPoint along = difference(greatest, least);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    RationalPoint direction{};
    direction[axis] = 1;
    add_plane(result, vanishes(along) ? direction : cross_product(along, direction), least);
  }
  result.emplace_back(along, least);
  result.emplace_back(difference({}, along), greatest);
  return result;
}

std::vector<RationalPoint> clipped(const std::vector<RationalPoint>& polygon,
                                   const HalfSpace& half_space) {
  std::vector<RationalPoint> result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const RationalPoint &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
    const Rational at_from = half_space(from), at_to = half_space(to);
    if (at_from >= 0) result.push_back(from);
    if (at_from * at_to >= 0) continue;
    RationalPoint between;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      between[axis] = from[axis] + (to[axis] - from[axis]) * at_from / (at_from - at_to);
    }
    result.push_back(between);
  }
  return result;
}

/// True if b is between a and c, or one of them.
bool is_between(const RationalPoint& a, const RationalPoint& b, const RationalPoint& c) {
  return vanishes(cross_product(difference(b, a), difference(c, a))) &&
         dot_product(difference(b, a), difference(b, c)) <= 0;
}

}  // namespace

std::vector<RationalPoint> intersection_of(const RationalTriangle& a, const RationalTriangle& b) {
  std::vector<RationalPoint> polygon(a.begin(), a.end());
  for (const HalfSpace& half_space : half_spaces_of(b)) polygon = clipped(polygon, half_space);
  std::ranges::sort(polygon);
  polygon.erase(std::unique(polygon.begin(), polygon.end()), polygon.end());
  if (polygon.size() < 3) return polygon;
  // Points between two others are no corners.
  std::vector<RationalPoint> corners;
  for (const RationalPoint& point : polygon) {
    const bool is_corner = std::ranges::none_of(polygon, [&](const RationalPoint& from) {
      return std::ranges::any_of(polygon, [&](const RationalPoint& to) {
        return from != point && to != point && is_between(from, point, to);
      });
    });
    if (is_corner) corners.push_back(point);
  }
  return corners;
}

}  // namespace touchstone::exact
