#pragma once

/// \file
/// The scenes: bodies, their positions at the start, and the forces on them. All are defined
/// by formulas.

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "examples/simulation/body.hpp"

namespace touchstone::simulation {

/// A vertex that a spring pulls to a moving place.
struct Pin {
  std::int32_t body = 0;
  std::int32_t vertex = 0;
  /// The place at a time in seconds.
  std::function<Eigen::Vector3d(double)> place;
};

struct Scene {
  std::string name;
  std::vector<Body> bodies;
  std::vector<Pin> pins;
  Eigen::Vector3d gravity{0.0, 0.0, -9.81};
  double time_step = 0.01;            ///< seconds
  int steps = 60;                     ///< enough to show the purpose of the scene
  double activation_distance = 1e-3;  ///< below which a barrier acts: d̂, in metres
};

struct SceneDescription {
  std::string_view name;
  std::string_view what;
  Scene (*make)();
};

/// All scenes, in the order of the paper and then of Erleben's.
[[nodiscard]] const std::vector<SceneDescription>& scenes();

/// \throws std::invalid_argument, listing the names, for an unknown one.
[[nodiscard]] Scene make_scene(std::string_view name);

}  // namespace touchstone::simulation
