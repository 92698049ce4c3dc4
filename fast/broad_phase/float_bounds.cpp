#include "fast/broad_phase/float_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "fast/platform/floating_point_state.hpp"
#include "fast/platform/threads.hpp"
#include "touchstone/filters/error_bounds.hpp"
#include "touchstone/filters/expressions.hpp"

namespace touchstone::fast {
namespace {

/// Vertices per task.
constexpr std::size_t vertices_of_task = 4096;

// ---- Places of coordinates among floats ---------------------------------------------------------

constexpr int least_exponent = -1074, step_of_window = 64, binades_of_window = 192;
/// Binary digits of the significands of a double, of a float in the window, and of a float
/// elsewhere.
constexpr int digits = 52, digits_of_window = 23, other_digits = digits_of_window - 6;

/// y = i + f of a magnitude other than 0, in units of 2^-52.
std::uint64_t logarithm(double magnitude) {
  constexpr auto unit = std::uint64_t{1} << digits;
  // The bits of a normal double are its exponent + 1023 and f. Subnormal ones are made normal.
  constexpr int normal = -1023 - least_exponent, subnormal = normal - digits;
  static_assert(normal == 51 && subnormal == -1);
  if (magnitude >= std::numeric_limits<double>::min()) {
    return std::bit_cast<std::uint64_t>(magnitude) + normal * unit;
  }
  return std::bit_cast<std::uint64_t>(magnitude * 0x1p52) - unit;
}

/// x and y, z and an unused number of a vertex at a time.
using DoublePair = double __attribute__((vector_size(16)));
using Place = std::array<DoublePair, 2>;
using WholeRow = std::int32_t __attribute__((vector_size(16)));

/// A place in float.
struct RoundedPlace {
  FloatRow floats;
  bool is_exact;
};

/// Rounds coordinates to floats.
class Rounding {
 public:
  /// \param j The number of the window.
  explicit Rounding(int j)
      : j_(j),
        begin_(std::max(high_bits(step_of_window * j), high_bits(digits))),
        end_(high_bits(step_of_window * j + binades_of_window)),
        shift_((52 - 63 * j) * binade) {}

  /// Takes no branch while all coordinates are 0, or normal and in the window.
  [[nodiscard]] RoundedPlace operator()(const Place& place) const {
    const auto a = std::bit_cast<WholeRow>(place[0]), b = std::bit_cast<WholeRow>(place[1]);
    const WholeRow low = __builtin_shufflevector(a, b, 0, 2, 4, 6);
    const WholeRow high = __builtin_shufflevector(a, b, 1, 3, 5, 7);
    const WholeRow magnitude = high & 0x7FFFFFFF, sign = high ^ magnitude;
    const WholeRow is_zero = (magnitude | low) == 0;
    const WholeRow is_elsewhere = ~is_zero & ((magnitude < begin_) | (magnitude >= end_));
    // The upper 23 digits of f; the rest is dropped.
    Magnitudes places{(((magnitude + shift_) << 3) | ((low >> 29) & 7)) & ~is_zero, low << 3};
    if (has_any(is_elsewhere)) places = each(place, places);
    return {std::bit_cast<FloatRow>(places.below | sign), !has_any(places.rest)};
  }

 private:
  static constexpr std::int32_t binade = 1 << 20;  ///< in the upper half of a double

  /// Places of magnitudes, rounded down, and a remainder, 0 iff that is exact.
  struct Magnitudes {
    WholeRow below;
    WholeRow rest;
  };

  /// The upper half of a normal double with that y.
  static std::int32_t high_bits(int y) { return std::min(y - 51, 2047) * binade; }

  static bool has_any(const WholeRow& row) { return (row[0] | row[1] | row[2]) != 0; }

  /// The places one by one.
  [[gnu::noinline]] [[nodiscard]] Magnitudes each(const Place& place, Magnitudes places) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double magnitude = std::abs(place[axis / 2][axis % 2]);
      if (magnitude == 0.0) continue;
      const std::uint64_t y = logarithm(magnitude);
      const int before_window = static_cast<int>(y >> digits) - step_of_window * j_;
      const bool is_inside = 0 <= before_window && before_window < binades_of_window;
      const int dropped = digits - (is_inside ? digits_of_window : other_digits);
      // The place of y = 0 on the line that y is on, in units of N.
      const int origin = is_inside ? 1 - 63 * j_ : before_window < 0 ? 1 : 190;
      places.below[axis] = static_cast<std::int32_t>(
          static_cast<std::int64_t>(y >> dropped) + origin * (std::int64_t{1} << digits_of_window));
      places.rest[axis] = (y & ((std::uint64_t{1} << dropped) - 1)) != 0 ? 1 : 0;
    }
    return places;
  }

  int j_;
  std::int32_t begin_, end_;  ///< the upper halves of doubles around the window
  std::int32_t shift_;        ///< from the upper half of a double to that of its place
};

/// j for vertices: the middle of the window is about the median of a sample of their exponents.
int window_of(const Motion& vertices) {
  constexpr std::size_t sample = 256;
  constexpr int usual = 15, last = 30;
  std::vector<int> exponents;
  const std::size_t stride = vertices.size() / sample + 1;
  for (std::size_t i = 0; i < vertices.size(); i += stride) {
    for (const auto& place : {vertices[i].start, vertices[i].end}) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (place[axis] != 0.0) exponents.push_back(std::ilogb(place[axis]) - least_exponent);
      }
    }
  }
  if (exponents.empty()) return usual;
  const auto median = exponents.begin() + static_cast<std::ptrdiff_t>(exponents.size() / 2);
  std::ranges::nth_element(exponents, median);
  const int begin = *median - binades_of_window / 2 + step_of_window / 2;
  return std::clamp(begin / step_of_window, 0, last);
}

// ---- Bounds -------------------------------------------------------------------------------------

/// Bounds of a coordinate.
struct Range {
  double lower;
  double upper;
};

/// Bounds of the coordinate at a time, from its values at both ends.
Range coordinate_at(double time, double from, double to) {
  if (from == to) return {from, from};
  const double size = std::max(std::abs(from), std::abs(to));
  // The bound of the error holds up to 2^1022.
  const bool is_large = size > 0x1p1000;
  const double scale = is_large ? 0x1p-30 : 1.0, unit = is_large ? 0x1p30 : 1.0;
  const auto position =
      filters::Position::evaluate<double>({from * scale, to * scale}, {1.0 - time, time});
  const double error = filters::position_double(size * scale);
  return {(position - 2.0 * error) * unit, (position + 2.0 * error) * unit};
}

/// Computation of the bounds of vertices.
class BoundsMaker {
 public:
  BoundsMaker(const Motion& vertices, double end, double distance)
      : round_(window_of(vertices)), end_(end), below_(distance / 2.0), above_(distance - below_) {}

  /// The maker for a vertex with that reach.
  [[nodiscard]] BoundsMaker with_reach(double reach) const {
    constexpr double enlarged = 1.0 + 0x1p-50;
    BoundsMaker result = *this;
    result.below_ = (below_ + reach) * enlarged;
    result.above_ = (above_ + reach) * enlarged;
    return result;
  }

  /// Sets the bounds of a vertex. Returns true if they are exact.
  bool set(VertexBounds& bounds, const MovingVertex& vertex) const {
    const bool is_exact = set(bounds, 0, place_of(vertex.start));
    if (end_ == 1.0) return set(bounds, 1, place_of(vertex.end)) && is_exact;
    const auto at_end = [&](std::size_t axis) {
      return coordinate_at(end_, vertex.start[axis], vertex.end[axis]);
    };
    const Range x = at_end(0), y = at_end(1), z = at_end(2);
    set(bounds, 1, {DoublePair{x.lower, y.lower}, DoublePair{z.lower, 0.0}},
        {DoublePair{x.upper, y.upper}, DoublePair{z.upper, 0.0}});
    return false;
  }

 private:
  static Place place_of(const std::array<double, 4>& x) {
    return {DoublePair{x[0], x[1]}, DoublePair{x[2], x[3]}};
  }

  bool set(VertexBounds& bounds, std::size_t end, const Place& place) const {
    if (above_ > 0.0) {
      set(bounds, end, place, place);
      return false;
    }
    const RoundedPlace rounded = round_(place);
    bounds.lower[end] = bounds.upper[end] = rounded.floats;
    return rounded.is_exact;
  }
  void set(VertexBounds& bounds, std::size_t end, const Place& lower, const Place& upper) const {
    bounds.lower[end] = round_({lower[0] - below_, lower[1] - below_}).floats;
    bounds.upper[end] = round_({upper[0] + above_, upper[1] + above_}).floats;
  }

  Rounding round_;
  double end_;
  double below_, above_;  ///< the parts of the distance
};

}  // namespace

FloatBounds::FloatBounds(const Motion& vertices, double end, double distance,
                         std::span<const double> reaches)
    : size_(vertices.size()), bounds_(size_) {
  const StrictFloatingPoint strict;
  const BoundsMaker maker(vertices, end, distance);
  exact_ = tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, size_, vertices_of_task), true,
      [this, &vertices, reaches, maker](const tbb::blocked_range<std::size_t>& range, bool exact) {
        const StrictFloatingPoint of_task;
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          exact &= reaches.empty() ? maker.set(bounds_[i], vertices[i])
                                   : maker.with_reach(reaches[i]).set(bounds_[i], vertices[i]);
        }
        return exact;
      },
      std::logical_and<>());
}

}  // namespace touchstone::fast
