#include "verify/generate/passing_planes.hpp"

#include <array>

namespace touchstone::verify::generate {

namespace {

constexpr Zone far_low{-3.0, -2.5};
constexpr Zone far_high{2.5, 3.0};
constexpr Zone wide{-1.0, 1.0};

/// Each point stays in its own zones. vertex_face: the triangle with vertices near (−3,−3), (3,−3),
/// (0,3) contains all of [−0.5,0.5]²; at y = 0.5 its sides are still beyond ±1. edge_edge: edge a
/// goes from x ≤ −2.5 to x ≥ 2.5 within |y| ≤ 0.5, edge b likewise with x and y exchanged.
void draw_interior(ContactKind kind, Sampler& sampler, Query& query) {
  using Zones = std::array<std::array<Zone, 2>, moving_points>;
  static constexpr Zones face{
      {{centre, centre}, {far_low, far_low}, {far_high, far_low}, {centre, far_high}}};
  static constexpr Zones edges{
      {{far_low, centre}, {far_high, centre}, {centre, far_low}, {centre, far_high}}};
  const Zones& zones = kind == ContactKind::vertex_face ? face : edges;
  for (std::size_t point = 0; point < moving_points; ++point) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      set(query, point, axis, sampler.within(axis, zones.at(point).at(axis)));
    }
  }
}

/// vertex_face: the side f0f1 is at x = s and reaches from y ≤ −2.5 to y ≥ 2.5; f2 is to the right
/// of it. The vertex at x = s, |y| ≤ 0.5, is on the side; a little to the left it is left of all of
/// the face; a little to the right it is inside. edge_edge: edge b is that side, ea1 is to the
/// right, and ea0 at x = s is on edge b; a little to the right edge a is right of edge b, a little
/// to the left it reaches across.
void draw_edge(ContactKind kind, int steps, Sampler& sampler, Query& query) {
  const bool vertex_face = kind == ContactKind::vertex_face;
  const Line side = sampler.within(0, centre);
  const std::size_t first = vertex_face ? 1 : 2;
  set(query, first, 0, side);
  set(query, first, 1, sampler.within(1, far_low));
  set(query, first + 1, 0, side);
  set(query, first + 1, 1, sampler.within(1, far_high));
  const std::size_t third = vertex_face ? 3 : 1;
  set(query, third, 0, sampler.within(0, right));
  set(query, third, 1, sampler.within(1, wide));
  set(query, 0, 0, sampler.nudged(side, vertex_face ? -steps : steps));
  set(query, 0, 1, sampler.within(1, centre));
}

/// vertex_face: f0 is at (s,c), f1 to the right and below, f2 to the right and above, so the vertex
/// at (s,c) is on f0; a little to the right it is inside the face, since the direction (1,0) points
/// into the angle at f0; a little to the left it is left of all. edge_edge: edge b goes to the left
/// from (s,c), ea0 is at (s,c) and ea1 to the right; with ea0 a little to the right x separates; a
/// little to the left ea0 is on edge b, which is then drawn at constant y = c.
void draw_corner(ContactKind kind, int steps, Sampler& sampler, Query& query) {
  const bool vertex_face = kind == ContactKind::vertex_face;
  const Line s = sampler.within(0, centre);
  const Line c = sampler.within(1, centre);
  set(query, 0, 0, sampler.nudged(s, vertex_face ? -steps : steps));
  set(query, 0, 1, c);
  const std::size_t primitive = vertex_face ? 1 : 2;
  set(query, primitive, 0, s);
  set(query, primitive, 1, c);
  if (vertex_face) {
    set(query, 2, 0, sampler.within(0, right));
    set(query, 2, 1, sampler.within(1, left));
    set(query, 3, 0, sampler.within(0, right));
    set(query, 3, 1, sampler.within(1, right));
  } else {
    set(query, 1, 0, sampler.within(0, right));
    set(query, 1, 1, sampler.within(1, wide));
    set(query, 3, 0, sampler.within(0, left));
    set(query, 3, 1, steps < 0 ? c : sampler.within(1, wide));
  }
}

}  // namespace

void draw_plan(ContactKind kind, Spot spot, Offset offset, Sampler& sampler, Query& query) {
  int steps = 0;
  if (offset == Offset::outside) steps = 1;
  if (offset == Offset::inside) steps = -1;
  if (spot == Spot::interior) draw_interior(kind, sampler, query);
  if (spot == Spot::edge) draw_edge(kind, steps, sampler, query);
  if (spot == Spot::corner) draw_corner(kind, steps, sampler, query);
}

void set_heights(ContactKind kind, const Line& first, const Line& second, Query& query) {
  const std::size_t size_of_first = kind == ContactKind::vertex_face ? 1 : 2;
  for (std::size_t point = 0; point < moving_points; ++point) {
    set(query, point, 2, point < size_of_first ? first : second);
  }
}

KnownQuery level_outcome(Offset offset, const Line& first, const Line& second, const Query& query) {
  const auto toi = meeting_time(first, second);
  return toi && offset != Offset::outside ? collision(query, toi) : no_collision(query);
}

}  // namespace touchstone::verify::generate
