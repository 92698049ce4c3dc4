#include "exact/scene/directions.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>

namespace touchstone::exact {
namespace {

/// Corners at the start, then the same number at the end, up to a common translation.
struct Corners {
  std::array<Eigen::Vector3d, 8> points;
  std::size_t count = 0;

  [[nodiscard]] std::span<const Eigen::Vector3d> all() const {
    return std::span(points).first(count);
  }
};

const Eigen::Vector3d& lowest(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& d) {
  return *std::ranges::min_element(points, {}, [&](const Eigen::Vector3d& w) { return w.dot(d); });
}

/// A direction d with a positive least d·w, if Gilbert's method finds one.
std::optional<Eigen::Vector3d> nearest(std::span<const Eigen::Vector3d> points) {
  constexpr int most_iterations = 48, more_iterations = 4;
  Eigen::Vector3d x = points.front();
  for (const Eigen::Vector3d& w : points.subspan(1)) x += w;
  x /= static_cast<double>(points.size());
  int separated = 0;
  for (int n = 0; n < most_iterations && separated < more_iterations; ++n) {
    const Eigen::Vector3d& w = lowest(points, x);
    if (w.dot(x) > 0.0) ++separated;
    const Eigen::Vector3d step = w - x;
    const double square = step.squaredNorm();
    if (!(square > 0.0)) break;
    x += std::clamp(-x.dot(step) / square, 0.0, 1.0) * step;
  }
  if (separated == 0) return std::nullopt;
  return x;
}

}  // namespace

checker::Primitive primitive_of(PrimitiveVertices vertices) {
  const std::int32_t first = vertices.front();
  return {0,
          {first, vertices.size() > 1 ? vertices[1] : first,
           vertices.size() > 2 ? vertices[2] : first}};
}

std::optional<checker::Direction> find_direction(const checker::Places& places, PrimitiveVertices a,
                                                 PrimitiveVertices b, double distance) {
  Corners corners;
  for (checker::Box checker::MovingBox::*const time :
       {&checker::MovingBox::start, &checker::MovingBox::end}) {
    const auto place = [&](std::int32_t vertex) {
      const checker::Integers& x = (places.box(vertex).*time).lower;
      return Eigen::Vector3d(static_cast<double>(x[0]), static_cast<double>(x[1]),
                             static_cast<double>(x[2]));
    };
    for (const std::int32_t v : a) {
      for (const std::int32_t w : b) corners.points.at(corners.count++) = place(v) - place(w);
    }
  }
  const auto rounded = [&, first = primitive_of(a), second = primitive_of(b),
                        whole = places.enlarged(distance)](const Eigen::Vector3d& d) {
    return rounded_direction({d[0], d[1], d[2]}, [&](const checker::Direction& direction) {
      return places.is_above(first, second, direction, whole);
    });
  };
  if (const auto x = nearest(corners.all())) {
    if (const auto result = rounded(*x)) return result;
  }
  // The normals at both ends and between, of three corners or more.
  const std::size_t half = corners.count / 2;
  if (half < 3) return std::nullopt;
  const auto normal = [&](std::size_t first) -> Eigen::Vector3d {
    const auto& w = corners.points;
    return (w[first + 1] - w[first]).cross(w[first + 2] - w[first]);
  };
  const Eigen::Vector3d start = normal(0), last = normal(half);
  for (const Eigen::Vector3d& n : {start, last, Eigen::Vector3d(start + last)}) {
    const Eigen::Vector3d d = corners.points.front().dot(n) < 0.0 ? Eigen::Vector3d(-n) : n;
    if (const auto result = rounded(d)) return result;
  }
  return std::nullopt;
}

}  // namespace touchstone::exact
