#include "verify/fuzz/plainness.hpp"
#include "verify/generate/everyday.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>

namespace touchstone::verify::fuzz {
namespace {

using Eigen::Vector3d;

// ---- Size ---------------------------------------------------------------------------------------

/// The distance of an exponent from a range.
std::uint64_t away(int exponent, int least, int greatest) {
  return static_cast<std::uint64_t>(std::max({least - exponent, exponent - greatest, 0}));
}

std::uint64_t drift(const AnyQuery& query, const AnyQuery& original) {
  constexpr int allowed = 3;
  const int size = size_exponent(query), of_original = size_exponent(original);
  if (away(of_original, least_everyday, greatest_everyday) != 0) {
    return away(size, least_everyday, greatest_everyday);
  }
  return away(size, of_original - allowed, of_original + allowed);
}

// ---- Degeneracy ---------------------------------------------------------------------------------

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

/// The query's shape, about 1 in extent: its products neither overflow nor vanish. All coordinates
/// are 0 if all points coincide.
AnyQuery shape(const AnyQuery& query) {
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

std::uint64_t collapsed_triangle(const Places& places) {
  const Vector3d a = places[2] - places[1];
  const Vector3d b = places[3] - places[1];
  const double longest = std::max({a.norm(), b.norm(), (b - a).norm()});
  if (longest <= least_part) return 2;
  return a.cross(b).norm() <= least_part * longest * longest ? 1 : 0;
}

std::uint64_t collapsed_edge(const Places& places, std::size_t first) {
  const Vector3d side = places.at(first + 1) - places.at(first);
  return side.norm() <= least_part ? 1 : 0;
}

std::uint64_t collapsed_in_shape(const AnyQuery& shape) {
  std::uint64_t result = 0;
  if (is_element(shape.kind())) return result;
  for (const double end : {0.0, 1.0}) {
    const Places places = places_at(shape, end);
    result += shape.kind() == Kind::vertex_face
                  ? collapsed_triangle(places)
                  : collapsed_edge(places, 0) + collapsed_edge(places, 2);
  }
  return result;
}

/// On curves of degree k the volume of the points is a polynomial of degree 3k, and times all
/// weights one of degree 4k: if it is about 0 at one time more, it is so at all times.
bool is_coplanar(const AnyQuery& shape) {
  constexpr double least_volume = 0x1p-20;
  const std::size_t degree = (shape.shape().is_rational ? 4 : 3) * shape.shape().degree;
  for (std::size_t i = 0; i <= degree; ++i) {
    const Places places = places_at(shape, static_cast<double>(i) / static_cast<double>(degree));
    const Vector3d a = places[1] - places[0], b = places[2] - places[0], c = places[3] - places[0];
    const double sizes = a.norm() * b.norm() * c.norm();
    if (std::abs(a.dot(b.cross(c))) > least_volume * sizes) return false;
  }
  return true;
}

// ---- Length -------------------------------------------------------------------------------------

std::uint64_t length(const AnyQuery& query, const std::vector<double>& of_query) {
  constexpr std::uint64_t of_magnitude = 8, of_coordinate = 2;
  const auto numbers = query.numbers();
  const std::size_t step = to_next_control(query);
  std::uint64_t result = 0;
  for (const double x : of_query) result += of_magnitude + writing_length(x);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const double x = numbers[i];
    if (x != 0.0) result += of_coordinate;
    if (std::signbit(x)) ++result;
    if (i + step < numbers.size() && x != numbers[i + step]) ++result;
  }
  return result;
}

bool is_greater(const AnyQuery& query, const PointPair& pair) {
  const std::size_t size = query.shape().numbers_of_point();
  for (std::size_t j = 0; j <= query.shape().degree; ++j) {
    for (std::size_t axis = 0; axis < point_axes; ++axis) {
      const auto at = [&](std::size_t point) {
        return query.numbers()[(moving_points * j + point) * size + axis];
      };
      if (at(pair[0]) != at(pair[1])) return at(pair[0]) > at(pair[1]);
    }
  }
  return false;
}

}  // namespace

bool Plainness::is_worse_somewhere(const Plainness& other) const {
  return beyond > other.beyond || degenerate > other.degenerate || drift > other.drift ||
         length > other.length;
}

bool is_valid(const AnyQuery& query) {
  const std::size_t size = query.shape().numbers_of_point();
  if (!is_finite(query.numbers())) return false;
  for (std::size_t i = point_axes; query.shape().is_rational && i < query.numbers().size();
       i += size) {
    if (!(query.numbers()[i] > 0.0)) return false;
  }
  return true;
}

Plainness plainness(const AnyQuery& query, const AnyQuery& original) {
  constexpr unsigned bits_for_sum = 8;
  const std::vector<double> all = magnitudes(query);
  Plainness result;
  for (const double x : all) {
    result.beyond += away(std::ilogb(x), least_everyday, greatest_everyday);
    result.size += std::bit_cast<std::uint64_t>(x) >> bits_for_sum;
  }
  result.degenerate = degeneracy(query);
  result.drift = drift(query, original);
  result.length = length(query, all);
  for (const PointPair& pair : exchangeable(query.kind())) {
    if (is_greater(query, pair)) ++result.disorder;
  }
  return result;
}

std::uint64_t degeneracy(const AnyQuery& query) {
  const AnyQuery its_shape = shape(query);
  return collapsed_in_shape(its_shape) + (is_coplanar(its_shape) ? 1 : 0);
}

std::uint64_t collapsed_elements(const AnyQuery& query) { return collapsed_in_shape(shape(query)); }

int size_exponent(const AnyQuery& query) {
  double greatest = 0.0;
  for_each_coordinate(query, point_axes,
                      [&](double x) { greatest = std::max(greatest, std::abs(x)); });
  return greatest == 0.0 ? least_everyday : std::ilogb(greatest);
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

std::uint64_t writing_length(double magnitude) {
  constexpr int of_digit = 3, of_point = 2;
  const generate::Decimal decimal = generate::shortest_decimal(magnitude);
  const int empty = std::max({decimal.exponent, -decimal.exponent - decimal.count, 0});
  return static_cast<std::uint64_t>(of_digit * decimal.count + empty +
                                    (decimal.exponent < 0 ? of_point : 0));
}

std::span<const PointPair> exchangeable(Kind kind) {
  static constexpr std::array<PointPair, 3> of_face{{{1, 2}, {1, 3}, {2, 3}}};
  static constexpr std::array<PointPair, 2> of_edges{{{0, 1}, {2, 3}}};
  if (is_element(kind)) return {};  // an exchange turns it inside out
  if (kind == Kind::vertex_face) return of_face;
  return of_edges;
}

}  // namespace touchstone::verify::fuzz
