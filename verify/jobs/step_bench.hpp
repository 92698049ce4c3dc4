#pragma once

/// \file
/// The time of a whole step of a scene (touchstone/step.hpp) and of its parts, and for comparison
/// that of reading the mesh once.

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fast/method.hpp"
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
  /// Called occasionally with the completed fraction of the repetitions, from this thread.
  std::function<void(double)> on_progress = nullptr;
  /// Once true, no further repetition begins. May be null.
  const std::atomic<bool>* stop = nullptr;
};

/// The times with this number of threads, medians over the repetitions.
struct StepTimes {
  int threads = 0;
  WorkTime trees;       ///< making the step: copies of the vertices, boxes and trees of them
  WorkTime candidates;  ///< finding all candidates, which are counted and not stored
  WorkTime collisions;  ///< all collisions with their times of impact, including the search
  WorkTime earliest;    ///< the earliest impact alone, the search included
  WorkTime next;        ///< making the next step of the mesh (Step::with_places)
  // Line searches, from the step: Step::free_step_size, and fast::line_search_limit in L2 with
  // p = 0.2 of the distance of the scene and of each pair.
  WorkTime free_step_size;
  WorkTime limit_of_scene;
  WorkTime limit_of_pairs;
};

/// The memory of steps with their collisions, in one thread.
struct StepMemory {
  /// The greatest resident memory of the first step above that before it, in bytes; 0: unknown.
  std::size_t peak = 0;
  /// Pages that were touched for the first time: in this step, and in the next one of the mesh.
  std::size_t faults_of_first = 0;
  std::size_t faults_of_next = 0;
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
  StepMemory memory;
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
