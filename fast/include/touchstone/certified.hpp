#pragma once

/// \file
/// The certified solver: exact answers at the speed of approximate ones.
///
/// Tight-Inclusion searches in (t,u,v). This solver searches in t alone: the primitives are in
/// contact at t iff the origin is in the convex hull of the corners w_i(t) (touchstone/query.hpp),
/// which signs of polynomials in t decide. Floating-point error bounds, derived from the
/// expressions themselves (filters/), prove most of these signs, in stages of increasing cost. A
/// query that one stage cannot decide goes on to the next, and the last one is exact
/// (docs/theory.md, section 6):
///
///     axis, direction, determinant, bisection    fast/certified/kernel_on_lanes.hpp, stages/
///     exact                                      fast/certified/exact/exact_stage.hpp
///
/// On Bézier curves of degrees up to 8, polynomial or rational, axis, direction and bisection look
/// at control points (fast/certified/curves.hpp, with the times of the slowest queries;
/// docs/theory.md, section 6.15).
///
/// With a minimum separation d, "contact" means distance ≤ d (L∞ or L2); all guarantees are the
/// same. (For large d, fast/certified/stages/conservative_advancement.hpp replaces bisection.)
///
/// Thus every answer is proved, in floating point or in integers. The functions are thread-safe.
/// The caller's floating-point state (rounding mode, flushing of subnormals, traps) has no effect
/// and is restored.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "touchstone/mesh.hpp"
#include "touchstone/query.hpp"
#include "touchstone/verdict.hpp"

namespace touchstone::fast {

/// The stages, cheapest first. Each decides a query or passes it to the next.
enum class Stage : std::uint8_t {
  axis,         ///< a coordinate axis separates the primitives at all times
  direction,    ///< one fixed direction separates them at all times
  determinant,  ///< the determinant keeps its sign
  bisection,    ///< signs on intervals of t (stages/: orientation and all later ones)
  exact,        ///< exact arithmetic
};
inline constexpr std::size_t stages = 5;

/// The name of the enumerator.
[[nodiscard]] std::string_view to_string(Stage stage);

struct CertifiedOptions {
  /// The maximum width of the enclosure of the time of impact, relative to its upper end; finite,
  /// not negative. An enclosure is never narrower than one spacing of doubles, and for a subnormal
  /// time it always has that width.
  double toi_tolerance = 1e-12;
  /// Only contacts up to this time, in [0,1], count; this limit is exact. If the time of impact is
  /// at most the width of the enclosure before t_max, toi_upper may exceed t_max, but not 1.
  double t_max = 1.0;
  /// The distance at which primitives are in contact.
  Separation separation = {};
  /// Maximum number of threads; 0 (all_cores): one for each core that the process may use.
  int max_threads = all_cores;
};

struct CertifiedResult {
  /// yes or no, always right; error if a coordinate is not finite, or a weight not positive and
  /// finite. Never undecided.
  Verdict verdict = Verdict::error;
  Stage stage = Stage::axis;     ///< the stage that decided
  double toi_lower = no_number;  ///< with yes: below the time of impact; 0 if that is 0
  double toi_upper = no_number;  ///< with yes: not below the time of impact; may be above t_max
  /// With yes: the parameters in F's domain of the contact, or of the nearest points at that time.
  /// An approximation without an error bound.
  double u = no_number;
  double v = no_number;
};

/// Decides one query.
/// \throws std::invalid_argument for options out of range.
[[nodiscard]] CertifiedResult solve(Kind kind, const Query& query,
                                    const CertifiedOptions& options = {});

/// Decides query i in results[i].
/// \throws std::invalid_argument for options out of range, or unless there is a result for each
/// query.
void solve(const Queries& queries, std::span<CertifiedResult> results,
           const CertifiedOptions& options = {});
void solve(Kind kind, std::span<const Query> queries, std::span<CertifiedResult> results,
           const CertifiedOptions& options = {});

/// A query that collides.
struct Collision {
  std::size_t candidate = 0;  ///< index of the query or the pair
  CertifiedResult result;     ///< its verdict is yes
};

/// The queries that collide, in order. Faster than `solve`, because queries that do not collide
/// have no result.
/// \throws std::invalid_argument for options out of range; std::domain_error naming the first query
/// with a number that makes its verdict `error`.
[[nodiscard]] std::vector<Collision> collisions(const Queries& queries,
                                                const CertifiedOptions& options = {});
[[nodiscard]] std::vector<Collision> collisions(Kind kind, std::span<const Query> queries,
                                                const CertifiedOptions& options = {});

/// The same for candidates.
/// \throws as above; std::out_of_range naming the first pair with an index out of range.
[[nodiscard]] std::vector<Collision> collisions(const MovingVertices& vertices,
                                                const Candidates& candidates,
                                                const CertifiedOptions& options = {});

}  // namespace touchstone::fast
