#pragma once

/// \file
/// Edges that pierce faces in a frame.
///
/// A mesh can intersect itself without a collision of considered pairs in a step: an edge may be in
/// a face from the start to the end. A step is therefore safe only if its first frame is free of
/// such pairs *and* no pair collides. Two surfaces of triangles intersect iff an edge of one meets
/// a triangle of the other.
///
/// **Definition.** An edge without a vertex in common with a face pierces it iff the closed segment
/// and the closed triangle have a point in common. (If they only touch, the step also finds a
/// contact at t=0.) An edge that starts at a corner of the face pierces it iff they have a further
/// point in common: then the edge lies in the face's plane and points into the angle at the corner.
/// An edge of the face itself never counts.
///
/// **Exactness.** The signs of orientations come from CGAL's kernel of exact predicates. The pairs
/// come from the broad phase (touchstone/step.hpp): exactly those whose boxes overlap.

#include <atomic>
#include <functional>
#include <span>
#include <vector>

#include "touchstone/mesh.hpp"
#include "verify/mesh/mesh_file.hpp"

namespace touchstone::verify::mesh {

/// An edge and the face that it pierces, by their numbers.
struct Piercing {
  std::int32_t edge = 0;
  std::int32_t face = 0;

  friend auto operator<=>(const Piercing&, const Piercing&) = default;
};

/// Selects the pairs to test: called with the numbers of an edge and a face; empty: all.
using PiercingFilter = std::function<bool(std::int32_t edge, std::int32_t face)>;

/// All pairs of an edge and a face that it pierces, in ascending order.
/// \param vertices n×3, finite. \param filter called in several threads at once. \param stop May be
/// null. \pre indices are in range.
/// \throws fast::Stopped soon after *stop turns true.
[[nodiscard]] std::vector<Piercing> find_piercings(const Vertices& vertices,
                                                   std::span<const fast::Edge> edges,
                                                   std::span<const fast::Face> faces,
                                                   const PiercingFilter& filter = nullptr,
                                                   const std::atomic<bool>* stop = nullptr);

}  // namespace touchstone::verify::mesh
