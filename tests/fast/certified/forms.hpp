#pragma once

/// \file
/// Forms with integer coefficients, given as functions of time: for the tests of polynomials and
/// roots.

#include <cstdint>

#include "fast/certified/exact/contact_conditions.hpp"
#include "fast/certified/exact/polynomial.hpp"

namespace touchstone::tests {

using Quadratic = fast::exact_stage::Form<fast::exact_stage::BigInteger, 2>;

/// a + b t + c t² as a form: t = y/(x+y).
[[nodiscard]] inline Quadratic in_time(std::int64_t a, std::int64_t b, std::int64_t c) {
  return {a, 2 * a + b, a + b + c};
}

[[nodiscard]] inline fast::exact_stage::Polynomial polynomial(const Quadratic& form) {
  return {form.begin(), form.end()};
}

/// a + b t + c t² + d t³, without roots at t=0 and t=1.
[[nodiscard]] inline fast::exact_stage::Polynomial cubic(std::int64_t a, std::int64_t b,
                                                         std::int64_t c, std::int64_t d) {
  return fast::exact_stage::inner_polynomial(
      fast::exact_stage::Polynomial{a, 3 * a + b, 3 * a + 2 * b + c, a + b + c + d});
}

}  // namespace touchstone::tests
