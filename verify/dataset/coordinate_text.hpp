#pragma once

/// \file
/// Coordinates as the CSV datasets write them: a pair of integers of any length whose quotient is a
/// double.
///
/// Most pairs are a numerator of at most 63 bits over a power of two of at most 63, and for these
/// machine integers are enough: n / 2^k with n = odd · 2^j is a double if `odd` has at most 53
/// bits, since |n| / 2^k lies in [2^-63, 2^63], far from both ends of the range. Longer powers of
/// two, small coordinates, need the same comparison of bits on long integers. All other pairs go
/// through rationals, where the nearest double is compared with the number itself.

#include <stdexcept>
#include <string>
#include <string_view>

namespace touchstone::verify {

/// A coordinate and whether the double is the number that was written.
struct ParsedCoordinate {
  /// Finite, and +0 if it is zero; the nearest double where not exact.
  double value;
  bool exact;
};

/// A pair that is no coordinate.
class CoordinateError : public std::invalid_argument {
 public:
  /// Which of the two integers is at fault.
  enum class Part { numerator, denominator };

  CoordinateError(Part part, const std::string& reason)
      : std::invalid_argument(reason), part_(part) {}
  [[nodiscard]] Part part() const { return part_; }

 private:
  Part part_;
};

/// The quotient of two decimal integers: an optional sign, then digits; nothing else.
/// \throws CoordinateError if one is no integer, the denominator is zero, or the double nearest to
/// the quotient is infinite.
[[nodiscard]] ParsedCoordinate parse_coordinate(std::string_view numerator,
                                                std::string_view denominator);

/// Appends "numerator,denominator" in lowest terms, denominator positive; −0 is written as "0,1".
/// \throws std::invalid_argument if the value is not finite.
void append_coordinate(std::string& text, double value);

}  // namespace touchstone::verify
