// The places of intersections: points of contacts (contacts.hpp) between doubles.
//
// At a vertex the point is given. An edge pq passes through a triangle, or crosses an edge in one
// plane with it, at
//
//     (D(q) p − D(p) q) / (D(q) − D(p)),
//
// where D is the determinant of the triangle and a point, or of the other edge and a point in a
// projection: it is linear, 0 at the place, and has different signs at p and q. The numbers are
// integers in units of the lowest bit; comparisons with doubles enclose the quotient. Of two points
// between the same doubles the quotients are compared.

#include <algorithm>
#include <cstddef>

#include "fast/certified/exact/enclosing_doubles.hpp"
#include "fast/distance/neighbouring_doubles.hpp"
#include "fast/intersections/triangle_contacts.hpp"

namespace touchstone::fast::meeting {
namespace {

using exact_stage::BigInteger;

struct Enclosure {
  double lower, upper;
};

/// numerator / denominator · 2^exponent. \pre the denominator is positive
Enclosure enclosure_of(const BigInteger& numerator, const BigInteger& denominator, int exponent) {
  if (numerator.sign() < 0) {
    const auto [lower, upper] = enclosure_of(-numerator, denominator, exponent);
    return {-upper, -lower};
  }
  exact_stage::Approximation guess = numerator.approximation();
  guess.exponent += exponent;
  const auto sign_of = [&](double x) -> std::optional<int> {
    const auto [significand, x_exponent] = exact_stage::odd_fraction(x);
    const long shift = long{exponent} - x_exponent;
    const BigInteger product = BigInteger(significand) * denominator;
    return shift < 0 ? (numerator - (product << -shift)).sign()
                     : ((numerator << shift) - product).sign();
  };
  const auto found =
      neighbouring_doubles(exact_stage::quotient(guess, denominator.approximation()), sign_of);
  return {found->lower, found->upper};
}

/// numerators / denominator · 2^exponent; of a vertex only the enclosure, which is the point.
struct Point {
  PointEnclosure enclosure;
  IntegerPoint numerators = {};
  BigInteger denominator = BigInteger(1);
  int exponent = 0;

  /// True if it is before the other one, by x, y and z in turn.
  [[nodiscard]] bool operator<(const Point& other) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (const int sign = compared(other, axis); sign != 0) return sign < 0;
    }
    return false;
  }

 private:
  [[nodiscard]] int compared(const Point& other, std::size_t axis) const {
    const auto doubles = [axis](const PointEnclosure& of) {
      return std::pair(of.lower[axis], of.upper[axis]);
    };
    const auto own = doubles(enclosure), others = doubles(other.enclosure);
    if (own != others) return own < others ? -1 : 1;
    if (own.first == own.second) return 0;
    const int shift = exponent - other.exponent;
    const BigInteger x = numerators[axis] * other.denominator;
    const BigInteger y = other.numerators[axis] * denominator;
    return ((x << std::max(shift, 0)) - (y << std::max(-shift, 0))).sign();
  }
};

/// The point of an edge pq where D is 0.
Point zero_on_edge(const InUnits& in, const IntegerPoint& p, const IntegerPoint& q, BigInteger of_p,
                   BigInteger of_q) {
  if (of_q.sign() < 0) {
    of_p = -of_p;
    of_q = -of_q;
  }
  Point result{.enclosure = {}, .denominator = of_q - of_p, .exponent = in.exponent};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result.numerators[axis] = of_q * p[axis] - of_p * q[axis];
    const auto [lower, upper] =
        enclosure_of(result.numerators[axis], result.denominator, in.exponent);
    result.enclosure.lower[axis] = lower;
    result.enclosure.upper[axis] = upper;
  }
  return result;
}

using Corners = std::span<const std::int32_t>;

/// \pre the edge passes through the triangle
Point crossing_of_face(const Positions& at, Corners edge, Corners face) {
  const InUnits in = in_units(at, {edge[0], edge[1], face[0], face[1], face[2]});
  const auto& [p, q, a, b, c] = in.points;
  return zero_on_edge(in, p, q, determinant(a, p, b, c), determinant(a, q, b, c));
}

/// \pre the edges cross in one plane
Point crossing_of_edge(const Positions& at, Corners edge, Corners other) {
  const InUnits in = in_units(at, {edge[0], edge[1], other[0], other[1], other[1]});
  const auto& [p, q, a, b, unused] = in.points;
  std::size_t axis = 0;
  BigInteger of_p = determinant(axis, a, b, p);
  while (of_p.sign() == 0) of_p = determinant(++axis, a, b, p);
  return zero_on_edge(in, p, q, of_p, determinant(axis, a, b, q));
}

Point at_vertex(const Positions& at, std::int32_t vertex) {
  PointEnclosure place;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    place.lower[axis] = place.upper[axis] = std::ldexp(at[vertex][axis], at.exponent());
  }
  return {place};
}

Point point_of(const Positions& at, const Element& a, const Element& b, const Contact& contact) {
  std::array<std::int32_t, 2> edge_of_a{}, edge_of_b{};
  const Corners of_a = vertices_of(a.simplex, contact.a, edge_of_a);
  const Corners of_b = vertices_of(b.simplex, contact.b, edge_of_b);
  if (of_a.size() == 1) return at_vertex(at, of_a[0]);
  if (of_b.size() == 1) return at_vertex(at, of_b[0]);
  if (of_a.size() == 3) return crossing_of_face(at, of_b, of_a);
  if (of_b.size() == 3) return crossing_of_face(at, of_a, of_b);
  return crossing_of_edge(at, of_a, of_b);
}

}  // namespace

std::array<PointEnclosure, 2> place_of(const Positions& at, const Element& a, const Element& b,
                                       Contacts contacts) {
  Point least = point_of(at, a, b, contacts.first()), greatest = least;
  for (;;) {
    contacts.remove(contacts.first());
    if (contacts.count() == 0) return {least.enclosure, greatest.enclosure};
    const Point point = point_of(at, a, b, contacts.first());
    least = std::min(least, point);
    greatest = std::max(greatest, point);
  }
}

}  // namespace touchstone::fast::meeting
