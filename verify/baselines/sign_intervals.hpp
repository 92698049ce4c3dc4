#pragma once

/// \file
/// Where on [0,1] a polynomial has the wanted sign: FPRF's way of solving everything.
///
/// The sign of a polynomial can only change at its zeros, so between neighbouring ones its value at
/// the middle tells. Zeros come from zeros_of() (rpoly.hpp) with their real parts alone: those of
/// complex pairs cut intervals too, which does no harm in exact arithmetic, and in floating point
/// stands for double zeros that came out as a complex pair.

#include <span>
#include <vector>

namespace touchstone::baselines {

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
/// first ones that are exactly 0 are left out, others however tiny are not. From degree 3 on there
/// are no intervals if the constant and all other coefficients that help are together of the other
/// sign. A quadratic a t² has a division by zero, and of its zero only that time is an interval.
[[nodiscard]] std::vector<TimeInterval> sign_intervals(std::span<const double> coefficients,
                                                       WantedSign sign);

}  // namespace touchstone::baselines
