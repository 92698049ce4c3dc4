#pragma once

/// \file
/// The certificate of a mesh at rest: all pairs of elements that intersect, and no others.
///
/// The *elements* are the faces, the listed edges of no face, and the listed points without an
/// edge; a face that repeats vertices is one too. Two elements intersect if they have the same
/// vertices, by their numbers, or a point in common that is not in the hull of their common
/// vertices (resting_pair.hpp). Two elements *can meet* if the group of some vertex of the one and
/// that of some vertex of the other are not held apart. In a *welded* mesh the vertices of one
/// group at one place are one vertex; which edges are of no face, and which points have no edge, is
/// decided before.
///
/// **Theorem.** If a certificate is accepted, the pairs of elements that it lists intersect, and no
/// others that can meet. Each listed pair has the same vertices, or a point that is verified. Every
/// other pair is kept apart by an axis, which the boxes of a tree show (places.hpp); cannot meet;
/// has one element whose vertices are some of the other's, so that all of it is shared; or has an
/// argument that is verified. All arguments are verified, whether or not they are needed.

#include "exact/checker/certificate.hpp"
#include "exact/checker/summary.hpp"

namespace touchstone::checker {

/// Reads and verifies the certificate that begins at the present line, and goes behind its `end`.
/// \param scenes if not null, the mesh (its lines from `vertices` to `apart`) has to be the one read there
/// \param options the limits
/// \throws Rejection if it proves nothing, std::runtime_error as Reader::advance.
[[nodiscard]] Proved check_mesh(Reader& reader, Reader* scenes, const Options& options);

}  // namespace touchstone::checker
