#include "verify/generate/hard_curves.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "verify/generate/curved_families.hpp"

namespace touchstone::verify::generate {
namespace {

/// The binomials of a degree.
std::vector<std::int64_t> binomials(std::size_t degree) {
  std::vector<std::int64_t> row{1};
  while (row.size() <= degree) {
    row.push_back(0);
    for (std::size_t k = row.size() - 1; k > 0; --k) row[k] += row[k - 1];
  }
  return row;
}

/// The odd part of the least common multiple of numbers.
double odd_multiple(const std::vector<std::int64_t>& numbers) {
  std::int64_t multiple = 1;
  for (const std::int64_t number : numbers) multiple = std::lcm(multiple, number);
  while (multiple % 2 == 0) multiple /= 2;
  return static_cast<double>(multiple);
}

/// The control values of m (t−a/8)² q(t) + gap.
std::vector<double> control_heights(std::size_t degree, double gap, Random& random) {
  const double a = static_cast<double>(random.between(1, 7)) / 8.0;
  const std::array<double, 3> square{a * a, -2.0 * a * (1.0 - a), (1.0 - a) * (1.0 - a)};
  const std::vector<std::int64_t> of_factor = binomials(degree - 2), of_all = binomials(degree);
  std::vector<double> values(degree + 1, 0.0);
  for (std::size_t j = 0; j < of_factor.size(); ++j) {
    const auto c = static_cast<double>(of_factor[j] * random.between(1, 4));
    for (std::size_t k = 0; k < square.size(); ++k) values[j + k] += c * square.at(k);
  }
  const double multiple = odd_multiple(of_all);
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] = values[k] * multiple / static_cast<double>(of_all[k]) + gap;
  }
  return values;
}

/// The query of these points at each control point, moved and turned.
template <class PointsAt>
base::AnyQuery moved_and_turned(const QueryShape& shape, Random& random,
                                const PointsAt& points_at) {
  constexpr std::int64_t reach = std::int64_t{1} << 41U;
  const auto component = [&] {
    return static_cast<double>(random.between(-reach, reach)) * 0x1p-38;
  };
  std::vector<double> numbers;
  for (std::size_t k = 0; k <= shape.degree; ++k) {
    const std::array<double, 3> moved{component(), component(), component()};
    const Points points = points_at(k);
    for (const auto& point : points) {
      const double x = point[0] + moved[0], y = point[1] + moved[1], z = point[2] + moved[2];
      numbers.insert(numbers.end(), {2 * x - 2 * y + z, x + 2 * y + 2 * z, 2 * x + y - 2 * z});
      if (shape.is_rational) numbers.push_back(quarter_weights.at(k));
    }
  }
  return {shape, numbers};
}

}  // namespace

base::AnyQuery hard_curves(Kind kind, std::size_t degree, double gap, Random& random) {
  const double sign = random.coin() ? 1.0 : -1.0;
  const std::vector<double> control = control_heights(degree, gap, random);
  return moved_and_turned({.kind = kind, .degree = degree}, random,
                          [&](std::size_t k) { return above(kind, sign * control[k]); });
}

base::AnyQuery hard_rotation(Kind kind, double gap, Random& random) {
  const Rotation rotation{.eighth = static_cast<double>(random.between(1, 7)),
                          .scale = std::ldexp(1.0, static_cast<int>(random.between(-2, 2))),
                          .direction = random.coin() ? 1.0 : -1.0,
                          .gap = gap};
  return moved_and_turned({.kind = kind, .degree = 2, .is_rational = true}, random,
                          [&](std::size_t k) { return turning(kind, rotation, k); });
}

}  // namespace touchstone::verify::generate
