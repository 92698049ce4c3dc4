#include "verify/baselines/closest_features.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cstdint>

namespace touchstone::baselines {
namespace {

using Vector3 = Eigen::Vector3d;

constexpr double parallel_squared_sine = 2.5e-16;

enum class Region : std::uint8_t { a, b, c, ab, ac, bc, face };

/// The feature of the triangle that is nearest to p, and there the weights of b and c.
struct Nearest {
  Region region;
  double b;
  double c;
};

/// By the Voronoi regions of the triangle's features: first the vertices', then the edges'.
Nearest nearest_in_triangle(const Vector3& p, const Triangle& triangle) {
  const auto& [a, b, c] = triangle;
  const Vector3 ab = b - a;
  const Vector3 ac = c - a;
  const double d1 = ab.dot(p - a);
  const double d2 = ac.dot(p - a);
  if (d1 <= 0.0 && d2 <= 0.0) return {Region::a, 0.0, 0.0};
  const double d3 = ab.dot(p - b);
  const double d4 = ac.dot(p - b);
  if (d3 >= 0.0 && d4 <= d3) return {Region::b, 1.0, 0.0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return {Region::ab, d1 / (d1 - d3), 0.0};
  const double d5 = ab.dot(p - c);
  const double d6 = ac.dot(p - c);
  if (d6 >= 0.0 && d5 <= d6) return {Region::c, 0.0, 1.0};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return {Region::ac, 0.0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {Region::bc, 1.0 - w, w};
  }
  const double scale = 1.0 / (va + vb + vc);
  return {Region::face, vb * scale, vc * scale};
}

double clamp01(double x) { return std::clamp(x, 0.0, 1.0); }

/// The squared distance of p and the line through a segment; of a segment of no length, its point.
double line_squared_distance(const Vector3& p, const Segment& segment) {
  const Vector3 along = segment.b - segment.a;
  const double length = along.squaredNorm();
  if (length == 0.0) return (p - segment.a).squaredNorm();
  return along.cross(p - segment.a).squaredNorm() / length;
}

/// The squared distance of p and a plane through a with this normal.
double plane_squared_distance(const Vector3& p, const Vector3& a, const Vector3& normal) {
  const double height = normal.dot(p - a);
  return height * height / normal.squaredNorm();
}

double segment_squared_distance(const Vector3& p, const Segment& segment) {
  const Vector3 along = segment.b - segment.a;
  if (along.dot(p - segment.a) <= 0.0) return (p - segment.a).squaredNorm();
  if (along.dot(p - segment.b) >= 0.0) return (p - segment.b).squaredNorm();
  return line_squared_distance(p, segment);
}

/// The least distance of an end of one segment and the other segment.
double end_squared_distance(const Segment& first, const Segment& second) {
  return std::min(
      {segment_squared_distance(first.a, second), segment_squared_distance(first.b, second),
       segment_squared_distance(second.a, first), segment_squared_distance(second.b, first)});
}

}  // namespace

double closest_point_squared_distance(const Vector3& p, const Triangle& triangle) {
  const auto& [a, b, c] = triangle;
  const Nearest nearest = nearest_in_triangle(p, triangle);
  const Vector3 point = a + nearest.b * (b - a) + nearest.c * (c - a);
  return (p - point).squaredNorm();
}

double closest_points_squared_distance(const Segment& first, const Segment& second) {
  const Vector3 u = first.b - first.a;
  const Vector3 v = second.b - second.a;
  const Vector3 r = first.a - second.a;
  const double uu = u.squaredNorm();
  const double vv = v.squaredNorm();
  const double vr = v.dot(r);
  double s = 0.0;
  double t = 0.0;
  if (uu <= point_squared_length && vv <= point_squared_length) return r.squaredNorm();
  if (uu <= point_squared_length) {
    t = clamp01(vr / vv);
  } else {
    const double ur = u.dot(r);
    if (vv <= point_squared_length) {
      s = clamp01(-ur / uu);
    } else {
      const double uv = u.dot(v);
      const double denominator = uu * vv - uv * uv;
      if (denominator != 0.0) s = clamp01((uv * vr - ur * vv) / denominator);
      t = (uv * s + vr) / vv;
      if (t < 0.0) s = clamp01(-ur / uu);
      if (t > 1.0) s = clamp01((uv - ur) / uu);
      t = clamp01(t);
    }
  }
  return (r + s * u - t * v).squaredNorm();
}

double feature_squared_distance(const Vector3& p, const Triangle& triangle) {
  const auto& [a, b, c] = triangle;
  switch (nearest_in_triangle(p, triangle).region) {
    case Region::a:
      return (p - a).squaredNorm();
    case Region::b:
      return (p - b).squaredNorm();
    case Region::c:
      return (p - c).squaredNorm();
    case Region::ab:
      return line_squared_distance(p, {a, b});
    case Region::ac:
      return line_squared_distance(p, {a, c});
    case Region::bc:
      return line_squared_distance(p, {b, c});
    default:
      return plane_squared_distance(p, a, (b - a).cross(c - a));
  }
}

double feature_squared_distance(const Segment& first, const Segment& second) {
  const Vector3 u = first.b - first.a;
  const Vector3 v = second.b - second.a;
  const Vector3 r = first.a - second.a;
  const Vector3 normal = u.cross(v);
  const bool is_parallel =
      normal.squaredNorm() < parallel_squared_sine * u.squaredNorm() * v.squaredNorm();
  if (!is_parallel) {
    // The nearest points of the lines: r + s u − t v is along the normal.
    const double s = normal.dot(v.cross(r));
    const double t = normal.dot(u.cross(r));
    const double whole = normal.squaredNorm();
    if (s > 0.0 && s < whole && t > 0.0 && t < whole) {
      return plane_squared_distance(first.a, second.a, normal);
    }
  }
  return end_squared_distance(first, second);
}

}  // namespace touchstone::baselines
