/// \file
/// Families of flat primitives that pass each other: the boundary of the domain, and one unit in
/// the last place beside it. See passing_planes.hpp.

#include <array>

#include "verify/generate/coordinate_sampler.hpp"
#include "verify/generate/family_builder.hpp"
#include "verify/generate/passing_planes.hpp"

namespace touchstone::verify::generate {

namespace {

constexpr Zone below{-3.0, -1.0};
constexpr Zone above{1.0, 3.0};

Offset offset_of(std::uint64_t variant) {
  static constexpr std::array<Offset, 3> offsets{Offset::none, Offset::outside, Offset::inside};
  return offsets.at(variant % offsets.size());
}

/// The heights cross, and the plan determines whether and where the projections meet.
KnownQuery crossing(Recipe& recipe, Spot spot) {
  Sampler sampler(recipe);
  const Offset offset = offset_of(recipe.variant);
  Query query{};
  draw_plan(recipe.contact(), spot, offset, sampler, query);
  const Line first = sampler.from_to(2, below, above);
  const Line second = sampler.within(2, centre);
  set_heights(recipe.contact(), first, second, query);
  return level_outcome(offset, first, second, query);
}

KnownQuery silhouette_edge(Recipe& recipe) { return crossing(recipe, Spot::edge); }

KnownQuery silhouette_vertex(Recipe& recipe) { return crossing(recipe, Spot::corner); }

/// The plan meets at all times; the first height ends one unit in the last place below the second,
/// or on it (toi = 1), or one above (the toi is the crossing of two lines with known doubles).
KnownQuery end_approached(Recipe& recipe) {
  static constexpr std::array<Spot, 3> spots{Spot::interior, Spot::edge, Spot::corner};
  Sampler sampler(recipe);
  Query query{};
  draw_plan(recipe.contact(), spots.at(recipe.variant / 3 % 3), Offset::none, sampler, query);
  const Line second = sampler.within(2, centre);
  const int steps = static_cast<int>(recipe.variant % 3) - 1;
  const Line first{sampler.draw(2, below), sampler.nudged(second.end, steps)};
  set_heights(recipe.contact(), first, second, query);
  return level_outcome(Offset::none, first, second, query);
}

/// Sides f0f1 at x = s and f2 at s plus eight units in the last place. The vertex is on the long
/// side, or four units inside, or one unit outside on either side. Four units and eight units may
/// differ in size where a power of two lies between, but the vertex is a fraction in [1/3, 2/3] of
/// the width inside at both ends, hence (mediant) at all times; there the needle still covers |y| ≤
/// 0.5, since f2 is within |y| ≤ 0.25: (1 − 2/3)·2.5 − (2/3)·0.25 > 0.5.
KnownQuery needle_triangle(Recipe& recipe) {
  static constexpr std::array<int, 4> vertex_steps{0, 4, -1, 9};
  const int steps = vertex_steps.at(recipe.variant % vertex_steps.size());
  Sampler sampler(recipe);
  Query query{};
  const Line side = sampler.within(0, centre);
  set(query, 0, 0, sampler.nudged(side, steps));
  set(query, 0, 1, sampler.within(1, centre));
  set(query, 1, 0, side);
  set(query, 1, 1, sampler.within(1, {-3.0, -2.5}));
  set(query, 2, 0, side);
  set(query, 2, 1, sampler.within(1, {2.5, 3.0}));
  set(query, 3, 0, sampler.nudged(side, 8));
  set(query, 3, 1, sampler.within(1, {-0.25, 0.25}));
  const Line first = sampler.from_to(2, below, above);
  const Line second = sampler.within(2, centre);
  set_heights(recipe.contact(), first, second, query);
  if (steps == -1 || steps == 9) return no_collision(query);
  return level_outcome(Offset::none, first, second, query);
}

constexpr std::array<Definition, 4> silhouette_list{{
    {{"silhouette-edge",
      "Flat primitives touch only when their heights, lines between known doubles, cross; vertex "
      "and side share x, and one unit in the last place away x separates everything.",
      Verdicts::both},
     silhouette_edge},
    {{"silhouette-vertex",
      "As silhouette-edge with the vertex (or end) on a vertex: x and y are shared, and one unit "
      "in the last place away x separates everything.",
      Verdicts::both},
     silhouette_vertex},
    {{"end-approached",
      "Flat primitives whose projections always meet; the heights end one unit in the last place "
      "apart, equal, or crossed.",
      Verdicts::both},
     end_approached},
    {{"needle-triangle",
      "As silhouette-edge with a face eight units in the last place wide; the vertex is on its "
      "side, in its middle, or one unit beside it where x separates.",
      Verdicts::both},
     needle_triangle,
     true,
     false},
}};

}  // namespace

std::span<const Definition> silhouette_definitions() { return silhouette_list; }

}  // namespace touchstone::verify::generate
