#include "verify/jobs/step_bench.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <stdexcept>

#include "touchstone/contacts.hpp"
#include "verify/base/cores.hpp"
#include "verify/base/deadline.hpp"
#include "verify/jobs/memory_pass.hpp"
#include "verify/jobs/timing.hpp"

namespace touchstone::verify::jobs {
namespace {

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
  std::array<Repetitions, step_parts.size()> parts = {};
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
    for (std::size_t i = 0; i < options_.repetitions && !stopped(); ++i) {
      repeat();
      if (options_.on_progress) {
        options_.on_progress(static_cast<double>(i + 1) /
                             static_cast<double>(options_.repetitions));
      }
    }
    result.interrupted = stopped();
    result.vertex_face = counts(ContactKind::vertex_face);
    result.edge_edge = counts(ContactKind::edge_edge);
    result.earliest = earliest_;
    result.memory_pass = memory_pass_.median();
    for (const Series& series : series_) {
      if (series.parts.back().empty()) continue;
      StepTimes& times = result.times.emplace_back(StepTimes{.threads = series.threads});
      std::ranges::transform(series.parts, times.parts.begin(), &Repetitions::median);
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
    options.solve = {
        .separation = options_.separation, .max_threads = threads, .kernels = options_.kernels};
    options.stop = options_.stop;
    return {mesh_.vertices, {.edges = mesh_.edges, .faces = mesh_.faces, .points = {}}, options};
  }

  /// All numbers of threads in turn, up to a stop.
  void repeat() {
    pass_over_memory();
    try {
      for (Series& series : series_) repeat(series);
    } catch (const fast::Stopped&) {
      // Its times are not complete, and are left out.
    }
  }

  void repeat(Series& series) {
    Repetitions* part = series.parts.data();
    std::optional<fast::Step> step;
    (part++)->add([&] { step.emplace(step_with(series.threads)); });
    for (auto& count : candidates_) count = 0;
    (part++)->add([&] {
      step->candidates([&](const fast::StepCandidates& some) {
        candidates_.at(index_of(some.kind)) += some.pairs.size();
      });
    });
    (part++)->add([&] { collisions_ = step->collisions(); });
    (part++)->add([&] { earliest_ = step->earliest(); });
    constexpr double fifth = 0.2;
    (part++)->add([&] { (void)step->free_step_size(); });
    (part++)->add([&] { (void)fast::line_search_limit(*step, fifth); });
    (part++)->add([&] {
      (void)fast::line_search_limit(*step, fifth, {.start_distance = fast::StartDistance::of_pair});
    });
  }

  static std::size_t index_of(ContactKind kind) { return static_cast<std::size_t>(kind); }

  [[nodiscard]] StepCounts counts(ContactKind kind) const {
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
