#pragma once

/// \file
/// Contacts at a chosen dyadic time τ = n/2^k, built from integers.
///
/// All four points are placed at time τ, at integer positions x, with integer velocities e per 2^-k
/// of time. Then x(0) = x − n·e and x(1) = x + (2^k − n)·e are integers, and the point is at
/// (1−τ) x(0) + τ x(1) = x at time τ, exactly. All magnitudes stay below 2^53 (positions: up to
/// 2^51, and 17 or fewer shape vectors of up to 2^46; motion: 16 or fewer velocities of up to
/// 2·2^46 + 2^46), so the integers are doubles; an axis may be multiplied by a power of two.
///
/// *Rigid* means: all points of one primitive have one velocity. All corners then move with the one
/// relative velocity r, F(t,u,v) = F(τ,u,v) + (t−τ) r·2^k, and if the edges E1 = w1−w0 and
/// E2 = w_last−w0 of the polygon have det[E1,E2,r] ≠ 0, then F has exactly one root (t,u,v) over
/// all reals: the plane of the polygon is crossed once.

#include <array>
#include <cstdint>

#include "touchstone/any_kind.hpp"
#include "touchstone/number.hpp"
#include "verify/generate/family_builder.hpp"

namespace touchstone::verify::generate {

/// An integer vector, all magnitudes far below 2^63.
using Vector = std::array<std::int64_t, 3>;

[[nodiscard]] Vector operator+(const Vector& a, const Vector& b);
[[nodiscard]] Vector operator-(const Vector& a, const Vector& b);
[[nodiscard]] Vector operator*(std::int64_t factor, const Vector& a);

/// The integer x. (What GMP converts itself is `long`, which has 32 bits on Windows.)
[[nodiscard]] exact::Integer whole(std::int64_t x);

/// The determinant of three vectors, exact.
[[nodiscard]] exact::Integer determinant(const Vector& a, const Vector& b, const Vector& c);

/// True if the vectors are linearly dependent.
[[nodiscard]] bool parallel(const Vector& a, const Vector& b);

/// Bounds of the integers drawn for one query: the sizes of positions (up to 2^51 or 16), of shapes
/// (up to 2^46 or 4) and of velocities (up to 2^46 or 4), none a power of two for full
/// significands.
struct GridSize {
  explicit GridSize(Recipe& recipe);
  std::int64_t position;
  std::int64_t shape;
  std::int64_t velocity;
};

/// A vector with components in [−bound, bound].
[[nodiscard]] Vector draw_vector(Random& random, std::int64_t bound);

/// A vector other than 0 with components in {−1, 0, 1}: one unit of the grid.
[[nodiscard]] Vector draw_unit_shift(Random& random);

/// A time in [0,1] whose denominator is a power of two.
struct DyadicTime {
  std::int64_t numerator;
  int log_denominator;

  [[nodiscard]] std::int64_t denominator() const { return std::int64_t{1} << log_denominator; }
  [[nodiscard]] exact::Rational value() const;
};

/// A random time strictly between 0 and 1, denominator at most 16.
[[nodiscard]] DyadicTime draw_inner_time(Random& random);

/// Four points at one moment.
struct Moment {
  DyadicTime time{};
  std::array<Vector, moving_points> position{};
  std::array<Vector, moving_points> velocity{};

  /// Corner number `corner` at the moment.
  [[nodiscard]] Vector corner(ContactKind kind, std::size_t corner) const;
  /// E1 and E2: the polygon's edges from corner 0 at the moment.
  [[nodiscard]] std::array<Vector, 2> edges(ContactKind kind) const;
  /// Velocity of the first primitive's first point relative to the second primitive's.
  [[nodiscard]] Vector relative_velocity(ContactKind kind) const;
};

/// Gives every point of a primitive one velocity, drawn until the two differ.
void move_rigidly(Recipe& recipe, const GridSize& size, Moment& moment);

/// Moves the first primitive (the vertex, or the edge a) by `shift` at all times.
void shift_first(ContactKind kind, const Vector& shift, Moment& moment);

/// The query of a moment, each axis multiplied by a random power of two that brings it close to 1.
[[nodiscard]] Query to_query(Recipe& recipe, const Moment& moment);

}  // namespace touchstone::verify::generate
