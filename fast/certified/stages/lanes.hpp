#pragma once

/// \file
/// Common parts of the kernel's stages: lists of queries, marks of places in them, and
/// loading the queries' points into lanes.
///
/// `Lanes` is a type of the file of one instruction set (fast/platform/lanes_*.hpp), in an
/// anonymous namespace. It has
/// - Value and Mask: a number and a truth value in each of its `width` lanes, one query a lane;
/// - Row: the three coordinates of one point, and possibly an undefined fourth number;
/// - Single and Rounded: a float and a whole number in each lane, of which there may be more;
/// - load and load_backwards: the points at `width` addresses. load and Row::load may read one
/// number
///   after a point, load_backwards and load_row_backwards one before it.
///
/// Templates on Lanes or its Value are local to that file too, as is all code in the stages apart
/// from expressions, so that no other file links code for its instruction set. Function templates
/// are `inline` because GCC then copies more of them into their callers.

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "fast/certified/kernel.hpp"
#include "touchstone/filters/error_bounds.hpp"
#include "touchstone/filters/polynomial_expressions.hpp"

namespace touchstone::fast::kernel {

/// The limits of a query's size. Larger queries are not decided.
template <class Scalar>
struct Limits {
  /// The maximum distance of a query's points from one of them on each axis: squares and cubes of
  /// the differences do not overflow.
  Scalar distance;
  /// Upper bounds of the differences of any two points, and of sums of differences or of products
  /// of two (of normals: times normal_scale), with a margin for rounding.
  Scalar difference;
  Scalar direction;
};

/// The limits and the error bounds of the stages, by the format of their numbers. The bounds of
/// middle Bernstein coefficients, which are the greatest, serve for all coefficients.
template <class Scalar>
struct StageFormat;

template <>
struct StageFormat<double> {
  static constexpr Limits<double> limits{0x1p100, 0x1p102, 0x1p210};
  /// The factor of normals that are directions.
  static constexpr double normal_scale = 1.0;
  /// The least length, or squared length, by which directions are divided.
  static constexpr double least_length = 0x1p-1000;
  static constexpr auto projected_gap = filters::measured_projected_gap_double;
  static constexpr auto advanced_gap = filters::measured_advanced_gap_double;
  static constexpr auto determinant = filters::measured_determinant_middle_double;
  static constexpr auto orientation = filters::measured_orientation_middle_double;
  static constexpr auto component_sum = filters::component_sum_double;
  static constexpr auto squared_length = filters::squared_length_double;
  static_assert(limits.direction <= projected_gap.greatest_x);
  static_assert(limits.direction <= advanced_gap.greatest_x);
  static_assert(limits.difference <= determinant.greatest_x);
  static_assert(limits.direction <= orientation.greatest_x);
  static_assert(limits.direction <= component_sum.greatest_x);
  static_assert(limits.direction <= squared_length.greatest_x);
  static_assert(filters::measured_determinant_end_double.rounding() <= determinant.rounding());
  static_assert(filters::measured_orientation_end_double.rounding() <= orientation.rounding());
};

/// The limits for whole numbers as coordinates (stages/single_precision.hpp).
template <>
struct StageFormat<float> {
  static constexpr Limits<float> limits{0x1p30F, 0x1p31F, 0x1p41F};
  static constexpr float normal_scale = 0x1p-23F;
  static constexpr float least_length = 0x1p-60F;
  static constexpr auto advanced_gap = filters::measured_advanced_gap_float;
  static constexpr auto determinant = filters::measured_determinant_middle_float;
  static constexpr auto orientation = filters::measured_orientation_middle_float;
  static constexpr auto component_sum = filters::component_sum_float;
  static constexpr auto squared_length = filters::squared_length_float;
  static_assert(limits.direction <= advanced_gap.greatest_x);
  static_assert(limits.difference <= determinant.greatest_x);
  static_assert(limits.direction <= orientation.greatest_x);
  static_assert(limits.direction <= component_sum.greatest_x);
  static_assert(limits.direction <= squared_length.greatest_x);
  static_assert(filters::measured_determinant_end_float.rounding() <= determinant.rounding());
  static_assert(filters::measured_orientation_end_float.rounding() <= orientation.rounding());
};

template <class Value>
using FormatOf = StageFormat<typename Value::Scalar>;

// ---- Lists of queries ---------------------------------------------------------------------------

/// Queries of the block, by their indices.
using Indices = KernelList<std::uint32_t>;

/// Marks of places in a list. Lists are written from these marks at the end of a stage: a store
/// whose address depends on a comparison delays the loads of all later queries.
template <class Lanes>
class Marks {
 public:
  static constexpr std::size_t word_size = 64;

  /// Begins without marks. \param size the length of the list (clearing unused words would take a
  /// single query longer than its stages)
  explicit Marks(std::size_t size) : count_((size + word_size - 1) / word_size) {
    for (std::size_t i = 0; i < count_; ++i) words_[i] = 0;
  }

  void set_word(std::size_t first, std::uint64_t word) { words_[first / word_size] = word; }
  /// Adds places from `first` on, at most to the end of its word.
  void add(std::size_t first, unsigned bits) {
    words_[first / word_size] |= std::uint64_t{bits} << (first % word_size);
  }

  template <class Function>
  void for_each(const Function& function) const {
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::uint64_t rest = words_[i]; rest != 0; rest &= rest - 1) {
        function(word_size * i + static_cast<std::size_t>(__builtin_ctzll(rest)));
      }
    }
  }

 private:
  std::array<std::uint64_t, kernel_block / word_size> words_;
  std::size_t count_;  ///< of words in use
};

template <class Lanes, class Item>
inline void append(KernelList<Item>& list, const Item& item) {
  list.items[list.count++] = item;
}

template <class Lanes>
inline void append_marked(Indices& list, const Indices& from, const Marks<Lanes>& marks) {
  marks.for_each([&](std::size_t place) { append<Lanes>(list, from.items[place]); });
}

/// The number of `count` items that the lanes take from `first` on.
template <class Lanes>
inline std::size_t taken(std::size_t first, std::size_t count) {
  return count - first < Lanes::width ? count - first : Lanes::width;
}

/// The number of times that the lanes are filled for a block.
template <class Lanes>
inline constexpr std::size_t groups_of_block = (kernel_block + Lanes::width - 1) / Lanes::width;

// ---- Lanes --------------------------------------------------------------------------------------

/// A number for each lane, in memory.
template <class Lanes>
using Numbers = std::array<double, Lanes::width>;

/// The first `count` lanes.
template <class Lanes>
inline unsigned first_lanes(std::size_t count) {
  return (1U << count) - 1U;
}

template <class Function>
inline void for_each_lane(unsigned lanes, const Function& function) {
  for (unsigned rest = lanes; rest != 0; rest &= rest - 1) {
    function(static_cast<std::size_t>(__builtin_ctz(rest)));
  }
}

/// The lanes of the mask among the first `count`.
template <class Mask>
inline unsigned valid_bits(const Mask& mask, std::size_t count) {
  return mask.bits() & ((1U << count) - 1U);
}

template <class Lanes>
inline void append_lanes(Indices& list, const std::array<std::uint32_t, Lanes::width>& indices,
                         unsigned lanes) {
  for_each_lane(lanes, [&](std::size_t lane) { append<Lanes>(list, indices[lane]); });
}

template <class Lanes>
inline void store_impacts(KernelOutput& output,
                          const std::array<std::uint32_t, Lanes::width>& indices, unsigned lanes,
                          const std::array<typename Lanes::Value, 2>& enclosure,
                          const std::array<typename Lanes::Value, 2>& uv) {
  alignas(64) std::array<Numbers<Lanes>, 4> rows;
  enclosure[0].store(rows[0].data());
  enclosure[1].store(rows[1].data());
  uv[0].store(rows[2].data());
  uv[1].store(rows[3].data());
  for_each_lane(lanes, [&](std::size_t lane) {
    append<Lanes>(output.impacts, KernelImpact{indices[lane], rows[0][lane], rows[1][lane],
                                               rows[2][lane], rows[3][lane]});
  });
}

// ---- Numbers and vectors of lanes ---------------------------------------------------------------

template <class Value>
using MaskOf = decltype(std::declval<Value>() < std::declval<Value>());

template <class Value>
using Vector = filters::Vector3<Value>;

/// The type of differences of coordinates.
template <class Coordinate>
using DifferenceOf = decltype(std::declval<Coordinate>() - std::declval<Coordinate>());

template <class Coordinate>
inline Vector<DifferenceOf<Coordinate>> minus(const Vector<Coordinate>& a,
                                              const Vector<Coordinate>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// The axes on which a comparison of rows is true, one bit each.
template <class RowMask>
inline unsigned axes_of(const RowMask& mask) {
  return mask.bits() & 0b111U;
}

template <class Row>
inline bool is_finite_row(const Row& row) {
  return axes_of(row - row == Row(0.0)) == 0b111U;
}

/// The greatest magnitude of a component.
template <class Value>
inline Value greatest(const Vector<Value>& a) {
  return max(max(abs(a[0]), abs(a[1])), abs(a[2]));
}

/// The same for a vector that moves between two.
template <class Value>
inline Value magnitude(const std::array<Vector<Value>, 2>& moving) {
  return max(greatest(moving[0]), greatest(moving[1]));
}

/// A time in [0,1] rounded to a multiple of 2^-52, so that 1 minus it is exact.
template <class Value>
inline Value to_exact(const Value& time) {
  return (time + Value(1.0)) - Value(1.0);
}

// ---- Sources of queries -------------------------------------------------------------------------

/// The points of a query: at t=0, then at t=1.
using Points = std::array<const double*, query_points>;

/// An array of queries or cells.
template <class Lanes>
struct FromArray {
  template <class Input>
  static Points points(const Input& input, std::size_t i) {
    const double* const first = input.queries[i].coordinates.data();
    Points result;
    for (std::size_t k = 0; k < query_points; ++k) result[k] = first + 3 * k;
    return result;
  }
  /// False: the memory after a query's last point may belong to other objects.
  static constexpr bool may_read_behind = false;
  /// Several places, because memory is faster then.
  static constexpr std::size_t places_at_once = 4;
  static constexpr bool is_one = false;
};

/// An array of one query.
template <class Lanes>
struct FromOne : FromArray<Lanes> {
  static constexpr bool is_one = true;
};

/// Pairs of primitives of a mesh.
template <class Lanes, ContactKind kind>
struct FromPairs {
  /// The vertices of a pair.
  static std::array<std::int32_t, moving_points> vertices(const KernelInput& input, std::size_t i) {
    const auto [first, second] = input.pairs[i];
    if constexpr (kind == ContactKind::vertex_face) {
      const Face& face = input.faces[static_cast<std::size_t>(second)];
      return {first, face[0], face[1], face[2]};
    } else {
      const Edge& a = input.edges[static_cast<std::size_t>(first)];
      const Edge& b = input.edges[static_cast<std::size_t>(second)];
      return {a[0], a[1], b[0], b[1]};
    }
  }
  static Points points(const KernelInput& input, std::size_t i) {
    const std::array<std::int32_t, moving_points> indices = vertices(input, i);
    Points result;
    for (std::size_t k = 0; k < moving_points; ++k) {
      const MovingVertex& vertex = input.vertices[static_cast<std::size_t>(indices[k])];
      result[k] = vertex.start.data();
      result[moving_points + k] = vertex.end.data();
    }
    return result;
  }
  static constexpr bool may_read_behind = true;
  /// One place at a time, because neighbours share vertices, which are in the cache.
  static constexpr std::size_t places_at_once = 1;
  static constexpr bool is_one = false;
};

/// The points of one query, the same in all lanes.
template <class Lanes>
inline std::array<Vector<typename Lanes::Value>, query_points> in_all_lanes(const Points& points) {
  using Value = typename Lanes::Value;
  std::array<Vector<Value>, query_points> result;
  for (std::size_t k = 0; k < query_points; ++k) {
    for (std::size_t axis = 0; axis < 3; ++axis) result[k][axis] = Value(points[k][axis]);
  }
  return result;
}

/// The points of `width` queries or cells, lane by lane. Lanes beyond `count` repeat the last. A
/// source whose points are not in memory as such has a function for it.
template <class Lanes, class Source, class Input>
inline std::array<Vector<typename Lanes::Value>, query_points> load(const Input& input,
                                                                    const std::uint32_t* indices,
                                                                    std::size_t count) {
  if constexpr (requires { Source::load(input, indices, count); }) {
    return Source::load(input, indices, count);
  } else if constexpr (Source::is_one) {
    return in_all_lanes<Lanes>(Source::points(input, indices[0]));
  } else {
    std::array<std::array<const double*, Lanes::width>, query_points> rows;
    for (std::size_t lane = 0; lane < Lanes::width; ++lane) {
      const Points points = Source::points(input, indices[lane < count ? lane : count - 1]);
      for (std::size_t k = 0; k < query_points; ++k) rows[k][lane] = points[k];
    }
    std::array<Vector<typename Lanes::Value>, query_points> result;
    for (std::size_t k = 0; k + 1 < query_points; ++k) result[k] = Lanes::load(rows[k]);
    result[7] = Source::may_read_behind ? Lanes::load(rows[7]) : Lanes::load_backwards(rows[7]);
    return result;
  }
}

}  // namespace touchstone::fast::kernel
