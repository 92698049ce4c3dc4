#pragma once

/// \file
/// The certified solver: exact answers at the speed of approximate ones.
///
/// Tight-Inclusion searches in (t,u,v). This needs t alone: a query collides at t iff the origin is
/// in the convex hull of its corners w_i(t) (exact/query.hpp), which signs of polynomials in t
/// decide. Floating-point bounds that are derived from the very expressions (filters/) prove most of
/// these signs, in stages from cheap to dear; a query that a stage cannot decide goes on to the next,
/// and the last one is exact (docs/theory.md, section 6):
///
///     axis, direction, determinant, bisection    fast/certified/kernel_on_lanes.hpp, stages/
///     exact                                      fast/certified/exact/exact_stage.hpp
///
/// With a minimum separation, contact is to be within a distance, in L∞ or L2, and all of this holds of
/// that. (fast/certified/stages/conservative_advancement.hpp takes the place of bisection where the distance is beyond
/// rounding.)
///
/// So every answer is proved, in floating point or in integers, and none is guessed. The floating-
/// point state of the caller (rounding mode, flushing of subnormals, traps) does not matter and is
/// left as it was.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "exact/query.hpp"
#include "fast/mesh.hpp"
#include "fast/method.hpp"

namespace touchstone::fast {

struct CertifiedKernel;

/// The stages, cheapest first. Each decides a query or hands it on.
enum class Stage : std::uint8_t {
  axis,         ///< a coordinate axis separates the primitives all the time
  direction,    ///< so does one fixed direction
  determinant,  ///< the determinant keeps its sign
  bisection,    ///< steps in t, with floating-point bounds
  exact,        ///< exact arithmetic
};
inline constexpr std::size_t stages = 5;

/// snake_case, as above.
[[nodiscard]] std::string_view name(Stage stage);

struct CertifiedOptions {
  /// The enclosure of the time of impact is at most this wide, relative to its upper end, or one spacing
  /// of doubles, as that of a subnormal time is with any tolerance; finite, not negative.
  double toi_tolerance = 1e-12;
  /// Only contacts up to this time count, in [0,1]: exactly these. Where the time of impact is t_max, or
  /// before it by less than the enclosure is wide, toi_upper may lie beyond t_max, but not beyond 1.
  double t_max = 1.0;
  /// What counts as contact: to be this near.
  Separation separation = {};
  /// Of a batch; 0: as many as oneTBB would use.
  int max_threads = 0;
  /// For tests: instead of the best kernel for this processor.
  const CertifiedKernel* kernel = nullptr;
};

struct CertifiedResult {
  /// yes or no: the truth. error: a coordinate is not finite. Never undecided.
  Verdict verdict = Verdict::error;
  Stage stage = Stage::axis;        ///< that decided
  double toi_lower = Answer::none;  ///< with yes: below the time of impact, or 0 if that is 0
  double toi_upper = Answer::none;  ///< with yes: not below the time of impact; perhaps above t_max
  /// With yes: where on the primitives the contact is, or where they are nearest then, in F's domain,
  /// computed without a bound.
  double u = Answer::none;
  double v = Answer::none;
};

/// Decides one query.
/// \throws std::invalid_argument for options out of range.
[[nodiscard]] CertifiedResult certified(Kind kind, const Query& query,
                                        const CertifiedOptions& options = {});

/// Decides query i in results[i].
/// \throws std::invalid_argument for options out of range or spans of different lengths.
void solve(Kind kind, std::span<const Query> queries, std::span<CertifiedResult> results,
           const CertifiedOptions& options = {});

/// Decides candidates.pairs[i] in results[i].
/// \throws as above; std::out_of_range for indices.
void solve(const MovingVertices& vertices, const Candidates& candidates,
           std::span<CertifiedResult> results, const CertifiedOptions& options = {});

/// A candidate that collides, or cannot be decided since a coordinate is not finite.
struct Collision {
  std::size_t candidate = 0;  ///< number of the query or the pair
  CertifiedResult result;     ///< yes or error
};

/// The queries that collide, in order: what `solve` says, without the cost of a result for each that
/// does not.
/// \throws as solve.
[[nodiscard]] std::vector<Collision> collisions(Kind kind, std::span<const Query> queries,
                                                const CertifiedOptions& options = {});

/// The same of candidates.
/// \throws as solve.
[[nodiscard]] std::vector<Collision> collisions(const MovingVertices& vertices,
                                                const Candidates& candidates,
                                                const CertifiedOptions& options = {});

/// An enclosure of the smallest time of impact; its upper end may lie beyond t_max as that of a single
/// query may.
struct EarliestImpact {
  double toi_lower = 0.0;
  double toi_upper = 0.0;
};

/// The smallest toi_lower and the smallest toi_upper of all candidates that collide; nothing if
/// none does. The same for any number of threads. Faster than `solve`: what begins later than the
/// best so far is not followed to its end.
/// \throws as solve; std::domain_error if a coordinate is not finite.
[[nodiscard]] std::optional<EarliestImpact> earliest(const MovingVertices& vertices,
                                                     const Candidates& candidates,
                                                     const CertifiedOptions& options = {});

/// What the certified solver is as a method: named `certified`, exact.
[[nodiscard]] const MethodInfo& certified_info();

/// The certified solver as a method.
[[nodiscard]] std::unique_ptr<Method> certified_method(const CertifiedOptions& base = {});

}  // namespace touchstone::fast
