/// \file
/// Families of contact at t = 0, 1/2 and 1 between two points that are given the same doubles.
///
/// The *pair* is v and f0, or ea0 and eb0; the *rest* are the other points. If x separates all
/// corners but the pair's strictly, contact can only be contact of the pair.

#include <array>

#include "verify/generate/coordinate_sampler.hpp"
#include "verify/generate/family_builder.hpp"
#include "verify/generate/passing_planes.hpp"

namespace touchstone::verify::generate {

using exact::Rational;

namespace {

constexpr Zone lower{-1.5, -1.0};
constexpr Zone upper{1.0, 1.5};

/// The points of the pair and the rest, for a kind.
struct Roles {
  std::size_t first = 0;
  std::size_t second;
  std::size_t rest_begin_of_second;
  bool first_has_rest;

  explicit Roles(ContactKind kind)
      : second(kind == ContactKind::vertex_face ? 1 : 2),
        rest_begin_of_second(second + 1),
        first_has_rest(kind == ContactKind::edge_edge) {}
};

/// Draws x of the rest: of the first primitive in one zone, of the second in another.
void draw_rest_x(ContactKind kind, const Zone& of_first, const Zone& of_second, Sampler& sampler,
                 Query& query) {
  const Roles roles(kind);
  if (roles.first_has_rest) set(query, 1, 0, sampler.within(0, of_first));
  for (std::size_t point = roles.rest_begin_of_second; point < moving_points; ++point) {
    set(query, point, 0, sampler.within(0, of_second));
  }
}

/// Draws y and z of all points anywhere.
void draw_rest_yz(Sampler& sampler, Query& query) {
  for (std::size_t point = 0; point < moving_points; ++point) {
    for (std::size_t axis = 1; axis < 3; ++axis) {
      set(query, point, axis, sampler.within(axis, anywhere));
    }
  }
}

/// The pair has the same doubles at t=1. In x, at t=0, the first primitive is left of the second,
/// and at t=1 too but for the pair: every corner has x < 0 for all t < 1. Hence toi = 1.
KnownQuery pair_at_end(Recipe& recipe) {
  const Roles roles(recipe.contact());
  Sampler sampler(recipe);
  Query query{};
  draw_rest_yz(sampler, query);
  draw_rest_x(recipe.contact(), left, right, sampler, query);
  set(query, roles.first, 0, sampler.from_to(0, lower, centre));
  set(query, roles.second, 0, sampler.from_to(0, upper, centre));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    query.at(1, roles.second, axis) = query.at(1, roles.first, axis);
  }
  return collision(query, Rational(1));
}

/// The pair meets at t=1 only; or flat primitives, whose projections always meet, reach the same
/// height at t=1 and not before.
KnownQuery contact_at_end(Recipe& recipe) {
  static constexpr std::array<Spot, 4> spots{Spot::interior, Spot::interior, Spot::edge,
                                             Spot::corner};
  const std::size_t variant = recipe.variant % spots.size();
  if (variant == 0) return pair_at_end(recipe);
  Sampler sampler(recipe);
  Query query{};
  draw_plan(recipe.contact(), spots.at(variant), Offset::none, sampler, query);
  const Line second = sampler.within(2, centre);
  const Line first{sampler.draw(2, {-3.0, -1.0}), second.end};
  set_heights(recipe.contact(), first, second, query);
  return level_outcome(Offset::none, first, second, query);
}

/// The pair has the same doubles at t=0 (or x, y or z one unit in the last place apart), all others
/// are strictly apart in x, and at t=1 all are: the first primitive right, the second left. So
/// every corner has x > 0 for all t > 0, and at t = 0 only the pair's corner can be zero.
KnownQuery start_left(Recipe& recipe) {
  const std::size_t variant = recipe.variant % 4;
  const Roles roles(recipe.contact());
  Sampler sampler(recipe);
  Query query{};
  draw_rest_yz(sampler, query);
  draw_rest_x(recipe.contact(), right, left, sampler, query);
  set(query, roles.first, 0, sampler.from_to(0, centre, right));
  set(query, roles.second, 0, sampler.from_to(0, centre, left));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    query.at(0, roles.second, axis) = query.at(0, roles.first, axis);
  }
  if (variant == 0) return collision(query, Rational(0));
  const std::size_t axis = variant - 1;
  query.at(0, roles.first, axis) = sampler.nudged(query.at(0, roles.first, axis), 1);
  return no_collision(query);
}

/// The pair's first point goes from p to q and its second from q to p, any doubles: in each
/// coordinate their difference is d at t=0 and exactly −d at t=1, so they meet at t = 1/2 for any
/// rounding. In x p is left of q and the rest is beyond, so every corner has x < 0 before. In
/// queries without collision y is shared instead, first above second by one unit in the last place,
/// and the rest is apart in y: y separates.
KnownQuery swap_at_half(Recipe& recipe) {
  const bool is_apart = recipe.variant % 3 == 2;
  const Roles roles(recipe.contact());
  Sampler sampler(recipe);
  Query query{};
  draw_rest_yz(sampler, query);
  draw_rest_x(recipe.contact(), left, right, sampler, query);
  set(query, roles.first, 0, sampler.from_to(0, lower, upper));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    query.at(0, roles.second, axis) = query.at(1, roles.first, axis);
    query.at(1, roles.second, axis) = query.at(0, roles.first, axis);
  }
  if (!is_apart) return collision(query, Rational(1, 2));
  const Line shared = sampler.within(1, centre);
  set(query, roles.second, 1, shared);
  set(query, roles.first, 1, sampler.nudged(shared, 1));
  if (roles.first_has_rest) set(query, 1, 1, sampler.within(1, right));
  for (std::size_t point = roles.rest_begin_of_second; point < moving_points; ++point) {
    set(query, point, 1, sampler.within(1, left));
  }
  return no_collision(query);
}

constexpr std::array<Definition, 3> endpoint_list{{
    {{"contact-at-end",
      "Two points have the same doubles at t=1 and x separates everything before; or flat "
      "primitives whose projections always meet reach the same height at t=1.",
      Verdicts::collisions},
     contact_at_end},
    {{"start-left",
      "Two points have the same doubles at t=0, or one coordinate differs by a unit in the last "
      "place, and x separates everything for t > 0.",
      Verdicts::both},
     start_left},
    {{"swap-at-half",
      "Two points exchange their places, so their difference changes its sign exactly and they "
      "meet at t=1/2; x separates before, or y for all t.",
      Verdicts::both},
     swap_at_half},
}};

}  // namespace

std::span<const Definition> endpoint_definitions() { return endpoint_list; }

}  // namespace touchstone::verify::generate
