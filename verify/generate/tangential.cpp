/// \file
/// The family of tangential contact inside the primitives: a double root without degeneracy.
///
/// vertex_face (relative to a common translation): f0 and f2 at x = a, z = ζ; f1 at x = a + 2m and
/// z = ζ + 2b'(t−τ); the vertex at x = a + m + d'(t−τ), z = ζ + b'(t−τ). Over the vertex the plane
/// of the face has the height ζ + 2b'(t−τ) (m + d'(t−τ)) / 2m. The vertex is above it by
///     b'(t−τ) − b'(t−τ) (m + d'(t−τ)) / m  =  −(b'd'/m) (t−τ)²:
/// it touches the plane at τ only. In x the vertex stays between 1/4 and 3/4 of the face's width
/// (16 |d| ≤ m/2), and in y the zones keep it strictly inside, so there is contact when the vertex
/// is in the plane. edge_edge: edge a in the place of the face, from (a, ζ) to (a + 2m, ·), and
/// edge b, along y across it, in the place of the vertex.
///
/// With the vertex moved by ε in z its height is ε − (b'd'/m)(t−τ)². For ε b'd' < 0 it is never 0.
/// For ε b'd' > 0 it has the sign of ε at τ and the other one at t=0 or at t=1, if b'd' δ² > |ε| m
/// for δ = τ or 1−τ: a collision. In integers, per 2^-k of time: |b d| n² > m with n = 2^k δ, for ε
/// one unit.

#include <algorithm>
#include <array>
#include <cstdlib>

#include "verify/generate/family_builder.hpp"
#include "verify/generate/grid.hpp"

namespace touchstone::verify::generate {

using exact::Integer;

namespace {

/// The integers of the construction; slope b, drift d, half width m, unit of y.
struct Tangency {
  std::int64_t half_width;
  std::int64_t slope;
  std::int64_t drift;
  std::int64_t unit;
  DyadicTime time;
};

/// Draws until the bent path leaves the tangent plane by more than one unit at one end.
Tangency draw_tangency(Recipe& recipe) {
  Random& random = recipe.random;
  const std::int64_t top = std::int64_t{1} << 48;
  Tangency tangency{};
  bool leaves = false;
  while (!leaves) {
    const DyadicTime time = draw_inner_time(random);
    if (recipe.full) {
      tangency = {random.between(top, 2 * top), random.of_either_sign(top / 8, top / 4),
                  random.of_either_sign(top / 64, top / 32), random.between(top / 2, top), time};
    } else {
      tangency = {64, random.of_either_sign(8, 16), random.of_either_sign(1, 2), 4, time};
    }
    const std::int64_t steps = std::max(time.numerator, time.denominator() - time.numerator);
    const Integer bend = whole(std::abs(tangency.slope)) * whole(std::abs(tangency.drift));
    leaves = bend * whole(steps * steps) > whole(tangency.half_width);
  }
  return tangency;
}

/// A y-coordinate within units·[low, high] quarters.
std::int64_t draw_quarters(Random& random, const Tangency& tangency, int low, int high) {
  return random.between(low * tangency.unit / 4, high * tangency.unit / 4);
}

/// Positions and velocities of f0, f1, f2, v, or ea0, ea1, eb0, eb1 as above.
Moment draw_moment(Recipe& recipe, const Tangency& tangency) {
  Random& random = recipe.random;
  const auto quarters = [&](int low, int high) {
    return draw_quarters(random, tangency, low, high);
  };
  const std::int64_t m = tangency.half_width;
  const Vector bent{0, 0, tangency.slope};
  Moment moment;
  moment.time = tangency.time;
  const Vector moving{tangency.drift, 0, tangency.slope};
  if (recipe.vertex_face()) {
    moment.position = {Vector{m, quarters(-1, 1), 0}, Vector{0, quarters(-12, -10), 0},
                       Vector{2 * m, quarters(-1, 1), 0}, Vector{0, quarters(10, 12), 0}};
    moment.velocity = {moving, Vector{}, 2 * bent, Vector{}};
  } else {
    moment.position = {Vector{0, quarters(-1, 1), 0}, Vector{2 * m, quarters(-1, 1), 0},
                       Vector{m, quarters(-12, -10), 0}, Vector{m, quarters(10, 12), 0}};
    moment.velocity = {Vector{}, 2 * bent, moving, moving};
  }
  const GridSize size(recipe);
  const Vector origin = draw_vector(random, size.position);
  const Vector common = draw_vector(random, size.velocity);
  for (std::size_t point = 0; point < moving_points; ++point) {
    moment.position.at(point) = moment.position.at(point) + origin;
    moment.velocity.at(point) = moment.velocity.at(point) + common;
  }
  return moment;
}

/// Tangential contact, or with the vertex (edge) moved by one unit through the plane or away from
/// it.
KnownQuery tangential(Recipe& recipe) {
  const Tangency tangency = draw_tangency(recipe);
  Moment moment = draw_moment(recipe, tangency);
  const std::size_t variant = recipe.variant % 3;
  const std::int64_t bend = (tangency.slope > 0) == (tangency.drift > 0) ? 1 : -1;
  const std::int64_t epsilon = variant == 1 ? bend : -bend;
  if (variant != 0) {
    // Edge b is the second primitive: moving edge a by −ε is moving edge b by ε.
    shift_first(recipe.contact(), {0, 0, recipe.vertex_face() ? epsilon : -epsilon}, moment);
  }
  const Query query = to_query(recipe, moment);
  if (variant == 2) return no_collision(query);
  if (variant == 1) return collision(query, std::nullopt);
  return collision(query, tangency.time.value());
}

constexpr std::array<Definition, 1> tangential_list{{
    {{"tangential",
      "The height of the vertex over the face (of edge over edge) is a constant times (t−τ)², "
      "exactly on the integer grid; moved by one unit it has two roots or none.",
      Verdicts::both},
     tangential},
}};

}  // namespace

std::span<const Definition> tangential_definitions() { return tangential_list; }

}  // namespace touchstone::verify::generate
