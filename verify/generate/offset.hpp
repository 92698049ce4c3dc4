#pragma once

/// \file
/// The first time at which a point on a straight line comes within a distance of the origin:
/// the closed form, in rationals, that decides the families about a separation.
///
/// In L∞ each coordinate is within d during an interval of t, and the first common time is the
/// greatest of their beginnings. In L2 the squared distance minus d² is a quadratic in t that opens
/// upward: it is within at t = 0, or from the smaller root on if its least value on [0,1] is not
/// positive. This root is rational iff the discriminant is the square of a rational.

#include <array>
#include <optional>

#include "touchstone/number.hpp"
#include "touchstone/query.hpp"

namespace touchstone::verify::generate {

/// A point at t=0 and at t=1.
struct Offset3 {
  std::array<exact::Rational, 3> start;
  std::array<exact::Rational, 3> end;
};

/// The first time of approach, if any.
struct Arrival {
  bool comes = false;
  /// The time if it is rational.
  std::optional<exact::Rational> time;
};

/// The first t in [0,1] at which the point is within the separation of the origin.
[[nodiscard]] Arrival arrival(const Offset3& offset, const Separation& separation);

}  // namespace touchstone::verify::generate
