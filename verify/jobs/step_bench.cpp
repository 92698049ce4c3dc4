#include "verify/jobs/step_bench.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <span>
#include <stdexcept>

#include "touchstone/contacts.hpp"
#include "verify/base/cores.hpp"
#include "verify/base/deadline.hpp"
#include "verify/jobs/memory_pass.hpp"
#include "verify/jobs/timing.hpp"

namespace touchstone::verify::jobs {
namespace {

/// The greatest resident memory since the last call, in bytes; 0: unknown. (That of getrusage never
/// falls.)
std::size_t take_peak() {
  std::size_t kilobytes = 0;
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word == "VmHWM:" && status >> kilobytes) break;
  }
  std::ofstream("/proc/self/clear_refs") << "5";
  return 1024 * kilobytes;
}

/// The pages that this process has touched for the first time.
std::size_t page_faults() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_minflt);
}

/// The times of one part of a step, one for each repetition.
class Repetitions {
 public:
  template <class Work>
  void add(const Work& work) {
    const WorkTime time = work_time_of(work);
    wall_.push_back(time.wall);
    processor_.push_back(time.processor);
  }

  [[nodiscard]] bool empty() const { return wall_.empty(); }
  [[nodiscard]] WorkTime median() const {
    return {.wall = jobs::median(wall_), .processor = jobs::median(processor_)};
  }

 private:
  std::vector<double> wall_;
  std::vector<double> processor_;
};

/// The times of all repetitions with this number of threads.
struct Series {
  int threads = 1;
  Repetitions trees = {};
  Repetitions candidates = {};
  Repetitions collisions = {};
  Repetitions earliest = {};
  Repetitions next = {};
  Repetitions free_step_size = {};
  Repetitions limit_of_scene = {};
  Repetitions limit_of_pairs = {};
};

class StepMeasurement {
 public:
  StepMeasurement(const mesh::MovingMesh& mesh, const StepBenchOptions& options)
      : mesh_(mesh), options_(options) {
    series_.push_back({.threads = 1});
    const int most = base::cores_for(options.threads);
    if (most > 1) series_.push_back({.threads = most});
  }

  [[nodiscard]] StepResult result() {
    StepResult result;
    result.name = mesh_.name;
    result.separation = options_.separation;
    result.vertices = mesh_.vertices.size();
    result.edges = mesh_.edges.size();
    result.faces = mesh_.faces.size();
    result.memory = memory();
    for (std::size_t i = 0; i < options_.repetitions && !stopped(); ++i) {
      pass_over_memory();
      for (Series& series : series_) {
        if (stopped()) break;
        try {
          repeat(series);
        } catch (const fast::Stopped&) {
          break;
        }
      }
      if (options_.on_progress) {
        options_.on_progress(static_cast<double>(i + 1) /
                             static_cast<double>(options_.repetitions));
      }
    }
    result.interrupted = stopped();
    result.vertex_face = counts(fast::PairKind::vertex_face);
    result.edge_edge = counts(fast::PairKind::edge_edge);
    result.earliest = earliest_;
    result.memory_pass = memory_pass_.median();
    for (const Series& series : series_) {
      if (series.limit_of_pairs.empty()) continue;
      result.times.push_back({.threads = series.threads,
                              .trees = series.trees.median(),
                              .candidates = series.candidates.median(),
                              .collisions = series.collisions.median(),
                              .earliest = series.earliest.median(),
                              .next = series.next.median(),
                              .free_step_size = series.free_step_size.median(),
                              .limit_of_scene = series.limit_of_scene.median(),
                              .limit_of_pairs = series.limit_of_pairs.median()});
    }
    result.earliest_agrees = result.times.empty() || earliest_agrees();
    return result;
  }

 private:
  [[nodiscard]] bool stopped() const { return base::is_stopped(options_.stop); }

  void pass_over_memory() {
    memory_pass_.add([&] {
      const std::span vertices(mesh_.vertices.data(), mesh_.vertices.size());
      checksum_ =
          checksum_ ^ memory_pass(vertices) ^ memory_pass(mesh_.edges) ^ memory_pass(mesh_.faces);
    });
  }

  [[nodiscard]] fast::Step step_with(int threads) const {
    fast::StepOptions options;
    options.separation = options_.separation;
    options.max_threads = threads;
    options.stop = options_.stop;
    return {mesh_.vertices, {.edges = mesh_.edges, .faces = mesh_.faces, .points = {}}, options};
  }

  /// Before all other steps, whose memory would be used again.
  [[nodiscard]] StepMemory memory() const {
    StepMemory memory;
    try {
      (void)take_peak();
      const std::size_t before = take_peak(), faults = page_faults();
      const fast::Step step = step_with(1);
      (void)step.collisions();
      const std::size_t faults_of_both = page_faults(), peak = take_peak();
      (void)step.with_separation(options_.separation).collisions();
      memory = {.peak = peak > before ? peak - before : 0,
                .faults_of_first = faults_of_both - faults,
                .faults_of_next = page_faults() - faults_of_both};
    } catch (const fast::Stopped&) {
      // Nothing else is measured then.
    }
    return memory;
  }

  void repeat(Series& series) {
    std::optional<fast::Step> step;
    series.trees.add([&] { step.emplace(step_with(series.threads)); });
    for (auto& count : candidates_) count = 0;
    series.candidates.add([&] {
      step->candidates([&](const fast::StepCandidates& some) {
        candidates_.at(index_of(some.kind)) += some.pairs.size();
      });
    });
    series.collisions.add([&] { collisions_ = step->collisions(); });
    series.earliest.add([&] { earliest_ = step->earliest(); });
    series.next.add([&] { (void)step->with_separation(options_.separation); });
    constexpr double part = 0.2;
    series.free_step_size.add([&] { (void)step->free_step_size(); });
    series.limit_of_scene.add([&] { (void)fast::line_search_limit(*step, part); });
    series.limit_of_pairs.add([&] {
      (void)fast::line_search_limit(*step, part, {.start_distance = fast::StartDistance::of_pair});
    });
  }

  static std::size_t index_of(fast::PairKind kind) { return static_cast<std::size_t>(kind); }

  [[nodiscard]] StepCounts counts(fast::PairKind kind) const {
    return {.candidates = candidates_.at(index_of(kind)),
            .collisions = static_cast<std::size_t>(
                std::ranges::count(collisions_, kind, &fast::StepCollision::kind))};
  }

  /// The earliest impact must be that of the collisions.
  [[nodiscard]] bool earliest_agrees() const {
    if (collisions_.empty() || !earliest_) return collisions_.empty() && !earliest_;
    return earliest_->toi_lower ==
               std::ranges::min(collisions_, {}, &fast::StepCollision::toi_lower).toi_lower &&
           earliest_->toi_upper ==
               std::ranges::min(collisions_, {}, &fast::StepCollision::toi_upper).toi_upper;
  }

  const mesh::MovingMesh& mesh_;
  const StepBenchOptions& options_;
  std::vector<Series> series_;
  Repetitions memory_pass_;
  volatile std::uint64_t checksum_ = 0;
  std::array<std::atomic<std::size_t>, 4> candidates_{};  ///< by kinds, of several threads at once
  std::vector<fast::StepCollision> collisions_;
  std::optional<fast::StepImpact> earliest_;
};

}  // namespace

StepResult bench_step(const mesh::MovingMesh& mesh, const StepBenchOptions& options) {
  if (options.repetitions == 0) throw std::invalid_argument("repetitions must be at least 1");
  return StepMeasurement(mesh, options).result();
}

}  // namespace touchstone::verify::jobs
