#include "verify/jobs/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace touchstone::verify::jobs {
namespace {

constexpr double golden_section = 0.6180339887498949;

/// A stride without a common divisor with the size, whose multiples therefore meet every position.
std::size_t stride_of(std::size_t size) {
  auto stride = static_cast<std::size_t>(golden_section * static_cast<double>(size));
  while (std::gcd(stride, size) != 1) ++stride;
  return stride;
}

}  // namespace

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

double quantile(std::vector<double> values, double fraction) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double rank = std::ceil(fraction * static_cast<double>(values.size()));
  const auto place = std::min(static_cast<std::size_t>(std::max(rank, 1.0)), values.size()) - 1;
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(place));
  return values[place];
}

std::vector<std::size_t> spread_sample(std::size_t size, std::size_t count) {
  std::vector<std::size_t> positions(std::min(size, count));
  if (count >= size) {
    std::iota(positions.begin(), positions.end(), std::size_t{0});
    return positions;
  }
  const std::size_t stride = stride_of(size);
  std::size_t position = 0;
  for (std::size_t& chosen : positions) {
    chosen = position;
    position = (position + stride) % size;
  }
  std::ranges::sort(positions);
  return positions;
}

}  // namespace touchstone::verify::jobs
