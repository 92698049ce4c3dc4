#pragma once

/// \file
/// Which pairs of primitives a step looks at beside vertices with faces and edges with edges.
///
/// A vertex v and an edge e without it are *told of* by other pairs if a face of e does not have v (v is then on
/// that face), or an edge of v shares no vertex with e (it then touches e). Let N be the vertices
/// that v has edges to. Not told of are v and e = {a, b} if N ⊆ {a, b} and every face of e has v:
/// - N is empty: v is *isolated*, and e any edge in no face;
/// - N = {a}: v is a *leaf* of the *hub* a, and e any other edge of a in no face. (A face of e with v had an edge from v to
///   b.)
/// - N = {a, b}: e is the one edge between v's two neighbours, if there is one, and in no face but {a, b, v}.
///
/// Two vertices v, w are told of by v and an edge of w without v, and the other way round; not if neither has an edge but
/// those between them: both are isolated, or they are the ends of a *lone* edge.
///
/// An edge from a vertex to itself is an edge that shares no vertex with any edge without it.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fast/mesh.hpp"
#include "fast/step.hpp"

namespace touchstone::fast {

/// A vertex with its leaves and with all of its edges in no face, as places in PairClasses::bare_edges.
struct Hub {
  std::vector<std::int32_t> leaves;
  std::vector<std::int32_t> edges;
};

struct PairClasses {
  /// The vertices of all elements, in order.
  std::vector<std::int32_t> vertices;
  /// Those without an edge, in order.
  std::vector<std::int32_t> isolated;
  /// The numbers of the edges in no face, in order. Found only if there are isolated vertices or leaves.
  std::vector<std::int32_t> bare_edges;
  /// Those with leaves and more than one edge in no face, one of which may be a leaf's own.
  std::vector<Hub> hubs;
  /// A vertex and the edge between its two neighbours.
  std::vector<IndexPair> folds;
  /// The ends of an edge, the smaller number first.
  std::vector<IndexPair> lone_ends;
};

/// \pre all indices are in range, and `edges` has those of the faces.
[[nodiscard]] PairClasses pair_classes(std::size_t vertices, const MeshElements& elements);

}  // namespace touchstone::fast
