#include "touchstone/step.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "fast/certified/block.hpp"
#include "fast/platform/floating_point_state.hpp"
#include "fast/platform/threads.hpp"
#include "fast/step/scene.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/intersections.hpp"

namespace touchstone::fast {
namespace {

static_assert(PairBuffer::capacity <= kernel_block);

/// Groups per task.
constexpr std::size_t groups_of_part = 32;

/// The end time of the boxes, for contacts up to a time: the least power of two that is not below
/// it, with a minimum, because at smaller ones the rounding of places in float would exceed the
/// motion.
double t_end_of(double time) {
  constexpr double least_t_end = 0x1p-40;
  if (time <= least_t_end) return least_t_end;
  int exponent = 0;
  const double fraction = std::frexp(time, &exponent);
  return std::ldexp(1.0, fraction == 0.5 ? exponent - 1 : exponent);
}

/// Calls take(pairs) for the pairs that find(buffer) appends, in the strict floating-point state.
/// \throws Stopped once the scene's stop is true.
template <class Find, class Take>
void for_each_block(const Scene& scene, const Find& find, Take take) {
  const StrictFloatingPoint strict;
  PairSink buffer(std::move(take), scene.stop());
  find(buffer);
  buffer.flush();
}

// ---- Collisions ---------------------------------------------------------------------------------

/// The whole step.
SceneInterval<2> whole_step(const Scene& scene) {
  return scene.up_to<2>(t_end_of(scene.certified().t_max));
}

/// Appends the collisions of a part, in the order of its pairs.
void collect(const Scene& scene, const SceneInterval<2>& step, const SearchPart& part,
             std::vector<StepCollision>& found) {
  std::vector<std::pair<std::size_t, StepCollision>> of_block;
  for_each_block(
      scene, [&](PairBuffer& pairs) { scene.find(step.trees, part, pairs); },
      [&](std::span<const IndexPair> pairs) {
        of_block.clear();
        scene.decide(part.kind, pairs, step.rounded, scene.certified().t_max,
                     [&](std::size_t place, const StepCollision& collision) {
                       of_block.emplace_back(place, collision);
                     });
        std::ranges::sort(of_block, {}, [](const auto& numbered) { return numbered.first; });
        for (const auto& [place, collision] : of_block) found.push_back(collision);
      });
}

std::vector<StepCollision> all_collisions(const Scene& scene) {
  const SceneInterval<2> step = whole_step(scene);
  const std::vector<SearchPart> parts = scene.parts(groups_of_part);
  std::vector<std::vector<StepCollision>> of_parts(parts.size());
  tbb::parallel_for(std::size_t{0}, parts.size(),
                    [&](std::size_t i) { collect(scene, step, parts[i], of_parts[i]); });
  std::size_t count = 0;
  for (const auto& some : of_parts) count += some.size();
  std::vector<StepCollision> result;
  result.reserve(count);
  for (const auto& some : of_parts) result.insert(result.end(), some.begin(), some.end());
  return result;
}

// ---- The earliest -------------------------------------------------------------------------------

/// Search for the earliest impact, or for any. The groups of the scene are searched in rounds:
/// first a few from all over the scene, then more and more. Steps with contacts mostly have early
/// ones, and on a short interval little moves. So the first rounds search such an interval, and all
/// rounds do if these find a contact in it. Otherwise the whole step is searched from the first
/// round on, and between rounds the boxes are fitted again if the earliest known impact leaves much
/// less to search.
class ImpactSearch {
 public:
  explicit ImpactSearch(const Scene& scene) : scene_(scene) {}

  [[nodiscard]] std::optional<StepImpact> earliest() {
    run();
    return result();
  }

  [[nodiscard]] bool is_any() {
    any_suffices_ = true;
    run();
    return has_any();
  }

 private:
  /// A round has the groups whose numbers are multiples of its stride, but of none before it.
  static constexpr std::array<std::size_t, 5> strides{256, 64, 16, 4, 1};
  /// The end of a short interval. Swept boxes suffice there, and need not be fitted again.
  static constexpr double short_end = 0x1p-8;
  /// The rounds that search a short interval first: a sixty-fourth of the groups.
  static constexpr std::size_t first_rounds = 2;

  using Found = std::vector<StepCollision>;

  void run() {
    // (Any contact is found as fast in the whole step.)
    const bool is_short = !any_suffices_ && is_early();
    if (!is_short) take_interval(t_end_of(scene_.certified().t_max));
    for (std::size_t round = is_short ? first_rounds : 0; round < strides.size() && !is_enough();
         ++round) {
      search(round);
      look_nearer(strides[round]);
    }
  }

  /// Searches a short interval in the first rounds. Returns true if contacts after it do not
  /// matter; otherwise this was in vain, and cost a fit of all boxes.
  bool is_early() {
    if (t_end_of(scene_.certified().t_max) <= short_end) return false;
    take_interval(short_end);
    for (std::size_t round = 0; round < first_rounds; ++round) search(round);
    if (limit() <= short_end) return true;
    // The search of the whole step finds these collisions again.
    for (Found& found : found_) found.clear();
    pairs_ = groups_ = 0;
    return false;
  }

  [[nodiscard]] bool is_enough() const { return any_suffices_ && has_any(); }

  [[nodiscard]] bool has_any() const {
    return upper_.load() < std::numeric_limits<double>::infinity();
  }

  // ---- The interval ----

  void take_interval(double end) {
    short_.reset();
    long_.reset();
    if (end <= short_end) {
      short_.emplace(scene_.up_to<1>(end));
    } else {
      long_.emplace(scene_.up_to<2>(end));
    }
  }

  /// Fits the boxes to the remaining time, if that is much less than before and many pairs are to
  /// be expected. \param stride Of the groups searched so far.
  void look_nearer(std::size_t stride) {
    static constexpr double much = 0.25;
    // Fitting a group takes about as long as deciding that many pairs.
    static constexpr std::size_t pairs_of_fit = 16;
    if (short_ || stride == 1) return;
    const double t_end = t_end_of(limit());
    if (t_end > much * long_->end) return;
    const std::size_t expected = (stride - 1) * pairs_.load();
    if (expected > pairs_of_fit * stride * groups_) take_interval(t_end);
  }

  /// Contacts after this time do not matter.
  [[nodiscard]] double limit() const {
    const CertifiedOptions& options = scene_.certified();
    return std::min(options.t_max,
                    limit_after(std::min(upper_.load(), 1.0), options.toi_tolerance));
  }

  // ---- Rounds ----

  void search(std::size_t round) { short_ ? search(*short_, round) : search(*long_, round); }

  /// Searches with the groups of a round.
  template <std::size_t instants>
  void search(const SceneInterval<instants>& interval, std::size_t round) {
    const std::vector<SearchPart> parts = scene_.parts(groups_of_part * strides[round]);
    tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
      const SearchPart& part = parts[i];
      std::vector<SearchPart> wanted;
      for (std::size_t group = part.first; group < part.end; group += strides[round]) {
        const bool is_done = round > 0 && group % strides[round - 1] == 0;
        if (!is_done) wanted.push_back({part.kind, group, group + 1});
      }
      groups_ += wanted.size();
      for_each_block(
          scene_,
          [&](PairBuffer& pairs) {
            for (const SearchPart& group : wanted) scene_.find(interval.trees, group, pairs);
          },
          [&](std::span<const IndexPair> pairs) {
            if (is_enough()) return;
            pairs_ += pairs.size();
            scene_.decide(part.kind, pairs, interval.rounded, std::min(limit(), interval.end),
                          [this](std::size_t, const StepCollision& collision) { add(collision); });
          });
    });
  }

  void add(const StepCollision& collision) {
    double known = upper_.load();
    while (collision.toi_upper < known &&
           !upper_.compare_exchange_weak(known, collision.toi_upper)) {
    }
    if (collision.toi_lower > upper_.load()) return;
    Found& found = found_.local();
    found.push_back(collision);
    // Collisions that are too late by now are dropped before the list would grow.
    if (found.size() == found.capacity()) drop_late(found);
  }

  void drop_late(Found& found) const {
    const double upper = upper_.load();
    std::erase_if(found, [upper](const StepCollision& one) { return one.toi_lower > upper; });
  }

  [[nodiscard]] std::optional<StepImpact> result() {
    StepImpact impact;
    for (Found& found : found_) {
      drop_late(found);
      impact.pairs.insert(impact.pairs.end(), found.begin(), found.end());
    }
    if (impact.pairs.empty()) return std::nullopt;
    sort_by_pair(impact.pairs);
    impact.toi_upper = upper_.load();
    impact.toi_lower = std::ranges::min(impact.pairs, {}, &StepCollision::toi_lower).toi_lower;
    return impact;
  }

  const Scene& scene_;
  bool any_suffices_ = false;
  /// One of them is the interval.
  std::optional<SceneInterval<1>> short_;
  std::optional<SceneInterval<2>> long_;
  std::atomic<std::size_t> pairs_ = 0;   ///< decided so far
  std::atomic<std::size_t> groups_ = 0;  ///< searched so far
  std::atomic<double> upper_ = std::numeric_limits<double>::infinity();
  tbb::enumerable_thread_specific<Found> found_;
};

// ---- The start ----------------------------------------------------------------------------------

MovingVertices start_of(const Scene& scene) {
  using Places = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
  static constexpr Eigen::Index stride = sizeof(MovingVertex) / sizeof(double);
  const MovingVertices& vertices = scene.vertices();
  const Eigen::Map<const Places, 0, Eigen::OuterStride<stride>> places(
      vertices.size() == 0 ? nullptr : vertices.data()->start.data(),
      static_cast<Eigen::Index>(vertices.size()), 3);
  return {places, places};
}

IntersectionOptions options_at_start(const Scene& scene) {
  return {
      .groups = scene.groups(), .max_threads = scene.certified().max_threads, .stop = scene.stop()};
}

// ---- The step that is taken ---------------------------------------------------------------------

/// \pre strict floating point
/// \throws std::domain_error if a motion overflows.
MovingVertices scaled_vertices(const MovingVertices& vertices, double alpha) {
  using Places = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
  const auto count = static_cast<Eigen::Index>(vertices.size());
  Places start(count, 3), end(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const MovingVertex& vertex = vertices[static_cast<std::size_t>(i)];
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double from = vertex.start[static_cast<std::size_t>(axis)];
      const double to = vertex.end[static_cast<std::size_t>(axis)];
      const double motion = to - from;
      if (!std::isfinite(motion)) {
        throw std::domain_error("vertex " + std::to_string(i) +
                                ": the motion x1 - x0 is greater than any double");
      }
      const double part = alpha * motion;
      start(i, axis) = from;
      end(i, axis) = from + part;
    }
  }
  return {start, end};
}

/// Search for a double in [0,1] that is free while the next one is not.
template <class IsFree>
class StepSizeSearch {
 public:
  explicit StepSizeSearch(const IsFree& is_free) : is_free_(is_free) {}

  /// \param guess Start of the search, in [0,1].
  [[nodiscard]] std::optional<double> run(double guess) {
    if (is_free_(1.0)) return 1.0;
    high_ = std::min(std::bit_cast<std::uint64_t>(guess), high_ - 1);
    if (is_free(high_)) {
      low_ = std::exchange(high_, std::bit_cast<std::uint64_t>(1.0));
      go_up();
    } else if (!go_down()) {
      return std::nullopt;
    }
    while (high_ - low_ > 1) {
      const std::uint64_t middle = low_ + (high_ - low_) / 2;
      (is_free(middle) ? low_ : high_) = middle;
    }
    return std::bit_cast<double>(low_);
  }

 private:
  static constexpr std::uint64_t growth = 8;

  [[nodiscard]] bool is_free(std::uint64_t bits) const {
    return is_free_(std::bit_cast<double>(bits));
  }

  /// Moves both up, in growing strides, as long as the next value is free.
  void go_up() {
    for (std::uint64_t stride = 1; stride < high_ - low_; stride *= growth) {
      if (!is_free(low_ + stride)) {
        high_ = low_ + stride;
        return;
      }
      low_ += stride;
    }
  }

  /// Moves both down until the lower one is free. Returns false if there is none.
  bool go_down() {
    for (std::uint64_t stride = 1; high_ > 0; stride *= growth) {
      low_ = high_ - std::min(stride, high_);
      if (is_free(low_)) return true;
      high_ = low_;
    }
    return false;
  }

  const IsFree& is_free_;
  /// The bits of nonnegative doubles, which have the doubles' order. At the end, the step is free
  /// with `low_` and not with `high_`.
  std::uint64_t low_ = 0;
  std::uint64_t high_ = std::bit_cast<std::uint64_t>(1.0);
};

// ---- Pairs --------------------------------------------------------------------------------------

void require_in_range(const Scene& scene, PairKind kind, const IndexPair& pair) {
  const auto count_of = [&](std::size_t sort) {
    if (sort == Sort::faces) return scene.elements().faces.size();
    const bool is_edge = sort == Sort::edges || sort == Sort::bare_edges;
    return is_edge ? scene.elements().edges.size() : scene.vertices().size();
  };
  const PairRecord& record = record_of(kind);
  if (std::cmp_less_equal(0, pair[0]) && std::cmp_less(pair[0], count_of(record.some)) &&
      std::cmp_less_equal(0, pair[1]) && std::cmp_less(pair[1], count_of(record.all))) {
    return;
  }
  throw std::out_of_range("step: there is no pair " + std::string(record.name) + " of " +
                          std::to_string(pair[0]) + " and " + std::to_string(pair[1]));
}

}  // namespace

// ---- Interface ----------------------------------------------------------------------------------

std::string_view to_string(PairKind kind) { return record_of(kind).name; }

Step::Step(MovingVertices vertices, const MeshElements& elements, const StepOptions& options) {
  if (options.max_threads < 0) {
    throw std::invalid_argument("step: max_threads must not be negative");
  }
  scene_ = with_threads(options.max_threads, [&] {
    return std::make_unique<const Scene>(std::move(vertices), elements, options);
  });
}

Step::Step(std::unique_ptr<const Scene> scene) : scene_(std::move(scene)) {}

Step::~Step() = default;
Step::Step(Step&& other) noexcept = default;
Step& Step::operator=(Step&& other) noexcept = default;

Step Step::with_places(MovingVertices vertices, const Separation& separation) const {
  return Step(with_threads(scene_->certified().max_threads, [&] {
    return std::make_unique<const Scene>(std::move(vertices), *scene_, separation);
  }));
}

std::optional<StepImpact> Step::earliest() const {
  return with_threads(scene_->certified().max_threads,
                      [this] { return ImpactSearch(*scene_).earliest(); });
}

std::vector<StepCollision> Step::collisions() const {
  return with_threads(scene_->certified().max_threads, [this] { return all_collisions(*scene_); });
}

bool Step::is_free() const {
  return with_threads(scene_->certified().max_threads,
                      [this] { return !ImpactSearch(*scene_).is_any(); });
}

std::vector<Intersection> Step::intersections_at_start() const {
  return intersections(start_of(*scene_), scene_->elements(), options_at_start(*scene_));
}

bool Step::starts_free() const {
  return !has_intersections(start_of(*scene_), scene_->elements(), options_at_start(*scene_));
}

Step Step::scaled(double alpha) const {
  // Written so that NaN fails too.
  if (!(alpha >= 0.0 && alpha <= 1.0)) {
    throw std::invalid_argument("step: the step size must be in [0,1]");
  }
  return Step(with_threads(scene_->certified().max_threads, [&] {
    return std::make_unique<const Scene>(scaled_vertices(scene_->vertices(), alpha), *scene_);
  }));
}

std::optional<double> Step::free_step_size() const {
  const std::optional<StepImpact> impact = earliest();
  const auto is_free = [&](double alpha) {
    const Step trial = scaled(alpha);
    // The pairs that collide first in the whole step mostly do in a trial step that is not free.
    const bool collides_again =
        impact && std::ranges::any_of(impact->pairs, [&](const auto& one) {
          const Query query = trial.query_of(one.kind, one.pair);
          return solve(kind_of(one.kind), query, trial.certified()).verdict == Verdict::yes;
        });
    return !collides_again && trial.is_free();
  };
  return StepSizeSearch(is_free).run(impact ? impact->toi_lower : 1.0);
}

void Step::candidates(const std::function<void(const StepCandidates&)>& take) const {
  with_threads(scene_->certified().max_threads, [&] {
    const Trees<1> trees = scene_->swept_trees();
    const std::vector<SearchPart> parts = scene_->parts(groups_of_part);
    tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
      const PairKind kind = parts[i].kind;
      std::vector<IndexPair> reported;
      for_each_block(
          *scene_, [&](PairBuffer& pairs) { scene_->find_candidates(trees, parts[i], pairs); },
          [&](std::span<const IndexPair> pairs) {
            reported.clear();
            for (const IndexPair& pair : pairs) reported.push_back(scene_->reported(kind, pair));
            take({.kind = kind, .pairs = reported});
          });
    });
  });
}

std::array<std::int32_t, moving_points> Step::vertices_of(PairKind kind,
                                                          const IndexPair& pair) const {
  require_in_range(*scene_, kind, pair);
  return scene_->vertices_of(kind, pair);
}

Query Step::query_of(PairKind kind, const IndexPair& pair) const {
  require_in_range(*scene_, kind, pair);
  return scene_->query_of(kind, pair);
}

const MovingVertices& Step::vertices() const { return scene_->vertices(); }

const CertifiedOptions& Step::certified() const { return scene_->certified(); }

std::span<const Edge> Step::edges() const { return scene_->elements().edges; }

}  // namespace touchstone::fast
