#pragma once

/// \file
/// Pairs of a moving mesh as input of the certified solver, and the checks of a mesh. The functions
/// are thread-safe.

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "touchstone/mesh.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast {

/// Pairs of one kind with the arrays that their indices refer to. Owns nothing.
struct Candidates {
  ContactKind kind = ContactKind::vertex_face;
  std::span<const IndexPair> pairs;
  std::span<const Edge> edges;  ///< needed for edge_edge
  std::span<const Face> faces;  ///< needed for vertex_face
};

/// The query whose points are these vertices, and a pair as a query. \pre their numbers are in
/// range.
[[nodiscard]] Query query_of(const Motion& vertices, const Tetrahedron& points);
[[nodiscard]] Query query_of(const Motion& vertices, const Candidates& candidates,
                             const IndexPair& pair);

/// \throws std::domain_error naming the first vertex with a coordinate that is NaN or infinite, or
/// a weight that is not positive and finite; std::length_error if there are more than 2^31−1
/// vertices.
void require_finite(const Motion& vertices);

/// \throws std::invalid_argument if the vertices move on curves. \param what needs straight lines
void require_straight(const Motion& vertices, std::string_view what);

/// \throws std::out_of_range naming the first edge, face, codimensional point or cell with an index
/// that is no vertex's; std::length_error if there are more than 2^31−1.
void require_in_range(const Motion& vertices, std::span<const Edge> edges);
void require_in_range(const Motion& vertices, std::span<const Face> faces);
void require_in_range(const Motion& vertices, std::span<const std::int32_t> points);
void require_cells_in_range(const Motion& vertices, const Mesh& mesh);

}  // namespace touchstone::fast
