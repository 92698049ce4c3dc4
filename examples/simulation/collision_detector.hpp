#pragma once

/// \file
/// Continuous collision detection for a simulator, by any method: how far a line search may go, and which contacts a
/// constrained step has.
///
/// **Line search** ([wang2021], algorithm 4). With the certified solver this is fast::line_search_limit, pair by pair: each
/// keeps p times its own distance. (Were it p times the least of the scene, a pair from far away could come as near as
/// the nearest at one stroke, and the nearest would be nearer at each.) Other methods that know of a separation are asked
/// for contact at p times the least distance of the scene; those that do not are asked for contact, and (1 − p) of the
/// time of impact is taken. Either may be 0, and may be wrong: that is what is to be seen.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "examples/simulation/recorder.hpp"
#include "fast/active_set.hpp"
#include "fast/line_search.hpp"
#include "fast/step.hpp"
#include "verify/solvers/solver.hpp"

namespace touchstone::simulation {

struct DetectorOptions {
  std::string method = "certified";
  double tolerance = 1e-6;              ///< δ, of methods that are driven by one
  std::int64_t max_checks = 1'000'000;  ///< m_I
  double p = 0.2;                       ///< the part of the distance that a line search keeps
  /// One query in so many is answered "no" whatever the truth, chosen by its coordinates; 0: none. (The certified solver is
  /// then asked as the others are.)
  std::uint64_t missed_one_in = 0;
  /// Of the queries that methods are asked, or would be. Null: they are not recorded.
  Recorder* recorder = nullptr;
  /// Of each motion no more queries of each kind than that are recorded, evenly spread; positive.
  std::size_t record_limit = SIZE_MAX;
};

/// What the detector did so far.
struct DetectorStatistics {
  std::uint64_t calls = 0;
  std::uint64_t candidates = 0;     ///< pairs that methods were asked about, or would have been
  std::uint64_t missed = 0;         ///< by missed_one_in, where the answer was not "no"
  std::uint64_t steps_of_zero = 0;  ///< line searches that may not go anywhere
  double seconds = 0.0;             ///< broad phase included, recording not
};

class CollisionDetector {
 public:
  /// \throws std::invalid_argument for an unknown method.
  explicit CollisionDetector(DetectorOptions options);

  /// A step size in [0, 1] up to which nothing is to touch.
  [[nodiscard]] double step_size(const fast::Step& step);

  /// The pairs that come within eta, with their contacts.
  [[nodiscard]] std::vector<fast::ActiveContact> active_set(const fast::Step& step, double eta);

  [[nodiscard]] const DetectorStatistics& statistics() const { return statistics_; }

 private:
  /// A pair that the method says comes near, and when.
  struct Hit {
    fast::PairKind kind;
    fast::IndexPair pair;
    double toi;
  };

  /// Is the whole step given to the certified solver, with its own broad phase?
  [[nodiscard]] bool is_whole() const;
  [[nodiscard]] std::vector<Hit> hits(const fast::Step& step, const Separation& separation);
  [[nodiscard]] double limit_by_method(const fast::Step& step);
  void record(const fast::Step& step);

  DetectorOptions options_;
  std::unique_ptr<verify::solvers::Solver> solver_;
  DetectorStatistics statistics_;
};

}  // namespace touchstone::simulation
