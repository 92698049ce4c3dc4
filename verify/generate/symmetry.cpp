#include "verify/generate/symmetry.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "verify/generate/draws.hpp"

namespace touchstone::verify::generate {
namespace {

constexpr int greatest_exponent = 60;

/// x · factor, if the factor, a power of two, loses nothing.
std::optional<double> exact_product(double x, double factor) {
  const double product = x * factor;
  if (!std::isfinite(product) || product / factor != x) return std::nullopt;
  return product;
}

/// a + b, if it is a double: the error of the rounded sum, itself a double, is 0. (Knuth's
/// two-sum.)
std::optional<double> exact_sum(double a, double b) {
  const double sum = a + b;
  const double b_part = sum - a;
  const double error = (a - (sum - b_part)) + (b - b_part);
  // In this form NaN, the error of an overflow, fails too.
  if (!(error == 0.0) || !std::isfinite(sum)) return std::nullopt;
  return sum;
}

template <std::size_t Size>
void shuffle(std::array<std::size_t, Size>& items, std::size_t first, std::size_t last,
             Random& random) {
  for (std::size_t i = first; i + 1 < last; ++i) {
    std::swap(items.at(i), items.at(i + draws::below(random, last - i)));
  }
}

/// The sign of a permutation.
template <std::size_t Size>
double sign_of(const std::array<std::size_t, Size>& items) {
  double sign = 1.0;
  for (std::size_t i = 0; i < Size; ++i) {
    for (std::size_t j = 0; j < i; ++j) sign = items.at(j) > items.at(i) ? -sign : sign;
  }
  return sign;
}

/// The sign by which it multiplies the volume of a tetrahedron, and if it leaves the last point and
/// axis as they are, the area of a triangle in the plane.
double sign_of(const Symmetry& symmetry) {
  double sign = sign_of(symmetry.points) * sign_of(symmetry.axes);
  for (const double factor : symmetry.factors) sign = factor < 0.0 ? -sign : sign;
  return sign;
}

void renumber(AnyKind kind, Random& random, Symmetry& symmetry) {
  if (kind.is_cell()) {
    shuffle(symmetry.points, 0, record_of(kind.cell()).point_count, random);
    return;
  }
  if (kind == ContactKind::vertex_face) {
    shuffle(symmetry.points, 1, moving_points, random);
    return;
  }
  shuffle(symmetry.points, 0, 2, random);
  shuffle(symmetry.points, 2, moving_points, random);
  if (random.coin()) {
    std::rotate(symmetry.points.begin(), symmetry.points.begin() + 2, symmetry.points.end());
  }
}

void multiply(Random& random, Symmetry& symmetry) {
  const auto draw = [&random] {
    return std::ldexp(1.0, static_cast<int>(random.between(-greatest_exponent, greatest_exponent)));
  };
  const bool uniform = random.coin();
  const double common = draw();
  for (double& factor : symmetry.factors) factor *= uniform ? common : draw();
}

/// Shifts by a vector that brings some coordinate to 0, or by a power of two of similar size: then
/// sums are sometimes exact.
void shift(const AnyQueries& query, Random& random, Symmetry& symmetry) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (random.coin()) continue;
    const std::size_t control = draws::below(random, query.degree + 1);
    const std::size_t point = moving_points * control + draws::below(random, moving_points);
    const double x = symmetry.factors.at(axis) *
                     query.numbers[point * query.numbers_of_point() + symmetry.axes.at(axis)];
    if (x == 0.0) continue;
    symmetry.shifts.at(axis) =
        random.coin() ? -x : std::ldexp(random.coin() ? 1.0 : -1.0, std::ilogb(x));
  }
}

/// False if some coordinate would not be exact.
bool write_image(const Symmetry& symmetry, const AnyQueries& query, std::span<double> result) {
  const std::size_t size = query.numbers_of_point();
  for (std::size_t control = 0; control <= query.degree; ++control) {
    const std::size_t from = moving_points * control;
    const std::size_t to = moving_points * (symmetry.reversed ? query.degree - control : control);
    for (std::size_t point = 0; point < moving_points; ++point) {
      const auto source = query.numbers.subspan((from + symmetry.points.at(point)) * size, size);
      const auto target = result.subspan((to + point) * size, size);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto product =
            exact_product(source[symmetry.axes.at(axis)], symmetry.factors.at(axis));
        if (!product) return false;
        const auto sum = exact_sum(*product, symmetry.shifts.at(axis));
        if (!sum) return false;
        target[axis] = *sum;
      }
      if (query.is_rational) target[3] = source[3];
    }
  }
  return true;
}

}  // namespace

std::optional<Query> image(const Symmetry& symmetry, const Query& query) {
  Query result{};
  const AnyQueries one(ContactKind::vertex_face, {&query, 1});
  if (!write_image(symmetry, one, result.coordinates)) return std::nullopt;
  return result;
}

std::optional<std::vector<double>> image(const Symmetry& symmetry, const AnyQueries& query) {
  std::vector<double> result(query.numbers.size());
  if (!write_image(symmetry, query, result)) return std::nullopt;
  return result;
}

Symmetry draw_symmetry(AnyKind kind, const Query& query, const Separation& separation,
                       Random& random) {
  return draw_symmetry(AnyQueries(kind, {&query, 1}), separation, random);
}

Symmetry draw_isometry(AnyKind kind, Random& random) {
  const bool is_plane = kind.is_cell() && record_of(kind.cell()).dimension == 2;
  Symmetry symmetry;
  if (random.coin()) renumber(kind, random, symmetry);
  if (random.coin()) shuffle(symmetry.axes, 0, is_plane ? 2 : 3, random);
  for (double& factor : symmetry.factors) factor = random.coin() ? 1.0 : -1.0;
  if (is_plane) symmetry.factors[2] = 1.0;
  if (kind.is_cell()) symmetry.factors[0] *= sign_of(symmetry);
  return symmetry;
}

Symmetry draw_symmetry(const AnyQueries& query, const Separation& separation, Random& random) {
  Symmetry symmetry = draw_isometry(query.kind, random);
  symmetry.reversed = draws::one_in(random, 4);
  const Symmetry isometry = symmetry;
  if (is_zero(separation) && draws::one_in(random, 3)) multiply(random, symmetry);
  if (draws::one_in(random, 3)) shift(query, random, symmetry);
  return image(symmetry, query) ? symmetry : isometry;
}

}  // namespace touchstone::verify::generate
