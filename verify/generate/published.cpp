/// \file
/// The configurations printed in the appendices of [wang2021], generalised. Query 0 of each
/// family and vertex_face is the printed one, bit for bit; edge_edge has analogues.

#include <array>

#include "verify/generate/coordinate_sampler.hpp"
#include "verify/generate/family_builder.hpp"
#include "verify/generate/passing_planes.hpp"

namespace touchstone::verify::generate {

using exact::Rational;

namespace {

using Points = std::array<std::array<double, 3>, query_points>;

Query to_query(const Points& points) {
  Query query{};
  for (std::size_t i = 0; i < query_points; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      query.at(i / moving_points, i % moving_points, axis) = points.at(i).at(axis);
    }
  }
  return query;
}

/// Are the first two coordinates of F zero at the time inside the domain? Nothing if that is so at
/// no (u,v), or at many.
std::optional<bool> meet_in_plane(ContactKind kind, const Query& query, const Rational& t) {
  const auto all = corners(kind);
  std::array<Rational, 2> w0, along_u, along_v;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    w0.at(axis) = corner_at(query, all.front(), axis, t);
    along_u.at(axis) = corner_at(query, all[1], axis, t) - w0.at(axis);
    along_v.at(axis) = corner_at(query, all.back(), axis, t) - w0.at(axis);
  }
  const Rational area = along_u[0] * along_v[1] - along_u[1] * along_v[0];
  if (area == 0) return std::nullopt;
  const Rational u = (along_v[0] * w0[1] - along_v[1] * w0[0]) / area,
                 v = (along_u[1] * w0[0] - along_u[0] * w0[1]) / area;
  if (u < 0 || v < 0) return false;
  return kind == ContactKind::vertex_face ? u + v <= 1 : u <= 1 && v <= 1;
}

constexpr Points printed_hourglass{{{0.1, 0.1, 0.1},
                                    {0, 0, 1},
                                    {1, 0, 1},
                                    {0, 1, 1},
                                    {0.1, 0.1, 0.1},
                                    {0, 0, 0},
                                    {0, 1, 0},
                                    {1, 0, 0}}};

/// Two points that exchange the corners (right, low) and (low, right) of a box while they sink; at
/// the middle of the motion both are at its centre. For vertex_face they are f1 and f2, and f0 is
/// (low, low); for edge_edge they are the ends of edge b.
Query draw_hourglass(Recipe& recipe) {
  Sampler sampler(recipe);
  Query query{};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double low = sampler.draw(axis, {-1.5, -1.0});
    const double high = sampler.draw(axis, right);
    const Line falling{high, low};
    const Line rising{low, high};
    set(query, 2, axis, axis == 0 ? falling : rising);
    set(query, 3, axis, axis == 0 ? rising : falling);
    set(query, 1, axis, {low, low});
    set(query, 0, axis, sampler.within(axis, {-1.0, 1.5}));
    if (!recipe.vertex_face()) {
      set(query, 0, axis, sampler.within(axis, {-1.0, 0.5}));
      set(query, 1, axis, sampler.within(axis, {1.0, 3.0}));
    }
  }
  const Line first = sampler.within(2, centre);
  const Line second = sampler.from_to(2, right, left);
  set_heights(recipe.contact(), first, second, query);
  return query;
}

/// Flat primitives: contact only when the heights are equal, once, at a rational time. At that time
/// the projections are a triangle (two segments), not degenerate unless it is the middle of the
/// motion, and the only candidate (u,v) is the solution of two linear equations.
KnownQuery hourglass(Recipe& recipe) {
  recipe.as_printed = recipe.index == 0 && recipe.vertex_face();
  const std::size_t first_of_second = recipe.vertex_face() ? 1 : 2;
  std::optional<bool> meets;
  Query query{};
  Rational toi;
  while (!meets) {
    query = recipe.as_printed ? to_query(printed_hourglass) : draw_hourglass(recipe);
    toi = *meeting_time(line_of(query, 0, 2), line_of(query, first_of_second, 2));
    meets = meet_in_plane(recipe.contact(), query, toi);
  }
  return *meets ? collision(query, toi) : no_collision(query);
}

constexpr Points printed_inflection{
    {{1, 1, 0}, {0, 0, 5}, {2, 0, 2}, {0, 1, 0}, {1, 1, 0}, {0, 0, -1}, {0, 0, -2}, {0, 7, 0}}};
/// The printed query with the parallelogram that has its corners w1, w0, w2 as w0, w1, w3: the same
/// cubic. (eb0, eb1) = (f1, f2), ea0 = v, ea1 = v + f1 − f0.
constexpr Points edge_inflection{
    {{1, 1, 0}, {3, 1, -3}, {2, 0, 2}, {0, 1, 0}, {1, 1, 0}, {1, 1, -1}, {0, 0, -2}, {0, 7, 0}}};

/// The direction d = (8, 1, −4) has d·w ≥ 1 for all corners of both queries, at t=0 and at t=1,
/// hence at all times (29, 1, 8 and 5, 1, 2; the parallelogram's fourth corner: 36 and 6). A change
/// of every coordinate by at most 1/256 changes d·w by at most 13·2/256 < 1.
KnownQuery inflection(Recipe& recipe) {
  KnownQuery known =
      no_collision(to_query(recipe.vertex_face() ? printed_inflection : edge_inflection));
  if (recipe.index == 0) {
    recipe.as_printed = true;
    return known;
  }
  Random& random = recipe.random;
  for (double& coordinate : known.query.coordinates) {
    coordinate += recipe.full ? (random.unit() - 0.5) / 256.0
                              : static_cast<double>(random.between(-2, 2)) / 1024.0;
  }
  std::array<int, 3> exponents{};
  for (int& exponent : exponents) exponent = static_cast<int>(random.between(-10, 10));
  scale_axes(exponents, known.query);
  return known;
}

constexpr Points printed_sliding{{{1, 0.5, 1},
                                  {0, 0.57, 1},
                                  {1, 0.57, 1},
                                  {1, 1.57, 1},
                                  {1, 0.5, 1},
                                  {0, 0.28, 1},
                                  {1, 0.28, 1},
                                  {1, 1.28, 1}}};

enum class Slide : std::uint8_t { on_vertex, beside, on_side, stops_short, arrives };

/// vertex_face: v, f1 and f2 share x, and f0 is left of them; f0 and f1 share y. edge_edge: ea0 and
/// eb0 share x, eb1 is left and ea1 right; eb0 and eb1 share y.
Query draw_sliding(Recipe& recipe, Slide slide, Sampler& sampler) {
  const bool vertex_face = recipe.vertex_face();
  Query query{};
  const Line height = sampler.within(2, centre);
  for (std::size_t point = 0; point < moving_points; ++point) set(query, point, 2, height);
  const Line s = sampler.within(0, centre);
  const Line y = sampler.within(1, centre);
  Line front = sampler.from_to(1, {0.75, 1.5}, {-1.5, -0.75});
  if (slide == Slide::stops_short) front.end = sampler.nudged(y.end, 1);
  if (slide == Slide::arrives) front.end = y.end;
  int steps = 0;
  if (slide == Slide::beside) steps = 1;
  if (slide == Slide::on_side) steps = -1;
  set(query, 0, 0, sampler.nudged(s, steps));
  set(query, 0, 1, y);
  const std::size_t back = vertex_face ? 1 : 3;
  set(query, back, 0, sampler.within(0, left));
  set(query, back, 1, front);
  set(query, 2, 0, s);
  set(query, 2, 1, front);
  const std::size_t rest = vertex_face ? 3 : 1;
  set(query, rest, 0, vertex_face ? s : sampler.within(0, right));
  set(query, rest, 1, sampler.within(1, vertex_face ? right : left));
  return query;
}

/// All points share z. The side f0f1 (edge b), at one y, comes down on the vertex (ea0), which is
/// below it before they meet, all other points being farther apart: y separates. When the y are
/// equal the vertex is on f1 (eb0), or one unit in the last place farther in, on the side; one unit
/// farther out x separates at all times.
KnownQuery sliding_degenerate(Recipe& recipe) {
  static constexpr std::array<Slide, 5> slides{Slide::on_vertex, Slide::beside, Slide::on_side,
                                               Slide::stops_short, Slide::arrives};
  recipe.as_printed = recipe.index == 0 && recipe.vertex_face();
  const Slide slide = slides.at(recipe.variant % slides.size());
  Sampler sampler(recipe);
  const Query query =
      recipe.as_printed ? to_query(printed_sliding) : draw_sliding(recipe, slide, sampler);
  if (slide == Slide::beside) return no_collision(query);
  const auto toi = meeting_time(line_of(query, 0, 1), line_of(query, 2, 1));
  return toi ? collision(query, toi) : no_collision(query);
}

constexpr std::array<Definition, 3> published_list{{
    {{"hourglass",
      "Two vertices of a flat sinking face exchange their corners; contact is possible only at the "
      "rational time of equal heights, and (u,v) solves two linear equations there.",
      Verdicts::both},
     hourglass},
    {{"inflection",
      "The printed cubic with an inflection and two roots; the direction (8,1,-4) separates all "
      "corners by 1 at both ends, more than the perturbations can change.",
      Verdicts::no_collisions},
     inflection},
    {{"sliding-degenerate",
      "Coplanar motion with shared x: a side comes down on the vertex, y separates before, and the "
      "meeting is where two known lines cross.",
      Verdicts::both},
     sliding_degenerate},
}};

}  // namespace

std::span<const Definition> published_definitions() { return published_list; }

}  // namespace touchstone::verify::generate
