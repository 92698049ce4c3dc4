/// \file
/// Families whose determinant is a product of three linear functions of t with known roots.
///
/// *Triangular corners.* With w0 = (α,0,0), w1 = (p,β,0), w_last = (q,r,γ), the zeros being shared
/// coordinates, the determinant is αβγ; α, β, γ are differences of two lines, so their roots are
/// exact rationals of the doubles. When γ ≠ 0 only the edge w0w1 lies in the plane z = 0: zero is
/// in the hull iff α = 0, or β = 0 and αp ≤ 0. When γ = 0 all corners are in that plane, and zero
/// is in the hull iff the polygon's section with the line y = 0 contains it.
///
/// *Avoiding corners.* With w0 = (α,y1,·), w1 = (α,y1,·), w0z − w1z = ±γ, and x = 0, y = β for the
/// last corner (for edge_edge the last two), the determinant is αβγ up to sign too. While α ≠ 0
/// only the last corner(s) have x = 0, and zero is in their hull iff β = 0 and their z have no
/// common strict sign. When α = 0 all x are zero, and y1 and β of one strict sign (or β = 0, y1 ≠
/// 0, which leaves the last corner(s)) exclude zero. Such a query therefore does not collide for
/// any roots.

#include <algorithm>
#include <array>
#include <initializer_list>
#include <vector>

#include "verify/generate/coordinate_sampler.hpp"
#include "verify/generate/family_builder.hpp"

namespace touchstone::verify::generate {

using exact::Rational;

namespace {

/// Two lines of one axis; their difference is α, β or γ.
struct Pair {
  Line base;
  Line other;
};
using Pairs = std::array<Pair, 3>;

/// A pair that meets once in (0,1), or not at all.
Pair draw_pair(std::size_t axis, bool meets, Sampler& sampler) {
  const bool upward = sampler.random().coin();
  const Zone& start = upward ? lower_zone : upper_zone;
  const Zone& end = upward == meets ? upper_zone : lower_zone;
  return {sampler.within(axis, centre), sampler.from_to(axis, start, end)};
}

/// A pair that exchanges its values: it meets at t = 1/2, whatever the doubles are.
Pair draw_swap(std::size_t axis, Sampler& sampler) {
  const double a = sampler.draw(axis, centre);
  const double b = sampler.draw(axis, upper_zone);
  return {{a, b}, {b, a}};
}

/// Pairs with one root for all the listed axes: copies of one pair times powers of two, or swaps.
Pairs draw_common_root(std::initializer_list<std::size_t> axes, bool by_swap, Sampler& sampler) {
  Pairs pairs{};
  const Pair original = draw_pair(0, true, sampler);
  for (std::size_t axis = 0; axis < 3; ++axis) pairs.at(axis) = draw_pair(axis, false, sampler);
  for (const std::size_t axis : axes) {
    const auto exponent = static_cast<int>(sampler.random().between(-6, 6));
    pairs.at(axis) = by_swap
                         ? draw_swap(axis, sampler)
                         : Pair{scaled(original.base, exponent), scaled(original.other, exponent)};
  }
  return pairs;
}

/// Triangular corners; p, q, r are drawn anywhere.
Query triangular(ContactKind kind, const Pairs& pairs, Sampler& sampler) {
  static constexpr std::array<std::size_t, 4> face_order{0, 1, 2, 3};
  static constexpr std::array<std::size_t, 4> edge_order{2, 0, 1, 3};
  const auto& order = kind == ContactKind::vertex_face ? face_order : edge_order;
  Query query{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < moving_points; ++i) {
      Line line = pairs.at(axis).base;
      if (i == axis + 1) line = pairs.at(axis).other;
      if (i > axis + 1) line = sampler.within(axis, anywhere);
      set(query, order.at(i), axis, line);
    }
  }
  return query;
}

/// The values of the triangular corners at one time.
struct Triangular {
  Rational alpha, p, beta, q, r, gamma;

  Triangular(ContactKind kind, const Query& query, const Rational& t) {
    const auto all = corners(kind);
    alpha = corner_at(query, all[0], 0, t);
    p = corner_at(query, all[1], 0, t);
    beta = corner_at(query, all[1], 1, t);
    q = corner_at(query, all.back(), 0, t);
    r = corner_at(query, all.back(), 1, t);
    gamma = corner_at(query, all.back(), 2, t);
  }
};

/// True if zero is in the polygon (α,0), (p,β), [edge_edge: (p+q−α, β+r),] (q,r). With β and r of
/// opposite sign the line y = 0 leaves the polygon at (α,0) and at (x,0) on the opposite boundary.
bool section_contains_zero(ContactKind kind, const Triangular& w) {
  if (w.beta == 0 && w.r == 0) {
    const Rational far = kind == ContactKind::edge_edge ? Rational(w.p + w.q - w.alpha) : w.q;
    const Rational low = std::min({w.alpha, w.p, w.q, far});
    const Rational high = std::max({w.alpha, w.p, w.q, far});
    return low <= 0 && high >= 0;
  }
  if (w.beta == 0) return w.alpha * w.p <= 0;
  if (w.r == 0) return w.alpha * w.q <= 0;
  if (sgn(w.beta) == sgn(w.r)) return w.alpha == 0;
  Rational x;
  if (kind == ContactKind::vertex_face) {
    x = (w.p * w.r - w.beta * w.q) / (w.r - w.beta);
  } else if (sgn(Rational(w.beta + w.r)) == sgn(w.beta)) {
    x = w.q - w.r / w.beta * (w.p - w.alpha);
  } else {
    x = w.p - w.beta / w.r * (w.q - w.alpha);
  }
  return w.alpha * x <= 0;
}

bool triangular_contact(ContactKind kind, const Query& query, const Rational& t) {
  const Triangular w(kind, query, t);
  if (w.gamma == 0) return section_contains_zero(kind, w);
  return w.alpha == 0 || (w.beta == 0 && w.alpha * w.p <= 0);
}

/// The verdict at each root, earliest first.
KnownQuery triangular_outcome(ContactKind kind, const Pairs& pairs, const Query& query) {
  std::vector<Rational> roots;
  for (const Pair& pair : pairs) {
    const auto root = meeting_time(pair.base, pair.other);
    if (root) roots.push_back(*root);
  }
  std::sort(roots.begin(), roots.end());
  for (const Rational& t : roots) {
    if (triangular_contact(kind, query, t)) return collision(query, t);
  }
  return no_collision(query);
}

/// Avoiding corners, as far as coordinates are shared: y1 and the z that decide are drawn anywhere.
/// The points that give α its root are f0 and f1, or eb0; f2 or eb1 gives β its root.
Query avoiding(ContactKind kind, const Pairs& pairs, Sampler& sampler) {
  const bool vertex_face = kind == ContactKind::vertex_face;
  const auto meets_x = [&](std::size_t point) { return point == 2 || (vertex_face && point == 1); };
  const Line y1 = sampler.within(1, anywhere);
  Query query{};
  for (std::size_t point = 0; point < moving_points; ++point) {
    set(query, point, 0, meets_x(point) ? pairs[0].other : pairs[0].base);
    const Line beta = point == 3 ? pairs[1].other : pairs[1].base;
    set(query, point, 1, meets_x(point) ? y1 : beta);
    set(query, point, 2, sampler.within(2, anywhere));
  }
  const std::size_t lifted = vertex_face ? 1 : 0;
  set(query, lifted, 2, pairs[2].base);
  set(query, lifted + 1, 2, pairs[2].other);
  return query;
}

/// The condition at the top of the file for avoiding corners.
bool avoids(ContactKind kind, const Pairs& pairs, const Query& query) {
  const auto all = corners(kind);
  const auto alpha_root = meeting_time(pairs[0].base, pairs[0].other);
  const auto beta_root = meeting_time(pairs[1].base, pairs[1].other);
  if (alpha_root) {
    const int y1 = sgn(corner_at(query, all.front(), 1, *alpha_root));
    const int beta = sgn(corner_at(query, all.back(), 1, *alpha_root));
    if (y1 == 0 || y1 * beta < 0) return false;
  }
  if (!beta_root) return true;
  const int z = sgn(corner_at(query, all.back(), 2, *beta_root));
  return z != 0 && z == sgn(corner_at(query, all[2], 2, *beta_root));
}

KnownQuery draw_avoiding(ContactKind kind, const Pairs& pairs, Sampler& sampler) {
  Query query = avoiding(kind, pairs, sampler);
  while (!avoids(kind, pairs, query)) query = avoiding(kind, pairs, sampler);
  return no_collision(query);
}

KnownQuery from_pairs(Recipe& recipe, const Pairs& pairs, bool is_apart, Sampler& sampler) {
  if (is_apart) return draw_avoiding(recipe.contact(), pairs, sampler);
  return triangular_outcome(recipe.contact(), pairs, triangular(recipe.contact(), pairs, sampler));
}

/// Triangular corners; β and γ have a root each, α has none.
KnownQuery two_roots(Recipe& recipe) {
  Sampler sampler(recipe);
  const Pairs pairs{draw_pair(0, false, sampler), draw_pair(1, true, sampler),
                    draw_pair(2, true, sampler)};
  return from_pairs(recipe, pairs, false, sampler);
}

/// Triangular corners, for which α = 0 is always a contact but possibly not the first one; or
/// avoiding ones.
KnownQuery three_roots(Recipe& recipe) {
  Sampler sampler(recipe);
  const Pairs pairs{draw_pair(0, true, sampler), draw_pair(1, true, sampler),
                    draw_pair(2, true, sampler)};
  return from_pairs(recipe, pairs, recipe.variant % 3 == 2, sampler);
}

/// Triangular corners; β and γ have the same root, by equal differences or by swaps: αβγ does not
/// change its sign there.
KnownQuery double_root(Recipe& recipe) {
  Sampler sampler(recipe);
  const Pairs pairs = draw_common_root({1, 2}, recipe.variant % 2 == 1, sampler);
  return from_pairs(recipe, pairs, false, sampler);
}

/// α, β and γ have the same root: triangular corners, for which it is a contact, or avoiding ones.
KnownQuery triple_root(Recipe& recipe) {
  Sampler sampler(recipe);
  const Pairs pairs = draw_common_root({0, 1, 2}, recipe.variant % 2 == 1, sampler);
  return from_pairs(recipe, pairs, recipe.variant % 3 == 2, sampler);
}

constexpr std::array<Definition, 4> product_list{{
    {{"two-roots",
      "Shared coordinates make the determinant a product of differences of known lines with two "
      "rational roots; the verdict at each follows from signs.",
      Verdicts::both},
     two_roots},
    {{"three-roots",
      "As two-roots with three roots; or all corners avoid 0 at each of them by their signs.",
      Verdicts::both},
     three_roots},
    {{"double-root",
      "As two-roots with both factors the same difference times powers of two, or two swaps at "
      "t=1/2: the determinant touches zero without changing its sign.",
      Verdicts::both},
     double_root},
    {{"triple-root",
      "As three-roots with one common root: a corner is 0 there, or all corners avoid 0 by signs.",
      Verdicts::both},
     triple_root},
}};

}  // namespace

std::span<const Definition> product_definitions() { return product_list; }

}  // namespace touchstone::verify::generate
