/// \file
/// Families of cells whose volume is a product with known roots, or a polynomial with
/// coefficients of known signs.
///
/// *Triangular cells.* With shared coordinates c − a = (0,β,·) and d − a = (0,0,γ), b − a being
/// (α,·,·), six times the volume is αβγ (twice the area αβ). α, β, γ are differences of two lines,
/// so their roots and signs are exact rationals of the doubles; the first time is 0 if the product
/// is not positive at t=0, and else the least root.
///
/// *Mirrored axes.* If on m axes all points move from x to −k x, those coordinates are (1 − (1+k)t)
/// times their start, so the volume is (1 − (1+k)t)^m W(t), W being the volume with these axes at
/// rest. Where all Bernstein coefficients of W are positive, it is positive on [0,1], and the
/// cell is flat at 1/(1+k) and not before.
///
/// *Grazing.* With α and β mirrored (k=1), b − a = (α,q) and c − a = (p,β), twice the area is
/// α(0)β(0)(1−2t)² − pq. Differences q > 0 and p of roundings keep their signs, since they are
/// linear: p < 0 makes the area positive throughout, p > 0 negative at t=1/2, and q = 0 makes it
/// touch 0 there.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "verify/generate/coordinate_sampler.hpp"
#include "verify/generate/family_builder.hpp"

namespace touchstone::verify::generate {

using exact::Rational;

namespace {

/// The axes that count.
std::size_t axes_of(const Recipe& recipe) { return record_of(recipe.kind.cell()).dimension; }

/// All points anywhere.
Query draw_points(Sampler& sampler) {
  Query query{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t point = 0; point < moving_points; ++point) {
      set(query, point, axis, sampler.within(axis, anywhere));
    }
  }
  return query;
}

// ---- Triangular cells ------------------------------------------------------------------------

/// A factor of the volume that stays positive, or crosses 0.
std::array<Line, 2> draw_factor(std::size_t axis, bool crosses, Sampler& sampler) {
  return {sampler.within(axis, centre),
          sampler.from_to(axis, upper_zone, crosses ? lower_zone : upper_zone)};
}

void set_factor(const std::array<Line, 2>& lines, std::size_t axis, Query& query) {
  for (std::size_t point = 0; point < moving_points; ++point) {
    if (point == 0 || point > axis + 1) set(query, point, axis, lines[0]);
  }
  set(query, axis + 1, axis, lines[1]);
}

/// A triangular cell of which the listed factors cross 0.
Query triangular_cell(const std::array<bool, 3>& crosses, Sampler& sampler) {
  Query query = draw_points(sampler);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    set_factor(draw_factor(axis, crosses.at(axis), sampler), axis, query);
  }
  return query;
}

KnownQuery cell_outcome(const Recipe& recipe, const Query& query) {
  int start = 1;
  std::optional<Rational> first;
  for (std::size_t axis = 0; axis < axes_of(recipe); ++axis) {
    const Line base = line_of(query, 0, axis), other = line_of(query, axis + 1, axis);
    start *= sgn(Rational(Rational(other.start) - Rational(base.start)));
    const auto root = meeting_time(base, other);
    if (root && (!first || *root < *first)) first = root;
  }
  if (start <= 0) return collision(query, Rational(0));
  return first ? collision(query, first) : no_collision(query);
}

/// Any factors cross 0; some cells begin inverted, by a negative factor.
KnownQuery factors(Recipe& recipe) {
  Sampler sampler(recipe);
  const auto coin = [&] { return sampler.random().coin(); };
  Query query = triangular_cell({coin(), coin(), coin()}, sampler);
  if (recipe.variant % 8 == 7)
    set(query, 1, 0, sampler.from_to(0, lower_zone, coin() ? lower_zone : upper_zone));
  return cell_outcome(recipe, query);
}

/// One factor is 0 at t=0 or t=1, or a rounding above or below.
KnownQuery flat_at_end(Recipe& recipe) {
  Sampler sampler(recipe);
  Query query = triangular_cell({}, sampler);
  const auto axis =
      static_cast<std::size_t>(sampler.random().between(0, static_cast<int>(axes_of(recipe)) - 1));
  const std::size_t end = sampler.random().coin() ? 1 : 0;
  query.at(end, axis + 1, axis) =
      sampler.nudged(query.at(end, 0, axis), static_cast<int>(recipe.variant % 3) - 1);
  return cell_outcome(recipe, query);
}

/// Two factors, or all, are the same times a power of two.
KnownQuery multiple_root(Recipe& recipe) {
  Sampler sampler(recipe);
  Query query = triangular_cell({}, sampler);
  const std::array<Line, 2> lines = draw_factor(0, true, sampler);
  const std::size_t count = recipe.variant % 4 == 3 ? axes_of(recipe) : 2;
  for (std::size_t axis = 0; axis < count; ++axis) {
    const auto exponent = static_cast<int>(sampler.random().between(-6, 6));
    set_factor({scaled(lines[0], exponent), scaled(lines[1], exponent)}, axis, query);
  }
  return cell_outcome(recipe, query);
}

/// Far from the origin, so that coordinates have few bits left for the cell.
KnownQuery translated(Recipe& recipe) {
  Sampler sampler(recipe);
  const auto coin = [&] { return sampler.random().coin(); };
  Query query = triangular_cell({coin(), false, coin()}, sampler);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double greatest = 0.0;
    for (std::size_t i = axis; i < query.coordinates.size(); i += 3) {
      greatest = std::max(greatest, std::abs(query.coordinates.at(i)));
    }
    const double far = std::ldexp(greatest, static_cast<int>(sampler.random().between(4, 44)));
    for (std::size_t i = axis; i < query.coordinates.size(); i += 3) query.coordinates.at(i) += far;
  }
  return cell_outcome(recipe, query);
}

// ---- Volumes ------------------------------------------------------------------------------------

/// Six times the volume, or twice the area, at time t, with the first axes at rest.
Rational volume(const Recipe& recipe, const Query& query, std::size_t at_rest, const Rational& t) {
  std::array<std::array<Rational, 3>, 3> w;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Rational time = axis < at_rest ? Rational(0) : t;
    for (std::size_t point = 1; point < moving_points; ++point) {
      w.at(point - 1).at(axis) = corner_at(query, {point, 0, 0, 0}, axis, time);
    }
  }
  const auto minor = [&](std::size_t i, std::size_t j) {
    return Rational(w.at(i)[0] * w.at(j)[1] - w.at(j)[0] * w.at(i)[1]);
  };
  if (axes_of(recipe) == 2) return minor(0, 1);
  return {w[2][2] * minor(0, 1) - w[1][2] * minor(0, 2) + w[0][2] * minor(1, 2)};
}

/// The Bernstein coefficients of that volume.
std::vector<Rational> volume_coefficients(const Recipe& recipe, const Query& query,
                                          std::size_t at_rest) {
  const auto at = [&](const Rational& t) { return volume(recipe, query, at_rest, t); };
  const Rational start = at(0), end = at(1), half = at(Rational(1, 2));
  switch (axes_of(recipe) - at_rest) {
    case 3: {
      // The value at −1 is 8 b0 − 12 b1 + 6 b2 − b3.
      const Rational sum = (8 * half - start - end) / 3;
      const Rational third = (at(-1) - 8 * start + end + 12 * sum) / 18;
      return {start, Rational(sum - third), third, end};
    }
    case 2:
      return {start, Rational(2 * half - (start + end) / 2), end};
    default:
      return {start, end};
  }
}

bool are_positive(const std::vector<Rational>& numbers) {
  return std::ranges::all_of(numbers, [](const Rational& x) { return x > 0; });
}

KnownQuery flat_at_known_time(Recipe& recipe) {
  Sampler sampler(recipe);
  const std::size_t mirrored = 1 + recipe.variant % axes_of(recipe);
  const double factor = std::ldexp(1.0, static_cast<int>(sampler.random().between(-4, 4)));
  for (;;) {
    Query query = draw_points(sampler);
    for (std::size_t point = 0; point < moving_points; ++point) {
      for (std::size_t axis = 0; axis < mirrored; ++axis) {
        query.at(1, point, axis) = -factor * query.at(0, point, axis);
      }
    }
    if (!are_positive(volume_coefficients(recipe, query, mirrored))) continue;
    return collision(query, Rational(1 / (1 + Rational(factor))));
  }
}

KnownQuery grazing_volume(Recipe& recipe) {
  Sampler sampler(recipe);
  Query query = triangular_cell({}, sampler);
  const int side = static_cast<int>(recipe.variant % 3) - 1;
  const std::array<std::size_t, 2> others{2, 1};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double start = sampler.draw(axis, centre), other = sampler.draw(axis, upper_zone);
    const Line line{start, -start};
    set(query, 0, axis, line);
    set(query, axis + 1, axis, {other, -other});
    // p on the first axis, q on the second.
    const int steps = static_cast<int>(sampler.random().between(1, 4));
    set(query, others.at(axis), axis,
        sampler.nudged(line, axis == 0 ? (side < 0 ? -steps : steps) : (side == 0 ? 0 : steps)));
  }
  for (const std::size_t point : {1U, 2U}) set(query, point, 2, line_of(query, 0, 2));
  if (side == 0) return collision(query, Rational(1, 2));
  return side < 0 ? no_collision(query) : collision(query, std::nullopt);
}

KnownQuery random_cells(Recipe& recipe) {
  Sampler sampler(recipe);
  for (;;) {
    const Query query = draw_points(sampler);
    const std::vector<Rational> all = volume_coefficients(recipe, query, 0);
    if (are_positive(all)) return no_collision(query);
    if (all.front() > 0 && all.back() < 0) return collision(query, std::nullopt);
  }
}

// ---- Scales -------------------------------------------------------------------------------------

/// Another family with its axes times powers of two, in a third of the queries the same, so that
/// products of coordinates overflow or underflow.
KnownQuery all_scales(Recipe& recipe) {
  static constexpr std::array bases{factors,     multiple_root,  flat_at_known_time,
                                    flat_at_end, grazing_volume, random_cells};
  const std::size_t variant = recipe.variant;
  Recipe inner = recipe;
  inner.random = Random(recipe.random.bits());
  inner.variant = recipe.random.bits() >> 32U;
  KnownQuery known = bases.at(variant % bases.size())(inner);
  std::array<int, 3> exponents{};
  for (int& exponent : exponents) exponent = static_cast<int>(recipe.random.between(-480, 480));
  if (variant / bases.size() % 3 == 0) exponents[1] = exponents[2] = exponents[0];
  scale_axes(exponents, known.query);
  return known;
}

constexpr Definition of_cells(const Family& family, KnownQuery (*build)(Recipe&)) {
  return {family, build, false, false, true};
}

constexpr std::array cell_list{
    of_cells({"volume-factors",
              "Shared coordinates make the volume a product of differences of known lines: the "
              "first root, or a start that is not positive, follows from exact rationals.",
              Verdicts::both},
             factors),
    of_cells({"flat-at-end",
              "As volume-factors, with one factor 0 at t=0 or t=1 by equal coordinates, or off "
              "by one rounding.",
              Verdicts::both},
             flat_at_end),
    of_cells({"multiple-root",
              "As volume-factors, with two or all factors the same times powers of two: the "
              "volume touches 0 or has a triple root.",
              Verdicts::collisions},
             multiple_root),
    of_cells({"translated-volume",
              "As volume-factors, up to 2^44 of its size away from the origin; the lines are "
              "those of the rounded coordinates.",
              Verdicts::both},
             translated),
    of_cells({"flat-at-known-time",
              "On one, two or all axes each coordinate ends at minus a power of two k times its "
              "start, so the cell is flat at 1/(1+k); the other factor of the volume has "
              "positive Bernstein coefficients.",
              Verdicts::collisions},
             flat_at_known_time),
    of_cells({"grazing-volume",
              "Twice the area is c (1-2t)^2 - p q with c > 0; p and q are differences of a few "
              "roundings, whose signs decide, or q = 0.",
              Verdicts::both},
             grazing_volume),
    of_cells({"random-elements",
              "Random points with a volume of positive Bernstein coefficients, in rationals, or "
              "positive at t=0 and negative at t=1.",
              Verdicts::both},
             random_cells),
    of_cells({"volume-scales",
              "Such a cell with each axis times a power of two between 2^-480 and 2^480, "
              "which keeps the sign of the volume.",
              Verdicts::both},
             all_scales),
};

}  // namespace

std::span<const Definition> cell_definitions() { return cell_list; }

}  // namespace touchstone::verify::generate
