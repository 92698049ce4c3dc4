#include "touchstone/line_search.hpp"

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

#include "fast/certified/block.hpp"
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
  result.step_size = step.certified().t_max;
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

/// Boxes of the vertices for the pairs that may come within their s up to a time T, as a motion
/// from the lower corner to the upper one, whose swept box it is.
///
/// Let a(t) and b(t) be points of two primitives, with weights λ_i and μ_j of their vertices. The
/// distance of the primitives at the start is d ≤ |a(t) − b(t)| + t V, where V is the sum of λ_i
/// |v_i| and μ_j |v_j|, and v_i the motion of a vertex but for one that all have in common. With
/// s ≤ c d, c = p (1 + 5u), |a(t) − b(t)| ≤ s at t ≤ T implies |a(t) − b(t)| ≤ T V c/(1 − c). So
/// boxes around the ways of the vertices up to T overlap if each is wider by |v_i| T c/(1 − c) on
/// both sides. Their rounding, at most 8u of a coordinate's size, and distances among the least
/// doubles are added.
class ReachedBoxes {
 public:
  ReachedBoxes(const MovingVertices& vertices, double p, double time)
      : vertices_(vertices),
        time_(time),
        reach_(time * p / ((1.0 - p) - 0.625 * 0x1p-50) * (1.0 + 0x1p-40)) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double least = positive_infinity, most = -positive_infinity;
      for (std::size_t i = 0; i < vertices.size(); ++i) {
        const double motion = vertices[i].end[axis] - vertices[i].start[axis];
        least = std::min(least, motion);
        most = std::max(most, motion);
      }
      common_[axis] = 0.5 * least + 0.5 * most;
    }
  }

  [[nodiscard]] MovingVertices motion() const {
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
    Rows lower(static_cast<Eigen::Index>(vertices_.size()), 3), upper(lower);
    for (Eigen::Index i = 0; i < lower.rows(); ++i) {
      const MovingVertex& vertex = vertices_[static_cast<std::size_t>(i)];
      const double width = reach_ * speed(vertex);
      for (Eigen::Index k = 0; k < 3; ++k) {
        const auto [from, to] = range(vertex, static_cast<std::size_t>(k), width);
        lower(i, k) = from;
        upper(i, k) = to;
      }
    }
    return {lower, upper};
  }

 private:
  [[nodiscard]] double speed(const MovingVertex& vertex) const {
    const auto v = [&](std::size_t axis) {
      return (vertex.end[axis] - vertex.start[axis]) - common_[axis];
    };
    return std::hypot(v(0), v(1), v(2));
  }

  [[nodiscard]] std::array<double, 2> range(const MovingVertex& vertex, std::size_t axis,
                                            double width) const {
    constexpr double least_distance = 0x1p-1000, greatest = std::numeric_limits<double>::max();
    const double from = vertex.start[axis], to = vertex.end[axis];
    const double then = from + time_ * (to - from);
    const double size = std::max(std::abs(from), std::abs(to)) + std::abs(common_[axis]);
    const double wider = width + 0x1p-48 * (size + width) + least_distance;
    const double lower = std::min(from, then) - wider, upper = std::max(from, then) + wider;
    // Written so that NaN also yields the widest range.
    return {lower >= -greatest ? lower : -greatest, upper <= greatest ? upper : greatest};
  }

  const MovingVertices& vertices_;
  double time_;
  double reach_;
  std::array<double, 3> common_{};
};

/// True if the swept boxes of a query's primitives have a common point.
bool are_near(Kind kind, const Query& query) {
  const std::size_t first = kind == Kind::edge_edge ? 2 : 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::array<double, 2> least{positive_infinity, positive_infinity};
    std::array<double, 2> most{-positive_infinity, -positive_infinity};
    for (std::size_t time = 0; time < 2; ++time) {
      for (std::size_t point = 0; point < moving_points; ++point) {
        const std::size_t primitive = point < first ? 0 : 1;
        least[primitive] = std::min(least[primitive], query.at(time, point, axis));
        most[primitive] = std::max(most[primitive], query.at(time, point, axis));
      }
    }
    if (least[0] > most[1] || least[1] > most[0]) return false;
  }
  return true;
}

/// Each considered pair has a distance d at the start, an s with p d ≤ s < d, and a time at which
/// it comes within s. Let T be the end of the earliest known enclosure, with a margin for the lower
/// ends of others. Only pairs that come within s up to T matter. The first known one is the
/// earliest impact: a pair that collides comes within s before. If T is short, the search has boxes
/// around little more than the motion up to T (ReachedBoxes); then one inequality (keeps_distance)
/// shows of most pairs that more than s is left up to T, before their distance is computed.
class SearchOfPairs {
 public:
  SearchOfPairs(const Step& step, double p, Norm norm) : step_(step), p_(p), norm_(norm) {}

  [[nodiscard]] LineSearchLimit run() {
    if (const auto impact = step_.with_separation({}).earliest()) begin_with(*impact);
    const auto consider_all = [this](const StepCandidates& some) {
      for (const IndexPair& pair : some.pairs) consider(some.kind, pair);
    };
    constexpr double short_time = 0x1p-2;
    if (time() * (1.0 + 2.0 * p_ / (1.0 - p_)) < short_time) {
      const ReachedBoxes boxes(step_.vertices(), p_, time());
      step_.with_places(boxes.motion(), {}).candidates(consider_all);
    } else {
      step_.with_separation({}).candidates(consider_all);
    }
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
  /// Contacts after this time do not matter.
  [[nodiscard]] double time() const {
    const CertifiedOptions& options = step_.certified();
    return std::min(options.t_max,
                    limit_after(std::min(upper_.load(), 1.0), options.toi_tolerance));
  }

  /// Takes the earliest known time from an impact and from the first of its pairs.
  void begin_with(const StepImpact& impact) {
    constexpr std::size_t enough = 16;
    upper_ = impact.toi_upper;
    for (const StepCollision& one :
         std::span(impact.pairs).first(std::min(impact.pairs.size(), enough))) {
      const Kind kind = Step::kind_of(one.kind);
      const Query query = step_.query_of(one.kind, one.pair);
      const std::optional<double> kept = kept_distance(p_, distance(kind, query, 0.0, norm_));
      if (kept) lower_time(solve_within(kind, query, *kept).toi_upper);
    }
  }

  [[nodiscard]] CertifiedResult solve_within(Kind kind, const Query& query, double kept) const {
    CertifiedOptions options = step_.certified();
    options.separation = {.distance = kept, .norm = norm_};
    return solve(kind, query, options);
  }

  void consider(PairKind kind, const IndexPair& pair) {
    const Query query = step_.query_of(kind, pair);
    const Kind query_kind = Step::kind_of(kind);
    // (s is at most p d (1 + 5u).)
    if (keeps_distance(query_kind, query, time(), {.part = p_, .norm = norm_})) return;
    if (!are_near(query_kind, query)) return;
    const Distance apart = distance(query_kind, query, 0.0, norm_);
    const std::optional<double> kept = kept_distance(p_, apart);
    if (!kept) {
      const std::scoped_lock lock(mutex_);
      (apart.upper == 0.0 ? touching_ : too_near_).push_back(at_start(kind, pair));
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
    result_.step_size = step_.certified().t_max;
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
