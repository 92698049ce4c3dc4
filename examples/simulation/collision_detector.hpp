#pragma once

/// \file
/// Continuous collision detection for a simulator, by any method: the limit of a line search,
/// and the contacts of a constrained step.
///
/// **Line search** ([wang2021], algorithm 4). With the certified solver this is
/// fast::line_search_limit, pair by pair: each keeps p times its own distance. (With p times the
/// least distance of the scene, a distant pair could become as close as the closest in one step,
/// and the closest pair would come closer in each.) Other methods that support a separation use p
/// times the least distance of the scene; for the rest the step is (1 − p) of the time of impact.
/// Either may be 0 or wrong; simulations show the effects.

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "examples/simulation/recorder.hpp"
#include "touchstone/contacts.hpp"
#include "touchstone/step.hpp"
#include "verify/solvers/solver.hpp"

namespace touchstone::simulation {

struct DetectorOptions {
  std::string method = "certified";
  double tolerance = 1e-6;  ///< δ, of methods that are driven by one
  double p = 0.2;           ///< the fraction of the distance that a line search keeps
  /// One query in this number, chosen by its coordinates, is answered "no" regardless of the truth;
  /// 0: none. (The certified solver is then used like the others.)
  std::uint64_t missed_one_in = 0;
  /// A single answer is "no" regardless of the truth: to the query that limits the limited line
  /// search of this number; 0: none. (The certified solver is then used like the others.)
  std::uint64_t missed_limit = 0;
  /// Records the queries of all methods. Null: they are not recorded.
  Recorder* recorder = nullptr;
  /// The maximum number of recorded queries of each motion and kind, evenly spread; positive.
  std::size_t record_limit = SIZE_MAX;
};

/// Statistics of the detector.
struct DetectorStatistics {
  std::uint64_t calls = 0;
  std::uint64_t candidates = 0;  ///< candidate pairs
  std::uint64_t missed = 0;      ///< planted false negatives
  /// Line searches that a contact limits, of methods called query by query.
  std::uint64_t limited = 0;
  std::uint64_t steps_of_zero = 0;  ///< line searches with a step size of 0
  double seconds = 0.0;             ///< including the broad phase, without recording
};

/// Pairs by kind, in order.
using Candidates = std::map<ContactKind, std::vector<fast::IndexPair>>;

[[nodiscard]] Candidates candidates_of(const fast::Step& step);

class CollisionDetector {
 public:
  /// \throws std::invalid_argument for an unknown method.
  explicit CollisionDetector(DetectorOptions options);

  /// A step size in [0, 1] up to which the method finds no collision.
  [[nodiscard]] double step_size(const fast::Step& step);

  /// The pairs that come within the distance, with their contacts.
  [[nodiscard]] std::vector<fast::ActiveContact> active_set(const fast::Step& step,
                                                            double distance);

  [[nodiscard]] const DetectorStatistics& statistics() const { return statistics_; }

 private:
  /// A pair with its time of impact according to the method.
  struct Impact {
    ContactKind kind;
    fast::IndexPair pair;
    double toi;
  };

  /// True if the certified solver takes the whole step, with its own broad phase.
  [[nodiscard]] bool is_whole() const;
  [[nodiscard]] std::vector<Impact> impacts(const fast::Step& step, const Separation& separation);
  [[nodiscard]] double limit_by_method(const fast::Step& step);
  void record(const fast::Step& step);

  DetectorOptions options_;
  std::unique_ptr<verify::solvers::Solver> solver_;
  DetectorStatistics statistics_;
};

/// Adds the wall-clock time until its end, in seconds.
class Stopwatch {
 public:
  explicit Stopwatch(double& seconds) : seconds_(seconds) {}
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;
  Stopwatch(Stopwatch&&) = delete;
  Stopwatch& operator=(Stopwatch&&) = delete;
  ~Stopwatch() { seconds_ += std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;

  double& seconds_;
  Clock::time_point start_ = Clock::now();
};

}  // namespace touchstone::simulation
