#include "touchstone/step.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

#include "fast/certified/block.hpp"
#include "fast/platform/floating_point_state.hpp"
#include "fast/platform/threads.hpp"
#include "fast/step/scene.hpp"
#include "fast/step/sieve.hpp"
#include "touchstone/intersections.hpp"
#include "touchstone/inversion.hpp"

namespace touchstone::fast {
namespace {

static_assert(PairBuffer::capacity <= kernel_block);

// ---- Collisions ---------------------------------------------------------------------------------

/// Appends the collisions of a part, in the order of its pairs.
template <std::size_t instants>
void collect(const Scene& scene, const SceneInterval<instants>& step, const SearchPart& part,
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

template <std::size_t instants>
std::vector<StepCollision> all_collisions(const Scene& scene, const SceneInterval<instants>& step) {
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

std::vector<StepCollision> all_collisions(const Scene& scene) {
  if (!scene.vertices().is_straight()) return all_collisions(scene, scene.up_to<1>(1.0));
  return all_collisions(scene, scene.up_to<2>(t_end_of(scene.certified().t_max)));
}

// ---- The earliest -------------------------------------------------------------------------------

/// Search for the earliest impact, or for any. Cells are examined first, which takes little;
/// their first inversion limits the search for pairs. The groups of the scene are searched in
/// rounds: first a few from all over the scene, then more and more. Steps with contacts mostly have
/// early ones, and on a short interval little moves. So the first rounds search such an interval,
/// and all rounds do if these find a contact in it. Otherwise the whole step is searched from the
/// first round on, and between rounds the boxes are fitted again if the earliest known impact
/// leaves much less to search. (On curves, all rounds search swept boxes of the whole step.)
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
  /// The rounds that search a short interval first: a sixty-fourth of the groups.
  static constexpr std::size_t first_rounds = 2;

  template <class One>
  using Found = tbb::enumerable_thread_specific<std::vector<One>>;

  void run() {
    scene_.find_inversions(
        scene_.certified(), 0.0, [this] { return is_enough() ? -1.0 : limit(); },
        [this](const StepInversion& one) { add(one, inversions_); });
    if (is_enough()) return;
    // (Any contact is found as fast in the whole step.)
    const bool is_short = is_straight_ && !any_suffices_ && is_early();
    if (!is_short) take_interval(t_end_of(limit()));
    for (std::size_t round = is_short ? first_rounds : 0; round < strides.size() && !is_enough();
         ++round) {
      search(round);
      look_nearer(strides[round]);
    }
  }

  /// Searches a short interval in the first rounds. Returns true if contacts after it do not
  /// matter; otherwise this was in vain, and cost a fit of all boxes.
  bool is_early() {
    if (t_end_of(limit()) <= short_end) return false;
    take_interval(short_end);
    for (std::size_t round = 0; round < first_rounds; ++round) search(round);
    if (limit() <= short_end) return true;
    // The search of the whole step finds these collisions again.
    for (auto& found : collisions_) found.clear();
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
    if (!is_straight_) {
      short_.emplace(scene_.up_to<1>(1.0));
    } else if (end <= short_end) {
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
                          [this](std::size_t, const StepCollision& one) { add(one, collisions_); });
          });
    });
  }

  template <class One>
  void add(const One& one, Found<One>& all) {
    double known = upper_.load();
    while (one.toi_upper < known && !upper_.compare_exchange_weak(known, one.toi_upper)) {
    }
    if (one.toi_lower > upper_.load()) return;
    std::vector<One>& found = all.local();
    found.push_back(one);
    // Those that are too late by now are dropped before the list would grow.
    if (found.size() == found.capacity()) drop_late(found);
  }

  template <class One>
  void drop_late(std::vector<One>& found) const {
    const double upper = upper_.load();
    std::erase_if(found, [upper](const One& one) { return one.toi_lower > upper; });
  }

  /// Those that may be the first, and the least of their lower ends in `lower`.
  template <class One>
  [[nodiscard]] std::vector<One> firsts(Found<One>& all, double& lower) const {
    std::vector<One> result;
    for (std::vector<One>& found : all) {
      drop_late(found);
      result.insert(result.end(), found.begin(), found.end());
    }
    for (const One& one : result) lower = std::min(lower, one.toi_lower);
    return result;
  }

  [[nodiscard]] std::optional<StepImpact> result() {
    if (!has_any()) return std::nullopt;
    StepImpact impact;
    impact.toi_lower = impact.toi_upper = upper_.load();
    impact.pairs = firsts(collisions_, impact.toi_lower);
    impact.inversions = firsts(inversions_, impact.toi_lower);
    sort_by_pair(impact.pairs);
    sort_by_number(impact.inversions);
    return impact;
  }

  const Scene& scene_;
  const bool is_straight_ = scene_.vertices().is_straight();
  bool any_suffices_ = false;
  /// The interval: one of these.
  std::optional<SceneInterval<1>> short_;
  std::optional<SceneInterval<2>> long_;
  std::atomic<std::size_t> pairs_ = 0;   ///< decided so far
  std::atomic<std::size_t> groups_ = 0;  ///< searched so far
  std::atomic<double> upper_ = std::numeric_limits<double>::infinity();
  Found<StepCollision> collisions_;
  Found<StepInversion> inversions_;
};

// ---- The start ----------------------------------------------------------------------------------

Motion start_of(const Scene& scene) {
  const Motion& vertices = scene.vertices();
  if (!vertices.is_straight()) {
    std::vector<double> twice;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const auto first = vertices.control_points(i).first(3);
      for (int end = 0; end < 2; ++end) twice.insert(twice.end(), first.begin(), first.end());
    }
    return {1, false, std::move(twice)};
  }
  using Places = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
  static constexpr Eigen::Index stride = sizeof(MovingVertex) / sizeof(double);
  const Eigen::Map<const Places, 0, Eigen::OuterStride<stride>> places(
      vertices.size() == 0 ? nullptr : vertices.data()->start.data(),
      static_cast<Eigen::Index>(vertices.size()), 3);
  return {places, places};
}

IntersectionOptions options_at_start(const Scene& scene) {
  return {.groups = scene.groups(),
          .can_collide = scene.can_collide(),
          .max_threads = scene.certified().max_threads,
          .stop = scene.stop()};
}

// ---- The step that is taken ---------------------------------------------------------------------

/// \throws std::domain_error if a motion overflows.
void require_finite_motions(const Motion& vertices) {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (std::isfinite(vertices[i].end[axis] - vertices[i].start[axis])) continue;
      throw std::domain_error("vertex " + std::to_string(i) +
                              ": the motion x1 - x0 is greater than any double");
    }
  }
}

/// The place of a coordinate in the step scaled by α. \pre strict floating point
double scaled_place(double from, double to, double alpha) {
  const double motion = to - from;
  const double part = alpha * motion;
  return from + part;
}

/// \pre strict floating point; the motions are finite.
Motion scaled_vertices(const Motion& vertices, double alpha) {
  using Places = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
  const auto count = static_cast<Eigen::Index>(vertices.size());
  Places start(count, 3), end(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const MovingVertex& vertex = vertices[static_cast<std::size_t>(i)];
    for (Eigen::Index k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      start(i, k) = vertex.start[axis];
      end(i, k) = scaled_place(vertex.start[axis], vertex.end[axis], alpha);
    }
  }
  return {start, end};
}

/// A pair of a step.
struct NamedPair {
  ContactKind kind;
  IndexPair pair;
};

/// The query in the step scaled by α. \pre strict floating point
Query scaled_query(Query query, double alpha) {
  for (std::size_t point = 0; point < moving_points; ++point) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double& end = query.at(1, point, axis);
      end = scaled_place(query.at(0, point, axis), end, alpha);
    }
  }
  return query;
}

/// True if a pair collides in the step scaled by α. \pre strict floating point
bool collides_scaled(const Scene& scene, ContactKind kind, const IndexPair& pair, double alpha) {
  CertifiedOptions options = scene.certified();
  options.separation = scene.separation_of(kind, pair, options.separation);
  options.t_max = 1.0;
  const Query query = scaled_query(scene.query_of(kind, pair), alpha);
  return solve(decided_as(kind), query, options).verdict == Verdict::yes;
}

/// A cell of a step.
struct NamedCell {
  CellKind kind;
  std::int32_t number;
};

/// True if a cell inverts in the step scaled by α. \pre strict floating point
bool inverts_scaled(const Scene& scene, CellKind kind, std::int32_t cell, double alpha) {
  const Query tetrahedron = scaled_query(scene.tetrahedron_of(kind, cell), alpha);
  return inversion(CellKind::tetrahedron, tetrahedron).verdict == Verdict::yes;
}

/// The pairs that may collide, and the cells that may invert, in steps scaled by any α up to
/// `end`, for a search that tries many of these.
///
/// **Theorem** (docs/theory.md, section 8.4). Let m be the greatest magnitude of a coordinate, and
/// u = 2^-53. A pair that collides in the step scaled by α comes within the separation plus 32 u m
/// + 2^-1070 in the step itself, at a time up to α. (Rounded places are wrong by less than 5.01 u
/// m.)
///
/// One search of the step with this separation finds them.
///
/// **Theorem** (docs/theory.md, section 10). Let R be the greatest coordinate of the edges from a
/// vertex of a cell at both ends of the step, and e = 11 u m. If 6 V(0) ≥ 2^10 · 18 e (R + e)²,
/// and more than 2^-10 V(0) is left in the step up to `end`, it does not invert in such a step.
///
/// So the others are tried.
class CloseTrials {
 public:
  CloseTrials(const Scene& scene, double end) : scene_(scene), end_(end) {
    double size = 0.0;
    for (std::size_t i = 0; i < scene.vertices().size(); ++i) {
      const MovingVertex& vertex = scene.vertices()[i];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        size = std::max({size, std::abs(vertex.start[axis]), std::abs(vertex.end[axis])});
      }
    }
    Separation wider = scene.certified().separation;
    // The last term covers the rounding of separations with thickness.
    const double thickness = scene.greatest_thickness();
    wider.distance =
        (wider.distance + (0x1p-48 * size + 0x1p-1070)) * (1.0 + 0x1p-50) + 0x1p-50 * thickness;
    is_complete_ = size <= 0x1p1000 && is_valid(wider) && std::isfinite(wider.distance + thickness);
    if (!is_complete_) return;
    find(wider);
    find_cells(11.0 * 0x1p-53 * size + 0x1p-1070);
  }

  /// True if `is_free` answers for α.
  [[nodiscard]] bool covers(double alpha) const { return is_complete_ && alpha <= end_; }

  /// True if no pair collides and no cell inverts in the step scaled by α.
  [[nodiscard]] bool is_free(double alpha) const {
    return std::ranges::none_of(cells_,
                                [&](const NamedCell& one) {
                                  return inverts_scaled(scene_, one.kind, one.number, alpha);
                                }) &&
           std::ranges::none_of(pairs_, [&](const NamedPair& one) {
             return collides_scaled(scene_, one.kind, one.pair, alpha);
           });
  }

 private:
  /// The most pairs, and cells: to try more takes as long as a search of the scaled step.
  static constexpr std::size_t most = std::size_t{1} << 15U;

  void find(const Separation& wider) {
    const Scene near(scene_.vertices(), scene_, wider);
    std::mutex mutex;
    for_each_possible_collision(near, end_, [&](ContactKind kind, const IndexPair& pair) {
      const std::scoped_lock lock(mutex);
      is_complete_ = is_complete_ && pairs_.size() < most;
      if (is_complete_) pairs_.push_back({kind, pair});
    });
  }

  /// \param error e
  void find_cells(double error) {
    std::mutex mutex;
    const auto take = [&](CellKind kind, std::int32_t number) {
      const std::scoped_lock lock(mutex);
      is_complete_ = is_complete_ && cells_.size() < most;
      if (is_complete_) cells_.push_back({kind, number});
    };
    scene_.find_inversions(
        {}, 0x1p-10, [&] { return is_complete_ ? end_ : -1.0; },
        [&](const StepInversion& one) { take(one.kind, one.cell); });
    for (const CellKind kind : cell_kinds) {
      const std::size_t size = scene_.mesh().count_of(kind);
      for (std::size_t i = 0; i < size && is_complete_; ++i) {
        const auto number = static_cast<std::int32_t>(i);
        if (is_thin(scene_.tetrahedron_of(kind, number), error)) take(kind, number);
      }
    }
  }

  /// True unless the inequality of the theorem is certain. (The computed determinant is wrong by
  /// less than 2^-47 R³, and the rest of the factor is more than the other roundings.)
  static bool is_thin(const Query& query, double error) {
    std::array<Eigen::Vector3d, 3> edge;
    double reach = 0.0;
    for (const std::size_t end : {1U, 0U}) {
      for (std::size_t i = 0; i < 3; ++i) {
        edge.at(i) = point_of(query, end, i + 1) - point_of(query, end, 0);
        reach = std::max(reach, edge.at(i).cwiseAbs().maxCoeff());
      }
    }
    const double volume = edge[0].dot(edge[1].cross(edge[2])), wide = reach + error;
    // NaN fails.
    return !(volume > 0x1p16 * error * wide * wide + 0x1p-46 * wide * wide * wide + 0x1p-1000);
  }

  const Scene& scene_;
  double end_;
  std::atomic<bool> is_complete_;
  std::vector<NamedPair> pairs_;
  std::vector<NamedCell> cells_;
};

/// Search for a double, 0 or up to a greatest one, that is free while the next one is not.
template <class IsFree>
class StepSizeSearch {
 public:
  /// \param greatest in [0,1]
  StepSizeSearch(const IsFree& is_free, double greatest)
      : is_free_(is_free), greatest_(std::bit_cast<std::uint64_t>(std::abs(greatest))) {}

  /// \param guess Start of the search, from 0 to the greatest.
  [[nodiscard]] std::optional<double> run(double guess) {
    if (is_free(greatest_)) return std::bit_cast<double>(greatest_);
    if (greatest_ == 0) return std::nullopt;
    high_ = std::min(std::bit_cast<std::uint64_t>(guess), greatest_ - 1);
    if (is_free(high_)) {
      low_ = std::exchange(high_, greatest_);
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
  std::uint64_t greatest_, low_ = 0, high_ = 0;
};

// ---- Pairs --------------------------------------------------------------------------------------

void require_in_range(const Scene& scene, ContactKind kind, const IndexPair& pair) {
  const auto count_of = [&](std::size_t sort) {
    if (sort == Sort::faces) return scene.mesh().faces.size();
    const bool is_edge = sort == Sort::edges || sort == Sort::bare_edges;
    return is_edge ? scene.mesh().edges.size() : scene.vertices().size();
  };
  const PairRecord& record = record_of(kind);
  if (std::cmp_less_equal(0, pair[0]) && std::cmp_less(pair[0], count_of(record.some)) &&
      std::cmp_less_equal(0, pair[1]) && std::cmp_less(pair[1], count_of(record.all))) {
    return;
  }
  throw std::out_of_range("step: there is no pair " + std::string(to_string(kind)) + " of " +
                          std::to_string(pair[0]) + " and " + std::to_string(pair[1]));
}

}  // namespace

// ---- Interface ----------------------------------------------------------------------------------

Step::Step(Motion vertices, Mesh mesh, const StepOptions& options) {
  require_valid(options.solve);
  scene_ = with_threads(options.solve.max_threads, [&] {
    return std::make_unique<const Scene>(std::move(vertices), std::move(mesh), options);
  });
}

Step::Step(std::unique_ptr<const Scene> scene) : scene_(std::move(scene)) {}

Step::~Step() = default;
Step::Step(Step&& other) noexcept = default;
Step& Step::operator=(Step&& other) noexcept = default;

Step Step::with_places(Motion vertices, const Separation& separation) const {
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

std::vector<StepInversion> Step::inversions() const {
  std::vector<StepInversion> result;
  std::mutex mutex;
  with_threads(scene_->certified().max_threads, [&] {
    scene_->find_inversions(
        scene_->certified(), 0.0, [this] { return scene_->certified().t_max; },
        [&](const StepInversion& one) {
          const std::scoped_lock lock(mutex);
          result.push_back(one);
        });
  });
  sort_by_number(result);
  return result;
}

bool Step::is_free() const {
  return with_threads(scene_->certified().max_threads,
                      [this] { return !ImpactSearch(*scene_).is_any(); });
}

std::vector<Intersection> Step::intersections_at_start() const {
  return intersections(start_of(*scene_), scene_->mesh(), options_at_start(*scene_));
}

bool Step::starts_free() const {
  std::atomic<bool> is_free = true;
  with_threads(scene_->certified().max_threads, [&] {
    scene_->find_inversions(
        scene_->certified(), 0.0, [&] { return is_free ? 0.0 : -1.0; },
        [&](const StepInversion& one) {
          if (one.start != 1) is_free = false;
        });
  });
  return is_free &&
         !has_intersections(start_of(*scene_), scene_->mesh(), options_at_start(*scene_));
}

Step Step::scaled(double alpha) const {
  // NaN fails, too.
  if (!(alpha >= 0.0 && alpha <= 1.0)) {
    throw std::invalid_argument("step: the step size must be in [0,1]");
  }
  return Step(with_threads(scene_->certified().max_threads, [&] {
    require_straight(scene_->vertices(), "step: a step size");
    require_finite_motions(scene_->vertices());
    return std::make_unique<const Scene>(scaled_vertices(scene_->vertices(), alpha), *scene_);
  }));
}

std::optional<double> Step::free_step_size() const {
  const StrictFloatingPoint strict;
  require_straight(vertices(), "step: a step size");
  require_finite_motions(vertices());
  const double greatest = scene_->certified().t_max;
  const std::optional<StepImpact> impact = earliest();
  if (!impact) {
    return StepSizeSearch([this](double alpha) { return scaled(alpha).is_free(); }, greatest)
        .run(greatest);
  }
  std::optional<CloseTrials> trials;
  const auto is_free = [&](double alpha) {
    // Those that collide or invert first in the whole step mostly do in a trial step that is not
    // free.
    const bool is_hit_again =
        std::ranges::any_of(
            impact->pairs,
            [&](const auto& one) { return collides_scaled(*scene_, one.kind, one.pair, alpha); }) ||
        std::ranges::any_of(impact->inversions, [&](const auto& one) {
          return inverts_scaled(*scene_, one.kind, one.cell, alpha);
        });
    if (is_hit_again) return false;
    if (alpha < greatest && !trials) {
      // Steps that are free beyond this are rare: rounding would have to move them as far.
      const double end = std::min(1.0, impact->toi_upper * (1.0 + 0x1p-6));
      with_threads(scene_->certified().max_threads, [&] { trials.emplace(*scene_, end); });
    }
    return trials && trials->covers(alpha) ? trials->is_free(alpha) : scaled(alpha).is_free();
  };
  return StepSizeSearch(is_free, greatest).run(impact->toi_lower);
}

void Step::candidates(const std::function<void(const StepCandidates&)>& take) const {
  with_threads(scene_->certified().max_threads, [&] {
    const Trees<1> trees = scene_->swept_trees();
    const std::vector<SearchPart> parts = scene_->parts(groups_of_part);
    tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
      const ContactKind kind = parts[i].kind;
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

std::array<std::int32_t, moving_points> Step::vertices_of(ContactKind kind,
                                                          const IndexPair& pair) const {
  require_in_range(*scene_, kind, pair);
  return scene_->vertices_of(kind, pair);
}

Query Step::query_of(ContactKind kind, const IndexPair& pair) const {
  require_straight(vertices(), "step: a query");
  require_in_range(*scene_, kind, pair);
  return scene_->query_of(kind, pair);
}

Query Step::tetrahedron_of(CellKind kind, std::int32_t cell) const {
  if (cell < 0 || std::cmp_greater_equal(cell, mesh().count_of(kind))) {
    throw std::out_of_range("step: there is no " + std::string(to_string(kind)) + " " +
                            std::to_string(cell));
  }
  return scene_->tetrahedron_of(kind, cell);
}

Separation Step::separation_of(ContactKind kind, const IndexPair& pair) const {
  require_in_range(*scene_, kind, pair);
  return scene_->separation_of(kind, pair, scene_->certified().separation);
}

const Motion& Step::vertices() const { return scene_->vertices(); }

StepOptions Step::options() const {
  return {.solve = scene_->certified(),
          .groups = groups(),
          .can_collide = scene_->can_collide(),
          .stop = scene_->stop()};
}

const Mesh& Step::mesh() const { return scene_->mesh(); }

const CollisionGroups& Step::groups() const { return scene_->groups(); }

const Scene& scene_of(const Step& step) { return *step.scene_; }

}  // namespace touchstone::fast
