#pragma once

/// \file
/// Triangle meshes in files.

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "touchstone/mesh.hpp"

namespace touchstone::verify::mesh {

/// Positions of vertices, a row each.
using Vertices = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// A vertex that is a part of a mesh by itself.
using Point = std::array<std::int32_t, 1>;

/// The groups of vertices that a file names.
struct Groups {
  std::vector<std::string> names;  ///< empty: before the first name, or of no vertex
  /// The group of each vertex, as an index of `names`; empty where the file names no group.
  std::vector<std::int32_t> of_vertex;
  /// The reason why the groups cannot be used, with the place in the file; empty if they can.
  std::string error;
};

/// A mesh at rest. Readers ensure that it has a vertex, that indices are in range and coordinates
/// finite.
///
/// Its edges are those of the faces and those that the file names by themselves, each once: ordered
/// and numbered as fast::edges_of does. Its points are the vertices that the file names as points
/// by themselves, or by an edge from a vertex to itself: ascending, each once.
struct Mesh : fast::Mesh {
  Vertices vertices;
  Groups groups;
  /// A line about parts of the file that were changed or ignored; empty if none were.
  std::string note;
};

/// The note of a mesh. \param polygons those with more than three vertices \param passed_over
/// names, with their numbers if they have one \param of_strips the triangles of strips
[[nodiscard]] std::string note_of(std::size_t polygons, std::span<const std::string> passed_over,
                                  std::size_t of_strips = 0);

/// Adds a polygon as a fan of triangles around its first vertex, and counts it if it is no
/// triangle.
/// \pre three vertices or more
void add_polygon(std::vector<fast::Face>& faces, std::span<const std::int32_t> vertices,
                 std::size_t& polygons);

/// A mesh from the contents of a file: the edges of the faces join those that the file names, in
/// any order and direction. An edge from a vertex to itself is a point.
/// \param coordinates x, y, z of each vertex in turn
/// \pre the coordinates are finite, the indices in range.
[[nodiscard]] Mesh make_mesh(std::span<const std::array<double, 3>> coordinates,
                             std::vector<fast::Face> faces, std::span<const fast::Edge> named_edges,
                             std::span<const Point> points = {});

/// The way to read the files of others.
inline constexpr std::string_view way_of_others =
    "`python3 -m touchstone.frames` makes an archive (.npz) of .vtk, .vtu, .xdmf and others";

/// True if the file's extension names a format that read_mesh knows.
[[nodiscard]] bool is_mesh_file(const std::filesystem::path& path);

/// True if both have the same number of vertices, and the same elements and groups.
[[nodiscard]] bool same_elements(const Mesh& a, const Mesh& b);

/// \throws DatasetError, with the contents of the mesh, if nothing in it could collide or invert.
void require_elements(const Mesh& mesh, const std::filesystem::path& path);

/// Reads a mesh in the format that the file's extension names, in either case: .ply or .obj.
/// \throws DatasetError if the extension is another, the file cannot be read or is in error.
[[nodiscard]] Mesh read_mesh(const std::filesystem::path& path);

}  // namespace touchstone::verify::mesh
