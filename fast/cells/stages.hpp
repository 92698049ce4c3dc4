#pragma once

/// \file
/// The stages for cells (docs/theory.md, section 10).
///
/// The volume of a tetrahedron a, b, c, d is that of the stage determinant: with r = a − b,
/// p = c − b and q = d − b,
///
///     det = r·(p×q) = −6 V,
///
/// so its Bernstein coefficients and error bounds are those of stages/determinant.hpp. A triangle
/// in the plane is the tetrahedron with d = b + (0,0,1) (touchstone/cell.hpp): q is exact.
///
/// **Theorem.** On [0,1]:
/// 1. If the first coefficient of det is certainly positive, the cell is inverted at t=0.
/// 2. If all are certainly negative, V > 0 throughout.
/// 3. If they certainly change sign once, from negative to positive, V has exactly one zero
///    (Descartes), and that is the first time.
/// If the first one is certainly negative and neither 2. nor 3. holds, intervals are examined in
/// ascending order (stages/bisection.hpp). V is positive at the beginning of each, for it is so at
/// 0 and up to the end of each interval that is skipped. So an interval on which all coefficients
/// have one sign is skipped, and the only zero in the first other one that is decided is the first
/// time. stages/refinement.hpp encloses it.
///
/// **A part f of the volume at t=0 to be kept**, 0 < f < 1: V is replaced by V − f V(0), whose
/// Bernstein coefficients are those of V less f V(0). *Theorem.* With 5 times the bounds, all of
/// the above holds for this. Proof. Let m be the product |r| |p| |q|, and u = 2^-53. The
/// coefficients (the middle ones times 3) are at most 18 m, nearly. If β bounds their errors, the
/// one of f det(0) times 3 adds at most 3 β. The two products and the difference round numbers of
/// at most 6 m (this error counts three times), 18 m and 36 m: by less than 73 u m, and by the
/// least double for underflow, all of which is less than β, as that is at least 144 u m and more
/// than the least doubles. In double-double f det(0) adds one β, and its product and the difference
/// are wrong by 8 u² times at most 6 m and 12 m, again less than β. ∎
///
/// A cell that does not invert up to t_limit is left out as soon as a test of [0, t_limit]
/// shows that; the others have the same result for any limit.
///
/// A cell with another first coefficient is left to integers, as is one that is too large for the
/// bounds or not finite. If the coefficients of det at both ends, products with each coordinate of
/// r, p and q as a factor, are finite, so are these.

#include <array>
#include <cstddef>
#include <cstdint>

#include "fast/certified/stages/bisection.hpp"
#include "fast/certified/stages/crossing.hpp"
#include "fast/certified/stages/determinant.hpp"
#include "fast/certified/stages/lanes.hpp"
#include "fast/certified/stages/moving_vectors.hpp"
#include "fast/certified/stages/orientation.hpp"
#include "fast/certified/stages/refinement.hpp"

namespace touchstone::fast::kernel {

// ---- Where cells come from ----------------------------------------------------------------------

template <class Value>
using Tetrahedra = std::array<Vector<Value>, query_points>;

/// An array of queries in its order, as the first stage takes them: their addresses differ by
/// constants. Lanes beyond `count` repeat the last.
template <class Lanes>
struct InOrder {
  static Tetrahedra<typename Lanes::Value> load(const CellInput& input,
                                                const std::uint32_t* indices, std::size_t count) {
    const double* const first = input.queries[indices[0]].coordinates.data();
    const auto load_places = [&](const auto& place) {
      Tetrahedra<typename Lanes::Value> result;
      for (std::size_t k = 0; k < query_points; ++k) {
        std::array<const double*, Lanes::width> row;
        for (std::size_t lane = 0; lane < Lanes::width; ++lane) {
          row[lane] = first + 3 * (query_points * place(lane) + k);
        }
        // The memory after the last one may belong to other objects.
        result[k] = k + 1 < query_points ? Lanes::load(row) : Lanes::load_backwards(row);
      }
      return result;
    };
    if (count == Lanes::width) return load_places([](std::size_t lane) { return lane; });
    return load_places([&](std::size_t lane) { return lane < count ? lane : count - 1; });
  }
};

/// Tetrahedra of a mesh.
template <class Lanes>
struct FromTetrahedra {
  static Points points(const CellInput& input, std::size_t i) {
    Points result;
    for (std::size_t k = 0; k < moving_points; ++k) {
      const auto number = static_cast<std::size_t>(input.corners[moving_points * i + k]);
      result[k] = input.vertices[number].start.data();
      result[moving_points + k] = input.vertices[number].end.data();
    }
    return result;
  }
  static constexpr bool may_read_behind = true;
  static constexpr bool is_one = false;
};

/// Makes the points of triangles in the plane, at t=0 and t=1, those of tetrahedra; the third
/// coordinates and the fourth points have no effect.
template <class Value>
inline void raise(Tetrahedra<Value>& points) {
  for (std::size_t k = 0; k < query_points; ++k) {
    if (k % moving_points == 3) points[k] = points[k - 2];
    points[k][2] = Value(k % moving_points == 3 ? 1.0 : 0.0);
  }
}

/// Triangles in the plane of a source.
template <class Lanes, class Source>
struct InPlane {
  static Tetrahedra<typename Lanes::Value> load(const CellInput& input,
                                                const std::uint32_t* indices, std::size_t count) {
    auto points = kernel::load<Lanes, Source>(input, indices, count);
    raise(points);
    return points;
  }
};

/// Triangles of a mesh in the plane.
template <class Lanes>
struct FromTriangles {
  using Value = typename Lanes::Value;

  static Tetrahedra<Value> load(const CellInput& input, const std::uint32_t* indices,
                                std::size_t count) {
    Tetrahedra<Value> points;
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<std::array<const double*, Lanes::width>, 2> rows;
      for (std::size_t lane = 0; lane < Lanes::width; ++lane) {
        const std::size_t cell = indices[lane < count ? lane : count - 1];
        const MovingVertex& vertex =
            input.vertices[static_cast<std::size_t>(input.corners[3 * cell + k])];
        rows[0][lane] = vertex.start.data();
        rows[1][lane] = vertex.end.data();
      }
      points[k] = Lanes::load(rows[0]);
      points[moving_points + k] = Lanes::load(rows[1]);
    }
    raise(points);
    return points;
  }
};

// ---- The stages ---------------------------------------------------------------------------------

/// What is proved of the volume on an interval at whose beginning it is positive.
struct ExamineVolume {
  template <class Value>
  struct Found {
    std::array<Value, 4> coefficients;  ///< of det
    DeterminantTest<Value> determinant;

    [[nodiscard]] MaskOf<Value> has_no_contact() const { return determinant.one_sided; }
    [[nodiscard]] MaskOf<Value> has_contact() const { return determinant.crosses_once; }
  };

  template <class Value>
  [[nodiscard]] static Found<Value> on(std::array<Value, 4> coefficients, const Value& of_start,
                                       const Value& bound) {
    const Value thrice = of_start * Value(3.0);
    coefficients = {coefficients[0] - of_start, coefficients[1] - thrice, coefficients[2] - thrice,
                    coefficients[3] - of_start};
    return {coefficients, {coefficients, bound}};
  }
  /// \param bounds of_volume
  template <class Value>
  [[nodiscard]] static Found<Value> on(const Ends<Value>& at,
                                       const Bounds<Value, ContactKind::vertex_face>& bounds) {
    return on(determinant_coefficients(at, Normals<Value>(at)), bounds.orientation_scale[0],
              bounds.determinant);
  }
};
static_assert(StageFormat<double>::determinant.rounding() >= 144 * 0x1p-53 &&
              filters::determinant_end_double_double.rounding() >= 144 * 0x1p-106);

/// The bound of det, and in the place of an orientation's the part of det at t=0 that is to be
/// kept.
template <class Value>
inline Bounds<Value, ContactKind::vertex_face> of_volume(const Ends<Value>& unit,
                                                         const Value& at_start, double kept) {
  const Value bound = determinant_bound<false>(unit, Value(0.0));
  return {bound * Value(kept > 0.0 ? kept_growth : 1.0), {at_start * Value(kept)}};
}

/// Examines [0,1].
/// \param crossings The cells whose first time is the only zero of det.
/// \param mixed Those with a positive volume at t=0 of which nothing else is proved.
template <class Lanes, class Source>
TOUCHSTONE_INLINE_CALLS inline void volume_stage(const CellInput& input, const Indices& all,
                                                 Crossings& crossings, Indices& mixed,
                                                 CellOutput& output) {
  using Value = typename Lanes::Value;
  using Mask = MaskOf<Value>;
  Marks<Lanes> of_inverted(all.count), of_crossings(all.count), of_mixed(all.count),
      of_rest(all.count);
  Intervals<Lanes> intervals;
  const Value zero(0.0), limit(StageFormat<double>::limits.difference);
  // (1 − end is exact.)
  const double end =
      static_cast<double>(static_cast<std::uint64_t>(input.t_limit * 0x1p40) + 1) * 0x1p-40;
  for (std::size_t first = 0; first < all.count; first += Lanes::width) {
    const std::size_t count = taken<Lanes>(first, all.count);
    const Ends<Value> unit = vectors_of<ContactKind::vertex_face>(
        load<Lanes, Source>(input, all.items.data() + first, count));
    const std::array<Value, 4> whole = determinant_coefficients(unit, Normals<Value>(unit));
    const auto bounds = of_volume(unit, whole[0], input.kept_volume);
    const Value& bound = bounds.determinant;
    const auto found = ExamineVolume::on(whole, bounds.orientation_scale[0], bound);
    const auto& c = found.coefficients;
    const Mask is_bounded = (size_of(unit) <= limit) & ((c[0] - c[0]) + (c[3] - c[3]) <= zero);
    const Mask is_positive = is_bounded & (c[0] < zero - bound);
    const unsigned valid = first_lanes<Lanes>(count);
    const unsigned positive = is_positive.bits() & valid;
    unsigned free = positive & found.determinant.one_sided.bits();
    if (end < 1.0 && free != positive) {
      const auto until = ExamineVolume::on(between(unit, zero, Value(end)), bounds);
      free |= positive & until.determinant.one_sided.bits();
    }
    if (free == valid) continue;
    const unsigned inverted = (is_bounded & (c[0] > bound)).bits() & valid;
    const unsigned crossing = positive & ~free & found.determinant.crosses_once.bits();
    if (crossing != 0) intervals.store(first, zero, Value(1.0), c);
    of_inverted.add(first, inverted);
    of_crossings.add(first, crossing);
    of_mixed.add(first, positive & ~free & ~crossing);
    of_rest.add(first, valid & ~positive & ~inverted);
  }
  append_marked(output.inverted, all, of_inverted);
  append_marked(output.undecided, all, of_rest);
  append_marked(mixed, all, of_mixed);
  of_crossings.for_each([&](std::size_t place) {
    append<Lanes>(crossings, intervals.crossing(place, all.items[place]));
  });
}

/// \tparam First the source for the first stage: of one cell, of cells in order, or Source
template <class Lanes, class Source, class First = Source>
void invert_from(const CellInput& input, CellOutput& output) {
  constexpr ContactKind kind = ContactKind::vertex_face;
  output.inverted.count = output.inversions.count = output.undecided.count = 0;
  Indices all, mixed, free;
  for (; all.count < input.count; ++all.count) {
    all.items[all.count] = static_cast<std::uint32_t>(all.count);
  }
  Crossings crossings;
  volume_stage<Lanes, First>(input, all, crossings, mixed, output);
  if (crossings.count + mixed.count == 0) return;
  Moving<Lanes, kind> moving;
  load_moving<Lanes, kind, Source>(input, mixed, moving, [&](const auto& unit) {
    const auto at_start = filters::dot(unit[r][0], filters::cross(unit[p][0], unit[q][0]));
    return of_volume(unit, at_start, input.kept_volume);
  });
  Bisection<Lanes, kind, ExamineVolume>(input.t_limit, moving, crossings, free, output.undecided)
      .run();
  Refinement<Lanes, false, kind, Source>::run(input, crossings, output.undecided, output);
}

template <class Lanes>
void invert(const CellInput& input, CellOutput& output) {
  if (input.queries == nullptr && input.kind == CellKind::tetrahedron) {
    invert_from<Lanes, FromTetrahedra<Lanes>>(input, output);
  } else if (input.queries == nullptr) {
    invert_from<Lanes, FromTriangles<Lanes>>(input, output);
  } else if (input.kind == CellKind::plane_triangle) {
    invert_from<Lanes, InPlane<Lanes, FromArray<Lanes>>, InPlane<Lanes, InOrder<Lanes>>>(input,
                                                                                         output);
  } else if (input.count == 1) {
    invert_from<Lanes, FromArray<Lanes>, FromOne<Lanes>>(input, output);
  } else {
    invert_from<Lanes, FromArray<Lanes>, InOrder<Lanes>>(input, output);
  }
}

}  // namespace touchstone::fast::kernel
