#pragma once

/// \file
/// The certificate of a whole step of a scene: every pair of primitives that can collide is looked
/// for here, and each is kept apart by an axis or by what the certificate says of it.
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
/// **Theorem.** If a certificate is accepted, no pair that can collide has a contact in [0,T]
/// (`no_contact T`), or in [0,LO], and one has in [LO,HI] (`earliest LO HI`). For a pair that is
/// not kept apart by an axis (places.hpp) has an argument: a direction (places.hpp), or
/// subintervals without a gap (proof.hpp). All arguments are verified, whether or not they are
/// needed.

#include <cstddef>
#include <cstdint>
#include <string>

#include "exact/checker/certificate.hpp"

namespace touchstone::checker {

/// Reads and verifies the certificate that begins at the present line, and goes behind its `end`.
/// \param scenes if not null, the scene (its lines from `vertices` to `separations`) has to be the one read there
/// \param options the limits
/// \returns what is proved, for a reader: the label, the size of the scene, separation and claim, a line each
/// \throws Rejection if it proves nothing, std::runtime_error as Reader::advance.
[[nodiscard]] std::string check_step(Reader& reader, Reader* scenes, const Options& options);

}  // namespace touchstone::checker
