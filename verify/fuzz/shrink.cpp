#include "verify/fuzz/shrink.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <unordered_set>
#include <utility>
#include <vector>

#include "verify/generate/random.hpp"

namespace touchstone::verify::fuzz {
namespace {

constexpr std::size_t axes = 3;
constexpr std::size_t ends = 2;
constexpr std::size_t coordinate_count = axes * query_points;
/// Distance of a point's coordinate at t=0 from the one at t=1.
constexpr std::size_t to_other_end = axes * moving_points;

// ---- Complexity ---------------------------------------------------------------------------------

/// A number as its significant bits and where they stand: they begin below 2^top, and are all
/// multiples of 2^lowest.
struct Places {
  int top;
  int lowest;
};

/// \pre x is finite and not 0.
Places places(double x) {
  int top = 0;
  const double fraction = std::frexp(x, &top);
  const auto significand = static_cast<std::int64_t>(std::ldexp(std::abs(fraction), 53));
  return {top, top - 53 + std::countr_zero(static_cast<std::uint64_t>(significand))};
}

std::uint64_t writing_length(double magnitude) {
  const auto [top, lowest] = places(magnitude);
  const int bits = top - lowest, empty = std::max({lowest, -top, 0});
  return static_cast<std::uint64_t>(bits + empty + (lowest < 0 ? 2 : 0));
}

/// The magnitudes that occur, 0 apart, least first.
std::vector<double> magnitudes(const Query& query) {
  std::vector<double> result;
  for (const double x : query.coordinates) {
    if (x != 0.0) result.push_back(std::abs(x));
  }
  std::ranges::sort(result);
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

using PointPair = std::array<std::size_t, 2>;

/// The pairs of points whose order does not matter.
std::span<const PointPair> exchangeable(Kind kind) {
  static constexpr std::array<PointPair, 3> of_face{{{1, 2}, {1, 3}, {2, 3}}};
  static constexpr std::array<PointPair, 2> of_edges{{{0, 1}, {2, 3}}};
  if (kind == Kind::vertex_face) return of_face;
  return of_edges;
}

bool is_greater(const Query& query, const PointPair& pair) {
  for (std::size_t end = 0; end < ends; ++end) {
    for (std::size_t axis = 0; axis < axes; ++axis) {
      const double first = query.at(end, pair[0], axis), second = query.at(end, pair[1], axis);
      if (first != second) return first > second;
    }
  }
  return false;
}

std::uint64_t hash_of(const Query& query) {
  std::uint64_t result = 0;
  for (const double x : query.coordinates) {
    result = generate::mix(result + std::bit_cast<std::uint64_t>(x) + 0x9e3779b97f4a7c15ULL);
  }
  return result;
}

// ---- Simpler numbers ----------------------------------------------------------------------------

/// The number rounded to so many bits, towards 0 and away from it. \pre x is finite and not 0.
std::array<double, 2> with_bits(double x, int bits) {
  int top = 0;
  const double scaled = std::ldexp(std::frexp(x, &top), bits);
  const double down = std::trunc(scaled), up = down + std::copysign(1.0, x);
  return {std::ldexp(down, top - bits), std::ldexp(up, top - bits)};
}

/// Numbers of bits to try, fewest first; then one fewer than there are.
constexpr std::array bit_counts{1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 24, 28, 32, 40, 48};

/// Numbers to try in the place of a positive one, the simplest first.
std::vector<double> simpler_numbers(double magnitude) {
  std::vector<double> result{0.0, 1.0, 2.0, 3.0, 0.5};
  const auto [top, lowest] = places(magnitude);
  const int bits = top - lowest;
  result.push_back(std::ldexp(magnitude, -lowest));  // the odd integer of the same bits
  result.push_back(std::ldexp(magnitude, 1 - top));  // between 1 and 2
  result.push_back(std::trunc(magnitude));
  result.push_back(std::ceil(magnitude));
  const auto add_rounded = [&](int count) {
    for (const double x : with_bits(magnitude, count)) result.push_back(x);
  };
  for (const int count : bit_counts) {
    if (count + 1 < bits) add_rounded(count);
  }
  if (bits > 1) add_rounded(bits - 1);
  result.push_back(magnitude - 1.0);
  result.push_back(magnitude / 2.0);
  return result;
}

// ---- The search ---------------------------------------------------------------------------------

/// One run: the simplest query so far, and the steps from it.
class Shrinker {
 public:
  Shrinker(Kind kind, const Query& query, const std::function<bool(const Query&)>& still_fails,
           const ShrinkOptions& options)
      : kind_(kind),
        still_fails_(still_fails),
        options_(options),
        query_(query),
        complexity_(complexity(kind, query)) {
    seen_.insert(hash_of(query));
  }

  Query run() {
    Complexity before;
    do {
      before = complexity_;
      scale();
      translate();
      follow_points();
      round_all();
      simplify_axes();
      simplify_points();
      simplify_values();
      simplify_coordinates();
      exchange_points();
    } while (complexity_ < before && !is_over());
    return query_;
  }

 private:
  [[nodiscard]] bool is_over() {
    over_ = over_ || calls_ >= options_.most_calls || (options_.must_end && options_.must_end());
    return over_;
  }

  /// Keeps the query if it is simpler and still fails.
  bool attempt(const Query& simpler) {
    if (over_ || !is_finite(simpler)) return false;
    const Complexity of_simpler = complexity(kind_, simpler);
    if (of_simpler >= complexity_ || is_over()) return false;
    if (!seen_.insert(hash_of(simpler)).second) return false;
    ++calls_;
    if (!still_fails_(simpler)) return false;
    query_ = simpler;
    complexity_ = of_simpler;
    return true;
  }

  /// Attempts the query with `change` applied to each coordinate of an axis.
  template <class Change>
  bool attempt_axis(std::size_t axis, const Change& change) {
    Query simpler = query_;
    for (std::size_t i = axis; i < coordinate_count; i += axes) {
      simpler.coordinates[i] = change(simpler.coordinates[i]);
    }
    return attempt(simpler);
  }

  // ---- The whole ----

  /// By powers of two: so that the greatest magnitude is between 1 and 2, and so that all are
  /// integers; in steps too, where only some of the way is possible.
  void scale() {
    const std::vector<double> all = magnitudes(query_);
    if (all.empty()) return;
    int lowest = std::numeric_limits<int>::max();
    for (const double x : all) lowest = std::min(lowest, places(x).lowest);
    const int top = places(all.back()).top;
    for (const int shift : {-lowest, 1 - top, (1 - top) / 2, (1 - top) / 4, top > 1 ? -1 : 1}) {
      scale_by(shift);
    }
    for (std::size_t axis = 0; axis < axes; ++axis) scale_axis(axis);
  }

  void scale_by(int shift) {
    Query simpler = query_;
    for (double& x : simpler.coordinates) x = std::ldexp(x, shift);
    attempt(simpler);
  }

  void scale_axis(std::size_t axis) {
    double greatest = 0.0;
    for (std::size_t i = axis; i < coordinate_count; i += axes) {
      greatest = std::max(greatest, std::abs(query_.coordinates[i]));
    }
    if (greatest == 0.0) return;
    const int shift = 1 - places(greatest).top;
    attempt_axis(axis, [&](double x) { return std::ldexp(x, shift); });
    attempt_axis(axis, [&](double x) { return x / greatest; });
    attempt_axis(axis, [](double x) { return x / 2.0; });
    attempt_axis(axis, [](double x) { return x * 2.0; });
  }

  /// So that some point's coordinate becomes 0.
  void translate() {
    for (std::size_t i = 0; i < coordinate_count; ++i) {
      const double origin = query_.coordinates[i];
      if (origin != 0.0) attempt_axis(i % axes, [&](double x) { return x - origin; });
    }
  }

  /// Seen from a point: it rests, the others move relative to it.
  void follow_points() {
    for (std::size_t point = 0; point < moving_points; ++point) {
      for (std::size_t axis = 0; axis < axes; ++axis) {
        const double motion = query_.at(1, point, axis) - query_.at(0, point, axis);
        Query simpler = query_;
        for (std::size_t other = 0; other < moving_points; ++other) {
          simpler.at(1, other, axis) -= motion;
        }
        if (motion != 0.0) attempt(simpler);
      }
    }
  }

  /// All coordinates to so many bits, and to so many binary places of the greatest one.
  void round_all() {
    const std::vector<double> all = magnitudes(query_);
    if (all.empty()) return;
    const int top = places(all.back()).top;
    for (const int bits : bit_counts) {
      Query shorter = query_, on_grid = query_;
      for (double& x : shorter.coordinates) {
        if (x != 0.0) x = with_bits(x, bits + 1)[0];
      }
      for (double& x : on_grid.coordinates) {
        x = std::ldexp(std::nearbyint(std::ldexp(x, bits - top)), top - bits) + 0.0;  // no −0
      }
      if (attempt(on_grid) || attempt(shorter)) return;
    }
  }

  // ---- Axes and points ----

  void simplify_axes() {
    for (std::size_t axis = 0; axis < axes; ++axis) {
      attempt_axis(axis, [](double) { return 0.0; });
      attempt_axis(axis, [](double x) { return 0.0 - x; });
      for (std::size_t end = 0; end < ends; ++end) {
        Query at_rest = query_;
        for (std::size_t point = 0; point < moving_points; ++point) {
          at_rest.at(1 - end, point, axis) = at_rest.at(end, point, axis);
        }
        attempt(at_rest);
      }
      for (std::size_t other = 0; other < axes; ++other) {
        Query alike = query_;
        for (std::size_t i = axis; i < coordinate_count; i += axes) {
          alike.coordinates[i] = query_.coordinates[i - axis + other];
        }
        attempt(alike);
      }
    }
  }

  /// Points in the place of another, at both ends or at one; at 0; at rest.
  void simplify_points() {
    for (std::size_t to = 0; to < query_points; ++to) {
      Query at_zero = query_;
      at_zero.point(to / moving_points, to % moving_points).setZero();
      attempt(at_zero);
      for (std::size_t from = 0; from < query_points; ++from) {
        copy_point(from, to, false);
        if (from < moving_points && to < moving_points) copy_point(from, to, true);
      }
    }
  }

  void copy_point(std::size_t from, std::size_t to, bool at_both_ends) {
    Query simpler = query_;
    for (std::size_t axis = 0; axis < axes; ++axis) {
      const std::size_t source = axes * from + axis, target = axes * to + axis;
      simpler.coordinates[target] = query_.coordinates[source];
      if (!at_both_ends) continue;
      simpler.coordinates[target + to_other_end] = query_.coordinates[source + to_other_end];
    }
    attempt(simpler);
  }

  void exchange_points() {
    for (const PointPair& pair : exchangeable(kind_)) {
      Query simpler = query_;
      for (std::size_t end = 0; end < ends; ++end) {
        simpler.point(end, pair[0]) = query_.point(end, pair[1]);
        simpler.point(end, pair[1]) = query_.point(end, pair[0]);
      }
      attempt(simpler);
    }
  }

  // ---- Values ----

  /// All coordinates of one magnitude together, longest first.
  void simplify_values() {
    std::vector<double> all = magnitudes(query_);
    std::ranges::stable_sort(all, std::ranges::greater{}, writing_length);
    for (const double magnitude : all) {
      std::vector<double> candidates = simpler_numbers(magnitude);
      const std::vector<double> others = magnitudes(query_);
      candidates.insert(candidates.begin() + 1, others.begin(), others.end());
      for (const double candidate : candidates) {
        if (replace_magnitude(magnitude, candidate)) break;
      }
    }
  }

  bool replace_magnitude(double magnitude, double replacement) {
    Query simpler = query_;
    for (double& x : simpler.coordinates) {
      if (std::abs(x) == magnitude) x = x < 0.0 ? 0.0 - replacement : replacement;
    }
    return attempt(simpler);
  }

  void simplify_coordinates() {
    for (std::size_t i = 0; i < coordinate_count; ++i) {
      for (const double candidate : candidates_for(i)) {
        Query simpler = query_;
        simpler.coordinates[i] = candidate;
        if (attempt(simpler)) break;
      }
    }
  }

  /// Numbers to try for a coordinate, the simplest first.
  [[nodiscard]] std::vector<double> candidates_for(std::size_t i) const {
    const double x = query_.coordinates[i];
    const std::size_t other_end = i < to_other_end ? i + to_other_end : i - to_other_end;
    std::vector<double> result{0.0, query_.coordinates[other_end], std::abs(x)};
    for (const double magnitude : magnitudes(query_)) {
      result.push_back(magnitude);
      result.push_back(-magnitude);
    }
    if (x == 0.0) return result;
    for (const double simpler : simpler_numbers(std::abs(x))) {
      result.push_back(x < 0.0 ? 0.0 - simpler : simpler);
    }
    return result;
  }

  Kind kind_;
  const std::function<bool(const Query&)>& still_fails_;
  const ShrinkOptions& options_;
  Query query_;
  Complexity complexity_;
  /// Hashes of what has been asked. Where two are the same, a query is left out.
  std::unordered_set<std::uint64_t> seen_;
  std::uint64_t calls_ = 0;
  bool over_ = false;
};

}  // namespace

Complexity complexity(Kind kind, const Query& query) {
  constexpr std::uint64_t of_magnitude = 8, of_coordinate = 2;
  constexpr unsigned room_for_sum = 8;
  Complexity result;
  for (const double x : magnitudes(query)) {
    result.length += of_magnitude + writing_length(x);
    result.size += std::bit_cast<std::uint64_t>(x) >> room_for_sum;
  }
  for (std::size_t i = 0; i < coordinate_count; ++i) {
    const double x = query.coordinates[i];
    if (x != 0.0) result.length += of_coordinate;
    if (std::signbit(x)) ++result.length;
    if (i < to_other_end && x != query.coordinates[i + to_other_end]) ++result.length;
  }
  for (const PointPair& pair : exchangeable(kind)) {
    if (is_greater(query, pair)) ++result.disorder;
  }
  return result;
}

Query shrink(Kind kind, const Query& query, const std::function<bool(const Query&)>& still_fails,
             const ShrinkOptions& options) {
  return Shrinker(kind, query, still_fails, options).run();
}

}  // namespace touchstone::verify::fuzz
