#pragma once

/// \file
/// The intersections of a mesh at rest with itself: the elements that meet outside their common
/// vertices, how and where. Exact for all finite coordinates.
///
/// \code{.cpp}
/// // Two triangles that cross, in a mesh at rest.
/// #include <touchstone/intersections.hpp>
///
/// #include <cstdio>
///
/// using namespace touchstone;
///
/// int main() {
///   const Eigen::MatrixX3d vertices{{0, 0, 0},  {4, 0, 0}, {0, 4, 0},
///                                   {1, 1, -1}, {1, 1, 1}, {1, 9, 0}};
///   const std::vector<fast::Face> faces{{0, 1, 2}, {3, 4, 5}};
///   for (const fast::Intersection& one : fast::intersections(vertices, {.faces = faces})) {
///     std::printf("faces %d and %d\n", one.numbers[0], one.numbers[1]);
///   }
/// }
/// // faces 0 and 1
/// \endcode
///
/// The *elements* are the faces, the edges of no face and the points of no face and no edge. Each
/// is the convex hull of its vertices. An edge that is listed twice, in any direction, is one edge;
/// one from a vertex to itself is no edge, but its vertex a point. Two elements *intersect* if
/// - they have a common point that is not in the hull of their common vertices, or
/// - they have the same vertices: duplicates.
///
/// Neighbours that meet only in their common vertex or edge do not intersect. Common vertices have
/// the same number, not only the same place: if every face of a file has its own vertices, faces
/// touch along all edges. With `weld`, vertices at the same place are one, and the elements are
/// those of the mesh that results. Touching counts: a step from there collides at t=0.
///
/// The broad phase (touchstone/broad_phase.hpp) finds the pairs whose boxes overlap; signs of
/// orientations decide these (fast/intersections/triangle_contacts.hpp, with theorem and proof).
/// The functions are thread-safe, do not depend on the caller's floating-point state, and have the
/// same results for any number of threads and any instruction set.

#include <Eigen/Core>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string_view>
#include <vector>

#include "touchstone/mesh.hpp"

namespace touchstone::fast {

enum class PrimitiveKind : std::uint8_t {
  face,   ///< its number among the faces
  edge,   ///< an edge, mostly of no face; its number among the edges
  point,  ///< a vertex of no face and no edge; its own number
};

/// The kind of an intersection: the first of these that is true.
enum class IntersectionKind : std::uint8_t {
  duplicates,         ///< the same vertices
  folded_faces,       ///< two faces on the same side of their common edge, in one plane
  coplanar_overlap,   ///< faces in one plane that overlap in an area
  edge_through_face,  ///< the inside of a face meets that of another one, or that of an edge
  vertex_in_face,     ///< a vertex inside a face
  edges_overlap,      ///< edges on one line overlap in a segment
  edges_cross,        ///< a point inside two edges that are not on one line
  vertex_on_edge,     ///< a vertex inside an edge
  vertices_coincide,  ///< two vertices at one place
};
inline constexpr std::size_t intersection_kinds = 9;

/// "face", "edge", "point".
[[nodiscard]] std::string_view to_string(PrimitiveKind kind);
/// "duplicates", "folded faces", "coplanar overlap", "edge through face", "vertex in face", "edges
/// overlap", "edges cross", "vertex on edge", "vertices coincide".
[[nodiscard]] std::string_view to_string(IntersectionKind kind);

/// A point between doubles: on each axis it is in [lower, upper], which are the same double or two
/// neighbouring ones.
struct PointEnclosure {
  std::array<double, 3> lower{};
  std::array<double, 3> upper{};

  friend auto operator<=>(const PointEnclosure&, const PointEnclosure&) = default;
};

/// Two elements that intersect: the one of the earlier kind first, then that of the smaller number.
struct Intersection {
  std::array<PrimitiveKind, 2> elements{};
  IndexPair numbers{};
  IntersectionKind kind = IntersectionKind::duplicates;
  /// The least and the greatest corner of the common part, by x, y and z in turn: the ends of a
  /// segment, twice the same point, or two corners of an area. (All 0 without `places`.)
  std::array<PointEnclosure, 2> place{};

  friend bool operator==(const Intersection&, const Intersection&) = default;
};

/// The pairs that are asked for.
enum class IntersectingPairs : std::uint8_t {
  all,  ///< of all elements
  /// Of an edge and a face without a common vertex, as the IPC Toolkit asks. The elements are the
  /// faces and all edges; points have no effect.
  edges_with_faces,
};

struct IntersectionOptions {
  IntersectingPairs pairs = IntersectingPairs::all;
  CollisionGroups groups = {};
  /// A rule for pairs of vertices, as StepOptions::can_collide.
  std::function<bool(std::int32_t, std::int32_t)> can_collide = nullptr;
  /// True if vertices at the same place, of the same group, are one vertex: the elements are found
  /// after that, and of those that are then one edge or one point the first is named.
  bool weld = false;
  /// Only the first so many are returned, in their order; the memory is bounded by them.
  std::size_t most = (std::numeric_limits<std::size_t>::max)();
  /// False leaves out the places; many of them take longer than all else.
  bool places = true;
  /// Maximum number of threads; 0 (all_cores): one for each core that the process may use.
  int max_threads = all_cores;
  /// Null, or a flag: once it is true, the search ends soon with the exception Stopped.
  const std::atomic<bool>* stop = nullptr;
};

/// All pairs of elements that intersect, ordered by the kinds of the elements, then by their
/// numbers.
/// \param mesh As for a step.
/// \throws std::domain_error naming the first vertex with a coordinate that is NaN or infinite;
/// std::out_of_range naming the first element with an index out of range; std::invalid_argument for
/// invalid groups or threads; std::length_error if there are more than 2^31−1 elements; Stopped.
[[nodiscard]] std::vector<Intersection> intersections(Motion vertices, const Mesh& mesh,
                                                      const IntersectionOptions& options = {});

/// True if there is an intersection. Ends with the first one. (`places` has no effect.) \throws as
/// above
[[nodiscard]] bool has_intersections(Motion vertices, const Mesh& mesh,
                                     const IntersectionOptions& options = {});

/// The same for a matrix of float or double, n×3, in any storage order. \throws also
/// std::invalid_argument for another shape
template <class Derived>
[[nodiscard]] std::vector<Intersection> intersections(const Eigen::MatrixBase<Derived>& vertices,
                                                      const Mesh& mesh,
                                                      const IntersectionOptions& options = {}) {
  return intersections(Motion(vertices, vertices), mesh, options);
}
template <class Derived>
[[nodiscard]] bool has_intersections(const Eigen::MatrixBase<Derived>& vertices, const Mesh& mesh,
                                     const IntersectionOptions& options = {}) {
  return has_intersections(Motion(vertices, vertices), mesh, options);
}

/// The defects of a mesh that are no intersections. All lists are ascending.
struct MeshDefects {
  /// Faces without an area: their vertices are on a line. Decided exactly.
  std::vector<std::int32_t> degenerate_faces;
  /// Edges without a length: from a vertex to itself, or to one at the same place.
  std::vector<std::int32_t> degenerate_edges;
  /// Vertices at the place of another one, and the first vertex at that place.
  std::vector<IndexPair> duplicated_vertices;
  /// Vertices that no element names.
  std::vector<std::int32_t> unreferenced_vertices;

  friend bool operator==(const MeshDefects&, const MeshDefects&) = default;
};

/// \throws as intersections
[[nodiscard]] MeshDefects mesh_defects(const Motion& vertices, const Mesh& mesh);
template <class Derived>
[[nodiscard]] MeshDefects mesh_defects(const Eigen::MatrixBase<Derived>& vertices,
                                       const Mesh& mesh) {
  return mesh_defects(Motion(vertices, vertices), mesh);
}

}  // namespace touchstone::fast
