/// \file
/// Families of motion in one common plane: the determinant of the corners vanishes for all t.
///
/// All eight points have the two heights z(0) and z(1), so F's z is zero and the x-y projections
/// decide. There contact over an interval of time and contact at a single instant are both
/// possible; a ground truth that looks for solution sets of positive measure would miss the second.

#include <array>

#include "verify/generate/coordinate_sampler.hpp"
#include "verify/generate/family_builder.hpp"
#include "verify/generate/passing_planes.hpp"

namespace touchstone::verify::generate {

namespace {

void share_height(Sampler& sampler, Query& query) {
  const Line height = sampler.within(2, centre);
  for (std::size_t point = 0; point < moving_points; ++point) set(query, point, 2, height);
}

/// The end of the motion towards the contact.
enum class Ending : std::uint8_t { passes, stops_short, arrives, starts_there };

/// A line that passes `target`, stops one unit in the last place below it, ends on it, or starts on
/// it and leaves it.
Line approach(std::size_t axis, const Line& target, Ending ending, Sampler& sampler) {
  constexpr Zone before{-3.0, -1.0};
  constexpr Zone after{1.0, 1.5};
  switch (ending) {
    case Ending::passes:
      return sampler.from_to(axis, before, after);
    case Ending::stops_short:
      return {sampler.draw(axis, before), sampler.nudged(target.end, -1)};
    case Ending::arrives:
      return {sampler.draw(axis, before), target.end};
    case Ending::starts_there:
      return {target.start, sampler.draw(axis, after)};
  }
  return target;
}

/// The face's side f0f1 (or edge b) is at x = s(t) and reaches from y ≤ −2 to y ≥ 2; the rest of
/// the face is to the right. The vertex (or ea0, with ea1 to its left) comes from the left within
/// |y| ≤ 0.5. While its x is below s, x separates strictly; when it is s, it is on the side.
KnownQuery coplanar_interval(Recipe& recipe) {
  static constexpr std::array<Ending, 4> endings{Ending::passes, Ending::stops_short,
                                                 Ending::arrives, Ending::starts_there};
  const Ending ending = endings.at(recipe.variant % endings.size());
  const bool vertex_face = recipe.vertex_face();
  const std::size_t side_begin = vertex_face ? 1 : 2;
  Sampler sampler(recipe);
  Query query{};
  share_height(sampler, query);
  const Line side = sampler.within(0, centre);
  set(query, side_begin, 0, side);
  set(query, side_begin, 1, sampler.within(1, left));
  set(query, side_begin + 1, 0, side);
  set(query, side_begin + 1, 1, sampler.within(1, right));
  const std::size_t third = vertex_face ? 3 : 1;
  set(query, third, 0, sampler.within(0, vertex_face ? right : Zone{-3.25, -3.0}));
  set(query, third, 1, sampler.within(1, centre));
  const Line x = approach(0, side, ending, sampler);
  set(query, 0, 0, x);
  set(query, 0, 1, sampler.within(1, centre));
  const auto toi = meeting_time(x, side);
  return toi ? collision(query, toi) : no_collision(query);
}

/// The pair (v and f0, or ea0 and eb0) shares x = s(t). All else of the first primitive is right of
/// it (there is only ea1), all else of the second too for the face, left for edge b; so only the
/// pair's corner can be zero, and it is where the y of the two are equal: one instant. One unit in
/// the last place outside, x separates. One unit inside, the vertex passes through the angle at f0,
/// whose sides go to y ≤ −2 and to y ≥ 2 (or ea0 passes through edge b, then at constant y): a
/// collision whose toi is left open.
KnownQuery instant(Recipe& recipe, Sampler& sampler, Offset offset, Ending ending) {
  const bool vertex_face = recipe.vertex_face();
  int steps = 0;
  if (offset == Offset::outside) steps = 1;
  if (offset == Offset::inside) steps = -1;
  Query query{};
  share_height(sampler, query);
  const Line s = sampler.within(0, centre);
  const Line target = sampler.within(1, centre);
  const Line y = approach(1, target, ending, sampler);
  set(query, 0, 0, sampler.nudged(s, vertex_face ? -steps : steps));
  set(query, 0, 1, y);
  const std::size_t primitive = vertex_face ? 1 : 2;
  set(query, primitive, 0, s);
  set(query, primitive, 1, target);
  if (vertex_face) {
    set(query, 2, 0, sampler.within(0, right));
    set(query, 2, 1, sampler.within(1, left));
    set(query, 3, 0, sampler.within(0, right));
    set(query, 3, 1, sampler.within(1, right));
  } else {
    set(query, 1, 0, sampler.within(0, right));
    set(query, 1, 1, sampler.within(1, {-3.0, 3.0}));
    set(query, 3, 0, sampler.within(0, left));
    set(query, 3, 1, offset == Offset::inside ? target : sampler.within(1, centre));
  }
  if (offset == Offset::outside) return no_collision(query);
  if (offset == Offset::inside) return collision(query, std::nullopt);
  const auto toi = meeting_time(y, target);
  return toi ? collision(query, toi) : no_collision(query);
}

KnownQuery coplanar_instant(Recipe& recipe) {
  Sampler sampler(recipe);
  switch (recipe.variant % 5) {
    case 1:
      return instant(recipe, sampler, Offset::outside, Ending::passes);
    case 2:
      return instant(recipe, sampler, Offset::inside, Ending::passes);
    case 3:
      return instant(recipe, sampler, Offset::none, Ending::stops_short);
    case 4:
      return instant(recipe, sampler, Offset::none, Ending::arrives);
    default:
      return instant(recipe, sampler, Offset::none, Ending::passes);
  }
}

/// coplanar-instant on a grid, then the shears z += a·x + b·y and y += c·z with a, b, c in
/// {−2..2}, {−2..2}, {−1, 1}: bijective linear maps, so verdict and toi stay. All numbers
/// are multiples of the grid's step, 2^-48 or more, and below 16, so both are exact. The common
/// plane is now oblique and moves; no two points share a coordinate but x. x is untouched, and so
/// is a separation by x.
KnownQuery isolated_instant(Recipe& recipe) {
  Sampler sampler = Sampler::on_grid(recipe);
  const std::uint64_t variant = recipe.variant % 3;
  const Offset offset = variant == 1 ? Offset::outside : Offset::none;
  KnownQuery known =
      instant(recipe, sampler, offset, variant == 2 ? Ending::stops_short : Ending::passes);
  Random& random = recipe.random;
  const auto a = static_cast<double>(random.of_either_sign(1, 2));
  const auto b = static_cast<double>(random.of_either_sign(1, 2));
  const double c = random.coin() ? 1.0 : -1.0;
  for (std::size_t end = 0; end < 2; ++end) {
    for (std::size_t point = 0; point < moving_points; ++point) {
      double& z = known.query.at(end, point, 2);
      double& y = known.query.at(end, point, 1);
      z += a * known.query.at(end, point, 0) + b * y;
      y += c * z;
    }
  }
  std::array<int, 3> exponents{};
  for (int& exponent : exponents) exponent = static_cast<int>(random.between(-8, 8));
  scale_axes(exponents, known.query);
  return known;
}

constexpr std::array<Definition, 3> coplanar_list{{
    {{"coplanar-interval",
      "All points share z, so the plane decides: the vertex (or end) crosses the line of a side at "
      "a rational time, well between its ends, and x separates before.",
      Verdicts::both},
     coplanar_interval},
    {{"coplanar-instant",
      "All points share z, two points share x and all others are strictly apart in x: contact is "
      "where the y of the two are equal, at one instant.",
      Verdicts::both},
     coplanar_instant},
    {{"isolated-instant",
      "coplanar-instant on an integer grid under two exact shears: the contact at one instant of a "
      "motion in an oblique plane that the published ground-truth script would miss.",
      Verdicts::both},
     isolated_instant},
}};

}  // namespace

std::span<const Definition> coplanar_definitions() { return coplanar_list; }

}  // namespace touchstone::verify::generate
