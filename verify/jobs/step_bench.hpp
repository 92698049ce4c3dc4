#pragma once

/// \file
/// A whole step of a simulation from end to end: the broad phase, then all collisions, or the
/// earliest one alone, by the certified solver from index pairs.

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fast/certified.hpp"
#include "verify/jobs/work_time.hpp"
#include "verify/mesh/moving_mesh.hpp"

namespace touchstone::verify::jobs {

struct StepBenchOptions {
  /// At least 1.
  std::size_t repetitions = 5;
  /// Timed with one thread and with so many; 0: all cores.
  unsigned threads = 0;
  /// Its separation is that of the broad phase too; max_threads is set by the benchmark.
  fast::CertifiedOptions certified = {};
  /// Called now and then with the fraction of the repetitions that is done, from this thread.
  std::function<void(double)> on_progress = nullptr;
  /// Once true, no further repetition is begun.
  const std::atomic<bool>* stop = nullptr;
};

/// The times with so many threads, medians over the repetitions.
struct StepTimes {
  int threads = 0;
  WorkTime broad_phase;  ///< of both kinds
  WorkTime collisions;   ///< verdict and time of impact of all candidates of both kinds
  WorkTime earliest;     ///< the earliest contact of both kinds alone
};

/// The counts of one kind.
struct StepCounts {
  std::size_t candidates = 0;
  std::size_t collisions = 0;
};

struct StepResult {
  std::string name;
  Separation separation = {};
  std::size_t vertices = 0;
  std::size_t edges = 0;
  std::size_t faces = 0;
  StepCounts vertex_face;
  StepCounts edge_edge;
  /// With one thread, then with as many as asked for if these are more.
  std::vector<StepTimes> times;
  /// Around the earliest time of impact; nothing if nothing collides.
  std::optional<fast::EarliestImpact> earliest;
  /// Is it that of the collisions, as fast::earliest promises?
  bool earliest_agrees = true;
  /// Then there are fewer repetitions or, if there was none, no times.
  bool interrupted = false;
};

/// \throws std::domain_error if a coordinate is not finite, std::invalid_argument for options out of
/// range.
[[nodiscard]] StepResult bench_step(const mesh::MovingMesh& mesh,
                                    const StepBenchOptions& options = {});

}  // namespace touchstone::verify::jobs
