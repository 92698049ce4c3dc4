#include "verify/fuzz/plainness.hpp"
#include "verify/generate/decimal.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string_view>

namespace touchstone::verify::fuzz {
namespace {

using Eigen::Vector3d;

// ---- Size ---------------------------------------------------------------------------------------

/// The distance of an exponent from a range.
std::uint64_t away(int exponent, int least, int greatest) {
  return static_cast<std::uint64_t>(std::max({least - exponent, exponent - greatest, 0}));
}

std::uint64_t drift(const Query& query, const Query& original) {
  constexpr int allowed = 3;
  const int size = size_exponent(query), of_original = size_exponent(original);
  if (away(of_original, least_everyday, greatest_everyday) != 0) {
    return away(size, least_everyday, greatest_everyday);
  }
  return away(size, of_original - allowed, of_original + allowed);
}

// ---- Degeneracy ---------------------------------------------------------------------------------

/// Halves a query that is so large that differences would overflow.
Query with_margin(const Query& query) {
  constexpr int most = 1000;
  Query result = query;
  if (size_exponent(query) < most) return result;
  for (double& x : result.coordinates) x *= 0.5;
  return result;
}

/// The greatest difference of two coordinates on an axis.
double extent(const Query& query) {
  double result = 0.0;
  for (std::size_t axis = 0; axis < point_axes; ++axis) {
    double least = query.coordinates[axis], greatest = least;
    for (std::size_t i = axis; i < coordinate_count; i += point_axes) {
      least = std::min(least, query.coordinates[i]);
      greatest = std::max(greatest, query.coordinates[i]);
    }
    result = std::max(result, greatest - least);
  }
  return result;
}

/// The query's shape, about 1 in extent: its products neither overflow nor vanish. All coordinates
/// are 0 if all points coincide.
Query shape(const Query& query) {
  const Query padded = with_margin(query);
  const double size = extent(padded);
  Query result{};
  if (size == 0.0) return result;
  const int exponent = std::ilogb(size);
  for (std::size_t i = 0; i < coordinate_count; ++i) {
    result.coordinates[i] =
        std::ldexp(padded.coordinates[i] - padded.coordinates[i % point_axes], -exponent);
  }
  return result;
}

/// The fraction of the query's extent below which a side is degenerate, and of the longest side
/// below which a triangle's height is.
constexpr double least_part = 0x1p-10;

std::uint64_t collapsed_triangle(const Query& shape, std::size_t end) {
  const Vector3d a = shape.point(end, 2) - shape.point(end, 1);
  const Vector3d b = shape.point(end, 3) - shape.point(end, 1);
  const double longest = std::max({a.norm(), b.norm(), (b - a).norm()});
  if (longest <= least_part) return 2;
  return a.cross(b).norm() <= least_part * longest * longest ? 1 : 0;
}

std::uint64_t collapsed_edge(const Query& shape, std::size_t end, std::size_t first) {
  const Vector3d side = shape.point(end, first + 1) - shape.point(end, first);
  return side.norm() <= least_part ? 1 : 0;
}

std::uint64_t collapsed_in_shape(Kind kind, const Query& shape) {
  std::uint64_t result = 0;
  for (std::size_t end = 0; end < motion_ends; ++end) {
    result += kind == Kind::vertex_face
                  ? collapsed_triangle(shape, end)
                  : collapsed_edge(shape, end, 0) + collapsed_edge(shape, end, 2);
  }
  return result;
}

/// A cubic that is about 0 at four times is about 0 at all times.
bool is_coplanar(const Query& shape) {
  constexpr double least_volume = 0x1p-20;
  for (const double t : {0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0}) {
    const auto place = [&](std::size_t point) -> Vector3d {
      return (1.0 - t) * shape.point(0, point) + t * shape.point(1, point);
    };
    const Vector3d origin = place(0), a = place(1) - origin, b = place(2) - origin;
    const Vector3d c = place(3) - origin;
    const double sizes = a.norm() * b.norm() * c.norm();
    if (std::abs(a.dot(b.cross(c))) > least_volume * sizes) return false;
  }
  return true;
}

// ---- Length -------------------------------------------------------------------------------------

std::uint64_t length(const Query& query, const std::vector<double>& of_query) {
  constexpr std::uint64_t of_magnitude = 8, of_coordinate = 2;
  std::uint64_t result = 0;
  for (const double x : of_query) result += of_magnitude + writing_length(x);
  for (std::size_t i = 0; i < coordinate_count; ++i) {
    const double x = query.coordinates[i];
    if (x != 0.0) result += of_coordinate;
    if (std::signbit(x)) ++result;
    if (i < to_other_end && x != query.coordinates[i + to_other_end]) ++result;
  }
  return result;
}

bool is_greater(const Query& query, const PointPair& pair) {
  for (std::size_t end = 0; end < motion_ends; ++end) {
    for (std::size_t axis = 0; axis < point_axes; ++axis) {
      const double first = query.at(end, pair[0], axis), second = query.at(end, pair[1], axis);
      if (first != second) return first > second;
    }
  }
  return false;
}

}  // namespace

bool Plainness::is_worse_somewhere(const Plainness& other) const {
  return beyond > other.beyond || degenerate > other.degenerate || drift > other.drift ||
         length > other.length;
}

Plainness plainness(Kind kind, const Query& query, const Query& original) {
  constexpr unsigned bits_for_sum = 8;
  const std::vector<double> all = magnitudes(query);
  Plainness result;
  for (const double x : all) {
    result.beyond += away(std::ilogb(x), least_everyday, greatest_everyday);
    result.size += std::bit_cast<std::uint64_t>(x) >> bits_for_sum;
  }
  result.degenerate = degeneracy(kind, query);
  result.drift = drift(query, original);
  result.length = length(query, all);
  for (const PointPair& pair : exchangeable(kind)) {
    if (is_greater(query, pair)) ++result.disorder;
  }
  return result;
}

std::uint64_t degeneracy(Kind kind, const Query& query) {
  const Query its_shape = shape(query);
  return collapsed_in_shape(kind, its_shape) + (is_coplanar(its_shape) ? 1 : 0);
}

std::uint64_t collapsed_elements(Kind kind, const Query& query) {
  return collapsed_in_shape(kind, shape(query));
}

int size_exponent(const Query& query) {
  double greatest = 0.0;
  for (const double x : query.coordinates) greatest = std::max(greatest, std::abs(x));
  return greatest == 0.0 ? least_everyday : std::ilogb(greatest);
}

std::vector<double> magnitudes(const Query& query) {
  std::vector<double> result;
  for (const double x : query.coordinates) {
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
  if (kind == Kind::vertex_face) return of_face;
  return of_edges;
}

}  // namespace touchstone::verify::fuzz
