#pragma once

/// \file
/// Queries of two rigid bodies whose rotation vectors are linear in time: decided, or undecided
/// within a proved error.
///
/// A point v of a body is at x(t) = p(t) + exp([r(t)]) v, where the position p and the rotation
/// vector r (its direction is the axis, its length the angle in radians) go linearly from the start
/// to the end. If r at the start is 0 or parallel to that at the end, this is a rotation about a
/// fixed axis with constant angular velocity, of any number of turns. The motion is transcendental,
/// so no decision is exact in general; but each is proved (docs/theory.md, section 2.6).
///
/// Bodies that no rotation moves (r is 0 at both ends, or their points are on its axis) are decided
/// exactly, as a query on straight lines. Other rotations, also those that are the same at both
/// ends, have matrices of irrational numbers: a contact that is only a touch stays undecided.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "touchstone/query.hpp"

namespace touchstone::exact {

struct RigidPose {
  std::array<double, 3> position{};
  std::array<double, 3> rotation{};  ///< rotation vector, in radians
};

struct RigidMotion {
  RigidPose start;
  RigidPose end;
};

/// Two primitives, each of its own body.
struct RigidQuery {
  /// The motions of the first and of the second primitive.
  std::array<RigidMotion, 2> bodies;
  /// The points in the order of Query, in the coordinates of their bodies.
  std::array<std::array<double, 3>, moving_points> points{};
};

struct RigidOptions {
  /// The length of the enclosure of the time of impact, if it can be reached.
  double toi_tolerance = 0x1p-20;
  /// The least length of an interval of times that is examined, and the greatest number of them
  /// (a few seconds): then the query is undecided.
  double least_interval = 0x1p-40;
  std::size_t greatest_count = 1U << 14U;
  /// Ends the search, if it becomes true. May be null.
  const std::atomic<bool>* stop = nullptr;
};

enum class RigidVerdict : std::uint8_t { no, yes, undecided };

/// What ends a search that decides nothing: the least interval, the greatest count, or the stop.
enum class RigidLimit : std::uint8_t { none, interval, count, stop };

struct RigidDecision {
  RigidVerdict verdict = RigidVerdict::undecided;
  /// There is no contact before toi_lower and, if the verdict is yes, one up to toi_upper. If it is
  /// no, both are 1. (Of translated bodies: the same or neighbouring doubles.)
  double toi_lower = 0.0;
  double toi_upper = 1.0;
  /// If undecided: the primitives come within this distance (in L2), at toi_lower or soon after.
  double error = 0.0;
  RigidLimit limit = RigidLimit::none;  ///< if undecided
  std::size_t intervals = 0;            ///< examined
};

/// Decides a query, never wrongly. Thread-safe.
/// \throws std::domain_error if a number is NaN or infinite, or one of a rotation above 2^100;
/// std::invalid_argument if the tolerance or the least interval is not in (0,1].
[[nodiscard]] RigidDecision decide(Kind kind, const RigidQuery& query,
                                   const RigidOptions& options = {});

}  // namespace touchstone::exact
