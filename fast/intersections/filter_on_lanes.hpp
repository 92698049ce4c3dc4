#pragma once

/// \file
/// The filter of pairs of triangles: those that certainly do not intersect
/// (touchstone/intersections.hpp), and those that certainly cross, by signs of rounded
/// determinants. It is written once for lanes, with one pair in each lane. Only the kernels include
/// this file, one file for each instruction set (filter_*.cpp).
///
/// Let A and B be triangles with an area, N and M their normals. A *side* of a vertex is the sign
/// of its determinant with a triangle; it is certain beyond the bound of measured_determinant_end.
/// A *turn* is the sign of an orientation in the projection along the axis of N's greatest
/// component; it is certain beyond the bound of measured_orientation_end
/// (fast/intersections/orientation.hpp). The triangles do not intersect
///
/// - with a common edge vw, if the other vertex of B has a certain side of A: then their planes are
///   different, and each triangle is on one side of the line vw in its plane. Or if the turns of
///   the two other vertices about vw are certain and different: vw separates the projections.
///
/// - with a common vertex v, A = vab, B = vcd,
///   1. if c and d are certainly on one side of A, or a and b on one side of B: the plane of that
///      triangle meets the other one in v alone.
///   2. if c and d are on different sides of A, a and b on different sides of B, and the side of c
///      is that of a. Proof. Let p, q, r, s be a − v, b − v, c − v, d − v. The plane of A meets the
///      edge cd in a point v + x, where x = λ r + μ s, λ = |N·s|, μ = |N·r| (up to a positive
///      factor), and B in the segment from v to there. x is in the plane of B, so x = α p + β q
///      with α M·p + β M·q = 0: α and β have the same sign, and the segment has other points of A
///      than v iff it is positive. det(x, r, q) is α det(p, r, q) = −α N·r, and also
///      μ det(s, r, q) = −μ M·q. So α has the sign of (N·r)(M·q), that is, is negative iff M·q and
///      N·r have different signs, that is, iff M·p and N·r have the same. ∎
///   3. if a line through v and one of a, b, c, d has, in the projection, the other vertex of its
///      triangle certainly on one side and both vertices of the other triangle on the other one.
///
/// - without a common vertex,
///   1. if all vertices of one are certainly on one side of the other.
///   2. if all six sides are certain, and the segments in which the triangles meet the line of both
///      planes are disjoint. Let p be the vertex of A that is alone on its side of B, and p, q, r
///      the rotation of A, likewise p', q', r' for B. If p is below B, exchange q' and r', which
///      turns M round and p above; if p' is below A, exchange q and r. In the plane of A, seen from
///      N, the direction N × M is 90° to the left of that in which M increases. A turns left, and p
///      is where M is positive, so along N × M the edge pr meets the line of both planes before pq.
///      In the plane of B, N increases 90° to the left of N × M, so p'q' meets it before p'r'. The
///      segments are disjoint iff pq is before p'q' or p'r' before pr. The edges pq and p'q' cross
///      the line at places in the order that the sign of det(q − p, p' − p, q' − p) tells: it is
///      positive iff pq is first. (With M = (1,0,0), N = (0,−1,0), p = (1,0,x), q = (−1,0,x),
///      p' = (0,−1,y), q' = (0,1,y) it is 4 (y − x). It changes sign only where the edges, which
///      pass through each other's planes, meet.)
///   3. if a line through an edge of one has, in the projection, its third vertex certainly on one
///      side and all of the other triangle on the other one.
///
/// If in the second cases all signs are certain and the segments meet, they have a segment in
/// common, because no sign is 0. An edge is not in the other triangle's plane; so the kind of the
/// intersection is edge_through_face (contacts.hpp).
///
/// Without a common vertex the first case excludes most pairs; the others come into lanes anew.
/// Where planes nearly coincide only the projection can be certain, elsewhere sides suffice; so the
/// projection is computed only if a lane needs it.
///
/// All of this holds for other elements, too, as triangles without an area: where a proof needs an
/// area, a sign is certain only with one.
///
/// `Lanes` is a type of the file of one instruction set, in an anonymous namespace, with Value and
/// Mask as in fast/certified/stages/lanes.hpp, and the functions of pair_order.hpp. No other file
/// may link code from here.

#include <array>
#include <cstddef>
#include <span>

#include "fast/intersections/filter_kernel.hpp"
#include "fast/intersections/orientation.hpp"
#include "fast/intersections/pair_order.hpp"
#include "touchstone/filters/error_bounds.hpp"
#include "touchstone/filters/polynomial_expressions.hpp"

namespace touchstone::fast::triangle_filter {

template <class Lanes>
class Filter {
 public:
  /// As TriangleKernel::filter.
  static void run(const PlaceAtRest* at, std::size_t common, std::span<const ElementPair> pairs,
                  FilteredPairs& result) {
    const auto decide = [&](const ElementPair* some, unsigned all, const auto& x) {
      const Known known = known_of(x);
      const unsigned crossing = known.crossing.bits() & all;
      const unsigned open = all & ~(known.apart.bits() | crossing);
      for_each(open, [&](std::size_t i) { result.open[result.open_count++] = some[i].pair; });
      for_each(crossing,
               [&](std::size_t i) { result.crossing[result.crossing_count++] = some[i].pair; });
    };
    if (common == 0) {
      std::array<ElementPair, SortedPairs::capacity> rest;
      std::size_t count = 0;
      for_all<0>(at, pairs, [&](const ElementPair* some, unsigned all, const auto& x) {
        for_each(all & ~are_beside(x).bits(), [&](std::size_t i) { rest[count++] = some[i]; });
      });
      for_all<0>(at, std::span(rest).first(count), decide);
    } else if (common == 1) {
      for_all<1>(at, pairs, decide);
    } else {
      for_all<2>(at, pairs, decide);
    }
  }

 private:
  using Value = typename Lanes::Value;
  using Mask = typename Lanes::Mask;
  using Point = filters::Vector3<Value>;
  static constexpr std::size_t width = Lanes::width;

  /// Calls work(pairs, bits, x) for some of the pairs after the other: the bits of their lanes, and
  /// their vertices.
  template <std::size_t common, class Work>
  static void for_all(const PlaceAtRest* at, std::span<const ElementPair> pairs, const Work& work) {
    static constexpr std::size_t different = 6 - common;
    for (std::size_t first = 0; first < pairs.size(); first += width) {
      const ElementPair* const some = pairs.data() + first;
      const std::size_t last = (pairs.size() - first < width ? pairs.size() - first : width) - 1;
      std::array<Point, different> x;
      for (std::size_t k = 0; k < different; ++k) {
        std::array<const double*, width> rows;
        for (std::size_t lane = 0; lane < width; ++lane) {
          const auto vertex = some[lane < last ? lane : last].vertices[k];
          rows[lane] = at[static_cast<std::size_t>(vertex)].data();
        }
        x[k] = Lanes::load(rows);
      }
      work(some, (2U << last) - 1U, x);
    }
  }

  template <class Take>
  static void for_each(unsigned bits, const Take& take) {
    for (; bits != 0; bits &= bits - 1) take(static_cast<std::size_t>(__builtin_ctz(bits)));
  }

  /// Pairs that certainly do not intersect, and those that certainly cross.
  struct Known {
    Mask apart, crossing;
  };

  // ---- Signs ----

  /// Where a sign is certain.
  struct Signs {
    Mask positive, negative;
  };
  static Signs signs(const Value& x, const Value& bound) {
    return {x > bound, x < Value(0.0) - bound};
  }
  static bool are_all(const Mask& mask) { return mask.bits() == Mask::all().bits(); }
  static Mask differ(const Signs& a, const Signs& b) {
    return (a.positive & b.negative) | (a.negative & b.positive);
  }
  template <std::size_t count>
  static Signs all_of(const std::array<Signs, count>& some) {
    Signs result = some[0];
    for (const Signs& one : some) {
      result = {result.positive & one.positive, result.negative & one.negative};
    }
    return result;
  }
  template <std::size_t count>
  static Mask are_one(const std::array<Signs, count>& some) {
    const Signs all = all_of(some);
    return all.positive | all.negative;
  }

  static Point difference(const Point& from, const Point& to) {
    return {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
  }
  static Value size_of(const Point& v) { return max(max(abs(v[0]), abs(v[1])), abs(v[2])); }

  /// p × q of two differences.
  struct Normal {
    Normal(const Point& p, const Point& q)
        : vector(filters::cross(p, q)), size(size_of(p) * size_of(q)) {}

    /// The sign of its product with a third difference.
    [[nodiscard]] Signs side(const Point& r) const {
      constexpr const auto& bound = filters::measured_determinant_end_double;
      constexpr double underflow = bound.underflow(meeting::Positions::greatest_difference);
      return signs(filters::dot(r, vector),
                   Value(bound.rounding()) * size * size_of(r) + Value(underflow));
    }

    Point vector;
    Value size;
  };

  // ---- The projection ----

  struct Point2 {
    Value u, v;

    friend Point2 operator-(const Point2& a, const Point2& b) { return {a.u - b.u, a.v - b.v}; }
    [[nodiscard]] Value size() const { return max(abs(u), abs(v)); }
  };

  class Projection {
   public:
    /// Along the axis of the greatest component of a vector.
    explicit Projection(const Point& normal) {
      const Value x = abs(normal[0]), y = abs(normal[1]), z = abs(normal[2]);
      along_x_ = (x >= y) & (x >= z);
      along_y_ = y >= z;
    }
    [[nodiscard]] Point2 operator()(const Point& p) const {
      return {chosen(p[1], p[2], p[0]), chosen(p[2], p[0], p[1])};
    }

   private:
    [[nodiscard]] Value chosen(const Value& x, const Value& y, const Value& z) const {
      return select(along_x_, x, select(along_y_, y, z));
    }

    Mask along_x_ = Mask::none(), along_y_ = Mask::none();
  };

  /// The sign of p × q for differences of a size up to √square.
  static Signs turn(const Point2& p, const Point2& q, const Value& square) {
    constexpr const auto& bound = filters::measured_orientation_end_double;
    constexpr double underflow = bound.underflow(meeting::Positions::greatest_difference);
    return signs(p.u * q.v - p.v * q.u, Value(bound.rounding()) * square + Value(underflow));
  }

  // ---- With a common edge ----

  /// Of v, w, a, b.
  static Known known_of(const std::array<Point, 4>& x) {
    const Point edge = difference(x[0], x[1]), a = difference(x[0], x[2]);
    const Point b = difference(x[0], x[3]);
    const Normal normal(edge, a);
    const Signs side = normal.side(b);
    const Mask apart = side.positive | side.negative;
    if (are_all(apart)) return {apart, Mask::none()};
    const Projection projected(normal.vector);
    const Point2 along = projected(edge), to_a = projected(a), to_b = projected(b);
    const Value size = max(along.size(), max(to_a.size(), to_b.size()));
    return {apart | differ(turn(along, to_a, size * size), turn(along, to_b, size * size)),
            Mask::none()};
  }

  // ---- With a common vertex ----

  /// Of v, a, b, c, d.
  static Known known_of(const std::array<Point, 5>& x) {
    const Point p = difference(x[0], x[1]), q = difference(x[0], x[2]);
    const Point r = difference(x[0], x[3]), s = difference(x[0], x[4]);
    const Normal first(p, q), second(r, s);
    const Signs c = first.side(r), d = first.side(s);
    const Mask beside_first = are_one(std::array{c, d});
    if (are_all(beside_first)) return {beside_first, Mask::none()};
    const Signs a = second.side(p), b = second.side(q);
    const Mask are_mixed = differ(c, d) & differ(a, b), crossing = are_mixed & differ(a, c);
    const Mask one_way = (c.positive & a.positive) | (c.negative & a.negative);
    const Mask apart = beside_first | are_one(std::array{a, b}) | (are_mixed & one_way);
    if (are_all(apart | crossing)) return {apart, crossing};
    return {apart | have_line_between(Projection(first.vector), p, q, r, s), crossing};
  }

  static Mask have_line_between(const Projection& projected, const Point& p, const Point& q,
                                const Point& r, const Point& s) {
    const Point2 a = projected(p), b = projected(q), c = projected(r), d = projected(s);
    const Value size = max(max(a.size(), b.size()), max(c.size(), d.size()));
    const Value square = size * size;
    const Signs ab = turn(a, b, square), cd = turn(c, d, square);
    const Signs ac = turn(a, c, square), ad = turn(a, d, square);
    const Signs bc = turn(b, c, square), bd = turn(b, d, square);
    return differ(ab, all_of(std::array{ac, ad})) | are_one(std::array{ab, bc, bd}) |
           are_one(std::array{cd, ac, bc}) | differ(cd, all_of(std::array{ad, bd}));
  }

  // ---- Without a common vertex ----

  using Triangle = std::array<Point, 3>;

  static Normal normal_of(const Triangle& x) {
    return Normal(difference(x[0], x[1]), difference(x[0], x[2]));
  }

  /// The sides of a triangle's vertices.
  static std::array<Signs, 3> sides(const Normal& plane, const Point& origin,
                                    const Triangle& triangle) {
    return {plane.side(difference(origin, triangle[0])),
            plane.side(difference(origin, triangle[1])),
            plane.side(difference(origin, triangle[2]))};
  }

  /// Two triangles, and the sides of each one's vertices.
  struct Two {
    explicit Two(const std::array<Point, 6>& x)
        : a{x[0], x[1], x[2]},
          b{x[3], x[4], x[5]},
          of_a(normal_of(a)),
          of_b(normal_of(b)),
          sides_of_a(sides(of_b, b[0], a)),
          sides_of_b(sides(of_a, a[0], b)) {}

    Triangle a, b;
    Normal of_a, of_b;
    std::array<Signs, 3> sides_of_a, sides_of_b;
  };

  /// True if one triangle is certainly on one side of the other's plane.
  static Mask are_beside(const std::array<Point, 6>& x) {
    const Triangle a{x[0], x[1], x[2]}, b{x[3], x[4], x[5]};
    const Mask beside = are_one(sides(normal_of(a), a[0], b));
    if (are_all(beside)) return beside;
    return beside | are_one(sides(normal_of(b), b[0], a));
  }

  /// \pre they are not beside each other
  static Known known_of(const std::array<Point, 6>& x) {
    const Two two(x);
    const auto [apart, crossing] =
        known_on_line(Rotation(two.a, two.sides_of_a), Rotation(two.b, two.sides_of_b));
    if (are_all(apart | crossing)) return {apart, crossing};
    return {apart | have_line_between(Projection(two.of_a.vector), two.a, two.b), crossing};
  }

  /// A triangle whose sides of a plane are certain and different, from the vertex on that is alone
  /// on its side.
  struct Rotation {
    Rotation(const Triangle& x, const std::array<Signs, 3>& sides) {
      const auto is_alone = [&](std::size_t i) {
        return differ(sides[i], all_of(std::array{sides[(i + 1) % 3], sides[(i + 2) % 3]}));
      };
      const Mask first = is_alone(0), second = is_alone(1), third = is_alone(2);
      is_certain = first | second | third;
      is_below =
          (first & sides[0].negative) | (second & sides[1].negative) | (third & sides[2].negative);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto chosen = [&](std::size_t i) {
          return select(first, x[i][axis],
                        select(second, x[(i + 1) % 3][axis], x[(i + 2) % 3][axis]));
        };
        p[axis] = chosen(0);
        q[axis] = chosen(1);
        r[axis] = chosen(2);
      }
    }

    Mask is_certain = Mask::none(), is_below = Mask::none();
    Point p, q, r;
  };

  static Point chosen(const Mask& mask, const Point& a, const Point& b) {
    return {select(mask, a[0], b[0]), select(mask, a[1], b[1]), select(mask, a[2], b[2])};
  }

  static Known known_on_line(const Rotation& a, const Rotation& b) {
    const auto from_p = [&](const Point& x) { return difference(a.p, x); };
    const Point q = from_p(chosen(b.is_below, a.r, a.q)), r = from_p(chosen(b.is_below, a.q, a.r));
    const Point other_p = from_p(b.p);
    const Point other_q = from_p(chosen(a.is_below, b.r, b.q));
    const Point other_r = from_p(chosen(a.is_below, b.q, b.r));
    const Signs at_q = Normal(other_p, other_q).side(q), at_r = Normal(other_p, other_r).side(r);
    const Mask are_certain = a.is_certain & b.is_certain;
    return {are_certain & (at_q.positive | at_r.negative),
            are_certain & at_q.negative & at_r.positive};
  }

  static Mask have_line_between(const Projection& projected, const Triangle& a, const Triangle& b) {
    const std::array<Point2, 3> of_a{projected(a[0]), projected(a[1]), projected(a[2])};
    const std::array<Point2, 3> of_b{projected(b[0]), projected(b[1]), projected(b[2])};
    Value size(0.0);
    for (std::size_t i = 0; i < 3; ++i) {
      size = max(size, max((of_a[i] - of_a[0]).size(), (of_b[i] - of_a[0]).size()));
    }
    // Of any two vertices the difference is at most twice as large, but for its rounding.
    const Value square = size * size * Value(4.5);
    return have_line_beside(of_a, of_b, square) | have_line_beside(of_b, of_a, square);
  }

  /// True if a line through an edge of the first triangle is between them.
  static Mask have_line_beside(const std::array<Point2, 3>& triangle,
                               const std::array<Point2, 3>& other, const Value& square) {
    Mask result = Mask::none();
    for (std::size_t i = 0; i < 3; ++i) {
      const Point2 &start = triangle[i], edge = triangle[(i + 1) % 3] - start;
      const auto side = [&](const Point2& x) { return turn(edge, x - start, square); };
      result = result | differ(side(triangle[(i + 2) % 3]),
                               all_of(std::array{side(other[0]), side(other[1]), side(other[2])}));
    }
    return result;
  }
};

}  // namespace touchstone::fast::triangle_filter

namespace touchstone::fast {

template <class Lanes>
constexpr TriangleKernel triangle_kernel_on(InstructionSet instructions) {
  return {.instructions = instructions,
          .sort = pair_order::sort<Lanes>,
          .filter = triangle_filter::Filter<Lanes>::run,
          .product_then_sum = product_then_sum<Lanes>};
}

}  // namespace touchstone::fast
