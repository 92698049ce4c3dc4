#pragma once

/// \file
/// RRP: rational root parity, after [brochu2012] with degenerate patches handled ([wang2021];
/// docs/methods.md, section 10). In verify/ because its numbers are GMP's.
///
/// **Algorithm.** As RP (verify/baselines/rp.hpp), the crossings of a ray from 0 with the image of
/// the domain's boundary are counted, everything in rationals. A flat patch is replaced by the
/// triangles that it covers. In front of a patch that is not flat stand two faces of its corners'
/// tetrahedron, chosen by the side of the patch that 0 is on. A ray that is parallel to a triangle
/// or meets its boundary is replaced by another direction; after eight more there is an error, and
/// an error is answered with no.
///
/// **Answer.** A verdict, without a time of impact (a yes ignores t_max) and without separation.
///
/// **Known defects**:
///   - *False negatives*: even numbers of roots, as for RP.
///   - If nothing moves, or all four points move by the same vector, the answer is no without an
///     examination: contact at rest or under a common translation is missed.
///   - A triangle that is degenerate at t=0 or t=1 makes a cap without area, to which every ray is
///     parallel: nine directions, an error, no. Contact with it at any time is missed.
///   - *False positives*: none on published data. But the two triangles in place of a flat patch
///     are hit if either is, and together they are more than the patch where its outline has a
///     reflex corner: the parity may be wrong either way, and 0 may be on a part outside the patch.
///     The test has an example.
///
/// **Promise.** None. The directions are drawn from a generator seeded with the query.

#include <memory>

#include "fast/method.hpp"
#include "touchstone/query.hpp"

namespace touchstone::baselines {

/// RRP's verdict. \pre all coordinates are finite.
[[nodiscard]] bool rrp_collides(Kind kind, const Query& query);

/// The method `rrp`. It ignores all options.
[[nodiscard]] std::unique_ptr<fast::Method> rrp_method();

}  // namespace touchstone::baselines
