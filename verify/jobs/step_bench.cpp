#include "verify/jobs/step_bench.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "verify/jobs/cores.hpp"
#include "verify/jobs/deadline.hpp"
#include "verify/jobs/statistics.hpp"

namespace touchstone::verify::jobs {
namespace {

/// The times of one part of a step, a repetition each.
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

/// Candidates of one kind and their results.
struct Part {
  Kind kind;
  std::vector<fast::IndexPair> pairs = {};
  std::vector<fast::CertifiedResult> results = {};
};

/// The times of all repetitions with so many threads.
struct Series {
  int threads = 1;
  Repetitions broad_phase = {};
  Repetitions collisions = {};
  Repetitions earliest = {};
};

/// The earlier of two impacts, of which either may be missing.
std::optional<fast::EarliestImpact> earlier(const std::optional<fast::EarliestImpact>& a,
                                            const std::optional<fast::EarliestImpact>& b) {
  if (!a || !b) return a ? a : b;
  return fast::EarliestImpact{.toi_lower = std::min(a->toi_lower, b->toi_lower),
                              .toi_upper = std::min(a->toi_upper, b->toi_upper)};
}

class StepRun {
 public:
  StepRun(const mesh::MovingMesh& mesh, const StepBenchOptions& options)
      : mesh_(mesh), options_(options) {
    series_.push_back({.threads = 1});
    const int most = cores_for(options.threads);
    if (most > 1) series_.push_back({.threads = most});
  }

  [[nodiscard]] StepResult result() {
    StepResult result;
    result.name = mesh_.name;
    result.separation = options_.certified.separation;
    result.vertices = mesh_.vertices.size();
    result.edges = mesh_.edges.size();
    result.faces = mesh_.faces.size();
    for (std::size_t i = 0; i < options_.repetitions && !stopped(); ++i) {
      for (Series& series : series_) {
        if (!stopped()) repeat(series);
      }
      if (options_.on_progress) {
        options_.on_progress(static_cast<double>(i + 1) /
                             static_cast<double>(options_.repetitions));
      }
    }
    result.interrupted = stopped();
    result.vertex_face = counts(parts_[0]);
    result.edge_edge = counts(parts_[1]);
    result.earliest = earliest_;
    for (const Series& series : series_) {
      if (series.earliest.empty()) continue;
      result.times.push_back({.threads = series.threads,
                              .broad_phase = series.broad_phase.median(),
                              .collisions = series.collisions.median(),
                              .earliest = series.earliest.median()});
    }
    result.earliest_agrees = result.times.empty() || earliest_agrees();
    return result;
  }

 private:
  [[nodiscard]] bool stopped() const { return is_stopped(options_.stop); }

  void repeat(Series& series) {
    fast::CertifiedOptions certified = options_.certified;
    certified.max_threads = series.threads;
    series.broad_phase.add([&] {
      for (Part& part : parts_)
        part.pairs = mesh::find_candidates(mesh_, part.kind, series.threads,
                                           options_.certified.separation.distance);
    });
    for (Part& part : parts_) part.results.resize(part.pairs.size());
    series.collisions.add([&] {
      for (Part& part : parts_) {
        fast::solve(mesh_.vertices, candidates(part), part.results, certified);
      }
    });
    series.earliest.add([&] {
      earliest_ = std::nullopt;
      for (const Part& part : parts_) {
        earliest_ = earlier(earliest_, fast::earliest(mesh_.vertices, candidates(part), certified));
      }
    });
  }

  [[nodiscard]] fast::Candidates candidates(const Part& part) const {
    return mesh::candidates_of(mesh_, part.kind, part.pairs);
  }

  static StepCounts counts(const Part& part) {
    const auto collides = [](const fast::CertifiedResult& result) {
      return result.verdict == fast::Verdict::yes;
    };
    return {.candidates = part.pairs.size(),
            .collisions = static_cast<std::size_t>(std::ranges::count_if(part.results, collides))};
  }

  /// The earliest impact is promised to be that of the results.
  [[nodiscard]] bool earliest_agrees() const {
    std::optional<fast::EarliestImpact> expected;
    for (const Part& part : parts_) {
      for (const fast::CertifiedResult& result : part.results) {
        if (result.verdict != fast::Verdict::yes) continue;
        expected = earlier(expected, fast::EarliestImpact{.toi_lower = result.toi_lower,
                                                          .toi_upper = result.toi_upper});
      }
    }
    return expected.has_value() == earliest_.has_value() &&
           (!expected || (expected->toi_lower == earliest_->toi_lower &&
                          expected->toi_upper == earliest_->toi_upper));
  }

  const mesh::MovingMesh& mesh_;
  const StepBenchOptions& options_;
  std::array<Part, 2> parts_{{{.kind = Kind::vertex_face}, {.kind = Kind::edge_edge}}};
  std::vector<Series> series_;
  std::optional<fast::EarliestImpact> earliest_;
};

}  // namespace

StepResult bench_step(const mesh::MovingMesh& mesh, const StepBenchOptions& options) {
  if (options.repetitions == 0) throw std::invalid_argument("repetitions must be at least 1");
  return StepRun(mesh, options).result();
}

}  // namespace touchstone::verify::jobs
