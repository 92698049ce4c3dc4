#pragma once

/// \file
/// The certificate of a whole step: the checker finds every pair of primitives that can collide,
/// and an axis or an argument of the certificate keeps each apart; and every element keeps its
/// volume.
///
/// A *primitive* is a vertex, an edge or a face; two *can collide* if
///   - they are a vertex and a face, two edges, a point (a vertex without an edge) and a bare edge
///     (one of no face), or two points;
///   - they have no vertex in common; and
///   - the group of some vertex of the one and that of some vertex of the other are not held apart.
/// Their D is fl(S + T), where S is the separation of the step, fl rounds to the nearest double,
/// and T is the greatest thickness of a vertex of the one and a vertex of the other: the one that
/// is listed for their groups, else the sum fl(r + s) of the groups' radii. Vertices that no face,
/// edge or point names take no part. The edges are those of the faces and those listed. The corners
/// of a vertex v and an edge e are those of v and the triangle e0 e1 e0, the corners of two
/// vertices v and w those of v and the triangle w w w.
///
/// An *element* is a tetrahedron, or a triangle in the plane z = 0 of the vertices' x and y, which
/// counts as a tetrahedron (exact/CERTIFICATES.md). Its contacts are the times at which its volume
/// is 0 or negative.
///
/// **Theorem.** If a certificate is accepted, no pair that can collide and no element has a contact
/// in [0,T] (`no_contact T`), or in [0,LO], and one has in [LO,HI] (`earliest LO HI`). *Proof.* A
/// pair that no axis keeps apart (places.hpp) has an argument: a direction (places.hpp), or
/// subintervals without a gap (proof.hpp). All arguments are verified, needed or not. An element
/// has subintervals, or is verified in all of the time as in one.

#include "exact/checker/certificate.hpp"
#include "exact/checker/summary.hpp"

namespace touchstone::checker {

/// Reads and verifies the certificate that begins at the current line, to the line after its `end`.
/// \param scenes null, or the next scene there (lines `vertices` to `separations`) must be the same
/// \param options the limits
/// \throws Rejection if it proves nothing, std::runtime_error as Reader::advance.
[[nodiscard]] Proved check_step(Reader& reader, Reader* scenes, const Options& options);

}  // namespace touchstone::checker
