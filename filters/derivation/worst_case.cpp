#include "touchstone/derivation/worst_case.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace touchstone::filters {
namespace {

/// Coordinates are 0 or in [2^-least_scale, 2) in magnitude.
constexpr int least_scale = 32;
/// The number of random inputs from whose best a climb starts, and the number of changes without
/// gain that end it.
constexpr int samples_per_climb = 200;
constexpr int patience = 3000;

/// A point of a group's polygon: Σ shares[i] vertex_i / 2^bits, the shares adding up to 2^bits.
struct GroupPoint {
  int bits = 0;
  std::vector<std::int64_t> shares;
};

struct State {
  std::vector<double> coordinates;
  std::vector<GroupPoint> points;
};

/// Of a number ≥ 0 over a power of two.
double nearest_double(const mpq_class& x) {
  mpz_class bits = x.get_num();
  auto exponent = -static_cast<int>(mpz_scan1(x.get_den_mpz_t(), 0));
  // The conversion rounds 62 bits to nearest; the last one stands for all that follow, too.
  const int excess = static_cast<int>(mpz_sizeinbase(bits.get_mpz_t(), 2)) - 62;
  if (excess > 0) {
    const auto shift = static_cast<mp_bitcnt_t>(excess);
    const bool is_inexact = mpz_scan1(bits.get_mpz_t(), 0) < shift;
    bits >>= shift;
    if (is_inexact) bits |= 1;
    exponent += excess;
  }
  // (GMP's own integers are `long`, which has 32 bits on Windows.)
  const mpz_class upper = bits >> 31U, lower = bits - (upper << 31U);
  return std::ldexp(static_cast<double>(std::int64_t{upper.get_si()} << 31U | lower.get_si()),
                    exponent);
}

class Search {
 public:
  Search(const ExpressionGraph& graph, const Evaluators& evaluators, const Format& format,
         const WorstCaseOptions& options)
      : graph_(graph),
        evaluators_(evaluators),
        format_(format),
        digits_(format_of_bounds(format).digits),
        degree_(static_cast<int>(derive_bound(graph, format).coefficients.size()) - 1),
        budget_(options.evaluations),
        random_(options.seed) {}

  WorstCase run() {
    while (budget_ > 0) climb(best_of_samples());
    return worst_;
  }

 private:
  // ---- Random numbers, without the standard's distributions, which differ between libraries -----

  std::uint64_t below(std::uint64_t end) { return random_() % end; }
  int between(int least, int greatest) {
    return least + static_cast<int>(below(static_cast<std::uint64_t>(greatest - least) + 1));
  }
  bool one_in(std::uint64_t n) { return below(n) == 0; }
  /// Random bits of a random length.
  std::int64_t random_bits(int most) {
    return static_cast<std::int64_t>(random_() >> (64 - between(1, most)));
  }

  // ---- Inputs -----------------------------------------------------------------------------------

  /// 1.000…r: mostly just above a power of two, sometimes far above it.
  double random_coordinate() {
    const double fraction = std::ldexp(static_cast<double>(random_bits(digits_ - 1)), 1 - digits_);
    const int scale = one_in(4) ? between(0, least_scale) : between(0, 1);
    return (one_in(2) ? 1 : -1) * std::ldexp(1 + fraction, -scale);
  }

  /// Just below 1, for the one vertex of a measured coordinate's weight.
  GroupPoint random_measure() {
    return {.bits = digits_, .shares = {(std::int64_t{1} << digits_) - random_bits(digits_ - 4)}};
  }

  GroupPoint random_point(std::size_t vertices) {
    if (vertices == 1) return random_measure();
    GroupPoint point{.bits = one_in(3) ? between(1, digits_) : digits_, .shares = {}};
    const std::int64_t whole = std::int64_t{1} << point.bits;
    std::vector<std::int64_t> cuts{0, whole};
    for (std::size_t i = 1; i < vertices; ++i) {
      cuts.push_back(static_cast<std::int64_t>(below(static_cast<std::uint64_t>(whole) + 1)));
    }
    std::ranges::sort(cuts);
    for (std::size_t i = 0; i < vertices; ++i) point.shares.push_back(cuts[i + 1] - cuts[i]);
    return point;
  }

  State random_state() {
    State state;
    for (std::size_t i = 0; i < graph_.coordinates; ++i) {
      state.coordinates.push_back(random_coordinate());
    }
    for (const GroupVertices& group : graph_.groups) {
      state.points.push_back(random_point(group.size()));
    }
    return state;
  }

  [[nodiscard]] Inputs inputs(const State& state) const {
    Inputs result{.coordinates = state.coordinates, .weights = {}};
    for (std::size_t g = 0; g < graph_.groups.size(); ++g) {
      const auto& [bits, shares] = state.points[g];
      for (std::size_t weight = 0; weight < graph_.groups[g].front().size(); ++weight) {
        std::int64_t sum = 0;
        for (std::size_t i = 0; i < shares.size(); ++i) {
          sum += shares[i] * graph_.groups[g][i][weight];
        }
        result.weights.push_back(std::ldexp(static_cast<double>(sum), -bits));
      }
    }
    return result;
  }

  // ---- Changes ----------------------------------------------------------------------------------

  void change_coordinate(double& x) {
    switch (below(8)) {
      case 0:
        x = random_coordinate();
        break;
      case 1:
        x = -x;
        break;
      case 2:
        x *= one_in(2) ? 2 : 0.5;
        break;
      case 3:
        x = std::copysign(std::ldexp(1.0, -between(0, 2)), x);
        break;
      default:
        x += (one_in(2) ? 1 : -1) *
             std::ldexp(static_cast<double>(random_bits(digits_ - 1)), std::ilogb(x) + 1 - digits_);
    }
    if (digits_ == float_format.digits) x = static_cast<double>(static_cast<float>(x));
    const bool in_range = std::abs(x) >= std::ldexp(1.0, -least_scale) && std::abs(x) < 2;
    if (!in_range) x = random_coordinate();
  }

  void change_point(GroupPoint& point) {
    if (one_in(8) || point.shares.size() == 1) {
      point = random_point(point.shares.size());
      return;
    }
    std::int64_t& from = point.shares[below(point.shares.size())];
    std::int64_t& to = point.shares[below(point.shares.size())];
    const std::int64_t amount = std::min(from, random_bits(point.bits));
    from -= amount;
    to += amount;
  }

  State changed(State state) {
    do {
      const std::size_t input = below(state.coordinates.size() + 2 * state.points.size());
      if (input < state.coordinates.size()) {
        change_coordinate(state.coordinates[input]);
      } else {
        change_point(state.points[(input - state.coordinates.size()) / 2]);
      }
    } while (one_in(3));
    return state;
  }

  // ---- The search -------------------------------------------------------------------------------

  [[nodiscard]] mpq_class computed(const Inputs& at) const {
    if (format_.digits == float_format.digits) return {evaluators_.in_float(at)};
    if (format_.digits == double_format.digits) return {evaluators_.in_double(at)};
    const auto [high, low] = evaluators_.in_double_double(at);
    return mpq_class(high) + mpq_class(low);
  }

  /// The error as a multiple of x^degree; counts as one evaluation.
  double error(const State& state) {
    --budget_;
    Inputs at = inputs(state);
    const double distance = nearest_double(abs(computed(at) - evaluators_.in_rationals(at)));
    double greatest = 0;
    for (const double x : at.coordinates) greatest = std::max(greatest, std::abs(x));
    const double relative = distance / std::pow(greatest, degree_);
    const double units = std::ldexp(relative, format_.digits);
    if (units > worst_.units) worst_ = {.inputs = std::move(at), .units = units};
    return relative;
  }

  State best_of_samples() {
    State best = random_state();
    double best_error = -1;
    for (int i = 0; i < samples_per_climb && budget_ > 0; ++i) {
      State state = random_state();
      const double found = error(state);
      if (found <= best_error) continue;
      best = std::move(state);
      best_error = found;
    }
    return best;
  }

  void climb(State state) {
    if (budget_ == 0) return;
    double height = error(state);
    for (int without_gain = 0; without_gain < patience && budget_ > 0; ++without_gain) {
      State next = changed(state);
      const double found = error(next);
      if (found > height) without_gain = 0;
      if (found < height) continue;
      state = std::move(next);
      height = found;
    }
  }

  const ExpressionGraph& graph_;
  const Evaluators& evaluators_;
  const Format& format_;
  int digits_;  ///< of the inputs
  int degree_;
  std::uint64_t budget_;
  std::mt19937_64 random_;
  WorstCase worst_;
};

}  // namespace

WorstCase search_worst_case(const ExpressionGraph& graph, const Evaluators& evaluators,
                            const Format& format, const WorstCaseOptions& options) {
  return Search(graph, evaluators, format, options).run();
}

}  // namespace touchstone::filters
