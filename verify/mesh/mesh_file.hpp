#pragma once

/// \file
/// Triangle meshes in files.

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "touchstone/mesh.hpp"

namespace touchstone::verify::mesh {

/// Positions of vertices, a row each.
using Vertices = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// A vertex that is a part of a mesh by itself.
using Point = std::array<std::int32_t, 1>;

/// The groups of vertices that a file names.
struct Groups {
  std::vector<std::string> names;
  /// Of each vertex, an index of `names`; empty where the file names no group.
  std::vector<std::int32_t> of_vertex;
  /// Why the groups cannot be used, with the place in the file; empty if they can.
  std::string error;
};

/// A mesh at rest. Wherever a reader made it, it has a vertex, indices are in range and coordinates
/// finite.
struct Mesh {
  Vertices vertices;
  std::vector<fast::Face> faces;
  /// Those of the faces and those that the file names by themselves, each once: ordered and
  /// numbered as fast::edges_of does.
  std::vector<fast::Edge> edges;
  /// The vertices that the file names as points by themselves, or by an edge from a vertex to
  /// itself: ascending, each once.
  std::vector<std::int32_t> points;
  Groups groups;
  /// What of the file was read in another form or passed over, in a line; empty if nothing was.
  std::string note;
};

/// The note of a mesh. \param polygons those with more than three vertices \param passed_over
/// names, with their numbers if they have one
[[nodiscard]] std::string note_of(std::size_t polygons, std::span<const std::string> passed_over);

/// Adds a polygon as a fan of triangles around its first vertex, and counts it if it is no
/// triangle.
/// \pre three vertices or more
void add_polygon(std::vector<fast::Face>& faces, std::span<const std::int32_t> vertices,
                 std::size_t& polygons);

/// A mesh from what a file holds: the edges of the faces join those that the file names, in
/// whatever order and direction. An edge from a vertex to itself is a point.
/// \param coordinates x, y, z of each vertex in turn
/// \pre the coordinates are finite, the indices in range.
[[nodiscard]] Mesh make_mesh(std::span<const std::array<double, 3>> coordinates,
                             std::vector<fast::Face> faces, std::span<const fast::Edge> named_edges,
                             std::span<const Point> points = {});

/// Does the file's extension name a format that read_mesh knows?
[[nodiscard]] bool is_mesh_file(const std::filesystem::path& path);

/// Have they as many vertices, and the same faces, edges, points and groups?
[[nodiscard]] bool same_elements(const Mesh& a, const Mesh& b);

/// \throws DatasetError that says what was found, if the mesh has nothing that could collide.
void require_elements(const Mesh& mesh, const std::filesystem::path& path);

/// Reads a mesh in the format that the file's extension names, in either case: .ply or .obj.
/// \throws DatasetError if the extension is another, the file cannot be read or is in error.
[[nodiscard]] Mesh read_mesh(const std::filesystem::path& path);

}  // namespace touchstone::verify::mesh
