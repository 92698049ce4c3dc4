#pragma once

/// \file
/// The scenes: bodies, their positions at the start, and the forces on them. All are defined
/// by formulas.

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "touchstone/mesh.hpp"

namespace touchstone::simulation {

// Bodies defined by formulas: blocks and rings of tetrahedra, cloth, and fixed obstacles.

using Tetrahedron = std::array<std::int32_t, 4>;
/// Positions of vertices, a row each, in metres.
using Vertices = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

enum class BodyKind : std::uint8_t {
  elastic,   ///< tetrahedra
  cloth,     ///< triangles that resist stretching and bending
  obstacle,  ///< triangles that do not move
};

struct Body {
  BodyKind kind = BodyKind::elastic;
  Vertices vertices;  ///< at rest
  std::vector<Tetrahedron> tetrahedra;
  /// The faces that can collide: the surface of the tetrahedra, the cloth, or the obstacle.
  std::vector<fast::Face> faces;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< at the start, in m/s
  double density = 1000.0;                             ///< kg/m³; of cloth kg/m²
  double youngs_modulus = 1e5;                         ///< Pa; of cloth N/m
};

/// A point of a body for a point of its grid.
using Map = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

/// The cube [−1,1]³ in cells of six tetrahedra each, moved by a map.
[[nodiscard]] Body block(const std::array<int, 3>& cells, const Map& map);

/// The same with its ends at x = −1 and x = 1 joined. The map must have the same values there.
[[nodiscard]] Body ring(const std::array<int, 3>& cells, const Map& map);

/// The square [−1,1]² × 0 in triangles, moved by a map, as cloth.
[[nodiscard]] Body cloth(const std::array<int, 2>& cells, const Map& map);

/// A plane curve, (x, z) in order, extruded along y from −width/2 to width/2 in this number of
/// strips.
[[nodiscard]] Body extruded(const std::vector<std::array<double, 2>>& profile, double width,
                            int strips);

/// Triangles with the same vertex in common, and the points of a closed curve around it in order.
[[nodiscard]] Body fan(const Eigen::Vector3d& tip, const std::vector<Eigen::Vector3d>& rim);

/// Any triangles, as an obstacle.
[[nodiscard]] Body obstacle(const std::vector<Eigen::Vector3d>& vertices,
                            std::vector<fast::Face> faces);

/// The cube [−1,1]³ with its layers rounded most of the way to spheres, of radius about 1. In a
/// whole ball the elements along the cube's edges would be flat.
[[nodiscard]] Eigen::Vector3d rounded_cube(const Eigen::Vector3d& point);

/// The body elsewhere.
[[nodiscard]] Body moved(Body body, const Eigen::Vector3d& translation);

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
