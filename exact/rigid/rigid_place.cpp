/// With θ = |r|, Rodrigues' formula is
///
///     x = p + v + (sin θ / θ) r × v + 2 (sin(θ/2) / θ)² r × (r × v).
///
/// It is evaluated with 320 binary digits. Every operation rounds by at most 2^-320 of its result,
/// sums of up to three products by less than 2^-317 of the sum of their magnitudes. Angles are
/// below 2^104, so an error of θ of 2^-318 of it changes sin θ by at most 2^-214. All terms are at
/// most 4 |v| or |p|: a coordinate errs by less than 2^-200 (|p| + |v|) before it is rounded to a
/// double, which adds at most 2^-53 of it, less than 2^-51 (|p| + |v|), or half the least subnormal
/// number. (MPFR's exponents have no such limit.)

#include "exact/rigid/rigid_place.hpp"

#include <mpfr.h>

#include <cstddef>

namespace touchstone::exact {
namespace {

class Real {
 public:
  Real() { mpfr_init2(x_, digits); }
  explicit Real(double value) : Real() { mpfr_set_d(x_, value, MPFR_RNDN); }
  Real(const Real& other) : Real() { mpfr_set(x_, other.x_, MPFR_RNDN); }
  Real& operator=(const Real& other) {
    mpfr_set(x_, other.x_, MPFR_RNDN);
    return *this;
  }
  ~Real() { mpfr_clear(x_); }

  /// In units of 2^unit.
  [[nodiscard]] double to_double(int unit) const {
    Real result;
    mpfr_mul_2si(result.x_, x_, -unit, MPFR_RNDN);
    return mpfr_get_d(result.x_, MPFR_RNDN);
  }
  [[nodiscard]] bool is_zero() const { return mpfr_zero_p(x_) != 0; }

  friend Real operator+(const Real& a, const Real& b) { return of(mpfr_add, a, b); }
  friend Real operator-(const Real& a, const Real& b) { return of(mpfr_sub, a, b); }
  friend Real operator*(const Real& a, const Real& b) { return of(mpfr_mul, a, b); }
  friend Real operator/(const Real& a, const Real& b) { return of(mpfr_div, a, b); }
  friend Real sine(const Real& a) {
    Real result;
    mpfr_sin(result.x_, a.x_, MPFR_RNDN);
    return result;
  }
  friend Real square_root(const Real& a) {
    Real result;
    mpfr_sqrt(result.x_, a.x_, MPFR_RNDN);
    return result;
  }

 private:
  static constexpr mpfr_prec_t digits = 320;

  template <class Operation>
  static Real of(const Operation& operation, const Real& a, const Real& b) {
    Real result;
    operation(result.x_, a.x_, b.x_, MPFR_RNDN);
    return result;
  }

  mpfr_t x_;
};

using Vector = std::array<Real, 3>;

Vector at_time(const std::array<double, 3>& start, const std::array<double, 3>& end, double t) {
  Vector result;
  for (std::size_t k = 0; k < 3; ++k) {
    result[k] = Real(start[k]) + Real(t) * (Real(end[k]) - Real(start[k]));
  }
  return result;
}

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace

std::array<double, 3> place_of(const RigidMotion& motion, const std::array<double, 3>& v, double t,
                               int unit) {
  const Vector p = at_time(motion.start.position, motion.end.position, t);
  const Vector r = at_time(motion.start.rotation, motion.end.rotation, t);
  const Vector body{Real(v[0]), Real(v[1]), Real(v[2])};
  const Real angle = square_root(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
  std::array<double, 3> result{};
  if (angle.is_zero()) {
    for (std::size_t k = 0; k < 3; ++k) result[k] = (p[k] + body[k]).to_double(unit);
    return result;
  }
  const Vector once = cross(r, body), twice = cross(r, once);
  const Real half = sine(angle / Real(2.0)) / angle;
  const Real first = sine(angle) / angle, second = Real(2.0) * half * half;
  for (std::size_t k = 0; k < 3; ++k) {
    result[k] = (p[k] + body[k] + first * once[k] + second * twice[k]).to_double(unit);
  }
  return result;
}

}  // namespace touchstone::exact
