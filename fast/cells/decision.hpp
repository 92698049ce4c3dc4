#pragma once

/// \file
/// Decisions about blocks of cells: the kernel, the kernel again for undecided cells of unusual
/// size (fast/certified/rescaling.hpp), and integers for the rest.

#include <cstddef>
#include <functional>

#include "fast/certified/kernel.hpp"
#include "touchstone/inversion.hpp"

namespace touchstone::fast {

/// The result of cells that decide_cells reports none of.
inline constexpr Inversion no_inversion{.verdict = Verdict::no, .start = 1};

/// Decides a block of cells, which invert when no more than `block.kept_volume` of their volume is
/// left, and passes on the results of those that may invert: report(index, result). Inversions
/// after t_limit may be left out; the results of the others do not depend on it.
/// \pre strict floating point; valid options. \param tetrahedron(index) a cell of the block
void decide_cells(CellInput block, double t_limit, const InversionOptions& options,
                  const CertifiedKernel& kernel,
                  const std::function<Query(std::size_t)>& tetrahedron,
                  const std::function<void(std::size_t, const Inversion&)>& report);

/// Decides cells in blocks, in the allowed threads, and passes on the results of those that may
/// invert. \throws as `inversions`
void for_each_inversion(const Cells& cells, const InversionOptions& options,
                        const std::function<void(std::size_t, const Inversion&)>& report);

}  // namespace touchstone::fast
