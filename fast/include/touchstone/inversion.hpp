#pragma once

/// \file
/// Inversions: whether and when moving tetrahedra, and triangles in the plane, lose their volume.
///
/// Injective maps and barrier methods limit a step twice: nothing may touch, and no element may
/// turn inside out. This is the second limit, exact as the first one (touchstone/certified.hpp):
///
///     #include <algorithm>
///     #include <cstdio>
///     #include <touchstone/inversion.hpp>
///
///     int main() {
///       using namespace touchstone::fast;
///       Eigen::MatrixXd start(4, 3), end(4, 3);
///       start << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
///       end << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, -3;  // the last vertex passes through the face
///       const std::vector<Tetrahedron> tetrahedra{{0, 1, 2, 3}};
///       double step_size = 1.0;  // up to which all volumes stay positive
///       for (const Inversion& each : inversions(MovingVertices(start, end), tetrahedra)) {
///         step_size = std::min(step_size, each.result.toi_lower);
///       }
///       std::printf("%.6f\n", step_size);  // 0.250000
///     }
///
/// All points move on straight lines from t=0 to t=1. An element *inverts* if its signed volume (in
/// the plane: area) is 0 or negative at some time (touchstone/element.hpp has the formula). So an
/// element that is flat or inverted at t=0 inverts at once; the answer tells which. Elements whose
/// vertices are in the other order have to be renumbered by the caller.
///
/// **Method.** Six times the volume is a cubic polynomial in t, the determinant of the certified
/// solver, with its error bounds: signs of Bernstein coefficients on [0,1], then on parts of it,
/// decide nearly all elements in floating point, on the lanes of the same kernels
/// (fast/certified/stages/inversion.hpp). Integers decide the rest. docs/theory.md, section 10.
///
/// Every answer is proved, and the same for any number of threads and any instruction set, alone or
/// in a batch. The functions are thread-safe. The caller's floating-point state has no effect and
/// is restored.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "touchstone/certified.hpp"
#include "touchstone/element.hpp"
#include "touchstone/mesh.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast {

/// As in CertifiedOptions.
struct InversionOptions {
  /// The maximum width of the enclosure of the first time, relative to its upper end; finite, not
  /// negative. An enclosure is never narrower than one spacing of doubles.
  double toi_tolerance = 1e-12;
  /// Only inversions up to this time, in [0,1], count; this limit is exact. toi_upper may exceed it
  /// by the width of the enclosure.
  double t_max = 1.0;
  /// In [0,1): an element counts as inverted as soon as no more than this part of its volume at t=0
  /// is left, exactly.
  double kept_volume = 0.0;
  /// Maximum number of threads; 0 (all_cores): one for each core that the process may use.
  int max_threads = all_cores;
};

struct InversionResult {
  /// yes: the volume is 0 or negative, or no more than the kept part, at some time in [0, t_max];
  /// no: it is more throughout;
  /// always right. error if a coordinate is not finite. Never undecided.
  Verdict verdict = Verdict::error;
  Stage stage = Stage::exact;  ///< the stage that decided: determinant, bisection or exact
  /// The sign of the volume at t=0: 1, 0 (flat) or −1 (inverted); 0 with error.
  std::int8_t start = 0;
  /// With yes: the first such time is above toi_lower and not above toi_upper; both are 0 if that
  /// time is 0, as it is unless `start` is 1.
  double toi_lower = no_number;
  double toi_upper = no_number;
};

/// Decides one element.
/// \throws std::invalid_argument for options out of range.
[[nodiscard]] InversionResult inversion(const Query& tetrahedron,
                                        const InversionOptions& options = {});
[[nodiscard]] InversionResult inversion(const PlaneTriangle& triangle,
                                        const InversionOptions& options = {});

/// Decides element i in results[i].
/// \throws std::invalid_argument for options out of range, or unless there is a result for each
/// element.
void inversions(std::span<const Query> tetrahedra, std::span<InversionResult> results,
                const InversionOptions& options = {});
void inversions(std::span<const PlaneTriangle> triangles, std::span<InversionResult> results,
                const InversionOptions& options = {});

/// An element that inverts.
struct Inversion {
  std::size_t element = 0;  ///< its number
  InversionResult result;   ///< its verdict is yes
};

/// The elements of a mesh that invert, in order. Elements that do not have no result, which takes
/// less time.
/// \throws std::invalid_argument for options out of range; std::out_of_range naming the first
/// element with an index that is no vertex's; std::domain_error naming the first vertex that is not
/// finite.
[[nodiscard]] std::vector<Inversion> inversions(const MovingVertices& vertices,
                                                std::span<const Tetrahedron> tetrahedra,
                                                const InversionOptions& options = {});
/// The same for triangles in the plane; the vertices' third coordinates have no effect.
[[nodiscard]] std::vector<Inversion> inversions(const MovingVertices& vertices,
                                                std::span<const Face> triangles,
                                                const InversionOptions& options = {});

}  // namespace touchstone::fast
