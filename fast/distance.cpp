#include "touchstone/contacts.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "fast/distance/exact_distance.hpp"
#include "fast/distance/filter_kernel.hpp"
#include "fast/distance/filtered_distance.hpp"
#include "fast/platform/floating_point_state.hpp"
#include "fast/platform/threads.hpp"
#include "fast/step/sieve.hpp"
#include "touchstone/filters/error_bounds.hpp"
#include "touchstone/filters/expressions.hpp"

namespace touchstone::fast {
namespace {

void require_time(double t) {
  // NaN fails, too.
  if (!(t >= 0.0 && t <= 1.0)) throw std::invalid_argument("distance: the time must be in [0,1]");
}

/// \pre strict floating point
Distance distance_at(ContactKind kind, const Query& query, double t, Norm norm) {
  if (const auto result = filtered_distance(kind, query, t, norm)) return *result;
  return exact_distance(kind, query, t, norm);
}

/// The same for a query that no kernel has seen.
Distance distance_of_one(ContactKind kind, const Query& query, double t, Norm norm) {
  if (norm == Norm::l2) {
    Distance result;
    distance_kernel_for_one().filter(kind, &query, 1, t, &result);
    if (result != open_distance) return result;
  }
  return distance_at(kind, query, t, norm);
}

/// Answers query i in results[i].
/// \param first the number of query 0 in messages
void answer(ContactKind kind, std::span<const Query> queries, double t, Norm norm,
            std::span<Distance> results, std::size_t first) {
  const StrictFloatingPoint strict;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    if (is_finite(queries[i])) continue;
    throw std::domain_error("distances: query " + std::to_string(first + i) +
                            ": a coordinate is not finite");
  }
  if (norm == Norm::l2) {
    const DistanceKernel& kernel = *distance_kernels().back();
    kernel.filter(kind, queries.data(), queries.size(), t, results.data());
  } else {
    std::ranges::fill(results, open_distance);
  }
  for (std::size_t i = 0; i < queries.size(); ++i) {
    if (results[i] == open_distance) results[i] = distance_at(kind, queries[i], t, norm);
  }
}

// ---- The least of a step ------------------------------------------------------------------------

/// True if one distance is certainly less than another. Doubles and the open intervals between
/// neighbouring doubles are disjoint, so their order is the order of the distances in them.
bool is_less(const Distance& a, const Distance& b) {
  return std::tie(a.lower, a.upper) < std::tie(b.lower, b.upper);
}

/// Finds the least distance by examining all pairs whose boxes are within a radius. The radius
/// begins with a part of a usual edge and grows until a pair is found, or until it is the distance
/// of the nearest known pair. A sample of the pairs makes that short from the beginning. The stages
/// of the certified solver on lanes (fast/step/sieve.hpp), then one inequality (keeps_distance),
/// exclude nearly all pairs that are farther apart, before their distance is computed.
///
/// All of these use positions rounded to doubles, except at the start. The error of a coordinate is
/// the bound of filters::Position, 2u of its magnitude, plus at most u of it for the rounding of
/// 1 − t. So the error of a distance is at most three bounds in L∞ and less than six in L2.
/// `slack_` is eight, which also covers its own rounding. Coordinates near the greatest double are
/// scaled, so that distances do not overflow.
///
/// With radii the distances are those of thick primitives, as are the radius and the known one. The
/// steps in which pairs are searched have the thickness too. Slack and margin then cover the
/// rounding of sums with it, and that of the enclosures: every pair whose enclosure overlaps the
/// least one is examined, so that the list does not depend on the order. (A scaled thickness would
/// be less than it, so the pairs found are too many.)
class LeastDistanceSearch {
 public:
  LeastDistanceSearch(const Step& step, double t, Norm norm) : step_(step), t_(t), norm_(norm) {
    const Motion& vertices = step.vertices();
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      for (const std::array<double, 4>& place : {vertices[i].start, vertices[i].end}) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          greatest_ = std::max(greatest_, std::abs(place[axis]));
        }
      }
    }
    if (greatest_ > far_from_overflow) scale_ = 0x1p-128;
    if (t > 0.0 || scale_ != 1.0) {
      slack_ = 8.0 * filters::position_double(scale_ * greatest_) + 0x1p-1070;
    }
    if (scene_of(step).has_thickness()) {
      slack_ += 0x1p-48 * scene_of(step).greatest_thickness() + 0x1p-1070;
      margin_ = 1.0 + 0x1p-50;
    }
  }

  [[nodiscard]] std::optional<LeastDistance> run() {
    const Motion resting = places();
    // An upper bound of all distances, 2 √3 of the greatest coordinate in L2.
    const double most = 4.0 * scale_ * greatest_;
    for (double radius = usual_length() / 64.0;;) {
      const Step near =
          step_.with_places(resting, {.distance = (radius + slack_) * margin_, .norm = norm_});
      with_threads(scene_of(step_).certified().max_threads, [&] { search(near, radius); });
      const double wider = radius == 0.0
                               ? std::max(most * 0x1p-12, std::numeric_limits<double>::denorm_min())
                               : 8.0 * radius;
      const double next = std::min({pairs_.empty() ? wider : most, known_ * scale_, most});
      if (next <= radius) break;
      radius = next;
    }
    if (pairs_.empty()) return std::nullopt;
    std::erase_if(pairs_,
                  [this](const PairDistance& one) { return one.distance.lower > least_.upper; });
    std::ranges::sort(pairs_, [](const PairDistance& a, const PairDistance& b) {
      return std::tie(a.kind, a.pair) < std::tie(b.kind, b.pair);
    });
    return LeastDistance{least_, std::move(pairs_)};
  }

 private:
  static constexpr double far_from_overflow = 0x1p900;

  /// The approximate positions of the vertices, times the scale.
  [[nodiscard]] Motion places() const {
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
    const Motion& vertices = step_.vertices();
    Rows rows(static_cast<Eigen::Index>(vertices.size()), 3);
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      const MovingVertex& vertex = vertices[static_cast<std::size_t>(i)];
      for (Eigen::Index k = 0; k < 3; ++k) {
        const auto axis = static_cast<std::size_t>(k);
        const double start = scale_ * vertex.start[axis], end = scale_ * vertex.end[axis];
        rows(i, k) = start == end || t_ == 0.0
                         ? start
                         : filters::Position::evaluate<double>({start, end}, {1.0 - t_, t_});
      }
    }
    return {rows, rows};
  }

  /// The median of the lengths of a sample of edges, in L∞.
  [[nodiscard]] double usual_length() const {
    constexpr std::size_t sample_size = 1024;
    const std::span<const Edge> edges = step_.mesh().edges;
    std::vector<double> lengths;
    for (std::size_t i = 0; i < edges.size(); i += edges.size() / sample_size + 1) {
      const auto& a = step_.vertices()[static_cast<std::size_t>(edges[i][0])].start;
      const auto& b = step_.vertices()[static_cast<std::size_t>(edges[i][1])].start;
      double length = 0.0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        length = std::max(length, std::abs(scale_ * a[axis] - scale_ * b[axis]));
      }
      lengths.push_back(length);
    }
    if (lengths.empty()) return 0.0;
    const auto median = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::ranges::nth_element(lengths, median);
    return *median;
  }

  /// Examines all pairs whose boxes are within that radius, and lists the nearest.
  void search(const Step& near, double radius) {
    const Scene& scene = scene_of(near);
    SceneInterval<1> rest{.end = 1.0, .trees = scene.swept_trees(), .rounded = {}};
    if (known_ == infinity) sample(near, rest.trees);
    pairs_.clear();
    const double distance = std::max(std::min(radius, known_ * scale_) + slack_, 0.0);
    const Separation within{.distance = distance * margin_, .norm = norm_};
    rest.rounded = fixed_point_vertices(near.vertices(), rest.end, within.distance);
    for_each_possible_collision(
        scene, rest, within, 0.0,
        [&](ContactKind kind, const IndexPair& pair) { consider(near, kind, pair); });
  }

  /// Examines the pairs of one group of primitives in 256.
  void sample(const Step& near, const Trees<1>& trees) {
    constexpr std::size_t stride = 256;
    const Scene& scene = scene_of(near);
    const std::vector<SearchPart> parts = scene.parts(stride);
    tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
      const SearchPart group{parts[i].kind, parts[i].first, parts[i].first + 1};
      for_each_block(
          scene, [&](PairBuffer& pairs) { scene.find(trees, group, pairs); },
          [&](std::span<const IndexPair> pairs) {
            for (const IndexPair& pair : pairs) {
              consider(near, group.kind, scene.reported(group.kind, pair));
            }
          });
    });
  }

  void consider(const Step& near, ContactKind kind, const IndexPair& pair) {
    const ContactKind query_kind = decided_as(kind);
    const double known = known_.load(std::memory_order_relaxed);
    const double thickness = scene_of(step_).thickness_of(kind, pair);
    const double within = std::max((known * scale_ + slack_) * margin_ + thickness * scale_, 0.0);
    if (keeps_distance(query_kind, near.query_of(kind, pair), 0.0,
                       {.part = 0.0, .least = within, .norm = norm_})) {
      return;
    }
    const Query query = step_.query_of(kind, pair);
    const Distance distance = less(distance_of_one(query_kind, query, t_, norm_), thickness);
    if (distance.lower > known_.load(std::memory_order_relaxed)) return;
    const std::scoped_lock lock(mutex_);
    if (scene_of(step_).has_thickness()) {
      least_ = {std::min(least_.lower, distance.lower), std::min(least_.upper, distance.upper)};
      known_ = least_.upper;
      pairs_.push_back({kind, pair, distance});
      return;
    }
    if (is_less(least_, distance)) return;
    if (is_less(distance, least_)) pairs_.clear();
    least_ = distance;
    known_ = distance.upper;
    pairs_.push_back({kind, pair, distance});
  }

  const Step& step_;
  double t_;
  Norm norm_;
  double greatest_ = 0.0;
  double scale_ = 1.0;
  double slack_ = 0.0;
  double margin_ = 1.0;  ///< a factor

  std::mutex mutex_;
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  Distance least_{infinity, infinity};
  std::vector<PairDistance> pairs_;       ///< the examined pairs with the least distance
  std::atomic<double> known_ = infinity;  ///< an upper bound of the least
};

}  // namespace

Distance distance(ContactKind kind, const Query& query, double t, Norm norm) {
  if (decided_as(kind) != kind) {
    return distance(decided_as(kind), decided_query(kind, query), t, norm);
  }
  require_time(t);
  if (!is_finite(query)) throw std::domain_error("distance: a coordinate is not finite");
  const StrictFloatingPoint strict;
  return distance_of_one(kind, query, t, norm);
}

void distances(ContactKind kind, std::span<const Query> queries, double t, Norm norm,
               std::span<Distance> results, int max_threads) {
  require_time(t);
  if (queries.size() != results.size()) {
    throw std::invalid_argument("distances: there must be as many results as queries");
  }
  std::vector<double> memory;
  const Queries decided = decided_queries({kind, queries}, memory);
  if (max_threads < 0) {
    throw std::invalid_argument("distances: max_threads must not be negative");
  }
  constexpr std::size_t queries_of_task = 256;
  with_threads(max_threads, [&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, queries.size(), queries_of_task),
        [&](const tbb::blocked_range<std::size_t>& range) {
          const auto part = [&](auto all) { return all.subspan(range.begin(), range.size()); };
          answer(decided.kind, part(decided.straight()), t, norm, part(results), range.begin());
        });
  });
}

std::optional<LeastDistance> least_distance(const Step& step, double t, Norm norm) {
  require_time(t);
  require_straight(step.vertices(), "least_distance");
  const StrictFloatingPoint strict;
  return LeastDistanceSearch(step, t, norm).run();
}

}  // namespace touchstone::fast
