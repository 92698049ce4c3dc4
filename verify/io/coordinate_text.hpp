#pragma once

/// \file
/// Coordinates as the CSV datasets write them: a numerator and a denominator, each an integer or a
/// decimal of any length, whose quotient is a double. A coordinate in one field has the denominator
/// 1.
///
/// Most pairs are n / 2^k with |n| ≤ 2^53 and k < 64: a double, by one division. All others, and
/// decimals, go through rationals, where the nearest double is compared with the number itself.

#include <stdexcept>
#include <string>
#include <string_view>

namespace touchstone::verify::io {

/// A coordinate, and whether the double equals the written number.
struct ParsedCoordinate {
  /// Finite, and +0 if it is zero; the nearest double where not exact.
  double value;
  bool exact;
};

/// The error for a pair that is not a coordinate.
class CoordinateError : public std::invalid_argument {
 public:
  /// The invalid number of the two.
  enum class Part { numerator, denominator };

  CoordinateError(Part part, const std::string& reason)
      : std::invalid_argument(reason), part_(part) {}
  [[nodiscard]] Part part() const { return part_; }

 private:
  Part part_;
};

/// The quotient of two numbers: an optional sign, digits with an optional point, and an optional
/// exponent ("-1.25e-3") of at most 10000; nothing else.
/// \throws CoordinateError if one is not such a number, the denominator is zero, or the double
/// nearest to the quotient is infinite.
[[nodiscard]] ParsedCoordinate parse_coordinate(std::string_view numerator,
                                                std::string_view denominator);

/// Why exact::rational_from_decimal does not take a text.
[[nodiscard]] std::string fault_of_decimal(std::string_view text);

/// True if a text is meant as a number, well-formed or not: it begins like one, or is NaN or
/// infinity.
[[nodiscard]] bool is_numeric(std::string_view text);

/// Appends "numerator,denominator" in lowest terms, denominator positive; −0 is written as "0,1".
/// \throws std::invalid_argument if the value is not finite.
void append_coordinate(std::string& text, double value);

}  // namespace touchstone::verify::io
