#include "verify/mesh/mesh_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "touchstone/broad_phase.hpp"
#include "verify/io/dataset_error.hpp"
#include "verify/mesh/obj.hpp"
#include "verify/mesh/ply.hpp"

namespace touchstone::verify::mesh {
namespace {

std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return text;
}

/// The edges of the faces and those named, in the order of fast::edges_of.
std::vector<fast::Edge> all_edges(std::vector<fast::Face> faces,
                                  std::span<const fast::Edge> named) {
  // A face without area has that one edge.
  for (const fast::Edge& edge : named) faces.push_back({edge[0], edge[1], edge[1]});
  return fast::edges_of(faces);
}

std::vector<std::int32_t> all_points(std::span<const Point> points,
                                     std::span<const fast::Edge> named_edges) {
  std::vector<std::int32_t> result;
  for (const auto& [point] : points) result.push_back(point);
  for (const auto& [a, b] : named_edges) {
    if (a == b) result.push_back(a);
  }
  std::ranges::sort(result);
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

}  // namespace

Mesh make_mesh(std::span<const std::array<double, 3>> coordinates, std::vector<fast::Face> faces,
               std::span<const fast::Edge> named_edges, std::span<const Point> points) {
  Mesh mesh;
  mesh.vertices.resize(static_cast<Eigen::Index>(coordinates.size()), 3);
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    mesh.vertices.row(static_cast<Eigen::Index>(i)) =
        Eigen::Map<const Eigen::RowVector3d>(coordinates[i].data());
  }
  mesh.edges = all_edges(faces, named_edges);
  mesh.faces = std::move(faces);
  mesh.points = all_points(points, named_edges);
  return mesh;
}

std::string note_of(std::size_t polygons, std::span<const std::string> passed_over,
                    std::size_t of_strips) {
  static constexpr std::size_t most_named = 20;
  std::vector<std::string> notes;
  if (polygons != 0) {
    notes.push_back(fmt::format("polygons read as fans of triangles: {}", polygons));
  }
  if (of_strips != 0) notes.push_back(fmt::format("triangles read from strips: {}", of_strips));
  if (!passed_over.empty()) {
    const auto named = passed_over.first(std::min(passed_over.size(), most_named));
    const std::size_t more = passed_over.size() - named.size();
    notes.push_back(fmt::format("passed over: {}{}", fmt::join(named, ", "),
                                more == 0 ? "" : fmt::format(" and {} more", more)));
  }
  return fmt::format("{}", fmt::join(notes, "; "));
}

void add_polygon(std::vector<fast::Face>& faces, std::span<const std::int32_t> vertices,
                 std::size_t& polygons) {
  for (std::size_t i = 2; i < vertices.size(); ++i) {
    faces.push_back({vertices[0], vertices[i - 1], vertices[i]});
  }
  if (vertices.size() > 3) ++polygons;
}

void require_elements(const Mesh& mesh, const std::filesystem::path& path) {
  if (!mesh.faces.empty() || !mesh.edges.empty() || !mesh.points.empty() ||
      !mesh.tetrahedra.empty())
    return;
  throw io::DatasetError(
      path, {},
      fmt::format("nothing in it can collide: no face, edge or point, only vertices: {}{}{}",
                  mesh.vertices.rows(), mesh.note.empty() ? "" : "; ", mesh.note));
}

bool is_mesh_file(const std::filesystem::path& path) {
  const std::string extension = lower_case(path.extension().string());
  return extension == ".ply" || extension == ".obj";
}

bool same_elements(const Mesh& a, const Mesh& b) {
  return a.vertices.rows() == b.vertices.rows() && a.faces == b.faces && a.edges == b.edges &&
         a.points == b.points && a.tetrahedra == b.tetrahedra && a.groups.names == b.groups.names &&
         a.groups.of_vertex == b.groups.of_vertex;
}

Mesh read_mesh(const std::filesystem::path& path) {
  const std::string extension = lower_case(path.extension().string());
  if (extension == ".ply") return read_ply(path);
  if (extension == ".obj") return read_obj(path);
  throw io::DatasetError(
      path, {}, fmt::format("unknown format: only .ply and .obj are meshes; {}", way_of_others));
}

}  // namespace touchstone::verify::mesh
