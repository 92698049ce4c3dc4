#pragma once

/// \file
/// The stages direction, determinant and orientation in single precision, for pairs of a mesh whose
/// vertices are also given in fixed point (docs/theory.md, section 6.11).
///
/// **Theorem.** Let a rounded query have corners within ε of those of a query, in each coordinate,
/// at both ends of the interval. Corners move linearly, so this holds throughout, and for all
/// convex combinations of corners. If the rounded query has no contact within D + ε in the maximum
/// norm, the query has none within D in that norm, nor in the Euclidean one, which is not less.
///
/// Each of three tests leaves those of the open queries that it does not exclude: directions, the
/// determinant and the orientations on [0,1], and these on parts of it.
///
/// The coordinates of rounded queries are whole numbers (fast/certified/fixed_point_vertices.hpp).
/// A difference of two is exact, and rounded once, to a float. So the stages' expressions have the
/// error bounds that are derived for float.

#include <array>
#include <cstddef>

#include "fast/certified/fixed_point_vertices.hpp"
#include "fast/certified/stages/determinant.hpp"
#include "fast/certified/stages/direction.hpp"
#include "fast/certified/stages/lanes.hpp"
#include "fast/certified/stages/moving_polygon.hpp"
#include "fast/certified/stages/moving_vectors.hpp"
#include "fast/certified/stages/orientation.hpp"

namespace touchstone::fast::kernel {

/// Number of queries in lanes of single precision.
template <class Lanes>
inline constexpr std::size_t single_width = Lanes::Single::width;

/// Lanes of single precision for the templates of other stages.
template <class Lanes>
struct SingleLanes {
  using Value = typename Lanes::Single;
  using Mask = MaskOf<Value>;
};

/// A coordinate in fixed point, of which differences are floats.
template <class Lanes>
struct FixedPointCoordinate {
  typename Lanes::Rounded whole;

  friend typename Lanes::Single operator-(const FixedPointCoordinate& a,
                                          const FixedPointCoordinate& b) {
    return a.whole - b.whole;
  }
};

/// The vertices of the open pairs in fixed point, by their places in a query. The last pair is
/// repeated to fill the lanes.
using RoundedVertices =
    std::array<std::array<const FixedPointVertex*, kernel_block>, moving_points>;

template <class Lanes>
inline void fill_lanes(RoundedVertices& rounded, std::size_t count) {
  for (std::size_t i = count; i % single_width<Lanes> != 0; ++i) {
    for (auto& vertices : rounded) vertices[i] = vertices[i - 1];
  }
}

/// All pairs of a block.
template <class Lanes, ContactKind kind>
inline void find_rounded(const KernelInput& input, RoundedVertices& rounded, Indices& open) {
  for (std::size_t i = 0; i < input.count; ++i) {
    const auto vertices = FromPairs<Lanes, kind>::vertices(input, i);
    for (std::size_t k = 0; k < moving_points; ++k) {
      rounded[k][i] = input.rounded + vertices[k];
      __builtin_prefetch(rounded[k][i]);
    }
    open.items[i] = static_cast<std::uint32_t>(i);
  }
  open.count = input.count;
  fill_lanes<Lanes>(rounded, open.count);
}

/// The points of the queries that fill the lanes, from `first` on. Inlined always, because the
/// compiler does not in large kernels, and the points then pass through memory.
template <class Lanes>
[[gnu::always_inline]] inline auto load_rounded(const RoundedVertices& rounded, std::size_t first) {
  std::array<Vector<FixedPointCoordinate<Lanes>>, query_points> result;
  for (std::size_t k = 0; k < moving_points; ++k) {
    const FixedPointVertex* const* const vertices = rounded[k].data() + first;
    const auto start = Lanes::Rounded::load(vertices, &FixedPointVertex::start);
    const auto end = Lanes::Rounded::load(vertices, &FixedPointVertex::end);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      result[k][axis].whole = start[axis];
      result[moving_points + k][axis].whole = end[axis];
    }
  }
  return result;
}

/// Examines [0,1] in this number of equal parts.
inline constexpr int parts_of_unit = 4;
template <class Value>
inline Value time_of(int part) {
  using Scalar = typename Value::Scalar;
  return Value(Scalar(part) / Scalar(parts_of_unit));
}

/// The lanes that may have a contact by the tests of determinant and orientation on each part.
template <class Lanes, ContactKind kind>
inline unsigned possible_by_parts(const Ends<typename Lanes::Single>& unit,
                                  const typename Lanes::Single& distance) {
  using Value = typename Lanes::Single;
  const Bounds<Value, kind> bounds = bounds_of<kind, true>(unit, distance);
  MaskOf<Value> free = MaskOf<Value>::all();
  for (int part = 0; part < parts_of_unit; ++part) {
    const auto at = between(unit, time_of<Value>(part), time_of<Value>(part + 1));
    free = free & examine<kind>(at, bounds).has_no_contact();
  }
  return ~free.bits();
}

/// The same by the theorem of moving_polygon.hpp, with the directions of the closest points in L∞
/// at both ends of each part, or at t=0 alone if nothing later counts: where the distance is too
/// large for determinants.
template <class Lanes, ContactKind kind>
inline unsigned possible_by_distance(
    const std::array<Vector<FixedPointCoordinate<Lanes>>, query_points>& points, float distance,
    double t_limit) {
  using Value = typename Lanes::Single;
  using Polygon = MovingPolygon<SingleLanes<Lanes>, kind, Norm::linf>;
  // Products of five coordinates, which are compared, stay below 2^127.
  constexpr float scale = 0x1p-16F;
  PolygonVectors<Value, kind> polygon_vectors(points);
  for (auto& moving : polygon_vectors.vectors) {
    for (Vector<Value>& x : moving) {
      for (Value& coordinate : x) coordinate = coordinate * Value(scale);
    }
  }
  const Polygon polygon(polygon_vectors.vectors, polygon_vectors.magnitude * Value(scale),
                        distance * scale);
  const auto projections_at = [&](int part) {
    return polygon.project(
        typename Polygon::Nearest(polygon.corners_at(time_of<Value>(part))).direction);
  };
  auto of_begin = projections_at(0);
  if (t_limit == 0.0) return ~polygon.ends_apart(of_begin, time_of<Value>(0)).bits();
  MaskOf<Value> free = MaskOf<Value>::all();
  for (int part = 0; part < parts_of_unit; ++part) {
    const auto of_end = projections_at(part + 1);
    const auto begin = time_of<Value>(part), end = time_of<Value>(part + 1);
    free = free & polygon.begins_apart(of_begin, of_end, begin, end, 1) &
           polygon.ends_apart(of_end, end);
    of_begin = of_end;
  }
  return ~free.bits();
}

/// The lanes in which the distance is so large a part of the polygon that determinants prove
/// little.
template <class Value>
inline unsigned large_distances(const Ends<Value>& unit, const Value& distance) {
  constexpr float large = 0x1p-11F;
  return (distance > size_of(unit) * Value(large)).bits();
}

/// Keeps the open queries that a test of their points, possible(points), does not exclude.
template <class Lanes, class Possible>
inline void keep(RoundedVertices& rounded, Indices& open, const Possible& possible) {
  constexpr std::size_t width = single_width<Lanes>;
  Marks<Lanes> kept(open.count);
  for (std::size_t i = 0; i < open.count; i += width) {
    const std::size_t rest = open.count - i;
    const unsigned valid = first_lanes<Lanes>(rest < width ? rest : width);
    kept.add(i, valid & possible(load_rounded<Lanes>(rounded, i)));
  }
  std::size_t count = 0;
  kept.for_each([&](std::size_t i) {
    for (auto& vertices : rounded) vertices[count] = vertices[i];
    open.items[count++] = open.items[i];
  });
  open.count = count;
  fill_lanes<Lanes>(rounded, count);
}

/// Directions after the sum of the corners: of one, two and three, two took the least time.
inline constexpr int more_directions = 2;

template <class Lanes, bool separated, ContactKind kind>
inline void single_precision_tests(const KernelInput& input, Indices& open) {
  using Value = typename Lanes::Single;
  RoundedVertices rounded;
  find_rounded<Lanes, kind>(input, rounded, open);
  const Value distance(input.rounded_distance);
  keep<Lanes>(rounded, open, [&](const auto& points) {
    return ~DirectionTest<Value, true, kind, more_directions>(points, distance).apart.bits();
  });
  keep<Lanes>(rounded, open, [&](const auto& points) {
    const Ends<Value> unit = vectors_of<kind>(points);
    return ~examine<kind>(unit, bounds_of<kind, true>(unit, distance)).has_no_contact().bits();
  });
  keep<Lanes>(rounded, open, [&](const auto& points) {
    const Ends<Value> unit = vectors_of<kind>(points);
    const unsigned far = separated ? large_distances(unit, distance) : 0U;
    const bool are_far = far == MaskOf<Value>::all().bits();
    unsigned possible = are_far ? far : possible_by_parts<Lanes, kind>(unit, distance);
    if constexpr (separated) {
      if ((possible & far) != 0) {
        possible &=
            possible_by_distance<Lanes, kind>(points, input.rounded_distance, input.t_limit);
      }
    }
    return possible;
  });
}

template <class Lanes, bool separated, ContactKind kind>
TOUCHSTONE_INLINE_CALLS inline void single_precision_tests_on_vectors(const KernelInput& input,
                                                                      Indices& open) {
  single_precision_tests<Lanes, separated, kind>(input, open);
}

/// (Calls without vectors stay: to inline them would take minutes.)
/// \param open The queries that are not decided; the others have no contact.
template <class Lanes, bool separated, ContactKind kind>
inline void single_precision_stage(const KernelInput& input, Indices& open) {
  if constexpr (Lanes::width > 1) {
    single_precision_tests_on_vectors<Lanes, separated, kind>(input, open);
  } else {
    single_precision_tests<Lanes, separated, kind>(input, open);
  }
}

}  // namespace touchstone::fast::kernel
