#include "fast/step.hpp"

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>
#include <utility>

#include "fast/certified/block.hpp"
#include "fast/platform/floating_point_state.hpp"
#include "fast/platform/threads.hpp"
#include "fast/step/scene.hpp"

namespace touchstone::fast {
namespace {

namespace tbb = oneapi::tbb;

static_assert(PairBuffer::capacity <= kernel_block);

/// So many groups are a task's.
constexpr std::size_t groups_of_part = 16;

/// The end of the interval [0, t] that the boxes are of, for contacts up to a time: the least power of two that is not below
/// it, and not far below the rounding of places in float.
double horizon_of(double time) {
  constexpr double least_horizon = 0x1p-40;
  if (time <= least_horizon) return least_horizon;
  int exponent = 0;
  const double fraction = std::frexp(time, &exponent);
  return std::ldexp(1.0, fraction == 0.5 ? exponent - 1 : exponent);
}

/// Calls take(pairs) for the pairs of a part as they are found. Under strict floating point.
template <std::size_t instants, class Take>
void for_each_block(const Scene& scene, const Trees<instants>& trees, const SearchPart& part,
                    Take take) {
  const StrictFloatingPoint strict;
  PairBuffer buffer;
  buffer.context = &take;
  buffer.take = [](void* context, std::span<const IndexPair> pairs) {
    (*static_cast<Take*>(context))(pairs);
  };
  scene.find(trees, part, buffer);
  buffer.flush();
}

// ---- Collisions ---------------------------------------------------------------------------------

/// Appends the collisions of a part, in the order of its pairs.
void collect(const Scene& scene, const Trees<2>& trees, const SearchPart& part,
             std::vector<StepCollision>& found) {
  std::vector<std::pair<std::size_t, StepCollision>> of_block;
  for_each_block(scene, trees, part, [&](std::span<const IndexPair> pairs) {
    of_block.clear();
    scene.decide(part.kind, pairs, part.is_listed, scene.certified().t_max,
                 [&](std::size_t place, const StepCollision& collision) {
                   of_block.emplace_back(place, collision);
                 });
    std::ranges::sort(of_block, {}, [](const auto& numbered) { return numbered.first; });
    for (const auto& [place, collision] : of_block) found.push_back(collision);
  });
}

std::vector<StepCollision> all_collisions(const Scene& scene) {
  const Trees<2> trees = scene.trees<2>(horizon_of(scene.certified().t_max));
  const std::vector<SearchPart> parts = scene.parts(groups_of_part);
  std::vector<std::vector<StepCollision>> of_parts(parts.size());
  tbb::parallel_for(std::size_t{0}, parts.size(),
                    [&](std::size_t i) { collect(scene, trees, parts[i], of_parts[i]); });
  std::size_t count = 0;
  for (const auto& some : of_parts) count += some.size();
  std::vector<StepCollision> result;
  result.reserve(count);
  for (const auto& some : of_parts) result.insert(result.end(), some.begin(), some.end());
  return result;
}

bool has_collision(const Scene& scene) {
  const Trees<2> trees = scene.trees<2>(horizon_of(scene.certified().t_max));
  const std::vector<SearchPart> parts = scene.parts(groups_of_part);
  std::atomic<bool> found = false;
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
    if (found) return;
    for_each_block(scene, trees, parts[i], [&](std::span<const IndexPair> pairs) {
      if (found) return;
      scene.decide(parts[i].kind, pairs, parts[i].is_listed, scene.certified().t_max,
                   [&](std::size_t, const StepCollision&) { found = true; });
    });
  });
  return found;
}

// ---- The earliest -------------------------------------------------------------------------------

/// Looks for the earliest impact: first among a few of the groups, which are all over the scene, then among more, then all.
/// What comes later than one that is known is of no interest, so boxes are fitted anew in between, to the time up to it.
class EarliestSearch {
 public:
  explicit EarliestSearch(const Scene& scene)
      : scene_(scene),
        horizon_(horizon_of(scene.certified().t_max)),
        trees_(scene.trees<2>(horizon_)),
        parts_(scene.parts(groups_of_part)) {}

  [[nodiscard]] std::optional<StepImpact> run() {
    // Of so many groups in a row, one is searched for; not again what was one of more.
    static constexpr std::array<std::size_t, 3> strides{64, 8, 1};
    for (std::size_t i = 0; i < strides.size(); ++i) {
      if (i > 0) look_nearer();
      const std::size_t before = i > 0 ? strides[i - 1] : 0;
      tbb::parallel_for(std::size_t{0}, parts_.size(),
                        [&](std::size_t part) { search(parts_[part], strides[i], before); });
    }
    return result();
  }

 private:
  using Found = std::vector<StepCollision>;

  /// Contacts after it are of no interest.
  [[nodiscard]] double limit() const {
    const CertifiedOptions& options = scene_.certified();
    return std::min(options.t_max,
                    limit_after(std::min(upper_.load(), 1.0), options.toi_tolerance));
  }

  /// Fits the boxes to the time that is left, if that is much less than before.
  void look_nearer() {
    static constexpr double much = 0.25;
    const double horizon = horizon_of(limit());
    if (horizon > much * horizon_) return;
    horizon_ = horizon;
    scene_.fit(trees_, horizon);
  }

  /// Searches for each `stride`-th group, but for each `before`-th.
  void search(SearchPart part, std::size_t stride, std::size_t before) {
    const auto is_wanted = [&](std::size_t group) {
      return group % stride == 0 && (before == 0 || group % before != 0);
    };
    const std::size_t end = part.end;
    while (part.first < end) {
      if (!is_wanted(part.first)) {
        ++part.first;
        continue;
      }
      part.end = part.first + 1;
      while (part.end < end && is_wanted(part.end)) ++part.end;
      for_each_block(scene_, trees_, part, [&](std::span<const IndexPair> pairs) {
        scene_.decide(part.kind, pairs, part.is_listed, limit(),
                      [this](std::size_t, const StepCollision& collision) { add(collision); });
      });
      part.first = part.end;
    }
  }

  void add(const StepCollision& collision) {
    double known = upper_.load();
    while (collision.toi_upper < known &&
           !upper_.compare_exchange_weak(known, collision.toi_upper)) {
    }
    if (collision.toi_lower > upper_.load()) return;
    Found& found = found_.local();
    found.push_back(collision);
    // What has become too late in the meantime is dropped where room would have to be made.
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
    std::ranges::sort(impact.pairs, [](const StepCollision& a, const StepCollision& b) {
      return std::tie(a.kind, a.pair) < std::tie(b.kind, b.pair);
    });
    impact.toi_upper = upper_.load();
    impact.toi_lower = std::ranges::min(impact.pairs, {}, &StepCollision::toi_lower).toi_lower;
    return impact;
  }

  const Scene& scene_;
  double horizon_;
  Trees<2> trees_;
  std::vector<SearchPart> parts_;
  std::atomic<double> upper_ = std::numeric_limits<double>::infinity();
  tbb::enumerable_thread_specific<Found> found_;
};

}  // namespace

// ---- Interface ----------------------------------------------------------------------------------

std::string_view to_string(PairKind kind) {
  switch (kind) {
    case PairKind::vertex_face:
      return "vertex-face";
    case PairKind::edge_edge:
      return "edge-edge";
    case PairKind::vertex_edge:
      return "vertex-edge";
    case PairKind::vertex_vertex:
      break;
  }
  return "vertex-vertex";
}

Step::Step(MovingVertices vertices, const MeshElements& elements, const StepOptions& options) {
  if (options.max_threads < 0)
    throw std::invalid_argument("step: max_threads must not be negative");
  scene_ = with_threads(options.max_threads, [&] {
    return std::make_unique<const Scene>(std::move(vertices), elements, options);
  });
}

Step::~Step() = default;
Step::Step(Step&& other) noexcept = default;
Step& Step::operator=(Step&& other) noexcept = default;

std::optional<StepImpact> Step::earliest() const {
  return with_threads(scene_->certified().max_threads,
                      [this] { return EarliestSearch(*scene_).run(); });
}

std::vector<StepCollision> Step::collisions() const {
  return with_threads(scene_->certified().max_threads, [this] { return all_collisions(*scene_); });
}

bool Step::is_free() const {
  return with_threads(scene_->certified().max_threads, [this] { return !has_collision(*scene_); });
}

void Step::candidates(const std::function<void(const StepCandidates&)>& take) const {
  with_threads(scene_->certified().max_threads, [&] {
    const Trees<1> trees = scene_->trees<1>(1.0);
    const std::vector<SearchPart> parts = scene_->parts(groups_of_part);
    tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
      const PairKind kind = parts[i].kind;
      std::vector<IndexPair> numbers;
      for_each_block(*scene_, trees, parts[i], [&](std::span<const IndexPair> pairs) {
        if (kind == PairKind::vertex_edge) {
          numbers.clear();
          for (const IndexPair& pair : pairs) numbers.push_back(scene_->reported(kind, pair));
          pairs = numbers;
        }
        take({.kind = kind, .pairs = pairs});
      });
    });
  });
}

Query Step::query_of(PairKind kind, const IndexPair& pair) const {
  return scene_->query_of(kind, pair);
}

const MovingVertices& Step::vertices() const { return scene_->vertices(); }

std::span<const Edge> Step::edges() const { return scene_->elements().edges; }

}  // namespace touchstone::fast
