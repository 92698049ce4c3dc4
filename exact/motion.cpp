#include "exact/motion.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <stdexcept>

namespace touchstone::exact {
namespace {

/// A finite double as significand · 2^exponent with an odd significand (0 · 2^0 for zero).
struct Decomposed {
  long significand = 0;
  int exponent = 0;
};

/// Taken from the bits: a caller's floating-point environment may flush subnormals to zero.
Decomposed decompose(double x) {
  static constexpr int fraction_bits = 52, exponent_bias = 1075, special_exponent = 0x7FF;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const int field = static_cast<int>((bits >> fraction_bits) & special_exponent);
  if (field == special_exponent)
    throw std::invalid_argument("a query's coordinates must be finite");
  std::uint64_t significand = bits & ((std::uint64_t{1} << fraction_bits) - 1);
  if (field != 0) significand |= std::uint64_t{1} << fraction_bits;
  if (significand == 0) return {};
  const int zeros = std::countr_zero(significand);
  const auto magnitude = static_cast<long>(significand >> zeros);
  return {(bits >> 63U) != 0 ? -magnitude : magnitude, std::max(field, 1) - exponent_bias + zeros};
}

void scale_axis(const Query& query, std::size_t axis, Motion& motion) {
  std::array<std::array<Decomposed, moving_points>, 2> parts;
  int least = std::numeric_limits<int>::max();
  for (std::size_t end = 0; end < 2; ++end) {
    for (std::size_t point = 0; point < moving_points; ++point) {
      parts[end][point] = decompose(query.at(end, point, axis));
      if (parts[end][point].significand != 0) least = std::min(least, parts[end][point].exponent);
    }
  }
  for (std::size_t end = 0; end < 2; ++end) {
    for (std::size_t point = 0; point < moving_points; ++point) {
      const auto& [significand, exponent] = parts[end][point];
      Integer& value = motion.points[point][axis].c[end];
      value = significand;
      if (significand != 0) value <<= static_cast<unsigned long>(exponent - least);
    }
  }
}

}  // namespace

Motion scale_to_integers(Kind kind, const Query& query) {
  Motion motion{.kind = kind, .points = {}, .corners = {}, .corner_count = 0};
  for (std::size_t axis = 0; axis < 3; ++axis) scale_axis(query, axis, motion);
  for (const auto& [plus, minus] : corners(kind)) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      motion.corners[motion.corner_count][axis] =
          motion.points[plus][axis] - motion.points[minus][axis];
    }
    ++motion.corner_count;
  }
  return motion;
}

Form<2> cross_component(const Motion& motion, std::size_t i, std::size_t j, std::size_t axis) {
  const Motion::Point &a = motion.corners[i], &b = motion.corners[j];
  const std::size_t y = (axis + 1) % 3, z = (axis + 2) % 3;
  Form<2> result = a[y] * b[z];
  subtract_product(result, a[z], b[y]);
  return result;
}

Form<2> dot(const Motion& motion, std::size_t i, std::size_t j) {
  const Motion::Point &a = motion.corners[i], &b = motion.corners[j];
  Form<2> sum;
  for (std::size_t axis = 0; axis < 3; ++axis) add_product(sum, a[axis], b[axis]);
  return sum;
}

Form<2> normal_component(const Motion& motion, std::size_t axis) {
  const std::size_t last = motion.corner_count - 1;
  const std::size_t y = (axis + 1) % 3, z = (axis + 2) % 3;
  const auto edge = [&](std::size_t corner, std::size_t k) {
    return motion.corners[corner][k] - motion.corners[0][k];
  };
  Form<2> result = edge(1, y) * edge(last, z);
  subtract_product(result, edge(1, z), edge(last, y));
  return result;
}

Form<3> determinant(const Motion& motion) {
  const std::size_t last = motion.corner_count - 1;
  Form<3> sum;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    add_product(sum, cross_component(motion, 0, 1, axis), motion.corners[last][axis]);
  }
  return sum;
}

}  // namespace touchstone::exact
