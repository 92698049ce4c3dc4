#include "verify/fuzz/shrink.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <unordered_set>
#include <utility>
#include <vector>

#include "verify/fuzz/plainness.hpp"
#include "verify/generate/random.hpp"

namespace touchstone::verify::fuzz {
namespace {

std::uint64_t hash_of(const Query& query) {
  std::uint64_t result = 0;
  for (const double x : query.coordinates) {
    result = generate::mix(result + std::bit_cast<std::uint64_t>(x) + 0x9e3779b97f4a7c15ULL);
  }
  return result;
}

// ---- Plainer numbers ----------------------------------------------------------------------------

double with_sign_of(double x, double magnitude) { return x < 0.0 ? 0.0 - magnitude : magnitude; }

/// The decimals of this number of digits below and above a positive number; the number itself if it
/// has no more digits.
std::array<double, 2> with_digits(double x, int digits) {
  const Decimal decimal = shortest_decimal(x);
  const int dropped = decimal.count - digits;
  if (dropped <= 0) return {x, x};
  const std::uint64_t down = decimal.digits / static_cast<std::uint64_t>(power_of_ten(dropped));
  return {from_decimal(down, decimal.exponent + dropped),
          from_decimal(down + 1, decimal.exponent + dropped)};
}

/// The nearest decimal with this number of digits.
double to_digits(double x, int digits) {
  if (x == 0.0) return 0.0;
  const auto [down, up] = with_digits(std::abs(x), digits);
  return with_sign_of(x, std::abs(x) - down <= up - std::abs(x) ? down : up);
}

/// Numbers of digits to try, fewest first; then one fewer than there are.
constexpr std::array digit_counts{1, 2, 3, 4, 5, 6, 8, 10, 12, 14};

/// A decimal without the roundings of sums.
constexpr int digits_of_sums = 14;

/// Numbers to try in place of a positive one, the plainest first.
std::vector<double> plainer_numbers(double magnitude) {
  std::vector<double> result{0.0, 1.0, 2.0, 3.0, 0.5};
  const Decimal decimal = shortest_decimal(magnitude);
  for (const std::uint64_t digit : {1U, 2U, 5U}) {
    for (const int more : {0, 1}) {
      result.push_back(from_decimal(digit, decimal.exponent + decimal.count - 1 + more));
    }
  }
  result.push_back(from_decimal(decimal.digits, 0));
  result.push_back(from_decimal(decimal.digits, 1 - decimal.count));
  result.push_back(std::trunc(magnitude));
  result.push_back(std::ceil(magnitude));
  const auto add_rounded = [&](int count) {
    for (const double x : with_digits(magnitude, count)) result.push_back(x);
  };
  for (const int count : digit_counts) {
    if (count + 1 < decimal.count) add_rounded(count);
  }
  if (decimal.count > 1) add_rounded(decimal.count - 1);
  result.push_back(magnitude - 1.0);
  result.push_back(magnitude / 2.0);
  return result;
}

// ---- The search ---------------------------------------------------------------------------------

/// One run: the plainest query so far, and the steps from it.
class Shrinker {
 public:
  Shrinker(Kind kind, const Query& query, const std::function<bool(const Query&)>& still_fails,
           const ShrinkOptions& options)
      : kind_(kind),
        still_fails_(still_fails),
        options_(options),
        original_(query),
        of_original_(plainness(kind, query, query)),
        query_(query),
        plainness_(of_original_) {
    seen_.insert(hash_of(query));
  }

  Query run() {
    Plainness before;
    do {
      before = plainness_;
      scale();
      translate();
      follow_points();
      round_all();
      space_evenly();
      simplify_axes();
      simplify_points();
      simplify_values();
      simplify_coordinates();
      exchange_points();
    } while (plainness_ < before && !is_over());
    return query_;
  }

 private:
  [[nodiscard]] bool is_over() {
    over_ = over_ || calls_ >= options_.most_calls || (options_.must_end && options_.must_end());
    return over_;
  }

  /// Keeps the query if it is plainer and still fails.
  bool attempt(const Query& plainer) {
    if (over_ || !is_finite(plainer)) return false;
    const Plainness of_plainer = plainness(kind_, plainer, original_);
    if (of_plainer >= plainness_ || of_plainer.is_worse_somewhere(of_original_) || is_over()) {
      return false;
    }
    if (!seen_.insert(hash_of(plainer)).second) return false;
    ++calls_;
    if (!still_fails_(plainer)) return false;
    query_ = plainer;
    plainness_ = of_plainer;
    return true;
  }

  /// Attempts the query with `change` applied to each coordinate of an axis.
  template <class Change>
  bool attempt_axis(std::size_t axis, const Change& change) {
    Query plainer = query_;
    for (std::size_t i = axis; i < coordinate_count; i += point_axes) {
      plainer.coordinates[i] = change(plainer.coordinates[i]);
    }
    return attempt(plainer);
  }

  // ---- The whole ----

  /// Scales by powers of two: to the original's size or a similar one, if that is everyday; else to
  /// any everyday size, those close to 1 first, or part of the way.
  void scale() {
    const int size = size_exponent(query_);
    for (const int target : {0, 1, -1, 2, -2, 3, -3, 4, -4, 6, -6, 9, -9}) scale_by(target - size);
    for (const int part : {2, 4, 8}) {
      while (scale_by(-size_exponent(query_) / part)) {
      }
    }
    for (std::size_t axis = 0; axis < point_axes; ++axis) scale_axis(axis);
  }

  bool scale_by(int shift) {
    Query plainer = query_;
    for (double& x : plainer.coordinates) x = std::ldexp(x, shift);
    return attempt(plainer);
  }

  void scale_axis(std::size_t axis) {
    double greatest = 0.0;
    for (std::size_t i = axis; i < coordinate_count; i += point_axes) {
      greatest = std::max(greatest, std::abs(query_.coordinates[i]));
    }
    if (greatest == 0.0) return;
    const int shift = size_exponent(query_) - std::ilogb(greatest);
    attempt_axis(axis, [&](double x) { return std::ldexp(x, shift); });
    attempt_axis(axis, [&](double x) { return x / greatest; });
    attempt_axis(axis, [](double x) { return x / 2.0; });
    attempt_axis(axis, [](double x) { return x * 2.0; });
  }

  /// Translates such that a coordinate of some point becomes 0.
  void translate() {
    for (std::size_t i = 0; i < coordinate_count; ++i) {
      const double origin = query_.coordinates[i];
      if (origin == 0.0) continue;
      attempt_axis(i % point_axes, [&](double x) { return x - origin; });
      attempt_axis(i % point_axes, [&](double x) { return to_digits(x - origin, digits_of_sums); });
    }
  }

  /// Changes to the frame of a point: it rests, the others move relative to it.
  void follow_points() {
    for (std::size_t point = 0; point < moving_points; ++point) {
      for (std::size_t axis = 0; axis < point_axes; ++axis) {
        const double motion = query_.at(1, point, axis) - query_.at(0, point, axis);
        Query plainer = query_;
        for (std::size_t other = 0; other < moving_points; ++other) {
          plainer.at(1, other, axis) -= motion;
        }
        if (motion != 0.0) attempt(plainer);
      }
    }
  }

  /// Rounds all coordinates, and those of each axis, to a number of digits, and to a number of
  /// places of the greatest one. Equality and order are preserved.
  void round_all() {
    for (std::size_t axis = 0; axis <= point_axes; ++axis) {
      double greatest = 0.0;
      for_each_of(axis, query_, [&](double& x) { greatest = std::max(greatest, std::abs(x)); });
      if (greatest == 0.0) continue;
      const Decimal decimal = shortest_decimal(greatest);
      const int top = decimal.exponent + decimal.count;
      for (const int digits : digit_counts) {
        const double unit = from_decimal(1, top - digits);
        Query shorter = query_, on_grid = query_;
        for_each_of(axis, shorter, [&](double& x) { x = to_digits(x, digits); });
        for_each_of(axis, on_grid, [&](double& x) {
          // Avoids −0 and digits that come from the rounding of the product.
          x = to_digits(std::nearbyint(x / unit) * unit + 0.0, digits);
        });
        if (attempt(on_grid) || attempt(shorter)) break;
      }
    }
  }

  /// Spaces the values of all coordinates, and of those of each axis, evenly in their order: faults
  /// that depend on order and equality remain.
  void space_evenly() {
    for (std::size_t axis = 0; axis <= point_axes; ++axis) {
      std::vector<double> values;
      for_each_of(axis, query_, [&](double& x) { values.push_back(x); });
      std::ranges::sort(values);
      values.erase(std::unique(values.begin(), values.end()), values.end());
      const double greatest = std::max(std::abs(values.front()), std::abs(values.back()));
      if (greatest == 0.0) continue;
      const Decimal decimal = shortest_decimal(greatest);
      const int top = decimal.exponent + decimal.count;
      for (const int exponent : {top, top - 1, top - 2, top - 3}) {
        for (const std::uint64_t step : {1U, 2U, 3U, 5U, 7U}) {
          space_evenly(axis, values, step, exponent);
        }
      }
    }
  }

  void space_evenly(std::size_t axis, const std::vector<double>& values, std::uint64_t step,
                    int exponent) {
    // Values next to 0 stay there.
    const auto rank_of = [&](double x) {
      return std::ranges::lower_bound(values, x) - values.begin();
    };
    const std::ptrdiff_t zero = rank_of(0.0);
    Query plainer = query_;
    for_each_of(axis, plainer, [&](double& x) {
      const std::ptrdiff_t rank = rank_of(x) - zero;
      const double magnitude =
          from_decimal(step * static_cast<std::uint64_t>(std::abs(rank)), exponent);
      x = rank < 0 ? -magnitude : magnitude;
    });
    attempt(plainer);
  }

  /// Calls use(x) for the coordinates of an axis, or of all axes for an index beyond the last one.
  template <class Use>
  static void for_each_of(std::size_t axis, Query& query, const Use& use) {
    for (std::size_t i = 0; i < coordinate_count; ++i) {
      if (axis == point_axes || i % point_axes == axis) use(query.coordinates[i]);
    }
  }

  // ---- Axes and points ----

  void simplify_axes() {
    for (std::size_t axis = 0; axis < point_axes; ++axis) {
      attempt_axis(axis, [](double) { return 0.0; });
      attempt_axis(axis, [](double x) { return 0.0 - x; });
      for (std::size_t end = 0; end < motion_ends; ++end) {
        Query at_rest = query_;
        for (std::size_t point = 0; point < moving_points; ++point) {
          at_rest.at(1 - end, point, axis) = at_rest.at(end, point, axis);
        }
        attempt(at_rest);
      }
      for (std::size_t other = 0; other < point_axes; ++other) {
        Query alike = query_;
        for (std::size_t i = axis; i < coordinate_count; i += point_axes) {
          alike.coordinates[i] = query_.coordinates[i - axis + other];
        }
        attempt(alike);
      }
    }
  }

  /// Moves points to another one, at both ends or at one; to 0; to rest on an axis, which can make
  /// degenerate elements proper.
  void simplify_points() {
    for (std::size_t to = 0; to < query_points; ++to) {
      Query at_zero = query_;
      at_zero.point(to / moving_points, to % moving_points).setZero();
      attempt(at_zero);
      for (std::size_t from = 0; from < query_points; ++from) {
        copy_point(from, to, false);
        if (from < moving_points && to < moving_points) copy_point(from, to, true);
      }
      for (std::size_t axis = 0; axis < point_axes && to < moving_points; ++axis)
        put_on_axis(to, axis);
    }
  }

  void put_on_axis(std::size_t point, std::size_t axis) {
    Query plainer = query_;
    for (std::size_t end = 0; end < motion_ends; ++end) {
      plainer.point(end, point).setZero();
      plainer.at(end, point, axis) = 1.0;
    }
    attempt(plainer);
  }

  void copy_point(std::size_t from, std::size_t to, bool at_both_ends) {
    Query plainer = query_;
    for (std::size_t axis = 0; axis < point_axes; ++axis) {
      const std::size_t source = point_axes * from + axis, target = point_axes * to + axis;
      plainer.coordinates[target] = query_.coordinates[source];
      if (!at_both_ends) continue;
      plainer.coordinates[target + to_other_end] = query_.coordinates[source + to_other_end];
    }
    attempt(plainer);
  }

  void exchange_points() {
    for (const PointPair& pair : exchangeable(kind_)) {
      Query plainer = query_;
      for (std::size_t end = 0; end < motion_ends; ++end) {
        plainer.point(end, pair[0]) = query_.point(end, pair[1]);
        plainer.point(end, pair[1]) = query_.point(end, pair[0]);
      }
      attempt(plainer);
    }
  }

  // ---- Values ----

  /// Changes all coordinates of one magnitude together, longest first.
  void simplify_values() {
    std::vector<double> all = magnitudes(query_);
    std::ranges::stable_sort(all, std::ranges::greater{}, writing_length);
    for (const double magnitude : all) {
      std::vector<double> candidates = plainer_numbers(magnitude);
      const std::vector<double> others = magnitudes(query_);
      candidates.insert(candidates.begin() + 1, others.begin(), others.end());
      for (const double candidate : candidates) {
        if (replace_magnitude(magnitude, candidate)) break;
      }
    }
  }

  bool replace_magnitude(double magnitude, double replacement) {
    Query plainer = query_;
    for (double& x : plainer.coordinates) {
      if (std::abs(x) == magnitude) x = with_sign_of(x, replacement);
    }
    return attempt(plainer);
  }

  /// Changes each coordinate alone, and at both ends if it is at rest.
  void simplify_coordinates() {
    for (std::size_t i = 0; i < coordinate_count; ++i) {
      for (const double candidate : candidates_for(i)) {
        Query plainer = query_;
        plainer.coordinates[i] = candidate;
        if (attempt(plainer)) break;
        if (i >= to_other_end) continue;
        plainer.coordinates[i + to_other_end] = candidate;
        if (attempt(plainer)) break;
      }
    }
  }

  /// Numbers to try for a coordinate, the plainest first.
  [[nodiscard]] std::vector<double> candidates_for(std::size_t i) const {
    const double x = query_.coordinates[i];
    const std::size_t other_end = i < to_other_end ? i + to_other_end : i - to_other_end;
    std::vector<double> result{0.0, query_.coordinates[other_end], std::abs(x), 1.0, -1.0};
    for (const double magnitude : magnitudes(query_)) {
      result.push_back(magnitude);
      result.push_back(-magnitude);
    }
    if (x == 0.0) return result;
    for (const double plainer : plainer_numbers(std::abs(x)))
      result.push_back(with_sign_of(x, plainer));
    return result;
  }

  Kind kind_;
  const std::function<bool(const Query&)>& still_fails_;
  const ShrinkOptions& options_;
  const Query& original_;
  Plainness of_original_;
  Query query_;
  Plainness plainness_;
  /// Hashes of the queries tried. A query with the same hash as an earlier one is skipped.
  std::unordered_set<std::uint64_t> seen_;
  std::uint64_t calls_ = 0;
  bool over_ = false;
};

}  // namespace

Query shrink(Kind kind, const Query& query, const std::function<bool(const Query&)>& still_fails,
             const ShrinkOptions& options) {
  return Shrinker(kind, query, still_fails, options).run();
}

}  // namespace touchstone::verify::fuzz
