/// \file
/// Families at the ends of the range of doubles.

#include <array>
#include <cmath>
#include <vector>

#include "verify/generate/coordinate_sampler.hpp"
#include "verify/generate/family_builder.hpp"
#include "verify/generate/passing_planes.hpp"

namespace touchstone::verify::generate {

namespace {

/// A query of another family, which changes with the variant.
KnownQuery build_base(Recipe& recipe) {
  std::vector<const Definition*> bases;
  for (const Definition& definition : base_definitions()) {
    const bool has_kind = recipe.vertex_face() ? definition.vertex_face : definition.edge_edge;
    if (has_kind) bases.push_back(&definition);
  }
  const Definition& base = *bases[recipe.variant % bases.size()];
  Recipe inner = recipe;
  inner.random = Random(recipe.random.bits());
  inner.variant = recipe.random.bits() >> 32U;
  // Not 0: query 0 of some families is printed in the paper and stays as it is.
  inner.index = 1;
  return base.build(inner);
}

/// All axes at once by 2^200 or 2^-200.
KnownQuery scaled_by_200(Recipe& recipe) {
  KnownQuery known = build_base(recipe);
  const int exponent = recipe.random.coin() ? 200 : -200;
  scale_axes({exponent, exponent, exponent}, known.query);
  return known;
}

/// Every axis multiplied by a separate power of two.
KnownQuery mixed_scales(Recipe& recipe) {
  KnownQuery known = build_base(recipe);
  std::array<int, 3> exponents{};
  for (int& exponent : exponents) exponent = static_cast<int>(recipe.random.between(-200, 200));
  scale_axes(exponents, known.query);
  return known;
}

/// Crossing heights over a plan (see passing_planes.hpp) at extreme scales: x within a few million
/// of the smallest subnormal, y and z up to 3/4 of the largest double and beyond, so that
/// differences of coordinates overflow. In few-bit queries the second height is the smallest
/// subnormal, of changing sign. The plans and heights only compare coordinates and divide exact
/// differences, so they hold at any scale at which their zones are apart: a unit in x has at least
/// 32 subnormals.
KnownQuery extreme_range(Recipe& recipe) {
  static constexpr std::array<Spot, 3> spots{Spot::interior, Spot::edge, Spot::corner};
  static constexpr std::array<Offset, 3> offsets{Offset::none, Offset::outside, Offset::inside};
  const std::size_t choices = recipe.full ? 2 : spots.size();
  const Spot spot = spots.at(recipe.variant % choices);
  const Offset offset =
      spot == Spot::interior ? Offset::none : offsets.at(recipe.variant / choices % offsets.size());
  const double tiny = std::ldexp(1.0, static_cast<int>(recipe.random.between(-1069, -1052)));
  const double huge = recipe.full ? 0x1p1022 * (1.2 + 0.13 * recipe.random.unit()) : 0x1p1022;
  Sampler sampler(recipe, {tiny, huge, huge});
  Query query{};
  draw_plan(recipe.contact(), spot, offset, sampler, query);
  const Line first = sampler.from_to(2, {-3.0, -1.0}, {1.0, 3.0});
  const Line second = recipe.full ? sampler.within(2, centre) : Line{0x1p-1074, -0x1p-1074};
  set_heights(recipe.contact(), first, second, query);
  return level_outcome(offset, first, second, query);
}

constexpr std::array<Definition, 3> scaled_list{{
    {{"scaled",
      "A query of another family times 2^200 or 2^-200, which is exact and changes neither the "
      "verdict nor the time of impact.",
      Verdicts::both},
     scaled_by_200},
    {{"mixed-scales",
      "A query of another family with each axis times its own power of two between 2^-200 and "
      "2^200: an exact diagonal map, under which roots of F stay roots.",
      Verdicts::both},
     mixed_scales},
    {{"extreme-range",
      "As the silhouette families, which only compare coordinates and divide exact differences, "
      "with coordinates near the largest and near the smallest doubles in one query.",
      Verdicts::both},
     extreme_range},
}};

}  // namespace

std::span<const Definition> scaled_definitions() { return scaled_list; }

}  // namespace touchstone::verify::generate
