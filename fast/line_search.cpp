#include "touchstone/contacts.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <limits>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "fast/broad_phase/swept_box.hpp"
#include "fast/certified/block.hpp"
#include "fast/platform/floating_point_state.hpp"
#include "fast/platform/threads.hpp"
#include "fast/step/scene.hpp"
#include "fast/step/sieve.hpp"
#include "touchstone/certified.hpp"

namespace touchstone::fast {
namespace {

constexpr double positive_infinity = std::numeric_limits<double>::infinity();

/// A double s with h + p (d − h) ≤ s < d, where h is the thickness, if one is certain. (A product
/// and a sum are rounded by at most half the spacing to the next double each, which is greatest for
/// s. For distances beyond the greatest double, s is that double.)
std::optional<double> kept_distance(double p, const Distance& d, double thickness = 0.0) {
  const double s =
      std::min(std::nextafter(thickness + p * less(d, thickness).upper, positive_infinity),
               std::numeric_limits<double>::max());
  const bool is_below = s < d.lower || (s == d.lower && d.lower < d.upper);
  return is_below ? std::optional(s) : std::nullopt;
}

StepCollision at_start(ContactKind kind, const IndexPair& pair) {
  return {.kind = kind, .pair = pair, .toi_lower = 0.0, .toi_upper = 0.0};
}

/// The status for an impact with this time.
LineSearchStatus status_of(double toi_lower) {
  return toi_lower > 0.0 ? LineSearchStatus::limited : LineSearchStatus::too_small;
}

// ---- The scene's distance -----------------------------------------------------------------------

LineSearchLimit limit_of_scene(const Step& step, double p, Norm norm) {
  const std::optional<LeastDistance> least = least_distance(step, 0.0, norm);
  LineSearchLimit result;
  result.step_size = scene_of(step).certified().t_max;
  if (!least) return result;
  result.distance = least->distance;
  std::optional<double> kept = kept_distance(p, least->distance);
  if (const double thickness = scene_of(step).greatest_thickness(); kept && thickness > 0.0) {
    // Separations of pairs, sums of s and a thickness, are rounded.
    const double rounding = 0x1p-51 * (thickness + least->distance.upper);
    *kept += rounding;
    if (!(*kept + rounding < least->distance.lower)) kept.reset();
  }
  if (!kept) {
    const bool is_in_contact = least->distance.upper <= 0.0;
    result.status = is_in_contact ? LineSearchStatus::in_contact : LineSearchStatus::too_small;
    result.step_size = 0.0;
    if (is_in_contact && scene_of(step).has_thickness()) {
      const auto impact = step.with_separation({.distance = 0.0, .norm = norm}).earliest();
      if (impact) result.pairs = impact->pairs;
      return result;
    }
    for (const PairDistance& one : least->pairs) {
      result.pairs.push_back(at_start(one.kind, one.pair));
    }
    return result;
  }
  std::optional<StepImpact> impact =
      step.with_separation({.distance = *kept, .norm = norm}).earliest();
  if (!impact || impact->pairs.empty()) return result;
  result.status = status_of(impact->toi_lower);
  result.step_size = impact->toi_lower;
  result.pairs = std::move(impact->pairs);
  return result;
}

// ---- The pairs' own distances -------------------------------------------------------------------

/// How far vertices move.
struct Displacement {
  double relative = 0.0;  ///< an upper bound, in L2, of that of one relative to another
  double mean = 0.0;      ///< the mean in L∞, nearly
};

/// That of all vertices. May be infinite or NaN.
Displacement displacement_of(const Motion& vertices) {
  Displacement result;
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
    result.relative = std::max(result.relative, std::nextafter(range, positive_infinity));
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    double motion = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      motion = std::max(motion, std::abs(vertices[i].end[axis] - vertices[i].start[axis]));
    }
    result.mean += motion / static_cast<double>(vertices.size());
  }
  constexpr double root_of_three = 1.7320508075688776;
  result.relative *= root_of_three;
  return result;
}

/// True if the swept boxes of a query's primitives are within the thickness.
bool are_near(ContactKind kind, const Query& query, double thickness) {
  const std::size_t first = kind == ContactKind::edge_edge ? 2 : 1;
  std::array<SweptBox, 2> boxes;
  for (std::size_t point = 0; point < moving_points; ++point) {
    SweptBox& box = boxes[point < first ? 0 : 1];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const std::size_t time : {0U, 1U}) {
        box.lower[axis] = std::min(box.lower[axis], query.at(time, point, axis));
        box.upper[axis] = std::max(box.upper[axis], query.at(time, point, axis));
      }
    }
  }
  return (thickness > 0.0 ? widened(boxes[0], thickness) : boxes[0]).overlaps(boxes[1]);
}

/// Each considered pair has a distance d at the start, an s with p d ≤ s < d, and a time at which
/// it comes within s. Let T be the end of the earliest known enclosure, with a margin for the lower
/// ends of others. Only pairs that come within s up to T matter. T begins with the earliest impact:
/// a pair that collides comes within s before.
///
/// s is at most c d, c = p (1 + 5u), and d − s at most T M, where M is the greatest relative
/// motion. So a pair that comes within s up to T comes within T M c/(1 − c). If this is short, one
/// search on lanes finds these pairs (fast/step/sieve.hpp); otherwise the search is for all
/// considered ones. For most of them an inequality (keeps_distance) shows, without the distance,
/// that more than s is left up to T. With radii, all of this holds for the distances of thick
/// primitives.
class SearchOfPairs {
 public:
  SearchOfPairs(const Step& step, double p, Norm norm)
      : step_(step), scene_(scene_of(step)), p_(p), norm_(norm) {
    // (At distance 0 both norms mean the same.)
    if (scene_.has_thickness()) contact_.norm = norm;
  }

  [[nodiscard]] LineSearchLimit run() {
    if (const auto impact = step_.with_separation(contact_).earliest()) begin_with(*impact);
    search();
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
      const Distance apart = less(distance(decided_as(one.kind), query, 0.0, norm_),
                                  scene_.thickness_of(one.kind, one.pair));
      if (apart.lower < result_.distance.lower) result_.distance = apart;
    }
    return std::move(result_);
  }

 private:
  void search() {
    // Distances among the least doubles are always examined.
    constexpr double least = 0x1p-1000;
    const Displacement motion = displacement_of(step_.vertices());
    const double until = time();
    const double within =
        until * p_ / ((1.0 - p_) - 5.0 * 0x1p-53 * p_) * (1.0 + 0x1p-40) * motion.relative;
    // Separations of pairs, sums with a thickness, are rounded.
    const double thickness = scene_.greatest_thickness(), rounding = 0x1p-50 * thickness;
    // NaN fails.
    if (within <= motion.mean && std::isfinite(within + thickness)) {
      const Step near =
          step_.with_separation({.distance = std::max(within, least) + rounding, .norm = norm_});
      with_threads(scene_.certified().max_threads, [&] {
        for_each_possible_collision(
            scene_of(near), until,
            [this](ContactKind kind, const IndexPair& pair) { consider(kind, pair); });
      });
    } else {
      step_.with_separation(contact_).candidates([this](const StepCandidates& some) {
        for (const IndexPair& pair : some.pairs) consider(some.kind, pair);
      });
    }
  }

  /// Contacts after this time do not matter.
  [[nodiscard]] double time() const {
    const CertifiedOptions& options = scene_.certified();
    return std::min(options.t_max,
                    limit_after(std::min(upper_.load(), 1.0), options.toi_tolerance));
  }

  /// Takes the earliest known time from an impact and from the first of its pairs.
  void begin_with(const StepImpact& impact) {
    constexpr std::size_t enough = 16;
    upper_ = impact.toi_upper;
    for (const StepCollision& one :
         std::span(impact.pairs).first(std::min(impact.pairs.size(), enough))) {
      const ContactKind kind = decided_as(one.kind);
      const Query query = step_.query_of(one.kind, one.pair);
      const std::optional<double> kept = kept_distance(p_, distance(kind, query, 0.0, norm_),
                                                       scene_.thickness_of(one.kind, one.pair));
      if (kept) lower_time(solve_within(kind, query, *kept).toi_upper);
    }
  }

  [[nodiscard]] CertifiedResult solve_within(ContactKind kind, const Query& query,
                                             double kept) const {
    CertifiedOptions options = scene_.certified();
    options.separation = {.distance = kept, .norm = norm_};
    return solve(kind, query, options);
  }

  void consider(ContactKind kind, const IndexPair& pair) {
    const Query query = step_.query_of(kind, pair);
    const ContactKind query_kind = decided_as(kind);
    const double thickness = scene_.thickness_of(kind, pair);
    // (s is at most p d (1 + 5u), or with a thickness wrong by at most 8u d.)
    if (keeps_distance(query_kind, query, time(),
                       {.part = p_, .least = thickness, .norm = norm_})) {
      return;
    }
    if (!are_near(query_kind, query, thickness)) return;
    const Distance apart = distance(query_kind, query, 0.0, norm_);
    const std::optional<double> kept = kept_distance(p_, apart, thickness);
    if (!kept) {
      const std::scoped_lock lock(mutex_);
      (apart.upper <= thickness ? touching_ : too_near_).push_back(at_start(kind, pair));
      return;
    }
    const CertifiedResult result = solve_within(query_kind, query, *kept);
    if (result.verdict == Verdict::yes) add(collision_of(kind, pair, result));
  }

  void add(const StepCollision& collision) {
    lower_time(collision.toi_upper);
    if (collision.toi_lower > upper_.load()) return;
    const std::scoped_lock lock(mutex_);
    result_.pairs.push_back(collision);
  }

  void lower_time(double toi_upper) {
    double known = upper_.load();
    while (toi_upper < known && !upper_.compare_exchange_weak(known, toi_upper)) {
    }
  }

  void take_earliest() {
    result_.step_size = scene_.certified().t_max;
    if (result_.pairs.empty()) return;
    std::erase_if(result_.pairs, [upper = upper_.load()](const StepCollision& one) {
      return one.toi_lower > upper;
    });
    if (result_.pairs.empty()) return;  // a cell is earlier
    result_.step_size = std::ranges::min(result_.pairs, {}, &StepCollision::toi_lower).toi_lower;
    result_.status = status_of(result_.step_size);
  }

  const Step& step_;
  const Scene& scene_;
  double p_;
  Norm norm_;
  Separation contact_ = {};  ///< at which thick primitives are in contact
  std::atomic<double> upper_ = positive_infinity;
  std::mutex mutex_;
  std::vector<StepCollision> touching_;  ///< at the start
  std::vector<StepCollision> too_near_;  ///< pairs with a distance too small for an s
  LineSearchLimit result_;
};

// ---- Cells --------------------------------------------------------------------------------------

/// Lowers the limit that pairs set to that of the cells, if it is earlier.
void limit_by_volumes(const Step& step, double kept_volume, LineSearchLimit& result) {
  const Scene& scene = scene_of(step);
  const CertifiedOptions& options = scene.certified();
  std::atomic<double> upper = positive_infinity;
  for (const StepCollision& one : result.pairs) upper = std::min(upper.load(), one.toi_upper);
  std::vector<StepInversion>& found = result.inversions;
  std::mutex mutex;
  with_threads(options.max_threads, [&] {
    scene.find_inversions(
        options, kept_volume,
        [&] {
          return std::min(options.t_max,
                          limit_after(std::min(upper.load(), 1.0), options.toi_tolerance));
        },
        [&](const StepInversion& one) {
          const std::scoped_lock lock(mutex);
          upper = std::min(upper.load(), one.toi_upper);
          if (one.toi_lower <= upper) found.push_back(one);
        });
  });
  const auto is_late = [&](const auto& one) { return one.toi_lower > upper; };
  std::erase_if(found, is_late);
  if (found.empty()) return;
  sort_by_number(found);
  std::erase_if(result.pairs, is_late);
  const auto is_inverted = [](const StepInversion& one) { return one.start != 1; };
  const double first = std::ranges::min(found, {}, &StepInversion::toi_lower).toi_lower;
  if (result.pairs.empty() || first < result.step_size) {
    result.status =
        std::ranges::any_of(found, is_inverted) ? LineSearchStatus::inverted : status_of(first);
  }
  result.step_size = std::min(result.step_size, first);
}

}  // namespace

LineSearchLimit line_search_limit(const Step& step, double p, const LineSearchOptions& options) {
  // NaN fails, too.
  if (!(p > 0.0 && p <= 1.0 - 0x1p-50)) {
    throw std::invalid_argument("line search: p must be more than 0 and at most 1 - 2^-50");
  }
  if (!(options.kept_volume >= 0.0 && options.kept_volume < 1.0)) {
    throw std::invalid_argument("line search: kept_volume must be in [0,1)");
  }
  require_straight(step.vertices(), "line search");
  const StrictFloatingPoint strict;
  LineSearchLimit result = options.start_distance == StartDistance::of_pair
                               ? SearchOfPairs(step, p, options.norm).run()
                               : limit_of_scene(step, p, options.norm);
  limit_by_volumes(step, options.kept_volume, result);
  return result;
}

}  // namespace touchstone::fast
