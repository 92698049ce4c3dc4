#pragma once

/// \file
/// The filter of distances in L2 for many queries at a time, one implementation for each
/// instruction set. (The algorithm: filter_on_lanes.hpp.)

#include <cstddef>
#include <span>

#include "fast/platform/instruction_set.hpp"
#include "touchstone/contacts.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast {

/// The answer that a kernel leaves open.
inline constexpr Distance open_distance{-1.0, -1.0};

/// The functions of one instruction set. Their answers are the same, but they may leave different
/// queries open.
struct DistanceKernel {
  InstructionSet instructions;
  /// Answers query i in results[i], or leaves it open. \pre strict floating point; all coordinates
  /// are finite; 0 ≤ t ≤ 1.
  void (*filter)(ContactKind kind, const Query* queries, std::size_t count, double t,
                 Distance* results);
  /// a b + c on its lanes, as CertifiedKernel.
  double (*product_then_sum)(double a, double b, double c);
};

/// The kernels that this processor can run, slowest first; scalar is always among them.
/// \throws std::runtime_error if one was compiled so that products are contracted.
[[nodiscard]] std::span<const DistanceKernel* const> distance_kernels();

/// The one of them that is fastest for one query.
[[nodiscard]] const DistanceKernel& distance_kernel_for_one();

}  // namespace touchstone::fast
