#include "touchstone/derivation/shipped_bound.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace touchstone::filters {
namespace {

/// The least number of the format that is not below x ≥ 0.
mpq_class round_up(const mpq_class& x, const Format& format) {
  if (x == 0) return x;
  // The distance between neighbouring numbers of the format at x.
  const mpq_class spacing = std::max<mpq_class>(
      power_of_two_below(x) * power_of_two(1 - format.digits), power_of_two(format.least_exponent));
  const mpq_class multiple = x / spacing;
  mpz_class up;
  mpz_cdiv_q(up.get_mpz_t(), multiple.get_num_mpz_t(), multiple.get_den_mpz_t());
  return mpq_class(up) * spacing;
}

/// A number of the format as a hexadecimal literal: C++'s spelling of an exact value.
std::string literal(const mpq_class& x, const Format& format) {
  return fmt::format("{:a}{}", x.get_d(), format.digits == float_format.digits ? "F" : "");
}

constexpr std::string_view preamble = R"(#pragma once

/// \file
/// The error bounds of the filtered expressions, derived from the expressions themselves.
///
/// Written by `touchstone-derive --emit filters/include/touchstone/filters/error_bounds.hpp`; not
/// to be edited. A test fails if it differs from what the derivation gives, another has Gappa prove
/// each bound.
///
/// (u: half the distance of 1 and the next number; x: the greatest magnitude of a coordinate.)

#include "touchstone/filters/error_bound.hpp"

namespace touchstone::filters {

)";

}  // namespace

std::vector<mpq_class> shipped_coefficients(const DerivedBound& bound, const Format& format) {
  const Format& numbers = format_of_bounds(format);
  const std::size_t degree = bound.coefficients.size() - 1;
  mpq_class margin(1);
  for (std::size_t i = 0; i < 2 * degree; ++i) margin *= 1 + 3 * numbers.unit_roundoff();
  const mpq_class underflow = power_of_two(numbers.least_exponent) * (degree > 1 ? 2 : 1);
  std::vector<mpq_class> result;
  for (std::size_t j = 0; j <= degree; ++j) {
    const mpq_class raised =
        bound.coefficients[j] * margin + (j < degree ? underflow : mpq_class(0));
    result.push_back(round_up(raised, numbers));
  }
  return result;
}

std::string error_bound_declaration(const ExpressionGraph& graph, const Format& format) {
  const DerivedBound bound = derive_bound(graph, format);
  const std::vector<mpq_class> coefficients = shipped_coefficients(bound, format);
  std::string list;
  for (std::size_t j = 0; j < coefficients.size(); ++j) {
    // The line breaks of clang-format: three doubles on a line, or four floats.
    const std::size_t on_a_line = format.digits == float_format.digits ? 4 : 3;
    const std::string_view separator = j == 0               ? ""
                                       : j % on_a_line == 0 ? ",\n                      "
                                                            : ", ";
    list += std::string(separator) + literal(coefficients[j], format);
  }
  const mpq_class units = bound.rounding() / format.unit_roundoff();
  const std::size_t degree = coefficients.size() - 1;
  // A comma at the end keeps clang-format from joining the lines.
  return fmt::format(
      "/// {0} in {1}: {2:.6g} u x{3} and underflow.\n"
      "inline constexpr ErrorBound<{7}, {4}> {0}_{1}{{\n"
      "    .coefficients = {{{{{5}}}}},\n"
      "    .greatest_x = {6},\n"
      "}};\n",
      graph.name, format.name, units.get_d(), degree == 1 ? "" : fmt::format("^{}", degree), degree,
      list, literal(power_of_two(bound.greatest_x_exponent), format),
      format_of_bounds(format).name);
}

std::string error_bounds_header(std::span<const ShippedExpression> expressions) {
  std::string text(preamble);
  for (const auto& [graph, format] : expressions) {
    text += error_bound_declaration(graph, format) + "\n";
  }
  text += "}  // namespace touchstone::filters\n";
  return text;
}

}  // namespace touchstone::filters
