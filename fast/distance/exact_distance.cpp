#include "fast/distance/exact_distance.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "fast/certified/exact/big_integer.hpp"
#include "fast/certified/exact/enclosing_doubles.hpp"
#include "fast/distance/neighbouring_doubles.hpp"
#include "fast/distance/polygon_features.hpp"

namespace touchstone::fast {
namespace exact_stage {

/// |a|. (In the namespace in which the templates of polygon_features.hpp look for it.)
static BigInteger abs(const BigInteger& a) { return a.sign() < 0 ? -a : a; }

}  // namespace exact_stage

namespace {

using exact_stage::BigInteger;
using exact_stage::BinaryFraction;

using Polygon = polygon::Polygon<BigInteger>;

/// numerator / denominator, which is positive.
struct Fraction {
  BigInteger numerator;
  BigInteger denominator{1};
};

/// The sign of a − b.
int compare(const Fraction& a, const Fraction& b) {
  return (a.numerator * b.denominator - b.numerator * a.denominator).sign();
}

/// P, in units of 2^unit.
struct ScaledPolygon {
  Polygon polygon;
  long unit = 0;
};

ScaledPolygon polygon_at(ContactKind kind, const Query& query, double t) {
  int lowest = std::numeric_limits<int>::max();
  for (const double x : query.coordinates) {
    const BinaryFraction fraction = exact_stage::odd_fraction(x);
    if (fraction.numerator != 0) lowest = std::min(lowest, fraction.exponent);
  }
  if (lowest == std::numeric_limits<int>::max()) lowest = 0;
  const auto integer = [&](double x) {
    const BinaryFraction fraction = exact_stage::odd_fraction(x);
    if (fraction.numerator == 0) return BigInteger();
    return BigInteger(fraction.numerator) << (fraction.exponent - lowest);
  };
  const BinaryFraction time = exact_stage::odd_fraction(t);
  const BigInteger weight_of_end(time.numerator);
  const BigInteger weight_of_start = (BigInteger(1) << -time.exponent) - weight_of_end;
  const auto at = [&](const Corner& corner, std::size_t axis) {
    const auto at_end = [&](std::size_t end) {
      return integer(query.at(end, corner.plus, axis)) - integer(query.at(end, corner.minus, axis));
    };
    return weight_of_start * at_end(0) + weight_of_end * at_end(1);
  };
  return {polygon::polygon_of<BigInteger>(polygon::distinct_corners(kind, query), at),
          lowest + time.exponent};
}

/// The square of the distance, by theorem 1.
Fraction squared_distance(const Polygon& p) {
  if (p.has_face()) {
    const auto face = polygon::face(p);
    const bool is_inside = std::ranges::all_of(std::span(face.turns).first(p.count),
                                               [](const BigInteger& x) { return x.sign() >= 0; });
    if (face.square.sign() > 0 && is_inside) return {face.height * face.height, face.square};
  }
  Fraction least{filters::dot(p.corner[0], p.corner[0])};
  const auto consider = [&](Fraction candidate) {
    if (compare(candidate, least) < 0) least = std::move(candidate);
  };
  for (std::size_t i = 1; i < p.count; ++i) consider({filters::dot(p.corner[i], p.corner[i])});
  for (std::size_t i = 0; i < p.sides(); ++i) {
    auto side = polygon::side(p, i);
    if (side.from.sign() < 0 && side.to.sign() > 0) {
      consider({std::move(side.area), std::move(side.square)});
    }
  }
  return least;
}

/// The distance, by theorem 3.
Fraction greatest_gap(const Polygon& p) {
  Fraction greatest;
  auto axes = polygon::axes(p);
  for (std::size_t i = 0; i < axes.count; ++i) {
    auto& axis = axes.items[i];
    if (axis.length.sign() == 0) continue;
    const auto values = std::span(axis.values).first(axis.count);
    const auto is_less = [](const BigInteger& a, const BigInteger& b) {
      return (a - b).sign() < 0;
    };
    const auto [least, most] = std::ranges::minmax(values, is_less);
    for (const BigInteger& gap : {least, -most}) {
      Fraction candidate{gap, axis.length};
      if (compare(candidate, greatest) > 0) greatest = std::move(candidate);
    }
  }
  return greatest;
}

/// The approximate root of that degree of a fraction in units of 2^(degree · unit).
double approximate_root(const Fraction& fraction, long unit, int degree) {
  const auto a = fraction.numerator.approximation(), b = fraction.denominator.approximation();
  const long exponent = a.exponent - b.exponent;
  const long odd = degree == 2 ? exponent & 1 : 0;
  const double quotient = a.significand / b.significand;
  const double root = degree == 2 ? std::sqrt(odd != 0 ? 2.0 * quotient : quotient) : quotient;
  const long shift = std::clamp((exponent - odd) / degree + unit, -3000L, 3000L);
  return std::ldexp(root, static_cast<int>(shift));
}

}  // namespace

Distance exact_distance(ContactKind kind, const Query& query, double t, Norm norm) {
  const ScaledPolygon scaled = polygon_at(kind, query, t);
  const int degree = norm == Norm::l2 ? 2 : 1;
  const Fraction fraction =
      norm == Norm::l2 ? squared_distance(scaled.polygon) : greatest_gap(scaled.polygon);
  if (fraction.numerator.sign() == 0) return {0.0, 0.0};
  const auto sign_of = [&](double x) -> std::optional<int> {
    const BinaryFraction s = exact_stage::odd_fraction(x);
    BigInteger beyond = fraction.denominator * BigInteger(s.numerator);
    if (degree == 2) beyond = beyond * BigInteger(s.numerator);
    // The fraction times 2^(degree · unit), less `beyond` times 2^(degree · exponent).
    const long shift = degree * (scaled.unit - s.exponent);
    if (shift >= 0) return ((fraction.numerator << shift) - beyond).sign();
    return (fraction.numerator - (beyond << -shift)).sign();
  };
  return *neighbouring_doubles(approximate_root(fraction, scaled.unit, degree), sign_of);
}

}  // namespace touchstone::fast
