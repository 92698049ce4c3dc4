#pragma once

/// \file
/// MPFR's numbers as a scalar that the expression templates can run on.

#include <mpfr.h>

namespace touchstone::filters {

/// A binary floating-point number of chosen precision. Results have the greater precision of their
/// operands and are rounded to nearest; MPFR's inexact flag is set if any of them was rounded.
class MpfrNumber {
 public:
  /// \param precision in bits, at least the 53 of a double, so that the value is exact
  MpfrNumber(double value, mpfr_prec_t precision) : MpfrNumber(precision) {
    mpfr_set_d(value_, value, MPFR_RNDN);
  }
  MpfrNumber(const MpfrNumber& other) : MpfrNumber(mpfr_get_prec(other.value_)) {
    mpfr_set(value_, other.value_, MPFR_RNDN);
  }
  MpfrNumber& operator=(const MpfrNumber& other) {
    if (this == &other) return *this;
    mpfr_set_prec(value_, mpfr_get_prec(other.value_));
    mpfr_set(value_, other.value_, MPFR_RNDN);
    return *this;
  }
  ~MpfrNumber() { mpfr_clear(value_); }

  /// The nearest double.
  [[nodiscard]] double to_double() const { return mpfr_get_d(value_, MPFR_RNDN); }

  friend MpfrNumber operator+(const MpfrNumber& a, const MpfrNumber& b) {
    return apply(mpfr_add, a, b);
  }
  friend MpfrNumber operator-(const MpfrNumber& a, const MpfrNumber& b) {
    return apply(mpfr_sub, a, b);
  }
  friend MpfrNumber operator*(const MpfrNumber& a, const MpfrNumber& b) {
    return apply(mpfr_mul, a, b);
  }

 private:
  explicit MpfrNumber(mpfr_prec_t precision) { mpfr_init2(value_, precision); }

  template <class Function>
  static MpfrNumber apply(const Function& function, const MpfrNumber& a, const MpfrNumber& b) {
    const mpfr_prec_t of_a = mpfr_get_prec(a.value_), of_b = mpfr_get_prec(b.value_);
    MpfrNumber result(of_a > of_b ? of_a : of_b);
    function(result.value_, a.value_, b.value_, MPFR_RNDN);
    return result;
  }

  mpfr_t value_;
};

}  // namespace touchstone::filters
