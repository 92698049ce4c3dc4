#include "verify/methods/reach.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace touchstone::verify {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double greatest_unscaled = 0x1p1016;

double up(double x) { return std::nextafter(x, infinity); }

std::array<double, 3> greatest_coordinates(const Query& query) {
  std::array<double, 3> greatest{};
  for (std::size_t i = 0; i < query.coordinates.size(); ++i) {
    greatest.at(i % 3) = std::max(greatest.at(i % 3), std::abs(query.coordinates.at(i)));
  }
  return greatest;
}

}  // namespace

double tight_inclusion_reach(Kind kind, const Query& query, const fast::Answer& answer,
                             const Separation& separation, fast::ErrorModel model) {
  const std::array<double, 3> x_max = greatest_coordinates(query);
  const double d = separation.distance;
  if (std::isnan(answer.tolerance) || std::max(std::ranges::max(x_max), d) > greatest_unscaled) {
    return infinity;
  }
  const double filter = std::ranges::max(fast::error_filter(kind, x_max, d, model));
  return up(up(up(answer.tolerance) + d) + 2.0 * filter);
}

}  // namespace touchstone::verify
