#include "verify/fuzz/plainness.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "verify/generate/everyday.hpp"

namespace touchstone::verify::fuzz {
namespace {

using Eigen::Vector3d;

/// Halves a query that is so large that differences would overflow.
AnyQuery with_margin(AnyQuery query) {
  constexpr int most = 1000;
  if (size_exponent(query) < most) return query;
  for_each_coordinate(query, point_axes, [](double& x) { x *= 0.5; });
  return query;
}

/// The greatest difference of two coordinates on an axis.
double extent(const AnyQuery& query) {
  double result = 0.0;
  for (std::size_t axis = 0; axis < point_axes; ++axis) {
    double least = query.numbers()[axis], greatest = least;
    for_each_coordinate(query, axis, [&](double x) {
      least = std::min(least, x);
      greatest = std::max(greatest, x);
    });
    result = std::max(result, greatest - least);
  }
  return result;
}

/// The query without its place and size, about 1 in extent: its products neither overflow nor
/// vanish. All coordinates are 0 if all points coincide.
AnyQuery normalised(const AnyQuery& query) {
  AnyQuery result = with_margin(query);
  const double size = extent(result);
  const int exponent = size == 0.0 ? 0 : std::ilogb(size);
  for (std::size_t axis = 0; axis < point_axes; ++axis) {
    const double origin = result.numbers()[axis];
    for_each_coordinate(result, axis, [&](double& x) { x = std::ldexp(x - origin, -exponent); });
  }
  return result;
}

/// The four points at one time.
using Places = std::array<Vector3d, moving_points>;

/// By de Casteljau's algorithm; weights are the fourth coordinate of points that they multiply.
Places places_at(const AnyQuery& query, double t) {
  const std::size_t size = query.shape().numbers_of_point();
  Places result;
  for (std::size_t point = 0; point < moving_points; ++point) {
    std::array<Eigen::Vector4d, greatest_degree + 1> row;
    for (std::size_t j = 0; j <= query.shape().degree; ++j) {
      const auto numbers = query.numbers().subspan((moving_points * j + point) * size, size);
      row.at(j) = {numbers[0], numbers[1], numbers[2], 1.0};
      if (query.shape().is_rational) row.at(j) *= numbers[3];
    }
    for (std::size_t count = query.shape().degree; count > 0; --count) {
      for (std::size_t j = 0; j < count; ++j) row.at(j) = (1.0 - t) * row.at(j) + t * row.at(j + 1);
    }
    result.at(point) = row[0].head<3>();
    if (query.shape().is_rational) result.at(point) /= row[0][3];
  }
  return result;
}

/// The fraction of the query's extent below which a side is degenerate, and of the longest side
/// below which a triangle's height is.
constexpr double least_part = 0x1p-10;

bool is_collapsed_triangle(const Places& places) {
  const Vector3d a = places[2] - places[1];
  const Vector3d b = places[3] - places[1];
  const double longest = std::max({a.norm(), b.norm(), (b - a).norm()});
  return longest <= least_part || a.cross(b).norm() <= least_part * longest * longest;
}

bool is_collapsed_edge(const Places& places, std::size_t first) {
  return (places.at(first + 1) - places.at(first)).norm() <= least_part;
}

bool is_collapsed(const AnyQuery& query) {
  if (query.kind().is_cell()) return false;
  return std::ranges::any_of(std::array{0.0, 1.0}, [&](double end) {
    const Places places = places_at(query, end);
    return query.kind() == ContactKind::vertex_face
               ? is_collapsed_triangle(places)
               : is_collapsed_edge(places, 0) || is_collapsed_edge(places, 2);
  });
}

/// On curves of degree k the volume of the points is a polynomial of degree 3k, and times all
/// weights one of degree 4k: if it is about 0 at one time more, it is so at all times.
bool is_coplanar(const AnyQuery& query) {
  constexpr double least_volume = 0x1p-20;
  const std::size_t degree = (query.shape().is_rational ? 4 : 3) * query.shape().degree;
  for (std::size_t i = 0; i <= degree; ++i) {
    const Places places = places_at(query, static_cast<double>(i) / static_cast<double>(degree));
    const Vector3d a = places[1] - places[0], b = places[2] - places[0], c = places[3] - places[0];
    const double sizes = a.norm() * b.norm() * c.norm();
    if (std::abs(a.dot(b.cross(c))) > least_volume * sizes) return false;
  }
  return true;
}

}  // namespace

bool is_valid(const AnyQuery& query) {
  const std::size_t size = query.shape().numbers_of_point();
  if (!is_finite(query.numbers())) return false;
  for (std::size_t i = point_axes; query.shape().is_rational && i < query.numbers().size();
       i += size) {
    if (!(query.numbers()[i] > 0.0)) return false;
  }
  return true;
}

Shape shape_of(const AnyQuery& query) {
  const AnyQuery same = normalised(query);
  if (is_collapsed(same)) return Shape::collapsed;
  return is_coplanar(same) ? Shape::coplanar : Shape::general;
}

std::string_view to_string(Shape shape) {
  static constexpr std::array<std::string_view, 3> names{"general", "coplanar", "collapsed"};
  return names.at(static_cast<std::size_t>(shape));
}

Plainness plainness(const AnyQuery& query) {
  const auto numbers = query.numbers();
  const std::size_t step = to_next_control(query);
  Plainness result{.shape = shape_of(query)};
  for (const double x : magnitudes(query)) result.digits += 1 + digits_of(x);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const double x = numbers[i];
    if (x != 0.0) ++result.marks;
    if (std::signbit(x)) ++result.marks;
    if (i + step < numbers.size() && x != numbers[i + step]) ++result.marks;
  }
  return result;
}

int size_exponent(const AnyQuery& query) {
  double greatest = 0.0;
  for_each_coordinate(query, point_axes,
                      [&](double x) { greatest = std::max(greatest, std::abs(x)); });
  return greatest == 0.0 ? 0 : std::ilogb(greatest);
}

std::vector<double> magnitudes(const AnyQuery& query) {
  std::vector<double> result;
  for (const double x : query.numbers()) {
    if (x != 0.0) result.push_back(std::abs(x));
  }
  std::ranges::sort(result);
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

std::uint64_t digits_of(double magnitude) {
  const generate::Decimal decimal = generate::shortest_decimal(magnitude);
  return static_cast<std::uint64_t>(
      decimal.count + std::max({decimal.exponent, -decimal.exponent - decimal.count, 0}));
}

}  // namespace touchstone::verify::fuzz
