#include "touchstone/contacts.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "fast/distance/proximity.hpp"
#include "fast/platform/floating_point_state.hpp"
#include "fast/step/scene.hpp"
#include "touchstone/certified.hpp"

namespace touchstone::fast {
namespace {

constexpr double positive_infinity = std::numeric_limits<double>::infinity();

/// A double s with p d ≤ s < d, if one is certain. (A product is rounded by at most half the
/// spacing to the next double. For distances beyond the greatest double, s is that double.)
std::optional<double> kept_distance(double p, const Distance& d) {
  const double s =
      std::min(std::nextafter(p * d.upper, positive_infinity), std::numeric_limits<double>::max());
  const bool is_below = s < d.lower || (s == d.lower && d.lower < d.upper);
  return is_below ? std::optional(s) : std::nullopt;
}

StepCollision at_start(PairKind kind, const IndexPair& pair) {
  return {.kind = kind, .pair = pair, .toi_lower = 0.0, .toi_upper = 0.0};
}

/// The status for an impact with these times.
LineSearchStatus status_of(double toi_lower) {
  return toi_lower > 0.0 ? LineSearchStatus::limited : LineSearchStatus::too_small;
}

// ---- The scene's distance -----------------------------------------------------------------------

LineSearchLimit limit_of_scene(const Step& step, double p, Norm norm) {
  const std::optional<LeastDistance> least = least_distance(step, 0.0, norm);
  LineSearchLimit result;
  result.step_size = step.options().t_max;
  if (!least) return result;
  result.distance = least->distance;
  const std::optional<double> kept = kept_distance(p, least->distance);
  if (!kept) {
    const bool is_in_contact = least->distance.upper == 0.0;
    result.status = is_in_contact ? LineSearchStatus::in_contact : LineSearchStatus::too_small;
    result.step_size = 0.0;
    for (const PairDistance& one : least->pairs) {
      result.pairs.push_back(at_start(one.kind, one.pair));
    }
    return result;
  }
  std::optional<StepImpact> impact =
      step.with_separation({.distance = *kept, .norm = norm}).earliest();
  if (!impact) return result;
  result.status = status_of(impact->toi_lower);
  result.step_size = impact->toi_lower;
  result.pairs = std::move(impact->pairs);
  return result;
}

// ---- The pairs' own distances -------------------------------------------------------------------

/// An upper bound of the motion of a vertex relative to another, in L2 or L∞. May be infinite.
double greatest_relative_motion(const MovingVertices& vertices) {
  double result = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double least = positive_infinity, most = -positive_infinity;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const double motion = vertices[i].end[axis] - vertices[i].start[axis];
      least = std::min(least, motion);
      most = std::max(most, motion);
    }
    // Each difference is rounded by at most half the spacing to the next double.
    const double range =
        std::nextafter(most, positive_infinity) - std::nextafter(least, -positive_infinity);
    result = std::max(result, std::nextafter(range, positive_infinity));
  }
  constexpr double root_of_three = 1.7320508075688776;
  return result * root_of_three;
}

/// Each considered pair has a distance d at the start, an s with p d ≤ s < d, and a time at which
/// it comes within s. That is (d − s) / M at the earliest, where M is the greatest relative motion.
/// As s ≤ p (1 + 2^-50) d and p ≤ 1 − 2^-50, d − s is more than a third of (1 − p) d. Let T be the
/// end of the earliest known enclosure. Pairs that are farther apart than 4 M T / (1 − p) come
/// within s after T, with a margin that also covers the lower end of their enclosures, and are not
/// examined.
class SearchOfPairs {
 public:
  SearchOfPairs(const Step& step, double p, Norm norm)
      : step_(step), p_(p), norm_(norm), motion_(greatest_relative_motion(step.vertices())) {}

  [[nodiscard]] LineSearchLimit run() {
    const Step at_no_distance = step_.with_separation({});
    // A pair that collides comes within s before.
    if (const auto impact = at_no_distance.earliest()) upper_ = impact->toi_upper;
    at_no_distance.candidates([this](const StepCandidates& some) { consider(some); });
    result_.step_size = 0.0;
    if (!touching_.empty()) {
      result_.status = LineSearchStatus::in_contact;
      result_.pairs = std::move(touching_);
    } else if (!too_near_.empty()) {
      result_.status = LineSearchStatus::too_small;
      result_.pairs = std::move(too_near_);
    } else {
      take_earliest();
    }
    sort_by_pair(result_.pairs);
    for (const StepCollision& one : result_.pairs) {
      const Query query = step_.query_of(one.kind, one.pair);
      const Distance apart = distance(Step::kind_of(one.kind), query, 0.0, norm_);
      if (apart.lower < result_.distance.lower) result_.distance = apart;
    }
    return std::move(result_);
  }

 private:
  void consider(const StepCandidates& some) {
    const Separation reach{.distance = reach_until(std::min(upper_.load(), 1.0)), .norm = norm_};
    for (const std::uint32_t i : perhaps_within(step_, some, reach)) {
      consider(some.kind, some.pairs[i]);
    }
  }

  /// Pairs that are farther apart come within s after that time. Distances among the least doubles
  /// are always examined.
  [[nodiscard]] double reach_until(double time) const {
    constexpr double least = 0x1p-1000, greatest = std::numeric_limits<double>::max();
    const double rest = 1.0 - step_.options().toi_tolerance;
    if (!(rest > 0.0)) return greatest;
    const double reach = 4.0 * motion_ * (time / (1.0 - p_) / rest);
    // Written so that NaN also yields the greatest value.
    return reach <= greatest ? std::max(reach, least) : greatest;
  }

  void consider(PairKind kind, const IndexPair& pair) {
    const Query query = step_.query_of(kind, pair);
    const Kind query_kind = Step::kind_of(kind);
    const Distance apart = distance(query_kind, query, 0.0, norm_);
    const std::optional<double> kept = kept_distance(p_, apart);
    if (!kept) {
      const std::scoped_lock lock(mutex_);
      (apart.upper == 0.0 ? touching_ : too_near_).push_back(at_start(kind, pair));
      return;
    }
    CertifiedOptions options = step_.options();
    options.separation = {.distance = *kept, .norm = norm_};
    const CertifiedResult result = solve(query_kind, query, options);
    if (result.verdict != Verdict::yes) return;
    add(collision_of(kind, pair, result));
  }

  void add(const StepCollision& collision) {
    double known = upper_.load();
    while (collision.toi_upper < known &&
           !upper_.compare_exchange_weak(known, collision.toi_upper)) {
    }
    if (collision.toi_lower > upper_.load()) return;
    const std::scoped_lock lock(mutex_);
    result_.pairs.push_back(collision);
  }

  void take_earliest() {
    result_.step_size = step_.options().t_max;
    if (result_.pairs.empty()) return;
    std::erase_if(result_.pairs, [upper = upper_.load()](const StepCollision& one) {
      return one.toi_lower > upper;
    });
    result_.step_size = std::ranges::min(result_.pairs, {}, &StepCollision::toi_lower).toi_lower;
    result_.status = status_of(result_.step_size);
  }

  const Step& step_;
  double p_;
  Norm norm_;
  double motion_;
  std::atomic<double> upper_ = positive_infinity;
  std::mutex mutex_;
  std::vector<StepCollision> touching_;  ///< at the start
  std::vector<StepCollision> too_near_;  ///< pairs with a distance too small for an s
  LineSearchLimit result_;
};

}  // namespace

LineSearchLimit line_search_limit(const Step& step, double p, const LineSearchOptions& options) {
  // Written so that NaN fails too.
  if (!(p > 0.0 && p <= 1.0 - 0x1p-50)) {
    throw std::invalid_argument("line search: p must be more than 0 and at most 1 - 2^-50");
  }
  const StrictFloatingPoint strict;
  if (options.start_distance == StartDistance::of_pair) {
    return SearchOfPairs(step, p, options.norm).run();
  }
  return limit_of_scene(step, p, options.norm);
}

}  // namespace touchstone::fast
