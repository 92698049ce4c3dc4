#include "verify/generate/grid.hpp"

#include <cmath>

namespace touchstone::verify::generate {

using exact::Integer;
using exact::Rational;

namespace {

/// A bound of about 2^bits that is no power of two.
std::int64_t draw_bound(Random& random, int bits) {
  const std::int64_t top = std::int64_t{1} << bits;
  return random.between(top / 2, top);
}

Integer minor(const Vector& a, const Vector& b, std::size_t i, std::size_t j) {
  return {whole(a.at(i)) * whole(b.at(j)) - whole(a.at(j)) * whole(b.at(i))};
}

std::size_t first_of_second(ContactKind kind) { return kind == ContactKind::vertex_face ? 1 : 2; }

}  // namespace

Vector operator+(const Vector& a, const Vector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

Vector operator-(const Vector& a, const Vector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Vector operator*(std::int64_t factor, const Vector& a) {
  return {factor * a[0], factor * a[1], factor * a[2]};
}

Integer whole(std::int64_t x) {
  return (Integer(static_cast<long>(x >> 32)) << 32U) + static_cast<unsigned long>(x & 0xFFFF'FFFF);
}

Integer determinant(const Vector& a, const Vector& b, const Vector& c) {
  return {minor(a, b, 0, 1) * whole(c[2]) - minor(a, b, 0, 2) * whole(c[1]) +
          minor(a, b, 1, 2) * whole(c[0])};
}

bool parallel(const Vector& a, const Vector& b) {
  return minor(a, b, 0, 1) == 0 && minor(a, b, 0, 2) == 0 && minor(a, b, 1, 2) == 0;
}

GridSize::GridSize(Recipe& recipe)
    : position(recipe.full ? draw_bound(recipe.random, 51) : 16),
      shape(recipe.full ? draw_bound(recipe.random, 46) : 4),
      velocity(recipe.full ? draw_bound(recipe.random, 46) : 4) {}

Vector draw_vector(Random& random, std::int64_t bound) {
  Vector vector{};
  for (std::int64_t& component : vector) component = random.between(-bound, bound);
  return vector;
}

Vector draw_unit_shift(Random& random) {
  Vector shift{};
  while (shift == Vector{}) shift = draw_vector(random, 1);
  return shift;
}

Rational DyadicTime::value() const {
  Rational value{whole(numerator), whole(denominator())};
  value.canonicalize();
  return value;
}

DyadicTime draw_inner_time(Random& random) {
  const auto log_denominator = static_cast<int>(random.between(1, 4));
  return {random.between(1, (std::int64_t{1} << log_denominator) - 1), log_denominator};
}

Vector Moment::corner(ContactKind kind, std::size_t corner) const {
  const Corner pair = corners(kind)[corner];
  return position.at(pair.plus) - position.at(pair.minus);
}

std::array<Vector, 2> Moment::edges(ContactKind kind) const {
  const Vector w0 = corner(kind, 0);
  return {corner(kind, 1) - w0, corner(kind, corners(kind).size() - 1) - w0};
}

Vector Moment::relative_velocity(ContactKind kind) const {
  return velocity.front() - velocity.at(first_of_second(kind));
}

void move_rigidly(Recipe& recipe, const GridSize& size, Moment& moment) {
  Vector first{}, second{};
  do {
    first = draw_vector(recipe.random, size.velocity);
    second = draw_vector(recipe.random, size.velocity);
  } while (first == second);
  for (std::size_t point = 0; point < moving_points; ++point) {
    moment.velocity.at(point) = point < first_of_second(recipe.contact()) ? first : second;
  }
}

void shift_first(ContactKind kind, const Vector& shift, Moment& moment) {
  for (std::size_t point = 0; point < first_of_second(kind); ++point) {
    moment.position.at(point) = moment.position.at(point) + shift;
  }
}

Query to_query(Recipe& recipe, const Moment& moment) {
  const int base = recipe.full ? -51 : 0;
  Query query{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int exponent = base + static_cast<int>(recipe.random.between(-8, 8));
    for (std::size_t point = 0; point < moving_points; ++point) {
      const std::int64_t x = moment.position.at(point).at(axis);
      const std::int64_t e = moment.velocity.at(point).at(axis);
      const std::int64_t start = x - moment.time.numerator * e;
      const std::int64_t end = start + moment.time.denominator() * e;
      query.at(0, point, axis) = std::ldexp(static_cast<double>(start), exponent);
      query.at(1, point, axis) = std::ldexp(static_cast<double>(end), exponent);
    }
  }
  return query;
}

}  // namespace touchstone::verify::generate
