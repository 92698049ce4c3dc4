#pragma once

/// \file
/// The scenes: bodies, their positions at the start, and the forces on them. All are defined
/// by formulas.

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "touchstone/mesh.hpp"

namespace touchstone::simulation {

using Tetrahedron = std::array<std::int32_t, 4>;
/// Positions of vertices, a row each, in metres.
using Vertices = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// An elastic body of tetrahedra, or, without tetrahedra, an obstacle, which does not move.
struct Body {
  Vertices vertices;  ///< at rest
  std::vector<Tetrahedron> tetrahedra;
  /// The faces that can collide: the surface of the tetrahedra, or the obstacle.
  std::vector<fast::Face> faces;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< at the start, in m/s
  double density = 1000.0;                             ///< kg/m³
  double youngs_modulus = 1e5;                         ///< Pa

  [[nodiscard]] bool is_obstacle() const { return tetrahedra.empty(); }
};

/// A point of a body for a point of its grid.
using Map = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

/// The cube [−1,1]³ in cells of six tetrahedra each, moved by a map. As a ring its ends at x = −1
/// and x = 1 are joined; the map must have the same values there.
[[nodiscard]] Body block(const std::array<int, 3>& cells, const Map& map, bool is_ring = false);

/// The mantle of a cone as an obstacle: triangles from its tip to a circle of points around the z
/// axis.
[[nodiscard]] Body cone(const Eigen::Vector3d& tip, double radius, double base_height, int points);

/// A vertex that a spring pulls to a moving place.
struct Pin {
  std::int32_t vertex = 0;  ///< the vertices of all bodies are numbered in turn
  /// The place at a time in seconds.
  std::function<Eigen::Vector3d(double)> place;
};

struct Scene {
  std::vector<Body> bodies;
  std::vector<Pin> pins;
  Eigen::Vector3d gravity{0.0, 0.0, -9.81};
  double time_step = 0.01;  ///< seconds
  int steps = 60;           ///< enough to show the purpose of the scene
  /// d̂ of barriers, below which they act, and η of constraints, in metres.
  double activation_distance = 1e-3;
};

struct SceneDescription {
  std::string_view name;
  std::string_view what;
  Scene (*make)();
};

/// All scenes.
[[nodiscard]] const std::vector<SceneDescription>& scenes();

}  // namespace touchstone::simulation
