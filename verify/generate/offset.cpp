#include "verify/generate/offset.hpp"

#include <algorithm>

namespace touchstone::verify::generate {

using exact::Integer;
using exact::Rational;

namespace {

Arrival arrival_linf(const Offset3& offset, const Rational& d) {
  Rational first = 0, last = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Rational& start = offset.start.at(axis);
    const Rational speed = offset.end.at(axis) - start;
    if (speed == 0) {
      if (abs(start) > d) return {};
      continue;
    }
    const Rational at_minus_d = (-d - start) / speed, at_d = (d - start) / speed;
    first = std::max(first, std::min(at_minus_d, at_d));
    last = std::min(last, std::max(at_minus_d, at_d));
  }
  if (first > last) return {};
  return {.comes = true, .time = first};
}

std::optional<Rational> rational_root(const Rational& square) {
  const Integer &numerator = square.get_num(), &denominator = square.get_den();
  if (mpz_perfect_square_p(numerator.get_mpz_t()) == 0 ||
      mpz_perfect_square_p(denominator.get_mpz_t()) == 0) {
    return std::nullopt;
  }
  return Rational(Integer(sqrt(numerator)), Integer(sqrt(denominator)));
}

Arrival arrival_l2(const Offset3& offset, const Rational& d) {
  Rational a = 0, b = 0, c = -d * d;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Rational& start = offset.start.at(axis);
    const Rational speed = offset.end.at(axis) - start;
    a += speed * speed;
    b += start * speed;
    c += start * start;
  }
  // a t² + 2 b t + c
  if (c <= 0) return {.comes = true, .time = Rational(0)};
  if (a == 0) return {};
  const Rational lowest = std::clamp<Rational>(-b / a, 0, 1);
  if ((a * lowest + 2 * b) * lowest + c > 0) return {};
  const auto root = rational_root(b * b - a * c);
  if (!root) return {.comes = true, .time = std::nullopt};
  return {.comes = true, .time = Rational((-b - *root) / a)};
}

}  // namespace

Arrival arrival(const Offset3& offset, const Separation& separation) {
  const Rational d(separation.distance);
  return separation.norm == Norm::linf ? arrival_linf(offset, d) : arrival_l2(offset, d);
}

}  // namespace touchstone::verify::generate
