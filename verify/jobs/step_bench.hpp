#pragma once

/// \file
/// The time of a whole step of a scene (touchstone/step.hpp) and of its parts, and for comparison
/// that of reading the mesh once.

#include <array>
#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "touchstone/step.hpp"
#include "verify/jobs/work_time.hpp"
#include "verify/mesh/moving_mesh.hpp"

namespace touchstone::verify::jobs {

struct StepBenchOptions {
  /// At least 1.
  std::size_t repetitions = 5;
  /// Timed with one thread and with this number of threads; 0: all cores.
  unsigned threads = 0;
  Separation separation = {};
  fast::Kernels kernels = {};  ///< as CertifiedOptions has them
  /// Called occasionally with the completed fraction of the repetitions, from this thread.
  std::function<void(double)> on_progress = nullptr;
  /// Once true, no further repetition begins. May be null.
  const std::atomic<bool>* stop = nullptr;
};

/// The parts that are timed, each with another search but for the first: making the step (copies of
/// the vertices, boxes and trees of them), finding all candidates, which are counted and not
/// stored, all collisions with their times of impact, the earliest impact alone; and line searches:
/// Step::free_step_size, and fast::line_search_limit in L2 with a fifth of the distance of the
/// scene and of each pair.
inline constexpr std::array<std::string_view, 7> step_parts{
    "trees",          "candidates",     "collisions",    "earliest",
    "free_step_size", "limit_of_scene", "limit_of_pairs"};

/// The times with this number of threads, medians over the repetitions.
struct StepTimes {
  int threads = 0;
  std::array<WorkTime, step_parts.size()> parts = {};  ///< by step_parts
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
  /// Reading the vertices and the elements once, in one thread: the median.
  WorkTime memory_pass;
  /// With one thread, then with the requested number if it is greater.
  std::vector<StepTimes> times;
  /// The earliest impact; empty if there is no collision.
  std::optional<fast::StepImpact> earliest;
  /// True if it equals that of the collisions, as fast::Step promises.
  bool earliest_agrees = true;
  /// True if there are fewer repetitions or, without any, no times.
  bool interrupted = false;
};

/// \throws std::domain_error if a coordinate or a motion is not finite, std::invalid_argument for
/// options out of range.
[[nodiscard]] StepResult bench_step(const mesh::MovingMesh& mesh,
                                    const StepBenchOptions& options = {});

}  // namespace touchstone::verify::jobs
