#pragma once

/// \file
/// The floating-point stages of the certified solver, written once for lanes: each lane has a query.
/// For the kernels alone: one file an instruction set includes this one (kernel_*.cpp).
///
/// F = r − u p − v q (filters/polynomial_expressions.hpp), the corners w_i are F at the vertices of
/// its domain, and a query collides at a time t iff 0 ∈ conv{w_i(t)}. Each stage ends the queries
/// that it can prove something of:
///
/// 1. **Axis.** On some coordinate axis all corners are on one side of 0 at t=0, and on the same at
///    t=1. They move linearly, so they are there all the time. Signs of differences are comparisons:
///    nothing is rounded.
/// 2. **Direction.** The same for d·w_i, with d the sum of the corners or a normal in between; beyond
///    its error bound.
/// 3. **Determinant**, and 4. **bisection.** An interval [a,b] of times, first [0,1]:
///    - det = r·(p×q) vanishes at each contact: no contact if its Bernstein coefficients on [a,b]
///      are all beyond their bound on one side.
///    - Let d be a fixed direction and o_i = d·(w_i × w_{i+1}) the orientations of consecutive
///      corners. If 0 = Σ λ_i w_i with barycentric λ ≥ 0, each o_i is d·N times a number ≥ 0: in a
///      contact they all have one sign. No contact if two of them keep opposite signs on [a,b].
///    - If all of them keep one sign (not 0) on [a,b], so does d·N, the sum of three of them or of
///      two opposite ones. Hence N ≠ 0, and each zero of det in [a,b] is a contact, in the inside of
///      the primitives. If the coefficients of det change sign once, certainly, it has exactly one
///      zero there (Descartes' rule for Bernstein coefficients).
///    If det changes sign once on [0,1], certainly, only its zero matters: where that is, Newton's
///    method tells well enough for a short interval, on which det must change sign too, and if need be
///    for a very short one. Elsewhere intervals are taken in order of time, halved if nothing is
///    proved, so that what is before the current one has no contact, and the zero found is the time of
///    impact.
/// 5. **Refinement.** Newton's method finds the zero; an enclosure around it, clipped to [a,b], is
///    right if det, in double-double, has at its ends the signs that it has at a and b, beyond the
///    bound of its value. If not, these two values tell where it is better.
///
/// **With a minimum separation** D, contact is a point of the polygon within D of the origin, and "no
/// contact" has to be proved of the polygon shifted by any x with ‖x‖ ≤ D: r becomes r − x, and so does
/// what is in its place in an orientation. That changes det by at most D ‖N‖₁ ≤ 4 D |p| |q| = b
/// (components' greatest magnitudes: a determinant of three vectors of ±1 is at most 4), and x·(d × y) by
/// at most 4 D |d| |y|; the middle coefficients, as they are computed, by thrice and twice that. The
/// coefficients' bounds are wider by thrice, and 3. to 5. hold as they are: a contact at a zero of det is
/// one at distance 0, and det, det + b and det − b cross zero once each on an interval on which det's
/// coefficients are seen to, so that there is no contact up to a time at which det is still more than b
/// away from 0.
///
/// But the zero of det is later than the time of impact. Where that is more than an enclosure's width,
/// det only tells of a time up to which there is no contact, and what follows is the other stage's:
/// fast/certified/stages/conservative_advancement.hpp. To it goes, too, all of which the shift leaves too little to tell.
///
/// Queries that no stage ends, or whose coordinates are so large, or not numbers, that the bounds do
/// not hold, are undecided here.
///
/// Lanes is a type local to its file (anonymous namespace) with Value and Mask (a lane each), Row
/// and RowMask (a point each), so that all that is instantiated here stays in that file.

#include <array>
#include <cstddef>
#include <cstdint>

#include "fast/certified/kernel.hpp"
#include "fast/certified/stages/conservative_advancement.hpp"
#include "filters/double_double.hpp"
#include "filters/error_bounds.hpp"
#include "filters/polynomial_expressions.hpp"

namespace touchstone::fast {

/// Queries are taken whose points are this near to one of them on each axis. Squares and cubes of
/// their differences are far from overflow.
inline constexpr double greatest_distance = 0x1p100;
/// What differences of any two of the points stay below, and sums of these or of products of two:
/// with room for rounding.
inline constexpr double greatest_difference = 0x1p102;
inline constexpr double greatest_direction = 0x1p210;
/// Where the distance times this exceeds the sizes of a query, shifts by it leave polynomials too little
/// to tell.
inline constexpr double greatest_shift = 0x1p16;

// What underflow adds to an error, at most: so small that no scene needs it smaller.
inline constexpr double gap_underflow =
    filters::measured_projected_gap_double.underflow(greatest_direction);
inline constexpr double advanced_gap_underflow =
    filters::measured_advanced_gap_double.underflow(greatest_direction);
inline constexpr double determinant_underflow =
    filters::measured_determinant_middle_double.underflow(greatest_difference);
inline constexpr double orientation_underflow =
    filters::measured_orientation_middle_double.underflow(greatest_direction);
inline constexpr double double_double_underflow =
    filters::determinant_end_double_double.underflow(greatest_difference);
static_assert(greatest_direction <= filters::measured_projected_gap_double.greatest_x);
static_assert(greatest_direction <= filters::measured_advanced_gap_double.greatest_x);
static_assert(greatest_difference <= filters::determinant_end_double_double.greatest_x);
static_assert(greatest_direction <= filters::measured_orientation_middle_double.greatest_x);
// One bound serves all Bernstein coefficients of a polynomial: that of the middle ones is greater.
static_assert(filters::measured_determinant_end_double.rounding() <=
              filters::measured_determinant_middle_double.rounding());
static_assert(filters::measured_orientation_end_double.rounding() <=
              filters::measured_orientation_middle_double.rounding());

template <class Lanes, bool separated>
class CertifiedStages {
 public:
  static void decide(const KernelInput& input, KernelOutput& output) {
    if (input.kind == Kind::vertex_face) {
      decide_kind<Kind::vertex_face>(input, output);
    } else {
      decide_kind<Kind::edge_edge>(input, output);
    }
  }

  static double product_then_sum(double a, double b, double c) {
    std::array<double, Lanes::width> result;
    (Value(a) * Value(b) + Value(c)).store(result.data());
    return result[0];
  }

 private:
  using Value = typename Lanes::Value;
  using Mask = typename Lanes::Mask;
  using Row = typename Lanes::Row;
  using RowMask = typename Lanes::RowMask;
  using Vector = std::array<Value, 3>;
  static constexpr std::size_t width = Lanes::width;

  /// Items of the block.
  template <class Item>
  using List = KernelOutput::List<Item>;
  /// Queries of the block, by their indices.
  using Indices = List<std::uint32_t>;

  /// The points of a query: at t=0, then at t=1.
  using Points = std::array<const double*, query_points>;

  template <Kind kind>
  static void decide_kind(const KernelInput& input, KernelOutput& output) {
    if (input.queries != nullptr) {
      run_stages<kind, FromArray>(input, output);
    } else {
      run_stages<kind, FromPairs<kind>>(input, output);
    }
  }

  template <Kind kind, class Source>
  static void run_stages(const KernelInput& input, KernelOutput& output) {
    output.separated_in_direction.count = output.one_sided.count = 0;
    output.rejected.count = output.hits.count = output.undecided.count = 0;
    Indices open, mixed, far, undecided;
    axis_stage<kind, Source>(input, open);
    unit_interval_stages<kind, Source>(input, open, mixed, output);
    far.count = 0;
    Crossings contacts, zeros;
    orientation_stage<kind, Source>(input, mixed, contacts, zeros, undecided, far, output);
    Indices& hopeless = separated ? far : output.undecided;
    zero_stages<kind, Source>(input, zeros, contacts, undecided, hopeless, far, output);
    Moving<kind> moving;
    load_moving<kind, Source>(input, undecided, moving);
    Bisection<kind>(input, moving, contacts, output.rejected, hopeless).run();
    refine<kind, Source>(input, contacts, hopeless, output);
    if constexpr (separated) {
      with_norm(input.separation.norm,
                [&]<Norm norm>() { advance_stage<kind, Source, norm>(input, far, output); });
    }
  }

  // ---- Lists of queries -------------------------------------------------------------------------

  /// Which places of a list are meant. Lists are written from these marks when a stage is through: a
  /// store whose address depends on a comparison delays the loads of all queries behind it.
  class Marks {
   public:
    static constexpr std::size_t word_size = 64;

    void set_word(std::size_t first, std::uint64_t word) { words_[first / word_size] = word; }
    /// Adds places from `first` on, no more than are left in its word.
    void add(std::size_t first, unsigned bits) {
      words_[first / word_size] |= std::uint64_t{bits} << (first % word_size);
    }

    template <class Function>
    void for_each(const Function& function) const {
      for (std::size_t i = 0; i < words_.size(); ++i) {
        for (std::uint64_t rest = words_[i]; rest != 0; rest &= rest - 1) {
          function(word_size * i + static_cast<std::size_t>(__builtin_ctzll(rest)));
        }
      }
    }

   private:
    std::array<std::uint64_t, kernel_block / word_size> words_{};
  };

  template <class Item>
  static void append(List<Item>& list, const Item& item) {
    list.items[list.count++] = item;
  }

  static void append_marked(Indices& list, const Indices& from, const Marks& marks) {
    marks.for_each([&](std::size_t place) { append(list, from.items[place]); });
  }

  /// How many of `count` items the lanes take from `first` on.
  static std::size_t taken(std::size_t first, std::size_t count) {
    return count - first < width ? count - first : width;
  }

  /// The first `count` lanes.
  static unsigned first_lanes(std::size_t count) { return (1U << count) - 1U; }

  template <class Function>
  static void for_each_lane(unsigned lanes, const Function& function) {
    for (unsigned rest = lanes; rest != 0; rest &= rest - 1) {
      function(static_cast<std::size_t>(__builtin_ctz(rest)));
    }
  }

  /// What of the first `count` lanes is in the mask.
  static unsigned valid_bits(const Mask& mask, std::size_t count) {
    return mask.bits() & first_lanes(count);
  }

  // ---- Where queries come from ------------------------------------------------------------------

  struct FromArray {
    static Points points(const KernelInput& input, std::size_t i) {
      const double* const first = input.queries[i].coordinates.data();
      Points result;
      for (std::size_t k = 0; k < query_points; ++k) result[k] = first + 3 * k;
      return result;
    }
    /// What is behind a query's last point may be another's memory.
    static constexpr bool may_read_behind = false;
    /// Memory is faster when read at several places at once.
    static constexpr std::size_t places_at_once = 4;
  };

  template <Kind kind>
  struct FromPairs {
    static Points points(const KernelInput& input, std::size_t i) {
      const auto [first, second] = input.pairs[i];
      std::array<std::int32_t, 4> indices;
      if constexpr (kind == Kind::vertex_face) {
        const Face& face = input.faces[static_cast<std::size_t>(second)];
        indices = {first, face[0], face[1], face[2]};
      } else {
        const Edge& a = input.edges[static_cast<std::size_t>(first)];
        const Edge& b = input.edges[static_cast<std::size_t>(second)];
        indices = {a[0], a[1], b[0], b[1]};
      }
      Points result;
      for (std::size_t k = 0; k < moving_points; ++k) {
        const MovingVertex& vertex = input.vertices[static_cast<std::size_t>(indices[k])];
        result[k] = vertex.start.data();
        result[moving_points + k] = vertex.end.data();
      }
      return result;
    }
    static constexpr bool may_read_behind = true;
    /// Neighbours share vertices, and these come from the cache.
    static constexpr std::size_t places_at_once = 1;
  };

  // ---- 1. Axis ----------------------------------------------------------------------------------

  template <Kind kind, class Source>
  static void axis_stage(const KernelInput& input, Indices& open) {
    Marks marks;
    constexpr std::size_t words = Source::places_at_once;
    std::size_t first = 0;
    for (; first + words * Marks::word_size <= input.count; first += words * Marks::word_size) {
      mark_open<kind, Source, words>(input, first, Marks::word_size, marks);
    }
    for (; first < input.count; first += Marks::word_size) {
      const std::size_t rest = input.count - first;
      mark_open<kind, Source, 1>(input, first, rest < Marks::word_size ? rest : Marks::word_size,
                                 marks);
    }
    open.count = 0;
    marks.for_each([&](std::size_t i) { append(open, static_cast<std::uint32_t>(i)); });
  }

  /// Marks the queries that no axis separates: `count` in each of some words.
  template <Kind kind, class Source, std::size_t word_count>
  static void mark_open(const KernelInput& input, std::size_t first, std::size_t count,
                        Marks& marks) {
    std::array<std::uint64_t, word_count> words{};
    const Row distance(input.separation.distance);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < word_count; ++k) {
        const Points points = Source::points(input, first + k * Marks::word_size + i);
        words[k] |= std::uint64_t{!separated_on_axis<kind, Source>(points, distance)} << i;
      }
    }
    for (std::size_t k = 0; k < word_count; ++k) {
      marks.set_word(first + k * Marks::word_size, words[k]);
    }
  }

  template <Kind kind, class Source>
  static bool separated_on_axis(const Points& points, const Row& distance) {
    std::array<Row, query_points> rows;
    for (std::size_t k = 0; k + 1 < query_points; ++k) rows[k] = Row::load(points[k]);
    rows[7] = Source::may_read_behind ? Row::load(points[7]) : Row::load_backwards(points[7]);
    const Sides start = sides<kind>(rows[0], rows[1], rows[2], rows[3], distance);
    const Sides end = sides<kind>(rows[4], rows[5], rows[6], rows[7], distance);
    const Row sum =
        ((rows[0] + rows[1]) + (rows[2] + rows[3])) + ((rows[4] + rows[5]) + (rows[6] + rows[7]));
    // Not &&: which queries end here nobody can predict, a processor neither.
    const bool is_separated = ((start.above & end.above) | (start.below & end.below)).any();
    return is_separated & sum.is_finite();
  }

  /// On which axes the first primitive is above the second, and below.
  struct Sides {
    RowMask above;
    RowMask below;
  };

  /// By more than the distance: a rounded difference that is greater is truly so, as rounding is
  /// monotone and leaves the distance as it is.
  template <Kind kind>
  static Sides sides(const Row& a, const Row& b, const Row& c, const Row& d, const Row& distance) {
    if constexpr (kind == Kind::vertex_face) {
      return sides(a, a, max(max(b, c), d), min(min(b, c), d), distance);
    } else {
      return sides(min(a, b), max(a, b), max(c, d), min(c, d), distance);
    }
  }

  static Sides sides(const Row& least_a, const Row& greatest_a, const Row& greatest_b,
                     const Row& least_b, const Row& distance) {
    if constexpr (separated) {
      return {least_a - greatest_b > distance, least_b - greatest_a > distance};
    } else {
      return {least_a > greatest_b, greatest_a < least_b};
    }
  }

  // ---- Vectors of lanes -------------------------------------------------------------------------

  static Vector minus(const Vector& a, const Vector& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  }

  static Value greatest(const Vector& a) { return max(max(abs(a[0]), abs(a[1])), abs(a[2])); }

  static Value magnitude(const std::array<Vector, 2>& moving) {
    return max(greatest(moving[0]), greatest(moving[1]));
  }

  /// The points of `width` queries, lane by lane. Lanes beyond `count` repeat the last.
  template <class Source>
  static std::array<Vector, query_points> load(const KernelInput& input,
                                               const std::uint32_t* indices, std::size_t count) {
    std::array<std::array<const double*, width>, query_points> rows;
    for (std::size_t lane = 0; lane < width; ++lane) {
      const Points points = Source::points(input, indices[lane < count ? lane : count - 1]);
      for (std::size_t k = 0; k < query_points; ++k) rows[k][lane] = points[k];
    }
    std::array<Vector, query_points> result;
    for (std::size_t k = 0; k + 1 < query_points; ++k) result[k] = Lanes::load(rows[k]);
    result[7] = Source::may_read_behind ? Lanes::load(rows[7]) : Lanes::load_backwards(rows[7]);
    return result;
  }

  // ---- 2 and 3. Direction and determinant, on [0,1] ------------------------------------------

  /// The corners are all a − b for a of the first and b of the second list; differences from one
  /// point, at t=0 and t=1.
  template <Kind kind>
  struct Differences {
    static constexpr std::size_t firsts = kind == Kind::vertex_face ? 1 : 2;
    static constexpr std::size_t seconds = kind == Kind::vertex_face ? 2 : 1;

    std::array<std::array<Vector, 2>, firsts> a;
    std::array<std::array<Vector, 2>, seconds> b;  ///< besides the origin, which is a b too

    explicit Differences(const std::array<Vector, query_points>& x) {
      constexpr std::size_t origin = kind == Kind::vertex_face ? 1 : 2;
      for (std::size_t end = 0; end < 2; ++end) {
        const Vector& from = x[4 * end + origin];
        for (std::size_t i = 0; i < firsts; ++i) a[i][end] = minus(x[4 * end + i], from);
        for (std::size_t i = 0; i < seconds; ++i) {
          b[i][end] = minus(x[4 * end + origin + 1 + i], from);
        }
      }
    }

    /// The sum of the corners, up to a factor.
    [[nodiscard]] Vector sum_of_corners() const {
      Vector sum;
      for (std::size_t k = 0; k < 3; ++k) {
        if constexpr (kind == Kind::vertex_face) {
          const Value of_a = a[0][0][k] + a[0][1][k];
          sum[k] = ((of_a + of_a) + of_a) - ((b[0][0][k] + b[0][1][k]) + (b[1][0][k] + b[1][1][k]));
        } else {
          sum[k] =
              ((a[0][0][k] + a[0][1][k]) + (a[1][0][k] + a[1][1][k])) - (b[0][0][k] + b[0][1][k]);
        }
      }
      return sum;
    }

    [[nodiscard]] Value magnitude() const {
      Value result = CertifiedStages::magnitude(a[0]);
      for (std::size_t i = 1; i < firsts; ++i)
        result = max(result, CertifiedStages::magnitude(a[i]));
      for (std::size_t i = 0; i < seconds; ++i) {
        result = max(result, CertifiedStages::magnitude(b[i]));
      }
      return result;
    }

    /// The least d·a − d·b, at both ends.
    [[nodiscard]] Value gap(const Vector& d) const {
      std::array<Value, 2> least;
      for (std::size_t end = 0; end < 2; ++end) {
        Value least_a = filters::dot(d, a[0][end]);
        for (std::size_t i = 1; i < firsts; ++i) least_a = min(least_a, filters::dot(d, a[i][end]));
        Value greatest_b(0.0);
        for (std::size_t i = 0; i < seconds; ++i) {
          greatest_b = max(greatest_b, filters::dot(d, b[i][end]));
        }
        least[end] = least_a - greatest_b;
      }
      return min(least[0], least[1]);
    }
  };

  static Mask separates(const Vector& d, const Value& gap, const Value& magnitude,
                        const Value& distance) {
    if constexpr (separated) return separates_by(d, gap, magnitude, distance);
    const Value bound =
        greatest(d) * magnitude * Value(filters::measured_projected_gap_double.rounding()) +
        Value(gap_underflow);
    return gap > bound;
  }

  /// By more than the distance: d·w − D n as filters::AdvancedGap at t=0 and t=1, with an n that is not
  /// below the norm of d, which is not above the sum of its components in any norm.
  static Mask separates_by(const Vector& d, const Value& gap, const Value& magnitude,
                           const Value& distance) {
    constexpr double above_rounding = 1.0 + 0x1p-50;
    const Value n = (abs(d[0]) + abs(d[1]) + abs(d[2])) * Value(above_rounding);
    const Value bound =
        n * max(magnitude, distance) * Value(filters::measured_advanced_gap_double.rounding()) +
        Value(advanced_gap_underflow);
    return gap - n * distance > bound;
  }

  /// The moving vectors of a query, by their places: r, p, q, and for the orientations
  /// vertex_face: a = f1 − v, e = f2 − f1; edge_edge: a = eb0 − ea1, e = eb1 − ea0.
  enum Place : std::size_t { r, p, q, a, e };
  static constexpr std::size_t vector_count = 5;

  /// The points whose differences they are.
  template <Kind kind>
  static constexpr std::array<std::array<std::size_t, 2>, vector_count> ends_of_vectors() {
    if constexpr (kind == Kind::vertex_face) return {{{0, 1}, {2, 1}, {3, 1}, {2, 0}, {3, 2}}};
    return {{{0, 2}, {0, 1}, {3, 2}, {2, 1}, {3, 0}}};
  }

  /// An orientation as ± x · (d × y).
  struct Orientation {
    Place x;
    Place y;
    bool negative;
  };

  /// In this order they are proportional to the barycentric v, u, 1−u−v or v, u, 1−u, 1−v.
  template <Kind kind>
  static constexpr auto orientations() {
    if constexpr (kind == Kind::vertex_face) {
      return std::array<Orientation, 3>{{{r, p, false}, {r, q, true}, {a, e, true}}};
    } else {
      return std::array<Orientation, 4>{{{r, p, false}, {r, q, true}, {a, q, true}, {e, p, false}}};
    }
  }

  /// The moving vectors at both ends of an interval.
  using Ends = std::array<std::array<Vector, 2>, vector_count>;

  /// What the bounds of `width` queries need: that of det, and for each orientation the product of its
  /// vectors' magnitudes.
  template <Kind kind>
  struct Bounds {
    Value determinant;
    std::array<Value, orientations<kind>().size()> orientation_scale;
  };

  /// The moving vectors of `width` queries at t=0 and t=1, from their points.
  template <Kind kind>
  static Ends vectors_of(const std::array<Vector, query_points>& x) {
    constexpr auto ends = ends_of_vectors<kind>();
    Ends at;
    for (std::size_t i = 0; i < vector_count; ++i) {
      for (std::size_t end = 0; end < 2; ++end) {
        at[i][end] = minus(x[4 * end + ends[i][0]], x[4 * end + ends[i][1]]);
      }
    }
    return at;
  }

  /// The magnitude of r, or of what is in its place, that makes the bounds of polynomials cover a shift
  /// of the polygon by the distance too. `rounding` is the factor of the magnitudes in the bound, `shift`
  /// that of the distance.
  static Value widened(const Value& magnitude, double rounding, const Value& distance,
                       double shift) {
    if constexpr (separated) return magnitude + distance * Value(shift / rounding);
    return magnitude;
  }
  static constexpr double shift_of_value = 4.001;
  static constexpr double shift_of_coefficients = 12.001;

  /// By the magnitudes of r, p and q; of coefficients or of a value, as `shift` says.
  static Value determinant_bound(const std::array<Value, 3>& magnitudes, double rounding,
                                 double underflow, const Value& distance, double shift) {
    return widened(magnitudes[0], rounding, distance, shift) * magnitudes[1] * magnitudes[2] *
               Value(rounding) +
           Value(underflow);
  }
  static Value determinant_bound(const std::array<Value, 3>& magnitudes, const Value& distance,
                                 double shift) {
    return determinant_bound(magnitudes, filters::measured_determinant_middle_double.rounding(),
                             determinant_underflow, distance, shift);
  }
  static Value determinant_bound(const Ends& unit, const Value& distance) {
    return determinant_bound({magnitude(unit[r]), magnitude(unit[p]), magnitude(unit[q])}, distance,
                             shift_of_coefficients);
  }

  template <Kind kind>
  static Bounds<kind> bounds_of(const Ends& unit, const Value& distance) {
    constexpr auto all_orientations = orientations<kind>();
    constexpr double rounding = filters::measured_orientation_middle_double.rounding();
    Bounds<kind> bounds{determinant_bound(unit, distance), {}};
    for (std::size_t i = 0; i < all_orientations.size(); ++i) {
      const auto [x, y, is_negative] = all_orientations[i];
      bounds.orientation_scale[i] =
          widened(magnitude(unit[x]), rounding, distance, shift_of_coefficients) *
          magnitude(unit[y]);
    }
    return bounds;
  }

  /// N at both ends, and twice its middle Bernstein coefficient.
  struct Normals {
    Vector a;
    Vector b;
    Vector twice_ab;

    explicit Normals(const Ends& at)
        : a(filters::cross(at[p][0], at[q][0])),
          b(filters::cross(at[p][1], at[q][1])),
          twice_ab(filters::normal_middle(at[p][0], at[p][1], at[q][0], at[q][1])) {}

    /// The normal in the middle of the interval, up to a factor.
    [[nodiscard]] Vector middle() const { return filters::add(filters::add(a, b), twice_ab); }
  };

  /// d0, 3 d1, 3 d2, d3 of the Bernstein coefficients of det.
  static std::array<Value, 4> determinant_coefficients(const Ends& at, const Normals& n) {
    return {filters::dot(at[r][0], n.a),
            filters::determinant_middle(at[r][0], at[r][1], n.a, n.twice_ab),
            filters::determinant_middle(at[r][1], at[r][0], n.b, n.twice_ab),
            filters::dot(at[r][1], n.b)};
  }

  /// What is proved of det on an interval.
  struct DeterminantTest {
    Mask one_sided;     ///< no zero
    Mask crosses_once;  ///< one zero
  };

  static DeterminantTest test_determinant(const std::array<Value, 4>& c, const Value& bound) {
    const Value minus_bound = Value(0.0) - bound;
    const Mask one_sided = (min(min(c[0], c[1]), min(c[2], c[3])) > bound) |
                           (max(max(c[0], c[1]), max(c[2], c[3])) < minus_bound);
    const Mask rises =
        (c[0] < minus_bound) & (c[3] > bound) & ((c[1] < minus_bound) | (c[2] > bound));
    const Mask falls =
        (c[0] > bound) & (c[3] < minus_bound) & ((c[1] > bound) | (c[2] < minus_bound));
    return {one_sided, rises | falls};
  }

  template <Kind kind, class Source>
  static void unit_interval_stages(const KernelInput& input, const Indices& open, Indices& mixed,
                                   KernelOutput& output) {
    Marks unbounded, of_direction, of_determinant, of_neither;
    const Value distance(input.separation.distance);
    for (std::size_t first = 0; first < open.count; first += width) {
      const std::size_t count = taken(first, open.count);
      const auto points = load<Source>(input, open.items.data() + first, count);
      const Differences<kind> differences(points);
      const Value magnitude = differences.magnitude();
      const Vector d = differences.sum_of_corners();
      const Mask bounded = (max(magnitude, distance) <= Value(greatest_distance)) & is_number(d);
      const Mask apart = separates(d, differences.gap(d), magnitude, distance);
      const Ends at = vectors_of<kind>(points);
      const Mask one_sided = test_determinant(determinant_coefficients(at, Normals(at)),
                                              determinant_bound(at, distance))
                                 .one_sided;
      const unsigned bits = valid_bits(bounded, count);
      unbounded.add(first, first_lanes(count) & ~bits);
      of_direction.add(first, bits & apart.bits());
      of_determinant.add(first, bits & ~apart.bits() & one_sided.bits());
      of_neither.add(first, bits & ~apart.bits() & ~one_sided.bits());
    }
    append_marked(output.undecided, open, unbounded);
    append_marked(output.separated_in_direction, open, of_direction);
    append_marked(output.one_sided, open, of_determinant);
    mixed.count = 0;
    append_marked(mixed, open, of_neither);
  }

  /// The sum of the corners has every coordinate in it: NaN and infinities show.
  static Mask is_number(const Vector& sum) {
    const Value zero(0.0);
    const Value difference = ((sum[0] - sum[0]) + (sum[1] - sum[1])) + (sum[2] - sum[2]);
    return difference <= zero;
  }

  // ---- 4. An interval ---------------------------------------------------------------------------

  /// What is proved of the orientations on an interval.
  struct OrientationTest {
    Mask opposed;  ///< two keep opposite signs
    Mask agree;    ///< all keep one sign
  };

  template <Kind kind>
  static OrientationTest test_orientations(const Vector& d, const Ends& at,
                                           const Bounds<kind>& bounds) {
    constexpr auto all_orientations = orientations<kind>();
    const Value scale = greatest(d) * Value(filters::measured_orientation_middle_double.rounding());
    Mask any_positive = Mask::none(), any_negative = Mask::none();
    Mask all_positive = Mask::all(), all_negative = Mask::all();
    for (std::size_t i = 0; i < all_orientations.size(); ++i) {
      const auto [x, y, is_negative] = all_orientations[i];
      const Vector d_y_a = filters::cross(d, at[y][0]), d_y_b = filters::cross(d, at[y][1]);
      const Value o_a = filters::dot(at[x][0], d_y_a), o_b = filters::dot(at[x][1], d_y_b);
      const Value o_ab = filters::orientation_middle(at[x][0], at[x][1], d_y_a, d_y_b);
      const Value bound = scale * bounds.orientation_scale[i] + Value(orientation_underflow);
      const Mask above = min(min(o_a, o_b), o_ab) > bound;
      const Mask below = max(max(o_a, o_b), o_ab) < Value(0.0) - bound;
      const Mask positive = is_negative ? below : above;
      const Mask negative = is_negative ? above : below;
      any_positive = any_positive | positive;
      any_negative = any_negative | negative;
      all_positive = all_positive & positive;
      all_negative = all_negative & negative;
    }
    return {any_positive & any_negative, all_positive | all_negative};
  }

  /// An interval, by what it has of the theorem.
  struct Examination {
    std::array<Value, 4> coefficients;  ///< of det
    DeterminantTest determinant;
    OrientationTest orientation;

    [[nodiscard]] Mask has_no_contact() const {
      return determinant.one_sided | orientation.opposed;
    }
    [[nodiscard]] Mask has_contact() const { return determinant.crosses_once & orientation.agree; }
  };

  template <Kind kind>
  static Examination examine(const Ends& at, const Bounds<kind>& bounds) {
    const Normals normals(at);
    const std::array<Value, 4> coefficients = determinant_coefficients(at, normals);
    return {coefficients, test_determinant(coefficients, bounds.determinant),
            test_orientations<kind>(normals.middle(), at, bounds)};
  }

  /// Vectors that move from `unit` at 0 to it at 1, at the ends of [begin, end].
  static Ends between(const Ends& unit, const Value& begin, const Value& end) {
    const Value one(1.0), before_begin = one - begin, before_end = one - end;
    Ends at;
    for (std::size_t i = 0; i < vector_count; ++i) {
      at[i] = {filters::at_time(unit[i][0], unit[i][1], before_begin, begin),
               filters::at_time(unit[i][0], unit[i][1], before_end, end)};
    }
    return at;
  }

  /// A zero of det, the only one in [begin, begin + length], and no contact before.
  struct Crossing {
    std::uint32_t index;
    double begin;
    double length;
    /// d0, 3 d1, 3 d2, d3 of the Bernstein coefficients there.
    std::array<double, 4> determinant;
  };
  using Crossings = List<Crossing>;

  /// Intervals of a list of queries, with det's coefficients, as they lie in memory.
  class Intervals {
   public:
    /// Those of the places from `first` on, a multiple of the width.
    void store(std::size_t first, const Value& begin, const Value& length,
               const std::array<Value, 4>& coefficients) {
      Rows& rows = groups_[first / width];
      begin.store(rows[0].data());
      length.store(rows[1].data());
      for (std::size_t i = 0; i < 4; ++i) coefficients[i].store(rows[2 + i].data());
    }

    [[nodiscard]] Crossing crossing(std::size_t place, std::uint32_t index) const {
      const Rows& rows = groups_[place / width];
      const std::size_t lane = place % width;
      return {index,
              rows[0][lane],
              rows[1][lane],
              {rows[2][lane], rows[3][lane], rows[4][lane], rows[5][lane]}};
    }

   private:
    using Rows = std::array<std::array<double, width>, 6>;
    alignas(width * sizeof(double)) std::array<Rows, (kernel_block + width - 1) / width> groups_;
  };

  // ---- 4a. Orientations on [0,1] ----------------------------------------------------------------

  template <Kind kind, class Source>
  static void orientation_stage(const KernelInput& input, const Indices& mixed, Crossings& contacts,
                                Crossings& zeros, Indices& undecided, Indices& far,
                                KernelOutput& output) {
    Marks of_contacts, of_rejected, of_zeros, of_rest, of_far;
    Intervals intervals;
    for (std::size_t first = 0; first < mixed.count; first += width) {
      const std::size_t count = taken(first, mixed.count);
      const Ends unit = vectors_of<kind>(load<Source>(input, mixed.items.data() + first, count));
      const Examination found =
          examine<kind>(unit, bounds_of<kind>(unit, Value(input.separation.distance)));
      intervals.store(first, Value(0.0), Value(1.0), found.coefficients);
      const unsigned contact = valid_bits(found.has_contact(), count);
      const unsigned rejected = valid_bits(found.has_no_contact(), count) & ~contact;
      const unsigned zero =
          valid_bits(found.determinant.crosses_once, count) & ~contact & ~rejected;
      const unsigned rest = first_lanes(count) & ~contact & ~rejected & ~zero;
      const unsigned is_far = far_lanes(input, unit);
      of_contacts.add(first, contact & ~is_far);
      of_rejected.add(first, rejected);
      of_zeros.add(first, zero);
      of_rest.add(first, rest & ~is_far);
      of_far.add(first, (contact | rest) & is_far);
    }
    const auto crossing = [&](std::size_t place) {
      return intervals.crossing(place, mixed.items[place]);
    };
    of_contacts.for_each([&](std::size_t place) { append(contacts, crossing(place)); });
    of_zeros.for_each([&](std::size_t place) { append(zeros, crossing(place)); });
    append_marked(output.rejected, mixed, of_rejected);
    append_marked(undecided, mixed, of_rest);
    append_marked(far, mixed, of_far);
  }

  /// The lanes whose distance is too great a shift.
  static unsigned far_lanes(const KernelInput& input, const Ends& unit) {
    if constexpr (!separated) return 0;
    const Value size = max(max(magnitude(unit[r]), magnitude(unit[p])), magnitude(unit[q]));
    return (Value(input.separation.distance * greatest_shift) > size).bits();
  }

  // ---- 4b. Around the only zero of det ----------------------------------------------------------

  /// Half the lengths of the intervals that are looked at: where the first is not short enough to tell,
  /// the second may be; where it is not either, bisection would not come to an end.
  static constexpr std::array<double, 2> halves_around_zero{0x1p-10, 0x1p-32};

  /// Rounded to a multiple of 2^-44, so that it and 1 minus it are exact.
  static Value to_short(const Value& time) {
    const Value shift(0x1p8);
    return (time + shift) - shift;
  }

  /// \param unclear Those that cross zero in the interval, where the orientations tell nothing.
  template <Kind kind, class Source>
  static void zero_stage(const KernelInput& input, double half, const Crossings& zeros,
                         Crossings& contacts, Crossings& unclear, Indices& undecided, Indices& far,
                         KernelOutput& output) {
    Marks of_contacts, of_rejected, of_unclear, of_rest, of_far;
    Intervals intervals;
    Indices all;
    all.count = zeros.count;
    for (std::size_t i = 0; i < zeros.count; ++i) all.items[i] = zeros.items[i].index;
    for (std::size_t first = 0; first < zeros.count; first += width) {
      const std::size_t count = taken(first, zeros.count);
      const Value zero = CrossingLanes(zeros.items.data() + first, count).cubic.zero(half);
      const Value begin = to_short(max(zero - Value(half), Value(0.0)));
      const Value end = to_short(min(zero + Value(half), Value(1.0)));
      const Ends unit = vectors_of<kind>(load<Source>(input, all.items.data() + first, count));
      const Examination found = examine<kind>(
          between(unit, begin, end), bounds_of<kind>(unit, Value(input.separation.distance)));
      intervals.store(first, begin, end - begin, found.coefficients);
      const Mask is_late = begin >= Value(input.t_limit);
      const unsigned here = valid_bits(found.determinant.crosses_once, count);
      const unsigned rejected = here & (found.orientation.opposed | is_late).bits();
      const unsigned contact = here & ~rejected & found.orientation.agree.bits();
      const unsigned is_far = far_lanes(input, unit) & first_lanes(count);
      of_contacts.add(first, contact & ~is_far);
      of_rejected.add(first, rejected);
      of_unclear.add(first, here & ~contact & ~rejected & ~is_far);
      of_rest.add(first, first_lanes(count) & ~here & ~is_far);
      of_far.add(first, is_far & ~rejected);
    }
    of_contacts.for_each(
        [&](std::size_t place) { append(contacts, intervals.crossing(place, all.items[place])); });
    of_unclear.for_each([&](std::size_t place) { append(unclear, zeros.items[place]); });
    append_marked(output.rejected, all, of_rejected);
    append_marked(undecided, all, of_rest);
    append_marked(far, all, of_far);
  }

  template <Kind kind, class Source>
  static void zero_stages(const KernelInput& input, const Crossings& zeros, Crossings& contacts,
                          Indices& undecided, Indices& hopeless, Indices& far,
                          KernelOutput& output) {
    Crossings unclear, still_unclear;
    zero_stage<kind, Source>(input, halves_around_zero[0], zeros, contacts, unclear, undecided, far,
                             output);
    zero_stage<kind, Source>(input, halves_around_zero[1], unclear, contacts, still_unclear,
                             hopeless, far, output);
    for (std::size_t i = 0; i < still_unclear.count; ++i) {
      append(hopeless, still_unclear.items[i].index);
    }
  }

  // ---- 4c. Bisection ----------------------------------------------------------------------------

  /// The moving vectors of `width` queries as they lie in memory, and what their bounds need.
  template <Kind kind>
  struct MovingLanes {
    static constexpr std::size_t orientation_count = orientations<kind>().size();
    static constexpr std::size_t rows = 6 * vector_count + 1 + orientation_count;

    /// x, y, z of each vector at t=0, then at t=1; the bound of det; the orientations' scales.
    alignas(width * sizeof(double)) std::array<std::array<double, width>, rows> row;

    void store(const Ends& unit, const Bounds<kind>& bounds) {
      for (std::size_t i = 0; i < vector_count; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
          unit[i][0][k].store(row[6 * i + k].data());
          unit[i][1][k].store(row[6 * i + 3 + k].data());
        }
      }
      bounds.determinant.store(row[6 * vector_count].data());
      for (std::size_t i = 0; i < orientation_count; ++i) {
        bounds.orientation_scale[i].store(row[6 * vector_count + 1 + i].data());
      }
    }

    [[nodiscard]] Value load(std::size_t i) const { return Value::load(row[i].data()); }

    [[nodiscard]] Ends unit() const {
      Ends result;
      for (std::size_t i = 0; i < vector_count; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
          result[i][0][k] = load(6 * i + k);
          result[i][1][k] = load(6 * i + 3 + k);
        }
      }
      return result;
    }

    [[nodiscard]] Bounds<kind> bounds() const {
      Bounds<kind> result{load(6 * vector_count), {}};
      for (std::size_t i = 0; i < orientation_count; ++i) {
        result.orientation_scale[i] = load(6 * vector_count + 1 + i);
      }
      return result;
    }
  };

  /// Queries to bisect, lane by lane.
  template <Kind kind>
  struct Moving {
    const Indices* indices;
    std::array<MovingLanes<kind>, (kernel_block + width - 1) / width> groups;
  };

  template <Kind kind, class Source>
  static void load_moving(const KernelInput& input, const Indices& indices, Moving<kind>& moving) {
    moving.indices = &indices;
    for (std::size_t first = 0; first < indices.count; first += width) {
      const std::size_t count = taken(first, indices.count);
      const Ends unit = vectors_of<kind>(load<Source>(input, indices.items.data() + first, count));
      moving.groups[first / width].store(unit,
                                         bounds_of<kind>(unit, Value(input.separation.distance)));
    }
  }

  /// Runs `width` queries at a time, each with an interval of its own; a lane that is done takes the
  /// next query.
  template <Kind kind>
  class Bisection {
   public:
    Bisection(const KernelInput& input, const Moving<kind>& moving, Crossings& contacts,
              Indices& rejected, Indices& hopeless)
        : input_(input),
          moving_(moving),
          contacts_(contacts),
          rejected_(rejected),
          hopeless_(hopeless) {}

    void run() {
      for (std::size_t lane = 0; lane < width; ++lane) take(lane);
      while (active_ != 0) step();
    }

   private:
    /// Intervals are not halved below this length, nor more of them examined than this. What is not clear
    /// then is less work for the exact stage.
    static constexpr double least_length = 0x1p-12;
    /// The same where det is not clear at an end of the interval, and so nor on any part at this end.
    static constexpr double least_length_at_zero = 0x1p-1;
    static constexpr double most_steps = 150;

    using Row = std::array<double, width>;

    // ---- Lanes ----

    /// The next query, if there is one, to the lane.
    void take(std::size_t lane) {
      active_ &= ~(1U << lane);
      if (next_ == moving_.indices->count) return;
      const MovingLanes<kind>& lanes = moving_.groups[next_ / width];
      const std::size_t from = next_ % width;
      for (std::size_t i = 0; i < lanes.row.size(); ++i) lanes_.row[i][lane] = lanes.row[i][from];
      index_[lane] = moving_.indices->items[next_++];
      begin_[lane] = 0.0;
      length_[lane] = 0.5;
      steps_[lane] = 0.0;
      active_ |= 1U << lane;
    }

    static Value load(const Row& row) { return Value::load(row.data()); }

    void step() {
      const Value begin = load(begin_), length = load(length_);
      const Examination found =
          examine<kind>(between(lanes_.unit(), begin, begin + length), lanes_.bounds());
      const unsigned contact = found.has_contact().bits() & active_;
      if (contact != 0) keep_contacts(contact, begin, length, found.coefficients);
      const auto& c = found.coefficients;
      const Mask is_at_zero = min(abs(c[0]), abs(c[3])) <= lanes_.bounds().determinant;
      advance(found.has_no_contact(), contact,
              select(is_at_zero, Value(least_length_at_zero), Value(least_length)));
    }

    // ---- What follows ----

    /// Goes on to the next interval where this one has no contact, to its first half elsewhere; the
    /// lanes that are done take other queries.
    void advance(const Mask& rejected, unsigned contact, const Value& least) {
      const Value begin = load(begin_), length = load(length_), end = begin + length;
      // The next interval is as long as its place in the dyadic order allows, at most twice this.
      const Value doubled = length + length, places = end / doubled, shift(0x1p52);
      const Mask can_double = ((places + shift) - shift) == places;
      const Value steps = load(steps_) + Value(1.0);
      const Value next_length =
          select(rejected, select(can_double, doubled, length), length * Value(0.5));
      const unsigned over = (rejected & (end >= Value(input_.t_limit))).bits() & active_ & ~contact;
      const Mask is_short = (next_length < least) & (next_length < length);
      const Mask is_hopeless = is_short | (steps > Value(most_steps));
      const unsigned hopeless = is_hopeless.bits() & active_ & ~contact & ~over;
      select(rejected, end, begin).store(begin_.data());
      next_length.store(length_.data());
      steps.store(steps_.data());
      for_each_lane(over | contact | hopeless, [&](std::size_t lane) {
        if ((over >> lane & 1U) != 0) append(rejected_, index_[lane]);
        if ((hopeless >> lane & 1U) != 0) append(hopeless_, index_[lane]);
        take(lane);
      });
    }

    void keep_contacts(unsigned lanes, const Value& begin, const Value& length,
                       const std::array<Value, 4>& coefficients) {
      Intervals intervals;
      intervals.store(0, begin, length, coefficients);
      for_each_lane(lanes, [&](std::size_t lane) {
        append(contacts_, intervals.crossing(lane, index_[lane]));
      });
    }

    MovingLanes<kind> lanes_{};
    alignas(width * sizeof(double)) Row begin_{};
    alignas(width * sizeof(double)) Row length_{};
    alignas(width * sizeof(double)) Row steps_{};
    std::array<std::uint32_t, width> index_{};
    unsigned active_ = 0;   ///< the lanes that hold a query
    std::size_t next_ = 0;  ///< of the queries
    const KernelInput& input_;
    const Moving<kind>& moving_;
    Crossings& contacts_;
    Indices& rejected_;
    Indices& hopeless_;
  };

  // ---- 5. Refinement ----------------------------------------------------------------------------

  using Precise = filters::DoubleDouble<Value>;

  /// det in double-double, at any time.
  class PreciseDeterminant {
   public:
    template <Kind kind>
    static PreciseDeterminant of(const std::array<Vector, query_points>& x, const Value& distance) {
      constexpr auto ends = ends_of_vectors<kind>();
      PreciseDeterminant result;
      result.distance_ = distance;
      for (std::size_t end = 0; end < 2; ++end) {
        for (std::size_t i = 0; i < 3; ++i) {
          for (std::size_t k = 0; k < 3; ++k) {
            const Precise difference =
                filters::exact_difference(x[4 * end + ends[i][0]][k], x[4 * end + ends[i][1]][k]);
            result.coordinates_[9 * end + 3 * i + k] = difference;
            result.magnitudes_[i] = max(result.magnitudes_[i], abs(difference.high));
          }
        }
      }
      result.bound_ =
          determinant_bound(result.magnitudes_, filters::determinant_end_double_double.rounding(),
                            double_double_underflow, distance, shift_of_value);
      return result;
    }

    [[nodiscard]] Value at(const Value& time) const {
      const Precise end{time, Value(0.0)};
      const Precise start = filters::exact_difference(Value(1.0), time);
      return filters::DeterminantEnd::evaluate<Precise>(coordinates_,
                                                        {start, end, start, end, start, end})
          .high;
    }

    [[nodiscard]] const Value& bound() const { return bound_; }
    /// Of det from the coefficients in double, on any interval.
    [[nodiscard]] Value rough_bound() const {
      return determinant_bound(magnitudes_, distance_, shift_of_value);
    }

   private:
    std::array<Precise, filters::DeterminantEnd::coordinates> coordinates_;
    std::array<Value, 3> magnitudes_{Value(0.0), Value(0.0), Value(0.0)};
    Value distance_{0.0};
    Value bound_{0.0};
  };

  /// det on an interval as a rising cubic of s ∈ [0,1].
  struct Cubic {
    std::array<Value, 4> c;  ///< d0, 3 d1, 3 d2, d3

    [[nodiscard]] Value at(const Value& s) const {
      const Value m = Value(1.0) - s;
      return m * m * (c[0] * m + c[1] * s) + s * s * (c[2] * m + c[3] * s);
    }
    [[nodiscard]] Value slope(const Value& s) const {
      const Value m = Value(1.0) - s, three(3.0);
      const Value first = c[1] - three * c[0], second = c[2] - c[1], third = three * c[3] - c[2];
      return m * m * first + (m * s + m * s) * second + s * s * third;
    }

    [[nodiscard]] Value magnitude() const {
      return max(max(abs(c[0]), abs(c[1])), max(abs(c[2]), abs(c[3])));
    }

    /// Its zero, by Newton's method, bisection where that leads away. A lane stops when it has moved
    /// by no more than `enough`, whatever the others do: its result is its own.
    [[nodiscard]] Value zero(double enough) const {
      constexpr int most_steps = 8;
      Value low(0.0), high(1.0), s = c[0] / (c[0] - c[3]);
      Mask moves = Mask::all();
      for (int i = 0; i < most_steps && moves.bits() != 0; ++i) {
        const Value value = at(s);
        const Mask before = value < Value(0.0);
        low = select(before, s, low);
        high = select(before, high, s);
        const Value newton = s - value / slope(s);
        const Value next =
            select((newton >= low) & (newton <= high), newton, (low + high) * Value(0.5));
        const Value step = abs(next - s);
        s = select(moves, next, s);
        moves = moves & (step > Value(enough));
      }
      return s;
    }
  };

  /// No contact in [0, begin], and one near `time`, or before.
  struct Approach {
    std::uint32_t index;
    double begin;
    double time;
  };
  using Approaches = List<Approach>;

  template <Kind kind, class Source>
  static void refine(const KernelInput& input, const Crossings& crossings, Indices& unproved,
                     KernelOutput& output) {
    Approaches approaches;
    approaches.count = 0;
    for (std::size_t first = 0; first < crossings.count; first += width) {
      refine_lanes<kind, Source>(input, crossings.items.data() + first,
                                 taken(first, crossings.count), approaches, unproved, output);
    }
    if constexpr (separated) {
      with_norm(input.separation.norm, [&]<Norm norm>() {
        arrive<kind, Source, norm>(input, approaches, unproved, output);
      });
    }
  }

  /// The crossings of `width` queries, lane by lane.
  struct CrossingLanes {
    std::array<std::uint32_t, width> indices;
    Value begin{0.0};
    Value length{0.0};
    Value sign{0.0};  ///< that makes det rise
    Cubic cubic{};

    CrossingLanes(const Crossing* crossings, std::size_t count) {
      alignas(64) std::array<std::array<double, width>, 7> rows;
      for (std::size_t lane = 0; lane < width; ++lane) {
        const Crossing& crossing = crossings[lane < count ? lane : count - 1];
        indices[lane] = crossing.index;
        rows[0][lane] = crossing.begin;
        rows[1][lane] = crossing.length;
        rows[2][lane] = crossing.determinant[0] < 0 ? 1.0 : -1.0;
        for (std::size_t i = 0; i < 4; ++i) rows[3 + i][lane] = crossing.determinant[i];
      }
      begin = Value::load(rows[0].data());
      length = Value::load(rows[1].data());
      sign = Value::load(rows[2].data());
      for (std::size_t i = 0; i < 4; ++i) cubic.c[i] = sign * Value::load(rows[3 + i].data());
    }
  };

  template <Kind kind, class Source>
  static void refine_lanes(const KernelInput& input, const Crossing* crossings, std::size_t count,
                           Approaches& approaches, Indices& unproved, KernelOutput& output) {
    const CrossingLanes lanes(crossings, count);
    const auto points = load<Source>(input, lanes.indices.data(), width);
    const PreciseDeterminant determinant =
        PreciseDeterminant::template of<kind>(points, Value(input.separation.distance));
    const Value half_width(0.4 * input.toi_tolerance);
    const Value zero = lanes.cubic.zero(0x1p-26);
    const Value newton = lanes.begin + lanes.length * zero;
    if constexpr (separated) {
      const Mask can_do =
          lanes.cubic.slope(zero) * newton * half_width > determinant.bound() * lanes.length;
      if (valid_bits(can_do, count) == 0) {
        keep_approaches(lanes, determinant, zero, first_lanes(count), approaches);
        return;
      }
    }
    Enclosure found(determinant, lanes, newton, half_width);
    if (valid_bits(found.proved, count) != first_lanes(count)) {
      found = found.or_else(Enclosure(determinant, lanes, found.corrected(), half_width));
    }
    const unsigned proved = valid_bits(found.proved, count);
    store_hits(output, lanes.indices, proved, {found.lower, found.upper},
               contact<kind>(points, found.toi));
    if constexpr (separated) {
      keep_approaches(lanes, determinant, zero, first_lanes(count) & ~proved, approaches);
    } else {
      append_lanes(unproved, lanes.indices, first_lanes(count) & ~proved);
    }
  }

  /// Up to where det proves that there is no contact, as its value there is less than −b: by more than
  /// the bound of its coefficients and what their sum is wrong by. The weights of the sum add up to 1,
  /// of 12 u of which rounding takes less than 2^-48; and the time is wrong by up to 3 · 2^-53, over
  /// which det moves by 18 · 2^-53 coefficients for an interval of length 1.
  static void keep_approaches(const CrossingLanes& lanes, const PreciseDeterminant& determinant,
                              const Value& zero, unsigned bits, Approaches& approaches) {
    const Value bound = determinant.rough_bound() +
                        lanes.cubic.magnitude() * (Value(0x1p-48) + Value(0x1p-48) / lanes.length);
    const Value s = zero - Value(2.0) * bound / lanes.cubic.slope(zero);
    const Mask proved =
        (s > Value(0.0)) & (s <= Value(1.0)) & (lanes.cubic.at(s) < Value(0.0) - bound);
    const Value begin = select(proved, to_exact(lanes.begin + lanes.length * s), lanes.begin);
    alignas(width * sizeof(double)) std::array<double, width> begins;
    begin.store(begins.data());
    for_each_lane(bits, [&](std::size_t lane) {
      append(approaches, Approach{lanes.indices[lane], begins[lane], begins[lane]});
    });
  }

  /// Around what should be the zero, with the signs of det at its ends.
  struct Enclosure {
    Value toi;
    Value lower;
    Value upper;
    Value at_lower;  ///< det there, made rising
    Value at_upper;
    Mask proved;  ///< it has the zero

    Enclosure(const PreciseDeterminant& determinant, const CrossingLanes& lanes,
              const Value& around, const Value& half_width)
        : toi(around),
          lower(max(around - around * half_width, lanes.begin)),
          upper(min(around + around * half_width, lanes.begin + lanes.length)),
          at_lower(lanes.sign * determinant.at(lower)),
          at_upper(lanes.sign * determinant.at(upper)),
          proved((at_lower < Value(0.0) - determinant.bound()) & (at_upper > determinant.bound())) {
    }

    /// Where the line through det's values at the ends is zero.
    [[nodiscard]] Value corrected() const {
      const Value rise = at_upper - at_lower;
      return select(rise > Value(0.0), lower - at_lower * (upper - lower) / rise, toi);
    }

    /// This where it is proved, the other elsewhere.
    [[nodiscard]] Enclosure or_else(const Enclosure& other) const {
      Enclosure result = other;
      result.toi = select(proved, toi, other.toi);
      result.lower = select(proved, lower, other.lower);
      result.upper = select(proved, upper, other.upper);
      result.proved = proved | other.proved;
      return result;
    }
  };

  // ---- With a separation ------------------------------------------------------------------------

  /// The vectors that MovingPolygon is made of, and their magnitude.
  template <Kind kind>
  struct PolygonVectors {
    std::array<std::array<Vector, 2>, 3> vectors;
    Value magnitude;

    explicit PolygonVectors(const std::array<Vector, query_points>& points) {
      const Differences<kind> of_points(points);
      std::size_t place = 0;
      for (const auto& a : of_points.a) vectors[place++] = a;
      for (const auto& b : of_points.b) vectors[place++] = b;
      magnitude = of_points.magnitude();
    }
  };

  /// Calls the function with the norm as its template argument.
  template <class Function>
  static void with_norm(Norm norm, const Function& function) {
    if (norm == Norm::linf) {
      function.template operator()<Norm::linf>();
    } else {
      function.template operator()<Norm::l2>();
    }
  }

  template <Kind kind, class Source, Norm norm>
  static void advance_stage(const KernelInput& input, const Indices& far, KernelOutput& output) {
    PolygonLanes<kind> polygons;
    for (std::size_t first = 0; first < far.count; first += width) {
      const std::size_t count = taken(first, far.count);
      polygons.groups[first / width].store(
          PolygonVectors<kind>(load<Source>(input, far.items.data() + first, count)));
    }
    Approaches approaches;
    approaches.count = 0;
    Advance<kind, norm>(input, far, polygons, approaches, output).run();
    arrive<kind, Source, norm>(input, approaches, output.undecided, output);
  }

  /// The polygons of `width` queries as they lie in memory.
  struct PolygonRows {
    static constexpr std::size_t magnitude_row = 18;

    alignas(width * sizeof(double)) std::array<std::array<double, width>, magnitude_row + 1> row;

    template <Kind kind>
    void store(const PolygonVectors<kind>& polygon) {
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t end = 0; end < 2; ++end) {
          for (std::size_t axis = 0; axis < 3; ++axis) {
            polygon.vectors[i][end][axis].store(row[6 * i + 3 * end + axis].data());
          }
        }
      }
      polygon.magnitude.store(row[magnitude_row].data());
    }

    template <Kind kind, Norm norm>
    [[nodiscard]] MovingPolygon<Lanes, kind, norm> polygon(double distance) const {
      std::array<std::array<Vector, 2>, 3> vectors;
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t end = 0; end < 2; ++end) {
          for (std::size_t axis = 0; axis < 3; ++axis) {
            vectors[i][end][axis] = Value::load(row[6 * i + 3 * end + axis].data());
          }
        }
      }
      return {vectors, Value::load(row[magnitude_row].data()), distance};
    }
  };

  template <Kind kind>
  struct PolygonLanes {
    std::array<PolygonRows, (kernel_block + width - 1) / width> groups;
  };

  /// Rounded to a multiple of 2^-52, so that 1 minus it is exact.
  static Value to_exact(const Value& time) { return (time + Value(1.0)) - Value(1.0); }

  /// Follows `width` queries at a time, each up to where it has come; a lane that is done takes the
  /// next query.
  template <Kind kind, Norm norm>
  class Advance {
   public:
    Advance(const KernelInput& input, const Indices& queries, const PolygonLanes<kind>& polygons,
            Approaches& approaches, KernelOutput& output)
        : input_(input),
          queries_(queries),
          polygons_(polygons),
          approaches_(approaches),
          output_(output) {}

    void run() {
      for (std::size_t lane = 0; lane < width; ++lane) take(lane);
      while (active_ != 0) step();
    }

   private:
    using Row = std::array<double, width>;
    using Polygon = MovingPolygon<Lanes, kind, norm>;
    using Nearest = typename Polygon::Nearest;

    static constexpr double most_steps = 60;
    /// A step goes so far on the way to where the contact is seen.
    static constexpr double part_of_way = 1.0 - 0x1p-10;
    /// The contact is near where the rest of the way is this part of the time, or the gap is so many
    /// bounds.
    static constexpr double near_in_time = 0x1p-12;
    static constexpr double near_in_bounds = 0x1p12;

    void take(std::size_t lane) {
      active_ &= ~(1U << lane);
      if (next_ == queries_.count) return;
      const PolygonRows& from = polygons_.groups[next_ / width];
      const std::size_t place = next_ % width;
      for (std::size_t i = 0; i < lanes_.row.size(); ++i) lanes_.row[i][lane] = from.row[i][place];
      index_[lane] = queries_.items[next_++];
      for (Row& row : state_) row[lane] = 0.0;
      active_ |= 1U << lane;
    }

    /// What a lane knows of its query, by rows of `state_`: no contact in [0, begin]; the direction that
    /// is best there, and the nearest point's parameters; where it looks next.
    enum State : std::size_t { begin, end, steps, parameter_u, parameter_v, direction };

    [[nodiscard]] Value load(State row) const { return Value::load(state_[row].data()); }

    /// Looks at [begin, end]; at first at the time 0.
    void step() {
      const Polygon polygon = lanes_.template polygon<kind, norm>(input_.separation.distance);
      const Value a = load(begin), b = load(end);
      const Mask is_first = load(steps) == Value(0.0);
      const Nearest nearest(polygon.corners_at(b));
      Vector c_a;
      for (std::size_t k = 0; k < 3; ++k) {
        c_a[k] = select(is_first, nearest.direction[k], Value::load(state_[direction + k].data()));
      }
      const auto of_a = polygon.project(c_a), of_b = polygon.project(nearest.direction);
      const Mask apart = polygon.begins_apart(of_a, of_b, a, b, 1.0) & polygon.ends_apart(of_b, b);
      const Value u = select(apart | is_first, nearest.u, load(parameter_u));
      const Value v = select(apart | is_first, nearest.v, load(parameter_v));
      const auto ahead = polygon.predict(of_b, nearest.u, nearest.v, b);
      const auto behind = polygon.predict(of_a, u, v, a);
      for (std::size_t k = 0; k < 3; ++k) {
        select(apart, nearest.direction[k], c_a[k]).store(state_[direction + k].data());
      }
      u.store(state_[parameter_u].data());
      v.store(state_[parameter_v].data());
      const Mask is_near = select_mask(apart, ahead.is_near, behind.is_near);
      go_on(apart,
            {select(apart, ahead.gap, behind.gap), select(apart, ahead.time, behind.time), is_near},
            polygon.bound());
    }

    static Mask select_mask(const Mask& mask, const Mask& a, const Mask& b) {
      return select(mask, select(a, Value(1.0), Value(0.0)), select(b, Value(1.0), Value(0.0))) >
             Value(0.5);
    }

    /// \param seen The contact as seen from where no contact is proved up to now.
    void go_on(const Mask& apart, const typename Polygon::Prediction& seen, const Value& bound) {
      const Value one(1.0), a = load(begin), b = load(end), step = load(steps);
      const Value from = select(apart, b, a);
      const Mask is_ahead = seen.is_near & (seen.time > from);
      const Value on_way = from + (seen.time - from) * Value(part_of_way);
      const Value whole = select(is_ahead & (on_way < one), on_way, one);
      const Value half = a + (b - a) * Value(0.5);
      const Mask is_shorter = is_ahead & (on_way < a + (b - a) * Value(0.875));
      const Value next = to_exact(select(apart, whole, select(is_shorter, on_way, half)));
      const Mask is_first = step == Value(0.0), touches = seen.gap <= Value(0.0);
      const Mask is_close = is_ahead & (seen.time <= one + Value(near_in_time)) &
                            ((seen.time - from <= seen.time * Value(near_in_time)) |
                             (seen.gap <= bound * Value(near_in_bounds)) | (next <= from));
      const Value apart_value = select(apart, one, Value(0.0));
      const Mask fails = apart_value < Value(0.5);
      const Mask arrives = is_close & select_mask(is_first, apart, Mask::all());
      const Mask touches_at_start = is_first & fails & touches;
      const Mask is_over = apart & (b >= Value(input_.t_limit));
      const Mask is_hopeless = (is_first & fails) | (next <= from) | (step >= Value(most_steps));
      from.store(state_[begin].data());
      next.store(state_[end].data());
      (step + one).store(state_[steps].data());
      finish(is_over.bits() & active_, (arrives | touches_at_start).bits() & active_,
             is_hopeless.bits() & active_, select(touches_at_start, Value(0.0), seen.time));
    }

    void finish(unsigned over, unsigned arrived, unsigned hopeless, const Value& time) {
      alignas(width * sizeof(double)) Row times;
      time.store(times.data());
      for_each_lane(over | arrived | hopeless, [&](std::size_t lane) {
        if ((over >> lane & 1U) != 0) {
          append(output_.rejected, index_[lane]);
        } else if ((arrived >> lane & 1U) != 0) {
          append(approaches_, Approach{index_[lane], state_[begin][lane], times[lane]});
        } else {
          append(output_.undecided, index_[lane]);
        }
        take(lane);
      });
    }

    PolygonRows lanes_{};
    alignas(width * sizeof(double)) std::array<Row, 8> state_{};
    std::array<std::uint32_t, width> index_{};
    unsigned active_ = 0;
    std::size_t next_ = 0;
    const KernelInput& input_;
    const Indices& queries_;
    const PolygonLanes<kind>& polygons_;
    Approaches& approaches_;
    KernelOutput& output_;
  };

  /// Parameters in F's domain, exactly: multiples of 2^-52, so that 1 − u is exact.
  template <Kind kind>
  static std::array<Value, 2> in_domain(const Value& u, const Value& v) {
    const Value zero(0.0), one(1.0);
    const Value inside_u = to_exact(max(min(u, one), zero));
    const Value inside_v = to_exact(max(min(v, one), zero));
    return {inside_u, kind == Kind::vertex_face ? min(inside_v, one - inside_u) : inside_v};
  }

  /// Encloses the times of impact.
  template <Kind kind, class Source, Norm norm>
  static void arrive(const KernelInput& input, const Approaches& approaches, Indices& unproved,
                     KernelOutput& output) {
    for (std::size_t first = 0; first < approaches.count; first += width) {
      arrive_lanes<kind, Source, norm>(input, approaches.items.data() + first,
                                       taken(first, approaches.count), unproved, output);
    }
  }

  template <Kind kind, class Source, Norm norm>
  static void arrive_lanes(const KernelInput& input, const Approach* approaches, std::size_t count,
                           Indices& unproved, KernelOutput& output) {
    std::array<std::uint32_t, width> indices;
    alignas(width * sizeof(double)) std::array<std::array<double, width>, 2> rows;
    for (std::size_t lane = 0; lane < width; ++lane) {
      const Approach& approach = approaches[lane < count ? lane : count - 1];
      indices[lane] = approach.index;
      rows[0][lane] = approach.begin;
      rows[1][lane] = approach.time;
    }
    const auto points = load<Source>(input, indices.data(), width);
    const PolygonVectors<kind> vectors(points);
    const double distance = input.separation.distance;
    const Arrival<kind, norm> arrival(
        MovingPolygon<Lanes, kind, norm>(vectors.vectors, vectors.magnitude, distance),
        PreciseProof<Lanes, kind, norm>(points, vectors.magnitude * Value(2.0), distance),
        Value::load(rows[0].data()), Value(0.4 * input.toi_tolerance));
    auto found = arrival.template around<norm>(arrival.corrected(Value::load(rows[1].data())));
    if (valid_bits(found.proved, count) != first_lanes(count)) {
      // In L∞ other points may be as near as the nearest one, and easier to find.
      found = found.or_else(arrival.template around<Norm::l2>(found.corrected));
    }
    const unsigned proved = valid_bits(found.proved, count);
    store_hits(output, indices, proved, {found.lower, found.upper}, {found.u, found.v});
    append_lanes(unproved, indices, first_lanes(count) & ~proved);
  }

  /// The enclosure of a time of impact, as it is searched for in the lanes.
  template <Kind kind, Norm norm>
  class Arrival {
   public:
    using Polygon = MovingPolygon<Lanes, kind, norm>;
    using Nearest = typename Polygon::Nearest;

    struct Found {
      Value lower;
      Value upper;
      Value u;
      Value v;
      Value corrected;  ///< where the time of impact seems to be, by the proof's own values
      Mask proved;

      /// This where it is proved, the other elsewhere.
      [[nodiscard]] Found or_else(const Found& other) const {
        return {select(proved, lower, other.lower),
                select(proved, upper, other.upper),
                select(proved, u, other.u),
                select(proved, v, other.v),
                other.corrected,
                proved | other.proved};
      }
    };

    Arrival(const Polygon& polygon, const PreciseProof<Lanes, kind, norm>& precise,
            const Value& begin, const Value& half_width)
        : polygon_(polygon), precise_(precise), begin_(begin), half_width_(half_width) {}

    /// By two steps of Newton's method; 0 stays 0.
    [[nodiscard]] Value corrected(Value time) const {
      const Mask is_start = time <= Value(0.0);
      for (int i = 0; i < 2; ++i) {
        const Nearest nearest(polygon_.corners_at(time));
        const auto seen =
            polygon_.predict(polygon_.project(nearest.direction), nearest.u, nearest.v, time);
        const Mask is_better = seen.is_near & (seen.time > begin_) & (seen.time <= Value(1.0));
        time = select(is_better, seen.time, time);
      }
      return select(is_start, Value(0.0), min(time, Value(1.0)));
    }

    /// \pre time is in [0,1].
    template <Norm norm_of_witness>
    [[nodiscard]] Found around(const Value& time) const {
      const Value margin = time * half_width_;
      const Value lower = max(time - margin, begin_);
      const Nearest at_begin(polygon_.corners_at(begin_)), at_lower(polygon_.corners_at(lower));
      const auto of_begin = polygon_.project(at_begin.direction);
      const auto of_lower = polygon_.project(at_lower.direction);
      const Value gap = precise_.least_gap(at_lower.direction, lower);
      const Value start = Polygon::Projections::at_point(of_lower.start, at_lower.u, at_lower.v);
      const Value end = Polygon::Projections::at_point(of_lower.end, at_lower.u, at_lower.v);
      const Value rate = start - end;
      // Contact may be over again within the margin: half a distance farther it is not.
      const Value through = precise_.distance() * Value(0.5) / rate;
      const Value upper =
          min(time + select(rate > Value(0.0), min(margin, through), margin), Value(1.0));
      const Mask is_start = upper == Value(0.0);
      const Mask is_free =
          is_start |
          (polygon_.begins_apart(of_begin, of_lower, begin_, lower, 2.0) & (gap > Value(0.0)));
      const NearestPoint<Lanes, kind, norm_of_witness> at_upper(polygon_.corners_at(upper));
      const auto [u, v] = in_domain<kind>(at_upper.u, at_upper.v);
      const Value seen = min(max(lower + gap / rate, begin_), Value(1.0));
      return {lower,
              upper,
              u,
              v,
              select(is_start, time, seen),
              is_free & precise_.is_within(upper, u, v)};
    }

   private:
    Polygon polygon_;
    PreciseProof<Lanes, kind, norm> precise_;
    Value begin_;
    Value half_width_;
  };

  /// u and v of the contact at a time, from the orientations, which are proportional to the
  /// barycentric coordinates.
  template <Kind kind>
  static std::array<Value, 2> contact(const std::array<Vector, query_points>& x,
                                      const Value& time) {
    constexpr auto ends = ends_of_vectors<kind>();
    constexpr auto all_orientations = orientations<kind>();
    std::array<Vector, vector_count> at;
    for (std::size_t i = 0; i < vector_count; ++i) {
      at[i] =
          filters::at_time(minus(x[ends[i][0]], x[ends[i][1]]),
                           minus(x[4 + ends[i][0]], x[4 + ends[i][1]]), Value(1.0) - time, time);
    }
    const Vector d = filters::cross(at[p], at[q]);
    std::array<Value, all_orientations.size()> o;
    for (std::size_t i = 0; i < o.size(); ++i) {
      const auto [first, second, is_negative] = all_orientations[i];
      const Value value = filters::dot(at[first], filters::cross(d, at[second]));
      o[i] = max(is_negative ? Value(0.0) - value : value, Value(0.0));
    }
    const Value one(1.0);
    if constexpr (kind == Kind::vertex_face) {
      const Value sum = o[0] + o[1] + o[2];
      const Value u = min(o[1] / sum, one);
      return {u, min(o[0] / sum, one - u)};
    } else {
      return {min(o[1] / (o[1] + o[2]), one), min(o[0] / (o[0] + o[3]), one)};
    }
  }

  static void store_hits(KernelOutput& output, const std::array<std::uint32_t, width>& indices,
                         unsigned lanes, const std::array<Value, 2>& enclosure,
                         const std::array<Value, 2>& uv) {
    alignas(64) std::array<std::array<double, width>, 4> rows;
    enclosure[0].store(rows[0].data());
    enclosure[1].store(rows[1].data());
    uv[0].store(rows[2].data());
    uv[1].store(rows[3].data());
    for_each_lane(lanes, [&](std::size_t lane) {
      append(output.hits,
             KernelHit{indices[lane], rows[0][lane], rows[1][lane], rows[2][lane], rows[3][lane]});
    });
  }

  static void append_lanes(Indices& list, const std::array<std::uint32_t, width>& indices,
                           unsigned lanes) {
    for_each_lane(lanes, [&](std::size_t lane) { append(list, indices[lane]); });
  }
};

template <class Lanes>
void decide_on(const KernelInput& input, KernelOutput& output) {
  if (input.separation.distance > 0.0) {
    CertifiedStages<Lanes, true>::decide(input, output);
  } else {
    CertifiedStages<Lanes, false>::decide(input, output);
  }
}

template <class Lanes>
constexpr CertifiedKernel certified_kernel_on(InstructionSet instructions) {
  return {.instructions = instructions,
          .decide = decide_on<Lanes>,
          .product_then_sum = CertifiedStages<Lanes, false>::product_then_sum};
}

}  // namespace touchstone::fast
