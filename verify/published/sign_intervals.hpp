#pragma once

/// \file
/// The times in [0,1] at which a polynomial has a required sign: the basis of FPRF.
///
/// The sign of a polynomial can only change at its zeros, so its value in the middle between
/// neighbouring ones decides. Zeros come from zeros_of() (rpoly.hpp) with their real parts alone:
/// those of complex pairs cut intervals too, which is harmless in exact arithmetic, and in floating
/// point represents double zeros that were computed as a complex pair.

#include <span>
#include <vector>

namespace touchstone::verify::published {

/// A closed interval of times in [0,1], of any length, 0 as well.
struct TimeInterval {
  double from;
  double to;

  friend bool operator==(const TimeInterval&, const TimeInterval&) = default;
};

enum class WantedSign { not_negative, not_positive };

/// The intervals, in ascending order.
///
/// The coefficients (the highest power's first) are divided by the greatest magnitude among them;
/// leading ones that are exactly 0 are omitted, tiny ones are not. From degree 3 on there are no
/// intervals if the constant together with all positive contributions is negative. A quadratic a t²
/// has a division by zero, and of its zero only that time is an interval.
[[nodiscard]] std::vector<TimeInterval> sign_intervals(std::span<const double> coefficients,
                                                       WantedSign sign);

}  // namespace touchstone::verify::published
