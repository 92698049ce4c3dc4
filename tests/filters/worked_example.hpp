#pragma once

/// \file
/// The worked example of filters/README.md, compiled and checked by worked_example_test.cpp.

#include <algorithm>
#include <cmath>
#include <optional>

#include "touchstone/filters/error_bound.hpp"
#include "touchstone/filters/expressions.hpp"

namespace researcher {

// README: the predicate
/// Twice the signed area of a triangle. Coordinates: ax, ay, bx, by, cx, cy. No weights.
struct Orientation {
  static constexpr std::string_view name = "orientation";
  static constexpr std::size_t coordinates = 6;
  static constexpr std::size_t weights = 0;

  template <class Visitor>
  static constexpr void visit_groups(const Visitor& /*visit*/) {}

  template <class Scalar>
  [[nodiscard]] static constexpr Scalar evaluate(const std::array<Scalar, coordinates>& x,
                                                 const std::array<Scalar, weights>& /*weights*/) {
    return (x[0] - x[4]) * (x[3] - x[5]) - (x[1] - x[5]) * (x[2] - x[4]);
  }
};
// README: end

using touchstone::filters::ErrorBound;

// README: the bound
/// orientation in double: 30 u x^2 and underflow.
inline constexpr ErrorBound<double, 2> orientation_double{
    .coefficients = {{0x0.0000000000004p-1022, 0x0.0000000000002p-1022, 0x1.e00000000000dp-49}},
    .greatest_x = 0x1p+510,
};
// README: end

// README: the filter
/// The sign of the area (−1, 0 would need exact arithmetic, 1), or nothing where double cannot say.
inline std::optional<int> orientation_sign(const std::array<double, 6>& x) {
  double greatest = 0;
  for (const double coordinate : x) greatest = std::max(greatest, std::abs(coordinate));
  if (!(greatest <= orientation_double.greatest_x)) return std::nullopt;
  const double area = Orientation::evaluate(x, std::array<double, 0>{});
  const double error = orientation_double(greatest);
  if (area > error) return 1;
  if (area < -error) return -1;
  return std::nullopt;
}
// README: end

}  // namespace researcher
