#pragma once

/// \file
/// The intersections of meshes at rest, for people (tables) and for machines (JSON, CSV).

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "touchstone/intersections.hpp"
#include "touchstone/inversion.hpp"
#include "verify/mesh/mesh_file.hpp"

namespace touchstone::verify::report {

/// The number of pairs that a text shows of a list.
inline constexpr std::size_t most_pairs = 10;

/// "  ... and 5 more (WHERE)" about a list of 15 pairs; empty if all are shown.
[[nodiscard]] std::string rest_text(std::size_t all, std::string_view where);

/// A mesh, and what is unusual in it by itself.
struct RestingMesh {
  std::string name;
  mesh::Mesh mesh;
  fast::MeshDefects defects = {};
  std::vector<fast::Inversion> inversions = {};  ///< the tetrahedra that are flat or inverted
};

/// Several meshes as one, whose vertices and elements are those of all in order. If there is more
/// than one, each is a group with its name.
[[nodiscard]] mesh::Mesh joined(const std::vector<RestingMesh>& meshes);

struct IntersectionReport {
  std::vector<RestingMesh> meshes;
  std::vector<fast::Intersection> intersections;  ///< of the joined mesh
  bool weld = false;
  double seconds = 0.0;
  bool interrupted = false;
};

/// The numbers of each kind; the first ten pairs with their places; what is unusual in each mesh.
[[nodiscard]] std::string to_text(const IntersectionReport& report);

/// "face 0 (0 1 2), face 1 (3 4 5)", with the names of the meshes if there are several.
[[nodiscard]] std::string pair_text(const std::vector<RestingMesh>& meshes,
                                    const fast::Intersection& intersection);

/// `meshes` (`name`, `vertices`, `edges`, `faces`, `degenerate_faces`, `degenerate_edges`,
/// `duplicated_vertices`, `unreferenced_vertices`, `tetrahedra`, `flat_tetrahedra`,
/// `inverted_tetrahedra`), `intersections` (`kind`, `first` and `second`:
/// `mesh`, an index, `element`, `number`; `place`: two points of three intervals), `counts` by
/// kind, `weld`, `seconds`, `interrupted`.
[[nodiscard]] nlohmann::json to_json(const IntersectionReport& report);

/// kind,first_mesh,first_element,first,second_mesh,second_element,second,x0_lower,x0_upper,…
[[nodiscard]] std::string to_csv(const IntersectionReport& report);

}  // namespace touchstone::verify::report
