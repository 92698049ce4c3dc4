// The kernel without explicit vector instructions, for every processor.

#include <cstddef>

#include "fast/tight_inclusion/box_kernel_on_lanes.hpp"

namespace touchstone::fast {
namespace {

/// The bounding box of corner values.
struct AxisBounds {
  static constexpr std::size_t axes = 3;

  double least[axes];     // NOLINT(modernize-avoid-c-arrays): no function of another file
  double greatest[axes];  // NOLINT(modernize-avoid-c-arrays)

  /// True if the box is beyond separation and filter on some axis.
  [[nodiscard]] bool are_beyond(const double* filter, double separation) const {
    bool result = false;
    for (std::size_t axis = 0; axis < axes; ++axis) {
      result = result || least[axis] - separation > filter[axis] ||
               greatest[axis] + separation < -filter[axis];
    }
    return result;
  }

  /// True if the box is within separation and filter on all axes.
  [[nodiscard]] bool are_within(const double* filter, double separation) const {
    bool result = true;
    for (std::size_t axis = 0; axis < axes; ++axis) {
      result = result && greatest[axis] - separation <= filter[axis] &&
               least[axis] + separation >= -filter[axis];
    }
    return result;
  }

  /// The longest side.
  [[nodiscard]] double width() const {
    double result = 0.0;
    for (std::size_t axis = 0; axis < axes; ++axis) {
      const double side = greatest[axis] - least[axis];
      result = side > result ? side : result;
    }
    return result;
  }
};

/// Eight lanes, one after the other.
struct Lanes {
  static constexpr std::size_t size = 8;
  static constexpr std::size_t half = 4;

  double lane[size];  // NOLINT(modernize-avoid-c-arrays): no function of another file

  static Lanes twice(double a, double b, double c, double d) { return {{a, b, c, d, a, b, c, d}}; }
  static Lanes twice(const double* four) { return twice(four[0], four[1], four[2], four[3]); }
  static Lanes halves(double a, double b) { return {{a, a, a, a, b, b, b, b}}; }
  template <std::size_t axis>
  static Lanes coordinate(const double* points) {
    Lanes result;
    for (std::size_t i = 0; i < size; ++i) result.lane[i] = points[3 * i + axis];
    return result;
  }

  friend Lanes operator+(const Lanes& a, const Lanes& b) {
    Lanes result;
    for (std::size_t i = 0; i < size; ++i) result.lane[i] = a.lane[i] + b.lane[i];
    return result;
  }
  friend Lanes operator-(const Lanes& a, const Lanes& b) {
    Lanes result;
    for (std::size_t i = 0; i < size; ++i) result.lane[i] = a.lane[i] - b.lane[i];
    return result;
  }
  friend Lanes operator*(const Lanes& a, const Lanes& b) {
    Lanes result;
    for (std::size_t i = 0; i < size; ++i) result.lane[i] = a.lane[i] * b.lane[i];
    return result;
  }

  template <int a, int b, int c, int d>
  [[nodiscard]] Lanes shuffled() const {
    return {{lane[a], lane[b], lane[c], lane[d], lane[half + a], lane[half + b], lane[half + c],
             lane[half + d]}};
  }

  void store(double* values) const {
    for (std::size_t i = 0; i < size; ++i) values[i] = lane[i];
  }

  [[nodiscard]] bool are_finite() const {
    bool result = true;
    for (const double x : lane) result = result && x - x == 0.0;
    return result;
  }
  [[nodiscard]] double least() const {
    double result = lane[0];
    for (const double x : lane) result = x < result ? x : result;
    return result;
  }
  [[nodiscard]] double greatest() const {
    double result = lane[0];
    for (const double x : lane) result = x > result ? x : result;
    return result;
  }
  [[nodiscard]] double magnitude() const {
    const double lower = -least(), upper = greatest();
    return upper > lower ? upper : lower;
  }

  static AxisBounds bounds(const Lanes& x, const Lanes& y, const Lanes& z) {
    return {{x.least(), y.least(), z.least()}, {x.greatest(), y.greatest(), z.greatest()}};
  }
};

}  // namespace

extern const BoxKernel scalar_box_kernel;
const BoxKernel scalar_box_kernel = BoxKernelOnLanes<Lanes>::kernel(InstructionSet::scalar);
extern const BoxKernel scalar_released_box_kernel;
const BoxKernel scalar_released_box_kernel =
    BoxKernelOnLanes<Lanes, ReleasedSteps>::kernel(InstructionSet::scalar);

}  // namespace touchstone::fast
