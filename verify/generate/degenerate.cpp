/// \file
/// Families of primitives that are collapsed to segments and points, on the integer grid.
///
/// *All on a line*: at time τ every point is P + k·g with a small integer k (its place on the
/// line). The motion is rigid with det[g,r,s] ≠ 0, where s is one unit of the grid. A corner is
/// then w(t) = (k_first − k_second) g + (t−τ) 2^k r with r not parallel to g: zero is in the hull
/// of the corners only at t = τ, and there iff the ranges of the two primitives' places meet. With
/// the first primitive moved by s the corners are s + (…) g + (t−τ) 2^k r, never zero.

#include "verify/generate/family_builder.hpp"
#include "verify/generate/grid.hpp"

namespace touchstone::verify::generate {

using exact::Integer;
using exact::Rational;

namespace {

/// Places on the line of the four points.
using Places = std::array<std::int64_t, moving_points>;

/// The change of the contact at place 0.
enum class Change : std::uint8_t { none, moved_off_line };

/// The query with all points on a line at one moment; see the top of the file.
KnownQuery on_a_line(Recipe& recipe, const Places& places, bool ranges_meet, Change change) {
  const GridSize size(recipe);
  Moment moment;
  moment.time = draw_inner_time(recipe.random);
  const Vector p = draw_vector(recipe.random, size.position);
  Vector g{}, shift{};
  do {
    g = draw_vector(recipe.random, size.shape);
    shift = draw_unit_shift(recipe.random);
    move_rigidly(recipe, size, moment);
  } while (determinant(g, moment.relative_velocity(recipe.contact()), shift) == 0);
  for (std::size_t point = 0; point < moving_points; ++point) {
    moment.position.at(point) = p + places.at(point) * g;
  }
  if (change == Change::moved_off_line) shift_first(recipe.contact(), shift, moment);
  const Query query = to_query(recipe, moment);
  if (!ranges_meet || change == Change::moved_off_line) return no_collision(query);
  return collision(query, moment.time.value());
}

Change every_third_moved(const Recipe& recipe) {
  return recipe.variant % 3 == 2 ? Change::moved_off_line : Change::none;
}

/// On a line with all places 0: both primitives are points.
KnownQuery point_point(Recipe& recipe) {
  return on_a_line(recipe, Places{}, true, every_third_moved(recipe));
}

/// On a line; one primitive is a point at place 0, the other a segment around 0, from 0, or past 0.
KnownQuery point_edge(Recipe& recipe) {
  Random& random = recipe.random;
  const std::size_t variant = recipe.variant % 5;
  std::int64_t low = -random.between(1, 8);
  if (variant == 3) low = 0;
  if (variant == 4) low = 1;
  const std::int64_t high = random.between(2, 8);
  const Places places = recipe.vertex_face() ? Places{0, low, high, random.coin() ? low : high}
                                             : Places{0, 0, low, high};
  return on_a_line(recipe, places, variant != 4,
                   variant == 2 ? Change::moved_off_line : Change::none);
}

/// On a line with two proper segments: the edges are parallel at all times.
KnownQuery parallel_edges(Recipe& recipe) {
  Random& random = recipe.random;
  const std::size_t variant = recipe.variant % 5;
  const Places overlapping{-random.between(1, 8), random.between(1, 8), -random.between(1, 8),
                           random.between(1, 8)};
  const Places meeting_places{-random.between(1, 8), 0, 0, random.between(1, 8)};
  const Places apart{-random.between(1, 8), 0, 1, random.between(2, 8)};
  if (variant == 3) return on_a_line(recipe, meeting_places, true, Change::none);
  if (variant == 4) return on_a_line(recipe, apart, false, Change::none);
  return on_a_line(recipe, overlapping, true, variant == 2 ? Change::moved_off_line : Change::none);
}

/// On a line with the face's three vertices at different places: a triangle without area.
KnownQuery zero_area_triangle(Recipe& recipe) {
  Random& random = recipe.random;
  const std::size_t variant = recipe.variant % 5;
  const std::int64_t low = -random.between(1, 4);
  const std::int64_t high = random.between(1, 4);
  Places places{0, low, high, random.of_either_sign(5, 8)};
  if (variant == 3) places[1] = 0;
  if (variant == 4) places = {0, 5 + low, 5 + high, 12};
  return on_a_line(recipe, places, variant != 4,
                   variant == 2 ? Change::moved_off_line : Change::none);
}

/// At τ some sides have length zero, but not before or after. In z each primitive is flat (one
/// height, one velocity for all of its points) and the heights are equal at τ only: contact happens
/// at τ or never. In the plane, at τ, all points of the second primitive's collapsed part are P,
/// and P is P itself or inside edge a; moved by a vector s that is not parallel to that edge it is
/// on nothing. Variants: one side collapses, or everything does.
KnownQuery zero_length_edges(Recipe& recipe) {
  const std::size_t variant = recipe.variant % 4;
  const bool all_collapse = variant == 1 || variant == 3;
  const bool collides = variant < 2;
  const GridSize size(recipe);
  const std::int64_t before = recipe.random.between(1, 8);
  const std::int64_t after = recipe.random.between(1, 8);
  Moment moment;
  moment.time = draw_inner_time(recipe.random);
  move_rigidly(recipe, size, moment);
  while (moment.relative_velocity(recipe.contact())[2] == 0) move_rigidly(recipe, size, moment);
  for (Vector& velocity : moment.velocity) {
    const Vector own = draw_vector(recipe.random, size.velocity);
    velocity = {own[0], own[1], velocity[2]};
  }
  const Vector p = draw_vector(recipe.random, size.position);
  Vector g{}, shift{};
  while (parallel(g, shift)) {
    g = draw_vector(recipe.random, size.shape);
    shift = draw_unit_shift(recipe.random);
    g[2] = shift[2] = 0;
  }
  const Vector back = all_collapse ? p : p - before * g;
  const Vector front = all_collapse ? p : p + after * g;
  moment.position = recipe.vertex_face() ? std::array<Vector, 4>{p, back, front, front}
                                         : std::array<Vector, 4>{back, front, p, p};
  if (!collides) shift_first(recipe.contact(), shift, moment);
  const Query query = to_query(recipe, moment);
  if (!collides) return no_collision(query);
  return collision(query, moment.time.value());
}

/// All points stay on one line, at places k(t) that are linear in t between integers (the line
/// itself may move along with a common velocity). Each edge has a leading end; the other ends stay
/// behind the leading ones. The edges therefore meet iff the gap between the leading ends closes,
/// first at t = gap(0) / (gap(0) − gap(1)). On two parallel lines, one moved by s, they never do.
KnownQuery collinear_edges(Recipe& recipe) {
  Random& random = recipe.random;
  const std::size_t variant = recipe.variant % 5;
  const std::int64_t gap0 = random.between(1, 6);
  std::int64_t gap1 = -random.between(1, 4);
  if (variant == 2) gap1 = 0;
  if (variant == 3) gap1 = 1;
  const std::array<std::int64_t, 2> lead{random.between(-3, 3), random.between(-3, 3)};
  const std::array<std::int64_t, 2> gap{gap0, gap1};
  std::array<Places, 2> places{};
  for (std::size_t end = 0; end < 2; ++end) {
    const std::int64_t a = lead.at(end);
    const std::int64_t b = a + gap.at(end);
    places.at(end) = {a, a - random.between(1, 4), b, b + random.between(1, 4)};
  }
  const GridSize size(recipe);
  const Vector p = draw_vector(random, size.position);
  Vector g{}, shift{};
  while (parallel(g, shift)) {
    g = draw_vector(random, size.shape);
    shift = draw_unit_shift(random);
  }
  const Vector common = draw_vector(random, size.velocity);
  Moment moment;
  for (std::size_t point = 0; point < moving_points; ++point) {
    const std::int64_t start = places[0].at(point);
    moment.position.at(point) = p + start * g;
    moment.velocity.at(point) = common + (places[1].at(point) - start) * g;
  }
  if (variant == 4) shift_first(recipe.contact(), shift, moment);
  const Query query = to_query(recipe, moment);
  if (gap1 > 0 || variant == 4) return no_collision(query);
  Rational toi{whole(gap0), whole(gap0 - gap1)};
  toi.canonicalize();
  return collision(query, toi);
}

constexpr std::array<Definition, 6> degenerate_list{{
    {{"point-point",
      "Both primitives are points; their relative path is a line that passes 0 at the dyadic time, "
      "or is moved off 0 by a vector that is not parallel to it.",
      Verdicts::both},
     point_point},
    {{"point-edge",
      "A point and a segment in rigid relative motion not along the segment meet at the dyadic "
      "time where they are on one line, or never.",
      Verdicts::both},
     point_edge},
    {{"parallel-edges",
      "Parallel edges in rigid relative motion are on one line at one dyadic time only, and touch "
      "there iff their ranges of integers on that line meet.",
      Verdicts::both},
     parallel_edges,
     false},
    {{"zero-area-triangle",
      "Vertex and collinear face are on one line at one dyadic time only, and touch there iff the "
      "vertex is in the face's range of integers.",
      Verdicts::both},
     zero_area_triangle,
     true,
     false},
    {{"zero-length-edges",
      "Each primitive is flat in one axis and the heights meet at one dyadic time, at which sides "
      "have length zero on the other primitive or beside it.",
      Verdicts::both},
     zero_length_edges},
    {{"collinear-edges",
      "Edges on a common line for all time touch when the gap between their leading ends, linear "
      "between integers, reaches 0; on two parallel lines never.",
      Verdicts::both},
     collinear_edges,
     false},
}};

}  // namespace

std::span<const Definition> degenerate_definitions() { return degenerate_list; }

}  // namespace touchstone::verify::generate
