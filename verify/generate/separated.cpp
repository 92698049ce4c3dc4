/// \file
/// Families about a separation d: the primitives come exactly to d, or pass it, known by
/// construction in either norm.
///
/// **Level.** All of the first primitive is at height p(t), all of the second at q(t), and their
/// projections meet at all times (passing_planes.hpp). So |F| ≥ |p − q| everywhere and F = (0, 0, p
/// − q) somewhere: the distance is |p − q| in both norms.
///
/// **Dominated.** One point of F is o(t) ≥ 0, componentwise, and all others are ≥ o(t) on all axes.
/// Hence the distance is ‖o‖ in both norms. With the vertex (end) at A and a vertex (end) of the
/// other primitive at B, o = A − B, all other points of the first are A plus a nonnegative vector,
/// and of the second B minus one; rounding is monotone, so this also holds for the rounded sums.
/// Alternatively, on the x axis the primitives overlap, F_x = 0 somewhere on the nearest lines, and
/// only y and z matter.
///
/// **Tilted.** The face, or the two edges' directions, lie in the plane of integer vectors g and h
/// with n·g = n·h = 0, and the first primitive is λ(t) n above it, all times a unit s. In L2 the
/// nearest point of F is λ n s, in L∞ it is the point of the plane with all components of one
/// magnitude (0 for zero components of n), λ s |n|² / ‖n‖₁: less is impossible, ‖x‖∞ ≥ |n·x| /
/// ‖n‖₁. Both lie inside F(t,·,·), which reaches far enough along g and h. Coordinates are integers
/// below 2^53 times a power of two, a common translation included.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "verify/generate/coordinate_sampler.hpp"
#include "verify/generate/family_builder.hpp"
#include "verify/generate/grid.hpp"
#include "verify/generate/offset.hpp"
#include "verify/generate/passing_planes.hpp"

namespace touchstone::verify::generate {

using exact::Integer;
using exact::Rational;

namespace {

using Vector3 = std::array<double, 3>;
using IntegerVector = std::array<std::int64_t, 3>;

/// The course of an offset, as factors at t=0 and t=1: powers of two or 0, so that products are
/// exact.
struct Course {
  double start;
  double end;
};

constexpr std::array<Course, 5> approaches{{{2, 0}, {4, 0}, {1, 0}, {2, -2}, {4, -4}}};
constexpr std::array<Course, 5> arrivals{{{2, 1}, {1, 2}, {4, 1}, {1, 4}, {4, 2}}};
constexpr std::array<Course, 8> one_sided{
    {{2, 0}, {1, 1}, {2, 1}, {1, 2}, {4, 0}, {1, 0}, {4, 2}, {4, 1}}};
constexpr std::array<Course, 8> two_sided{
    {{2, 0}, {1, 1}, {2, 1}, {1, 2}, {4, -4}, {1, -1}, {4, 2}, {2, -2}}};

template <class List>
const auto& draw_one(Random& random, const List& list) {
  return list.at(static_cast<std::size_t>(random.between(0, std::ssize(list) - 1)));
}

/// Itself or a neighbouring double.
double draw_neighbour(Random& random, double value) {
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto choice = random.between(0, 3);
  if (choice == 2) return std::nextafter(value, infinity);
  if (choice == 3) return std::nextafter(value, 0.0);
  return value;
}

/// The scene at an independent scale, or at that of the separation.
Sampler draw_scene(Recipe& recipe) {
  if (recipe.random.coin()) return Sampler(recipe);
  const auto exponent = static_cast<int>(recipe.random.between(-2, 6));
  const double factor = recipe.full ? 1.0 + recipe.random.unit() : 1.0;
  const double scale = std::ldexp(factor * recipe.separation.distance, exponent);
  return Sampler(recipe, {scale, scale, scale});
}

KnownQuery outcome(const Query& query, const Arrival& arrived) {
  return arrived.comes ? collision(query, arrived.time) : no_collision(query);
}

/// A difference of two coordinates, assigned to one of them, or half to each.
struct Split {
  double first;
  double second;

  [[nodiscard]] double of_first(double difference) const { return first * difference; }
  [[nodiscard]] double of_second(double difference) const { return second * difference; }
};

constexpr std::array<Split, 3> splits{{{1, 0}, {0, -1}, {0.5, -0.5}}};

// ---- Level ------------------------------------------------------------------------------------

/// The height moves from one double to another.
KnownQuery level(Recipe& recipe, const Line& height) {
  static constexpr std::array<Spot, 3> spots{Spot::interior, Spot::edge, Spot::corner};
  Query query{};
  Sampler scene = draw_scene(recipe);
  draw_plan(recipe.contact(), spots.at(recipe.variant % spots.size()), Offset::none, scene, query);
  const Split split = draw_one(recipe.random, splits);
  const Line first{split.of_first(height.start), split.of_first(height.end)};
  const Line second{split.of_second(height.start), split.of_second(height.end)};
  set_heights(recipe.contact(), first, second, query);
  const Offset3 offset{.start = {0, 0, Rational(height.start)},
                       .end = {0, 0, Rational(height.end)}};
  return outcome(query, arrival(offset, recipe.separation));
}

/// The height moves from above d to 0 or below: with 2d and 4d at the start the contact is at ½, ¾,
/// ¼ or ⅜; with any other height s at the start and 0 at the end it is at 1 − d/s.
KnownQuery approach(Recipe& recipe) {
  const double d = recipe.separation.distance;
  if (recipe.variant % 3 == 2) {
    return level(recipe, {.start = d * (1.0 + 3.0 * recipe.random.unit()), .end = 0.0});
  }
  const Course course = draw_one(recipe.random, approaches);
  return level(recipe, {.start = course.start * d, .end = course.end * d});
}

/// The height stays d, or a neighbour of d.
KnownQuery grazing(Recipe& recipe) {
  const double height = draw_neighbour(recipe.random, recipe.separation.distance);
  return level(recipe, {.start = height, .end = height});
}

/// The height comes down to d, or a neighbour of d, at t=1 only, or leaves it at t=0, or ends
/// above.
KnownQuery endpoint(Recipe& recipe) {
  const double height = draw_neighbour(recipe.random, recipe.separation.distance);
  const Course course = draw_one(recipe.random, arrivals);
  return level(recipe, {.start = course.start * height, .end = course.end * height});
}

// ---- Dominated --------------------------------------------------------------------------------

/// An offset of exactly or nearly d in one of the norms.
Vector3 draw_offset(Recipe& recipe) {
  const double d = recipe.separation.distance;
  const auto times = [](double unit, const Vector3& v) {
    return Vector3{v[0] * unit, v[1] * unit, v[2] * unit};
  };
  switch (recipe.random.between(0, 6)) {
    case 0:
      return {d, 0, 0};
    case 1:
      return {d, d, 0};
    case 2:
      return {d, d, d};
    case 3:
      return times(d / 5, {3, 4, 0});
    case 4:
      return times(d / 7, {2, 3, 6});
    case 5:
      return times(d / 3, {1, 2, 2});
    default:
      return {1.5 * d * recipe.random.unit(), 1.5 * d * recipe.random.unit(),
              1.5 * d * recipe.random.unit()};
  }
}

/// An offset for the y and z axes alone.
Vector3 draw_side_offset(Recipe& recipe) {
  const double d = recipe.separation.distance;
  switch (recipe.random.between(0, 3)) {
    case 0:
      return {0, d, 0};
    case 1:
      return {0, d, d};
    case 2:
      return {0, 3 * (d / 5), 4 * (d / 5)};
    default:
      return {0, 1.5 * d * recipe.random.unit(), 1.5 * d * recipe.random.unit()};
  }
}

/// The offset of the nearest points, and its assignment to the two primitives.
struct Nearest {
  Vector3 start;
  Vector3 end;
  Split split;

  /// Coordinate of the first primitive's nearest point.
  [[nodiscard]] Line first(std::size_t axis) const {
    return {split.of_first(start.at(axis)), split.of_first(end.at(axis))};
  }
  [[nodiscard]] Line second(std::size_t axis) const {
    return {split.of_second(start.at(axis)), split.of_second(end.at(axis))};
  }
  [[nodiscard]] Offset3 offset() const {
    Offset3 exact;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      exact.start.at(axis) = Rational(start.at(axis));
      exact.end.at(axis) = Rational(end.at(axis));
    }
    return exact;
  }
};

/// The offset on a course, one component sometimes moved to a neighbouring double.
Nearest draw_nearest(Recipe& recipe, Vector3 offset) {
  double& component = offset.at(static_cast<std::size_t>(recipe.random.between(0, 2)));
  if (component > 0) component = draw_neighbour(recipe.random, component);
  const Course course = draw_one(recipe.random, one_sided);
  Nearest nearest{.start = {}, .end = {}, .split = draw_one(recipe.random, splits)};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    nearest.start.at(axis) = course.start * offset.at(axis);
    nearest.end.at(axis) = course.end * offset.at(axis);
  }
  return nearest;
}

/// Whole primitives, or primitives that are shrunk to points and segments.
enum class Shape : std::uint8_t { whole, degenerate };

bool belongs_to_first(ContactKind kind, std::size_t point) {
  return point < (kind == ContactKind::vertex_face ? 1U : 2U);
}

/// The nearest point of its primitive, farther from the other one by some length ≥ 0.
Line draw_farther(ContactKind kind, std::size_t point, std::size_t axis, const Nearest& nearest,
                  Sampler& scene) {
  static constexpr Zone away{0.0, 3.0};
  const double start = scene.draw(axis, away), end = scene.draw(axis, away);
  if (belongs_to_first(kind, point)) {
    const Line base = nearest.first(axis);
    return {base.start + start, base.end + end};
  }
  const Line base = nearest.second(axis);
  return {base.start - start, base.end - end};
}

void set_nearest(ContactKind kind, std::size_t point, std::size_t axis, const Nearest& nearest,
                 Query& query) {
  set(query, point, axis,
      belongs_to_first(kind, point) ? nearest.first(axis) : nearest.second(axis));
}

/// Vertex against vertex, end against end; or point against point.
KnownQuery corner_to_corner(Recipe& recipe, Shape shape) {
  Sampler scene = draw_scene(recipe);
  const Nearest nearest = draw_nearest(recipe, draw_offset(recipe));
  const std::size_t second = recipe.vertex_face() ? 1 : 2;
  Query query{};
  for (std::size_t point = 0; point < moving_points; ++point) {
    const bool is_nearest = point == 0 || point == second || shape == Shape::degenerate;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (is_nearest) {
        set_nearest(recipe.contact(), point, axis, nearest, query);
      } else {
        set(query, point, axis, draw_farther(recipe.contact(), point, axis, nearest, scene));
      }
    }
  }
  return outcome(query, arrival(nearest.offset(), recipe.separation));
}

/// Along x the second primitive reaches from left to right of the first one's nearest point, or of
/// a parallel edge of it.
void draw_along_x(Recipe& recipe, bool parallel, Sampler& scene, Query& query) {
  const bool vertex_face = recipe.vertex_face();
  const std::size_t second = vertex_face ? 1 : 2;
  set(query, 0, 0, scene.within(0, parallel ? left : centre));
  set(query, second, 0, scene.within(0, left));
  set(query, second + 1, 0, scene.within(0, right));
  const std::size_t other = vertex_face ? 3 : 1;
  set(query, other, 0, scene.within(0, parallel ? right : centre));
}

/// Vertex or end against a side of the face or an edge; edge against parallel edge. Degenerate: the
/// face is a segment, the first edge a point.
KnownQuery side(Recipe& recipe, Shape shape) {
  Sampler scene = draw_scene(recipe);
  const Nearest nearest = draw_nearest(recipe, draw_side_offset(recipe));
  const std::size_t other = recipe.vertex_face() ? 3 : 1;
  const bool parallel = !recipe.vertex_face() && shape == Shape::whole && recipe.random.coin();
  Query query{};
  draw_along_x(recipe, parallel, scene, query);
  for (std::size_t point = 0; point < moving_points; ++point) {
    for (std::size_t axis = 1; axis < 3; ++axis) {
      if (point != other || parallel || shape == Shape::degenerate) {
        set_nearest(recipe.contact(), point, axis, nearest, query);
      } else {
        set(query, point, axis, draw_farther(recipe.contact(), point, axis, nearest, scene));
      }
    }
  }
  if (shape == Shape::degenerate && !recipe.vertex_face()) {
    for (const std::size_t end : {0U, 1U}) query.at(end, 1, 0) = query.at(end, 0, 0);
  }
  return outcome(query, arrival(nearest.offset(), recipe.separation));
}

KnownQuery corner(Recipe& recipe) { return corner_to_corner(recipe, Shape::whole); }

KnownQuery side(Recipe& recipe) { return side(recipe, Shape::whole); }

KnownQuery degenerate(Recipe& recipe) {
  return recipe.variant % 2 == 0 ? corner_to_corner(recipe, Shape::degenerate)
                                 : side(recipe, Shape::degenerate);
}

// ---- Tilted -----------------------------------------------------------------------------------

/// n of integer length, with two integer vectors perpendicular to it.
struct Plane {
  IntegerVector n;
  std::int64_t length;
  std::int64_t sum;  ///< of the components
  IntegerVector g;
  IntegerVector h;
};

constexpr std::array<Plane, 3> planes{{{{3, 4, 0}, 5, 7, {4, -3, 0}, {0, 0, 1}},
                                       {{2, 3, 6}, 7, 11, {3, -2, 0}, {0, 2, -1}},
                                       {{1, 2, 2}, 3, 5, {2, -1, 0}, {0, 1, -1}}}};

/// The position of a point in the plane, as multiples of g and h.
struct Place2 {
  std::int64_t g;
  std::int64_t h;
};

/// A range of multiples.
struct Range {
  std::int64_t low;
  std::int64_t high;
};

constexpr Range near_zero{-8, 8};
constexpr Range far_below{-60, -40};
constexpr Range far_above{40, 60};

/// The ranges of a point's multiples of g and h. With λ ≤ 4 the nearest points need |g| ≤ 4 and
/// |h| ≤ 7 around the origin, which the triangle contains, and the parallelogram of the edges.
struct Ranges {
  Range g;
  Range h;
};

const std::array<Ranges, moving_points>& ranges_of(ContactKind kind) {
  static constexpr Range zero{0, 0};
  static constexpr std::array<Ranges, moving_points> face{
      {{zero, zero}, {far_below, far_below}, {far_above, far_below}, {near_zero, far_above}}};
  static constexpr std::array<Ranges, moving_points> edges{
      {{far_below, zero}, {far_above, zero}, {zero, far_below}, {zero, far_above}}};
  return kind == ContactKind::vertex_face ? face : edges;
}

/// The grid: the unit s of the construction is `unit` · 2^exponent.
struct Grid {
  std::int64_t unit;
  int exponent;
};

/// The distance at λ = 1 in units of s.
Rational distance_of_plane(const Plane& plane, Norm norm) {
  const Integer length = whole(plane.length);
  if (norm == Norm::l2) return {length};
  Rational ratio(Integer(length * length), whole(plane.sum));
  ratio.canonicalize();
  return ratio;
}

/// The multiple of the grid closest to d, or the next one.
Grid draw_grid(Recipe& recipe, const Rational& distance) {
  const double d = recipe.separation.distance;
  const int exponent = std::ilogb(d) - (recipe.full ? 40 : 4);
  const double units = std::ldexp(d, -exponent) / distance.get_d();
  return {.unit = static_cast<std::int64_t>(units) + recipe.random.between(0, 1),
          .exponent = exponent};
}

std::int64_t draw_translation(Recipe& recipe) {
  return recipe.full ? recipe.random.between(-(std::int64_t{1} << 51), std::int64_t{1} << 51)
                     : recipe.random.between(-16, 16);
}

KnownQuery tilted(Recipe& recipe) {
  Random& random = recipe.random;
  const Plane& plane = draw_one(random, planes);
  const Rational distance = distance_of_plane(plane, recipe.separation.norm);
  const Grid grid = draw_grid(recipe, distance);
  const Course course = draw_one(random, two_sided);
  const bool translated = random.coin();
  Query query{};
  for (std::size_t end = 0; end < 2; ++end) {
    const auto lambda = static_cast<std::int64_t>(end == 0 ? course.start : course.end);
    IntegerVector translation{};
    if (translated) std::ranges::generate(translation, [&] { return draw_translation(recipe); });
    for (std::size_t point = 0; point < moving_points; ++point) {
      const auto [g_range, h_range] = ranges_of(recipe.contact()).at(point);
      const Place2 place{random.between(g_range.low, g_range.high),
                         random.between(h_range.low, h_range.high)};
      const std::int64_t height = belongs_to_first(recipe.contact(), point) ? lambda : 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int64_t multiple =
            height * plane.n.at(axis) + place.g * plane.g.at(axis) + place.h * plane.h.at(axis);
        query.at(end, point, axis) = std::ldexp(
            static_cast<double>(multiple * grid.unit + translation.at(axis)), grid.exponent);
      }
    }
  }
  const Rational unit(std::ldexp(static_cast<double>(grid.unit), grid.exponent));
  const Rational near = distance * unit;
  const Offset3 offset{.start = {0, 0, Rational(near * course.start)},
                       .end = {0, 0, Rational(near * course.end)}};
  return outcome(query, arrival(offset, recipe.separation));
}

constexpr std::array<Definition, 7> separated_list{{
    {{"separation-approach",
      "Flat primitives whose projections always meet are as far apart as their heights; the height "
      "goes from 2d or 4d to 0 or below, so it is d at a known time.",
      Verdicts::collisions},
     approach},
    {{"separation-grazing",
      "The same at a height that stays exactly d (contact), or the next double above d (none) or "
      "below.",
      Verdicts::both},
     grazing},
    {{"separation-endpoint",
      "The same at a height that reaches exactly d, or a neighbouring double, only at t=1, or "
      "leaves it at t=0.",
      Verdicts::both},
     endpoint},
    {{"separation-corner",
      "Vertex against vertex, all else farther on every axis: the distance is that of the two, "
      "offset along an axis, a diagonal or a Pythagorean vector.",
      Verdicts::both},
     corner},
    {{"separation-side",
      "A vertex or edge beside an edge that reaches past it, all else farther on both other axes: "
      "the distance is that of two lines.",
      Verdicts::both},
     side},
    {{"separation-tilted",
      "Large flat primitives in a plane with a normal of integer length: the distance is a "
      "rational multiple of the height in either norm, on an integer grid.",
      Verdicts::both},
     tilted},
    {{"separation-degenerate",
      "As corner and side with primitives that are points or segments: faces without area, edges "
      "without length.",
      Verdicts::both},
     degenerate},
}};

}  // namespace

std::span<const Definition> separated_definitions() { return separated_list; }

}  // namespace touchstone::verify::generate
