#pragma once

/// \file
/// Two rigid cubes that tumble into one another, again and again, with collision detection on
/// curves: touchstone/step.hpp.
///
/// A cube turns about a fixed axis with constant angular velocity while nothing touches it, because
/// its inertia is the same about all axes. In a step each vertex moves on the cubic Hermite curve
/// through its places and velocities at both ends. A spring draws each cube to the origin, by
/// a change of velocity between two steps. A step ends before the earliest impact; then an elastic
/// impulse at the nearest points acts along the contact normal.

#include <array>
#include <cstdint>
#include <filesystem>

namespace touchstone::simulation {

struct TumblingOptions {
  int steps = 400;
  /// Where the queries are written, as curves of degree 3: tumbling-vf.npy and tumbling-ee.npy.
  /// Empty: nowhere.
  std::filesystem::path folder = {};
};

struct TumblingResult {
  int impacts = 0;
  /// By Kind: the candidates of all steps, and those that collide by the certified solver.
  std::array<std::uint64_t, 2> queries{};
  std::array<std::uint64_t, 2> collisions{};
  /// The greatest change of kinetic energy by an impulse, of that before it.
  double worst_change = 0.0;
};

[[nodiscard]] TumblingResult tumble(const TumblingOptions& options);

}  // namespace touchstone::simulation
