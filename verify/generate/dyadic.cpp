/// \file
/// Families whose contact is at a chosen dyadic (t,u,v), every coordinate an integer times a power
/// of two. See grid.hpp for the arithmetic.
///
/// With integer weights l0 + l1 + l2 = T and u = l1/T, v = l2/T, the face
///     f1 = P − l0·g1,   f2 = P − l0·g2,   f0 = P + l1·g1 + l2·g2
/// has Σ l_i (f_i − P) = 0: the point (u,v) of the face is P, for any integer vectors g1, g2. The
/// edges ea0 = P − i·g, ea1 = P + (T−i)·g and eb0 = P − j·h, eb1 = P + (T−j)·h have P at u = i/T
/// and v = j/T.

#include "verify/generate/family_builder.hpp"
#include "verify/generate/grid.hpp"

namespace touchstone::verify::generate {

using exact::Integer;
using exact::Rational;

namespace {

/// The place of the contact on the primitives.
enum class Place : std::uint8_t { interior, boundary, corner, outside };

/// u = first/total, v = second/total.
struct Weights {
  std::int64_t first;
  std::int64_t second;
  std::int64_t total;
};

Weights draw_weights(Recipe& recipe, Place place) {
  if (place == Place::corner) return {0, 0, 1};
  Random& random = recipe.random;
  const std::int64_t total = std::int64_t{1} << random.between(2, 4);
  if (place == Place::boundary) return {random.between(1, total - 1), 0, total};
  if (place == Place::outside) return {random.between(1, total - 1), -1, total};
  const std::int64_t first = random.between(1, total - 2);
  const std::int64_t most = recipe.vertex_face() ? total - 1 - first : total - 1;
  return {first, random.between(1, most), total};
}

/// Places the points such that the position (u,v) of both primitives is one point P at the moment.
void place_points(Recipe& recipe, const GridSize& size, const Weights& weights, Moment& moment) {
  const Vector p = draw_vector(recipe.random, size.position);
  const Vector g = draw_vector(recipe.random, size.shape);
  const Vector h = draw_vector(recipe.random, size.shape);
  const auto [first, second, total] = weights;
  if (recipe.vertex_face()) {
    const std::int64_t zeroth = total - first - second;
    moment.position = {p, p + first * g + second * h, p - zeroth * g, p - zeroth * h};
  } else {
    moment.position = {p - first * g, p + (total - first) * g, p - second * h,
                       p + (total - second) * h};
  }
}

/// A rigid moment with det[E1,E2,r] ≠ 0: its one contact of infinite planes and lines is at the
/// moment's time and at the weights.
Moment draw_rigid(Recipe& recipe, const Weights& weights, const DyadicTime& time) {
  const GridSize size(recipe);
  Moment moment;
  moment.time = time;
  bool crosses = false;
  while (!crosses) {
    place_points(recipe, size, weights, moment);
    move_rigidly(recipe, size, moment);
    const auto [e1, e2] = moment.edges(recipe.contact());
    crosses = determinant(e1, e2, moment.relative_velocity(recipe.contact())) != 0;
  }
  return moment;
}

/// F has one root over all reals (det[E1,E2,r] ≠ 0), at (τ, u, v) with weights inside the domain (a
/// collision) or with l2 = −1 (v < 0, no collision).
KnownQuery interior_dyadic(Recipe& recipe) {
  const bool inside = recipe.variant % 4 != 3;
  const Weights weights = draw_weights(recipe, inside ? Place::interior : Place::outside);
  const Moment moment = draw_rigid(recipe, weights, draw_inner_time(recipe.random));
  const Query query = to_query(recipe, moment);
  return inside ? collision(query, moment.time.value()) : no_collision(query);
}

/// F(τ,u,v) = 0 by integer arithmetic, whatever the four velocities are. There may be an earlier
/// root: the toi is left open.
KnownQuery interior_deforming(Recipe& recipe) {
  static constexpr std::array<Place, 3> places{Place::interior, Place::boundary, Place::corner};
  const GridSize size(recipe);
  const Weights weights = draw_weights(recipe, places.at(recipe.variant % places.size()));
  Moment moment;
  moment.time = draw_inner_time(recipe.random);
  place_points(recipe, size, weights, moment);
  for (Vector& velocity : moment.velocity) velocity = draw_vector(recipe.random, size.velocity);
  return collision(to_query(recipe, moment), std::nullopt);
}

/// Rational with the value numerator/denominator.
Rational ratio(const Integer& numerator, const Integer& denominator) {
  Rational value(numerator, denominator);
  value.canonicalize();
  return value;
}

/// The first primitive of a rigid moment moved by s. F(t,u,v) = w0 + u E1 + v E2 + (t−τ) 2^k r was
/// zero at (τ,u,v); now s + du E1 + dv E2 + dt 2^k r = 0 has one solution, by Cramer's rule, and
/// the query collides iff (τ+dt, u+du, v+dv) is in the domain.
KnownQuery shifted(Recipe& recipe, const Weights& weights, Moment moment, const Vector& s) {
  const auto [e1, e2] = moment.edges(recipe.contact());
  const Vector r = moment.relative_velocity(recipe.contact());
  const Integer all = determinant(e1, e2, r);
  const Integer total = whole(weights.total);
  const Rational u(ratio(whole(weights.first), total) - ratio(determinant(s, e2, r), all));
  const Rational v(ratio(whole(weights.second), total) - ratio(determinant(e1, s, r), all));
  const Rational t(moment.time.value() -
                   ratio(determinant(e1, e2, s), Integer(all * whole(moment.time.denominator()))));
  shift_first(recipe.contact(), s, moment);
  const Query query = to_query(recipe, moment);
  const bool in_time = t >= 0 && t <= 1;
  const bool in_domain = u >= 0 && v >= 0 && (recipe.vertex_face() ? u + v <= 1 : u <= 1 && v <= 1);
  return in_time && in_domain ? collision(query, t) : no_collision(query);
}

KnownQuery boundary_dyadic(Recipe& recipe, Place place) {
  const Weights weights = draw_weights(recipe, place);
  const Moment moment = draw_rigid(recipe, weights, draw_inner_time(recipe.random));
  if (recipe.variant % 2 == 1) {
    return shifted(recipe, weights, moment, draw_unit_shift(recipe.random));
  }
  return collision(to_query(recipe, moment), moment.time.value());
}

/// The only root is on a corner of the domain: vertex on vertex, or end on end. In every second
/// query the first primitive is then moved by one unit of the grid, and the root moves by Cramer's
/// rule.
KnownQuery vertex_dyadic(Recipe& recipe) { return boundary_dyadic(recipe, Place::corner); }

/// The same on an edge of the domain, v = 0: vertex on edge, or end of one edge inside the other.
KnownQuery edge_dyadic(Recipe& recipe) { return boundary_dyadic(recipe, Place::boundary); }

/// F(0,u,v) = 0 by integer arithmetic, and no root is earlier than t = 0.
KnownQuery contact_at_start(Recipe& recipe) {
  static constexpr std::array<Place, 3> places{Place::interior, Place::boundary, Place::corner};
  const GridSize size(recipe);
  const Weights weights = draw_weights(recipe, places.at(recipe.variant % places.size()));
  Moment moment;
  moment.time = {0, static_cast<int>(recipe.random.between(1, 4))};
  place_points(recipe, size, weights, moment);
  for (Vector& velocity : moment.velocity) velocity = draw_vector(recipe.random, size.velocity);
  return collision(to_query(recipe, moment), Rational(0));
}

/// r = 0: nothing moves, or all points move alike, so F does not depend on t. The chosen (u,v) is a
/// root at all times. In queries without collision it has v < 0 (and E1, E2 are independent, so no
/// other (u,v) is a root), or the first primitive is moved by s off the common plane, det[E1,E2,s]
/// ≠ 0.
KnownQuery no_motion(Recipe& recipe) {
  static constexpr std::array<Place, 6> places{Place::interior, Place::outside,  Place::boundary,
                                               Place::corner,   Place::interior, Place::interior};
  const std::size_t variant = recipe.variant % places.size();
  const GridSize size(recipe);
  const Weights weights = draw_weights(recipe, places.at(variant));
  Moment moment;
  moment.time = {0, 1};
  Vector off_plane{};
  bool independent = false;
  while (!independent) {
    place_points(recipe, size, weights, moment);
    off_plane = draw_unit_shift(recipe.random);
    const auto [e1, e2] = moment.edges(recipe.contact());
    independent = determinant(e1, e2, off_plane) != 0;
  }
  if (recipe.random.coin()) moment.velocity.fill(draw_vector(recipe.random, size.velocity));
  if (variant == 5) shift_first(recipe.contact(), off_plane, moment);
  const Query query = to_query(recipe, moment);
  const bool collides = variant != 5 && places.at(variant) != Place::outside;
  return collides ? collision(query, Rational(0)) : no_collision(query);
}

constexpr std::array<Definition, 6> dyadic_list{{
    {{"interior-dyadic",
      "Rigid relative motion across a plane has one contact of the infinite plane or lines; it is "
      "placed at a dyadic (t,u,v) on an integer grid, inside the domain or just outside.",
      Verdicts::both},
     interior_dyadic},
    {{"interior-deforming",
      "F(t,u,v) = 0 holds in integers at a chosen dyadic (t,u,v), for any four velocities.",
      Verdicts::collisions},
     interior_deforming},
    {{"vertex-dyadic",
      "As interior-dyadic with the contact on vertex and vertex; moved by one grid unit, the one "
      "root follows by Cramer's rule.",
      Verdicts::both},
     vertex_dyadic},
    {{"edge-dyadic",
      "As interior-dyadic with the contact on an edge of the domain; moved by one grid unit, the "
      "one root follows by Cramer's rule.",
      Verdicts::both},
     edge_dyadic},
    {{"contact-at-start",
      "F(0,u,v) = 0 holds in integers for a chosen (u,v), and no time is earlier than 0.",
      Verdicts::collisions},
     contact_at_start},
    {{"no-motion",
      "Without relative motion F does not depend on t: the chosen (u,v) is a root at all times, or "
      "is outside the domain and unique, or the primitives lie in parallel planes.",
      Verdicts::both},
     no_motion},
}};

}  // namespace

std::span<const Definition> dyadic_definitions() { return dyadic_list; }

}  // namespace touchstone::verify::generate
