#include "verify/fuzz/shrink.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <unordered_set>
#include <utility>
#include <vector>

#include "verify/generate/everyday.hpp"
#include "verify/generate/random_stream.hpp"

namespace touchstone::verify::fuzz {
namespace {

std::uint64_t hash_of(const AnyQuery& query) {
  std::uint64_t result = query.numbers().size() + (query.shape().is_rational ? 1 : 0);
  for (const double x : query.numbers()) {
    result = generate::mix(result + std::bit_cast<std::uint64_t>(x) + 0x9e3779b97f4a7c15ULL);
  }
  return result;
}

// ---- Plainer numbers ----------------------------------------------------------------------------

double with_sign_of(double x, double magnitude) { return x < 0.0 ? 0.0 - magnitude : magnitude; }

/// The decimals of this number of digits below and above a positive number; the number itself if it
/// has no more digits.
std::array<double, 2> with_digits(double x, int digits) {
  const generate::Decimal decimal = generate::shortest_decimal(x);
  const int dropped = decimal.count - digits;
  if (dropped <= 0) return {x, x};
  const std::uint64_t down =
      decimal.digits / static_cast<std::uint64_t>(generate::power_of_ten(dropped));
  return {generate::from_decimal(down, decimal.exponent + dropped),
          generate::from_decimal(down + 1, decimal.exponent + dropped)};
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
  const generate::Decimal decimal = generate::shortest_decimal(magnitude);
  for (const std::uint64_t digit : {1U, 2U, 5U}) {
    for (const int more : {0, 1}) {
      result.push_back(generate::from_decimal(digit, decimal.exponent + decimal.count - 1 + more));
    }
  }
  result.push_back(generate::from_decimal(decimal.digits, 0));
  result.push_back(generate::from_decimal(decimal.digits, 1 - decimal.count));
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

/// The maximum number of queries that are tested.
constexpr std::uint64_t most_calls = 50'000;

/// One run: the plainest query so far, and the steps from it.
class Shrinker {
 public:
  Shrinker(const AnyQuery& query, const std::function<bool(const AnyQuery&)>& still_fails,
           const std::function<bool()>& must_end)
      : still_fails_(still_fails),
        must_end_(must_end),
        query_(query),
        plainness_(plainness(query)) {
    seen_.insert(hash_of(query));
  }

  AnyQuery run() {
    Plainness before;
    do {
      before = plainness_;
      straighten();
      scale();
      translate();
      round_all();
      simplify_axes();
      simplify_points();
      simplify_values();
      simplify_coordinates();
    } while (plainness_ < before && !is_over());
    return query_;
  }

 private:
  [[nodiscard]] bool is_over() {
    over_ = over_ || calls_ >= most_calls || must_end_();
    return over_;
  }

  /// Keeps the query if it is plainer and still fails.
  bool attempt(const AnyQuery& plainer) {
    if (over_ || !is_valid(plainer)) return false;
    const Plainness of_plainer = plainness(plainer);
    if (of_plainer >= plainness_ || is_over()) return false;
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
    AnyQuery plainer = query_;
    for_each_coordinate(plainer, axis, [&](double& x) { x = change(x); });
    return attempt(plainer);
  }

  [[nodiscard]] const AnyShape& shape() const { return query_.shape(); }
  [[nodiscard]] std::size_t point_size() const { return shape().numbers_of_point(); }
  /// From a number of a control point to the same number of the next one.
  [[nodiscard]] std::size_t next() const { return to_next_control(query_); }

  // ---- Curves ----

  /// Attempts straight lines between two control points or at rest in one, the ends first; curves
  /// without weights; and of the next lower degree: the same curve if it has one, or one without
  /// some control point.
  void straighten() {
    while (!shape().is_straight()) {
      const std::size_t degree = shape().degree;
      bool is_plainer = attempt(without_weights(with_control({0, degree})));
      for (std::size_t i = 0; i < (degree + 1) * (degree + 1) && !is_plainer; ++i) {
        is_plainer = attempt(without_weights(with_control({i / (degree + 1), i % (degree + 1)})));
      }
      is_plainer =
          is_plainer || attempt(without_weights(query_)) || (degree > 1 && attempt(reduced()));
      for (std::size_t left_out = 0; left_out <= degree && degree > 1 && !is_plainer; ++left_out) {
        std::vector<std::size_t> kept;
        for (std::size_t j = 0; j <= degree; ++j) {
          if (j != left_out) kept.push_back(j);
        }
        is_plainer = attempt(with_control(kept));
      }
      if (!is_plainer) return;
    }
  }

  /// The curves of these control points.
  [[nodiscard]] AnyQuery with_control(const std::vector<std::size_t>& kept) const {
    std::vector<double> numbers;
    for (const std::size_t j : kept) {
      const auto control = std::as_const(query_).numbers().subspan(j * next(), next());
      numbers.insert(numbers.end(), control.begin(), control.end());
    }
    AnyShape of_kept = shape();
    of_kept.degree = kept.size() - 1;
    return {of_kept, std::move(numbers)};
  }

  static AnyQuery without_weights(const AnyQuery& query) {
    AnyShape bare = query.shape();
    bare.is_rational = false;
    std::vector<double> numbers;
    for_each_coordinate(query, point_axes, [&](double x) { numbers.push_back(x); });
    return {bare, std::move(numbers)};
  }

  /// The control points c of the next lower degree k that gave those b of the query's degree, if
  /// they did: (k+1) b_j = j c_(j−1) + (k+1−j) c_j.
  [[nodiscard]] AnyQuery reduced() const {
    AnyShape lower = shape();
    --lower.degree;
    const auto all = std::as_const(query_).numbers();
    std::vector<double> numbers(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(next()));
    const auto degree = static_cast<double>(shape().degree);
    for (std::size_t i = next(); i < lower.numbers_of_query(); ++i) {
      const std::size_t row = i / next();
      const auto j = static_cast<double>(row);
      numbers.push_back((degree * all[i] - j * numbers[i - next()]) / (degree - j));
    }
    return {lower, std::move(numbers)};
  }

  // ---- The whole ----

  /// Scales by powers of two: to sizes close to 1, or part of the way.
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
    AnyQuery plainer = query_;
    for_each_coordinate(plainer, point_axes, [&](double& x) { x = std::ldexp(x, shift); });
    return attempt(plainer);
  }

  void scale_axis(std::size_t axis) {
    const double greatest = greatest_of(axis);
    if (greatest == 0.0) return;
    const int shift = size_exponent(query_) - std::ilogb(greatest);
    attempt_axis(axis, [&](double x) { return std::ldexp(x, shift); });
    attempt_axis(axis, [&](double x) { return x / greatest; });
  }

  /// Translates such that a coordinate of some point becomes 0.
  void translate() {
    for (std::size_t i = 0; i < query_.numbers().size(); ++i) {
      const std::size_t axis = i % point_size();
      const double origin = query_.numbers()[i];
      if (axis >= point_axes || origin == 0.0) continue;
      attempt_axis(axis, [&](double x) { return x - origin; });
      attempt_axis(axis, [&](double x) { return to_digits(x - origin, digits_of_sums); });
    }
  }

  /// Rounds all coordinates, and those of each axis, to a number of digits, and to a number of
  /// places of the greatest one. Equality and order are preserved.
  void round_all() {
    for (std::size_t axis = 0; axis <= point_axes; ++axis) {
      const double greatest = greatest_of(axis);
      if (greatest == 0.0) continue;
      const generate::Decimal decimal = generate::shortest_decimal(greatest);
      const int top = decimal.exponent + decimal.count;
      for (const int digits : digit_counts) {
        const double unit = generate::from_decimal(1, top - digits);
        AnyQuery shorter = query_, on_grid = query_;
        for_each_coordinate(shorter, axis, [&](double& x) { x = to_digits(x, digits); });
        for_each_coordinate(on_grid, axis, [&](double& x) {
          // Avoids −0 and digits that come from the rounding of the product.
          x = to_digits(std::nearbyint(x / unit) * unit + 0.0, digits);
        });
        if (attempt(on_grid) || attempt(shorter)) break;
      }
    }
  }

  /// The greatest magnitude of an axis, or of all axes for an index beyond the last one.
  [[nodiscard]] double greatest_of(std::size_t axis) const {
    double greatest = 0.0;
    for_each_coordinate(query_, axis,
                        [&](double x) { greatest = std::max(greatest, std::abs(x)); });
    return greatest;
  }

  // ---- Axes and points ----

  void simplify_axes() {
    for (std::size_t axis = 0; axis < point_axes; ++axis) {
      attempt_axis(axis, [](double) { return 0.0; });
      attempt_axis(axis, [](double x) { return 0.0 - x; });
      for (std::size_t control = 0; control <= shape().degree; ++control) {
        AnyQuery at_rest = query_;
        for_each_index(axis, [&](std::size_t i) {
          at_rest.numbers()[i] = query_.numbers()[control * next() + i % next()];
        });
        attempt(at_rest);
      }
      for (std::size_t other = 0; other < point_axes; ++other) {
        AnyQuery alike = query_;
        for_each_index(
            axis, [&](std::size_t i) { alike.numbers()[i] = query_.numbers()[i - axis + other]; });
        attempt(alike);
      }
    }
  }

  /// Calls use(i) for the index of each number of an axis.
  template <class Use>
  void for_each_index(std::size_t axis, const Use& use) const {
    const std::size_t size = point_size(), count = query_.numbers().size();
    for (std::size_t i = axis; i < count; i += size) use(i);
  }

  /// Moves control points to another one, of one time or of all; to 0; to rest on an axis, which
  /// can make degenerate elements proper.
  void simplify_points() {
    const std::size_t count = moving_points * (shape().degree + 1);
    for (std::size_t to = 0; to < count; ++to) {
      AnyQuery at_zero = query_;
      place(at_zero, to, {0.0, 0.0, 0.0});
      attempt(at_zero);
      for (std::size_t from = 0; from < count; ++from) {
        copy_point(from, to, false);
        if (from < moving_points && to < moving_points) copy_point(from, to, true);
      }
      for (std::size_t axis = 0; axis < point_axes && to < moving_points; ++axis)
        put_on_axis(to, axis);
    }
  }

  static void place(AnyQuery& query, std::size_t point, const std::array<double, 3>& at) {
    std::ranges::copy(at, query.numbers().begin() + static_cast<std::ptrdiff_t>(
                                                        point * query.shape().numbers_of_point()));
  }

  void put_on_axis(std::size_t point, std::size_t axis) {
    AnyQuery plainer = query_;
    std::array<double, 3> at{};
    at.at(axis) = 1.0;
    for (std::size_t j = 0; j <= shape().degree; ++j) place(plainer, moving_points * j + point, at);
    attempt(plainer);
  }

  /// \param at_all_times Those of all control points; the indices are of the first ones.
  void copy_point(std::size_t from, std::size_t to, bool at_all_times) {
    AnyQuery plainer = query_;
    for (std::size_t j = 0; j <= (at_all_times ? shape().degree : 0); ++j) {
      for (std::size_t axis = 0; axis < point_axes; ++axis) {
        plainer.numbers()[j * next() + point_size() * to + axis] =
            query_.numbers()[j * next() + point_size() * from + axis];
      }
    }
    attempt(plainer);
  }

  // ---- Values ----

  /// Changes all numbers of one magnitude together, longest first.
  void simplify_values() {
    std::vector<double> all = magnitudes(query_);
    std::ranges::stable_sort(all, std::ranges::greater{}, digits_of);
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
    AnyQuery plainer = query_;
    for (double& x : plainer.numbers()) {
      if (std::abs(x) == magnitude) x = with_sign_of(x, replacement);
    }
    return attempt(plainer);
  }

  /// Changes each number alone, and at all times if it is at rest.
  void simplify_coordinates() {
    for (std::size_t i = 0; i < query_.numbers().size(); ++i) {
      for (const double candidate : candidates_for(i)) {
        AnyQuery plainer = query_;
        plainer.numbers()[i] = candidate;
        if (attempt(plainer)) break;
        if (i >= next()) continue;
        for (std::size_t j = 1; j <= shape().degree; ++j) {
          plainer.numbers()[j * next() + i] = candidate;
        }
        if (attempt(plainer)) break;
      }
    }
  }

  /// Numbers to try for a number, the plainest first.
  [[nodiscard]] std::vector<double> candidates_for(std::size_t i) const {
    const double x = query_.numbers()[i];
    const std::size_t other = i + next() < query_.numbers().size() ? i + next() : i - next();
    std::vector<double> result{0.0, query_.numbers()[other], std::abs(x), 1.0, -1.0};
    for (const double magnitude : magnitudes(query_)) {
      result.push_back(magnitude);
      result.push_back(-magnitude);
    }
    if (x == 0.0) return result;
    for (const double plainer : plainer_numbers(std::abs(x)))
      result.push_back(with_sign_of(x, plainer));
    return result;
  }

  const std::function<bool(const AnyQuery&)>& still_fails_;
  const std::function<bool()>& must_end_;
  AnyQuery query_;
  Plainness plainness_;
  /// Hashes of the queries tried. A query with the same hash as an earlier one is skipped.
  std::unordered_set<std::uint64_t> seen_;
  std::uint64_t calls_ = 0;
  bool over_ = false;
};

}  // namespace

AnyQuery shrink(const AnyQuery& query, const std::function<bool(const AnyQuery&)>& still_fails,
                const std::function<bool()>& must_end) {
  return Shrinker(query, still_fails, must_end).run();
}

}  // namespace touchstone::verify::fuzz
