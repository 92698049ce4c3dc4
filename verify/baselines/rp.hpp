#pragma once

/// \file
/// RP: root parity ([brochu2012]; docs/methods.md, section 9).
///
/// **Theorem.** F maps the boundary of its domain (a prism for vertex-face, a cube for edge-edge)
/// to a closed surface of triangles and bilinear patches. If 0 is not on it, the number of roots of
/// F inside, each counted with its multiplicity, has the parity of the number of times that a ray
/// from 0 crosses the surface.
///
/// **Algorithm.** If a plane through 0 has all corners of F strictly on one side, the answer is no.
/// Otherwise the crossings of a segment from 0 to beyond the corners are counted: with triangles by
/// orientations, with a patch by two triangles of its corners' tetrahedron, chosen by the side of
/// the patch that 0 is on. Signs come from intervals in upward rounding, and from exact numbers if
/// these contain 0. A crossing on a triangle's boundary invalidates the segment; after ten segments
/// the answer is yes.
///
/// **Answer.** A verdict, without a time of impact (a yes ignores t_max) and without separation.
///
/// **Known defects.**
///   - *False negatives*: even numbers of roots, always. In and out again within the step: a fifth
///     of random vertex-face collisions with large deformation, a third of edge-edge. The test
///     separates the queries by their number of roots: even ones are missed, odd ones found.
///   - *False positives*: a flat patch that folds over itself ("hourglass"), in whose plane 0 lies
///     within the hull of the corners but not on the patch; and queries that are still open after
///     ten segments. All segments lie in the plane z = 0, so primitives in that plane can
///     invalidate all of them.
///   - *False positives* where all coordinates are below about 1e-15: the segment is at least 10
///     long, so the weight of a crossing with a face at t=0 or t=1 is rounded to that of 0 itself,
///     which is treated as contact there.
///   - In the coplanar fallback the crossing of one edge is not noticed (planar_overlap.hpp): the
///     parity may then be wrong either way.
///
/// **Promise.** None. The directions are drawn from a generator seeded with the query.

#include <memory>

#include "fast/method.hpp"
#include "touchstone/query.hpp"

namespace touchstone::baselines {

/// RP's verdict. \pre all coordinates are finite, and the rounding is to nearest.
/// \throws std::overflow_error if the segment does not fit into doubles, to be treated as a
/// collision.
[[nodiscard]] bool rp_collides(Kind kind, const Query& query);

/// The method `rp`. It ignores all options.
[[nodiscard]] std::unique_ptr<fast::Method> rp_method();

}  // namespace touchstone::baselines
