#pragma once

/// \file
/// The certified solver: exact answers at the speed of approximate ones.
///
/// \code{.cpp}
/// // A vertex falls through a resting triangle: the impact, and when it is within 1/4.
/// #include <touchstone/certified.hpp>
///
/// #include <cstdio>
///
/// using namespace touchstone;
///
/// int main() {
///   const double f0[]{0, 0, 0}, f1[]{4, 0, 0}, f2[]{0, 4, 0}, above[]{1, 1, 1}, below[]{1, 1, -2};
///   const fast::CertifiedResult impact =
///       fast::solve_vertex_face(above, f0, f1, f2, below, f0, f1, f2);
///   if (impact.verdict != fast::Verdict::yes) return 1;  // exact
///   std::printf("t = %.12f, u = %g, v = %g\n", impact.toi_lower, impact.u, impact.v);
///
///   // The same as a query: v, f0, f1, f2 at t=0, then at t=1. Contact: a distance up to 1/4.
///   const Query query{{1, 1, 1,  0, 0, 0, 4, 0, 0, 0, 4, 0,
///                      1, 1, -2, 0, 0, 0, 4, 0, 0, 0, 4, 0}};
///   const Separation quarter{.distance = 0.25, .norm = Norm::l2};
///   const fast::CertifiedResult near =
///       fast::solve(ContactKind::vertex_face, query, {.separation = quarter});
///   std::printf("within 1/4 at t = %g\n", near.toi_upper);
/// }
/// // t = 0.333333333333, u = 0.25, v = 0.25
/// // within 1/4 at t = 0.25
/// \endcode
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
/// On Bézier curves of degrees up to 8, polynomial or rational, axis, direction and bisection use
/// control points (docs/theory.md, section 6.15; fast/certified/curves.hpp has the times of the
/// slowest queries).
///
/// With a minimum separation d, "contact" means distance ≤ d (L∞ or L2); all guarantees are the
/// same. (For large d, fast/certified/stages/conservative_advancement.hpp replaces bisection.)
///
/// For two primitives given by their points, solve_vertex_face and the like take the points at t=0
/// and then, in the same order, at t=1; in between they move on straight lines. An edge or a point
/// replaces a face as a triangle without an area: solve_vertex_edge uses (e0, e1, e0),
/// solve_vertex_vertex (p1, p1, p1).
///
/// Thus every answer is proved, in floating point or in integers. The functions are thread-safe.
/// The caller's floating-point state (rounding mode, flushing of subnormals, traps) has no effect
/// and is restored.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>

#include "touchstone/query.hpp"

namespace touchstone::fast {

// ---- Answers ------------------------------------------------------------------------------------

/// An answer of a solver to "do they collide?".
enum class Verdict : std::uint8_t {
  no,
  yes,
  undecided,  ///< no decision; to be treated as a conservative yes
  error,      ///< a coordinate is NaN or infinite (touchstone/query.hpp has the rule)
};

/// The value of a number that an answer does not have: NaN.
inline constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

struct CertifiedKernel;
struct SearchKernel;

/// Kernels that a test or a benchmark chooses; null: the best one for this processor
/// (fast/kernels.hpp).
struct Kernels {
  const CertifiedKernel* certified = nullptr;
  const SearchKernel* search = nullptr;
};

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
  /// All kernels have the same results.
  Kernels kernels = {};
};

struct CertifiedResult {
  /// yes or no, always right; error if a coordinate that has an effect is not finite, or a weight
  /// not positive and finite. Never undecided.
  Verdict verdict = Verdict::error;
  bool is_exact = false;         ///< true if the exact stage decided
  double toi_lower = no_number;  ///< with yes: below the time of impact; 0 if that is 0
  double toi_upper = no_number;  ///< with yes: not below the time of impact; may be above t_max
  /// The parameters, with yes, in F's domain, of the contact or of the nearest points at that time.
  /// An approximation without an error bound.
  double u = no_number;
  double v = no_number;
};

// ---- Queries ------------------------------------------------------------------------------------

/// Decides one query.
/// \throws std::invalid_argument for options out of range.
[[nodiscard]] CertifiedResult solve(ContactKind kind, const Query& query,
                                    const CertifiedOptions& options = {});

/// Decides query i in results[i].
/// \throws std::invalid_argument for options out of range, or unless there is a result for each
/// query.
void solve(const Queries& queries, std::span<CertifiedResult> results,
           const CertifiedOptions& options = {});

// ---- Points, as simulators have them ------------------------------------------------------------

/// Three coordinates, from an Eigen vector (or a row or column of a matrix) or from a pointer to x,
/// of floats or doubles. For use as a parameter.
struct Point {
  /// \throws std::invalid_argument unless there are three coefficients.
  template <class Derived>
  requires requires(const Derived& vector) { vector.eval().coeff(0); }
  Point(const Derived& vector) {  // NOLINT(google-explicit-constructor)
    static_assert(Derived::SizeAtCompileTime == 3 || Derived::SizeAtCompileTime < 0,
                  "a point has three coordinates");
    if (vector.size() != 3) throw std::invalid_argument("a point must have three coordinates");
    const auto& values = vector.eval();
    for (int i = 0; i < 3; ++i) coordinates.at(std::size_t(i)) = to_double(values.coeff(i));
  }
  Point(const double* x) : coordinates{x[0], x[1], x[2]} {}  // NOLINT(google-explicit-constructor)
  Point(const float* x)                                      // NOLINT(google-explicit-constructor)
      : coordinates{to_double(x[0]), to_double(x[1]), to_double(x[2])} {}

  std::array<double, 3> coordinates;
};

/// Solves a point and a triangle. With yes, (u, v) is the point t0 + u (t1 − t0) + v (t2 − t0).
/// \throws std::invalid_argument for options out of range, as the other functions do.
[[nodiscard]] CertifiedResult solve_vertex_face(const Point& p_t0, const Point& t0_t0,
                                                const Point& t1_t0, const Point& t2_t0,
                                                const Point& p_t1, const Point& t0_t1,
                                                const Point& t1_t1, const Point& t2_t1,
                                                const CertifiedOptions& options = {});

/// Solves two edges. With yes, u is the parameter on the first one, from its first point, and v on
/// the second.
[[nodiscard]] CertifiedResult solve_edge_edge(const Point& ea0_t0, const Point& ea1_t0,
                                              const Point& eb0_t0, const Point& eb1_t0,
                                              const Point& ea0_t1, const Point& ea1_t1,
                                              const Point& eb0_t1, const Point& eb1_t1,
                                              const CertifiedOptions& options = {});

/// Solves a point and an edge. With yes, u is the parameter on the edge, and v is 0.
[[nodiscard]] CertifiedResult solve_vertex_edge(const Point& p_t0, const Point& e0_t0,
                                                const Point& e1_t0, const Point& p_t1,
                                                const Point& e0_t1, const Point& e1_t1,
                                                const CertifiedOptions& options = {});

/// Solves two points. With yes, u and v are 0.
[[nodiscard]] CertifiedResult solve_vertex_vertex(const Point& p0_t0, const Point& p1_t0,
                                                  const Point& p0_t1, const Point& p1_t1,
                                                  const CertifiedOptions& options = {});

}  // namespace touchstone::fast
