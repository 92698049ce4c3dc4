#pragma once

/// \file
/// Inversions of cells: exact answers whether and when the volume of a moving cell
/// (touchstone/cell.hpp) is 0 or negative.
///
/// \code{.cpp}
/// // The apex of a tetrahedron falls through its base.
/// #include <touchstone/inversion.hpp>
///
/// #include <cstdio>
///
/// using namespace touchstone;
///
/// int main() {
///   // a, b, c, d at t=0, then at t=1.
///   const Query cell{{0, 0, 0,  1, 0, 0,  0, 1, 0,  0, 0, 1,
///                     0, 0, 0,  1, 0, 0,  0, 1, 0,  0, 0, -1}};
///   const fast::Inversion found = fast::inversion(CellKind::tetrahedron, cell);
///   std::printf("inverts: %d, at t = %g\n", found.verdict == fast::Verdict::yes, found.toi_upper);
/// }
/// // inverts: 1, at t = 0.5
/// \endcode
///
/// Cells move on straight lines here. Error bounds of the volume's Bernstein coefficients prove
/// most answers, in lanes (fast/cells/stages.hpp), and integers the rest (docs/theory.md, section
/// 10). The functions are thread-safe; the caller's floating-point state has no effect and is
/// restored.

#include <cstdint>
#include <span>

#include "touchstone/cell.hpp"
#include "touchstone/certified.hpp"

namespace touchstone::fast {

struct InversionOptions {
  /// As in CertifiedOptions.
  double toi_tolerance = 1e-12;
  /// Only inversions up to this time, in [0,1], count; this limit is exact.
  double t_max = 1.0;
  /// Maximum number of threads; 0 (all_cores): one for each core that the process may use.
  int max_threads = all_cores;
  Kernels kernels = {};
};

/// An answer about a cell.
struct Inversion {
  /// yes (it inverts) or no, always right; error if a coordinate that has an effect is not finite.
  Verdict verdict = Verdict::error;
  bool is_exact = false;         ///< true if integers decided
  std::int8_t start = 0;         ///< the sign of its volume at t=0: 1, 0 (flat) or −1 (inverted)
  double toi_lower = no_number;  ///< with yes: below the first time; 0 if that is 0
  double toi_upper = no_number;  ///< with yes: not below it; may be above t_max
};

/// Decides one cell. Both ends of its first time are 0 unless `start` is 1.
/// \throws std::invalid_argument for options out of range.
[[nodiscard]] Inversion inversion(CellKind kind, const Query& cell,
                                  const InversionOptions& options = {});

/// Decides cell i in results[i].
/// \throws std::invalid_argument for options out of range, for cells on curves, or unless there is
/// a result for each cell.
void inversions(const Cells& cells, std::span<Inversion> results,
                const InversionOptions& options = {});

}  // namespace touchstone::fast
