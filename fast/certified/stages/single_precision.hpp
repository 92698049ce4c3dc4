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
/// The coordinates of rounded queries are whole numbers (fast/certified/fixed_point_vertices.hpp).
/// A difference of two is exact, and rounded once, to a float. So the stages' expressions have the
/// error bounds that are derived for float.

#include <array>
#include <cstddef>

#include "fast/certified/fixed_point_vertices.hpp"
#include "fast/certified/stages/determinant.hpp"
#include "fast/certified/stages/direction.hpp"
#include "fast/certified/stages/lanes.hpp"
#include "fast/certified/stages/moving_vectors.hpp"
#include "fast/certified/stages/orientation.hpp"

namespace touchstone::fast::kernel {

/// Number of queries in lanes of single precision.
inline constexpr std::size_t single_width = 16;

/// A coordinate in fixed point, of which differences are floats.
template <class Lanes>
struct FixedPointCoordinate {
  typename Lanes::Rounded whole;

  friend typename Lanes::Single operator-(const FixedPointCoordinate& a,
                                          const FixedPointCoordinate& b) {
    return a.whole - b.whole;
  }
};

/// The vertices of pairs in fixed point, by their places in a query.
template <class Lanes, std::size_t count>
using RoundedVertices = std::array<std::array<const FixedPointVertex*, count>, moving_points>;

/// The vertices of a block. The last pair is repeated to fill the lanes.
template <class Lanes, Kind kind>
inline void find_rounded(const KernelInput& input, RoundedVertices<Lanes, kernel_block>& rounded) {
  std::size_t i = 0;
  for (; i < input.count; ++i) {
    const auto vertices = FromPairs<Lanes, kind>::vertices(input, i);
    for (std::size_t k = 0; k < moving_points; ++k) {
      rounded[k][i] = input.rounded + vertices[k];
    }
  }
  for (; i % single_width != 0; ++i) {
    for (auto& vertices : rounded) vertices[i] = vertices[i - 1];
  }
}

/// The points of sixteen queries from `first` on.
template <class Lanes, std::size_t count>
inline auto load_rounded(const RoundedVertices<Lanes, count>& rounded, std::size_t first) {
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

/// The tests of determinant and orientation on parts of [0,1], where they did not suffice on all
/// of it. \param open The queries; then those that are not decided.
template <class Lanes, Kind kind>
inline void parts_stage(const RoundedVertices<Lanes, kernel_block>& rounded, float distance,
                        Indices& open, KernelOutput& output) {
  using Value = typename Lanes::Single;
  static constexpr float parts = 4;
  Marks<Lanes> of_none, of_all;
  RoundedVertices<Lanes, single_width> some;
  for (std::size_t first = 0; first < open.count; first += single_width) {
    for (std::size_t lane = 0; lane < single_width; ++lane) {
      const std::size_t place =
          open.items[first + lane < open.count ? first + lane : open.count - 1];
      for (std::size_t k = 0; k < moving_points; ++k) some[k][lane] = rounded[k][place];
    }
    const Ends<Value> unit = vectors_of<kind>(load_rounded<Lanes>(some, 0));
    const Bounds<Value, kind> bounds = bounds_of<kind, true>(unit, Value(distance));
    unsigned rest =
        first_lanes<Lanes>(open.count - first < single_width ? open.count - first : single_width);
    const unsigned valid = rest;
    unsigned possible = 0;
    for (float part = 0; part < parts && possible != valid; part += 1) {
      const auto found =
          examine<kind>(between(unit, Value(part / parts), Value((part + 1) / parts)), bounds);
      possible |= valid & ~found.has_no_contact().bits();
    }
    of_none.add(first, possible);
    of_all.add(first, valid & ~possible);
  }
  of_all.for_each([&](std::size_t i) { append<Lanes>(output.rejected, open.items[i]); });
  std::size_t count = 0;
  of_none.for_each([&](std::size_t i) { open.items[count++] = open.items[i]; });
  open.count = count;
}

/// \param mixed The queries that are not decided.
template <class Lanes, Kind kind>
inline void single_precision_stage(const KernelInput& input, Indices& mixed, KernelOutput& output) {
  using Value = typename Lanes::Single;
  Marks<Lanes> of_direction, of_determinant, of_orientation, of_none;
  RoundedVertices<Lanes, kernel_block> rounded;
  find_rounded<Lanes, kind>(input, rounded);
  const Value distance(input.rounded_distance);
  for (std::size_t first = 0; first < input.count; first += single_width) {
    for (std::size_t i = first + single_width; i < first + 2 * single_width && i < input.count;
         ++i) {
      for (const auto& vertices : rounded) __builtin_prefetch(vertices[i]);
    }
    const auto points = load_rounded<Lanes>(rounded, first);
    const DirectionTest<Value, true, kind> direction(points, distance);
    const Ends<Value> at = vectors_of<kind>(points);
    const Normals<Value> normals(at);
    const Bounds<Value, kind> bounds = bounds_of<kind, true>(at, distance);
    const DeterminantTest<Value> determinant(determinant_coefficients(at, normals),
                                             bounds.determinant);
    const OrientationTest<Value> orientation =
        test_orientations<kind>(normals.middle(), at, bounds);
    const unsigned valid =
        first_lanes<Lanes>(input.count - first < single_width ? input.count - first : single_width);
    const unsigned apart = direction.apart.bits();
    const unsigned one_sided = determinant.one_sided.bits() & ~apart;
    const unsigned opposed = orientation.opposed.bits() & ~apart & ~one_sided;
    of_direction.add(first, valid & apart);
    of_determinant.add(first, valid & one_sided);
    of_orientation.add(first, valid & opposed);
    of_none.add(first, valid & ~(apart | one_sided | opposed));
  }
  const auto append_to = [](Indices& list) {
    return [&list](std::size_t place) { append<Lanes>(list, static_cast<std::uint32_t>(place)); };
  };
  of_direction.for_each(append_to(output.separated_in_direction));
  of_determinant.for_each(append_to(output.one_sided));
  of_orientation.for_each(append_to(output.rejected));
  mixed.count = 0;
  of_none.for_each(append_to(mixed));
  parts_stage<Lanes, kind>(rounded, input.rounded_distance, mixed, output);
}

}  // namespace touchstone::fast::kernel
