#pragma once

/// \file
/// The search of Tight-Inclusion with another kernel and filter: for comparisons
/// (verify/published/tight_inclusion.cpp).

#include <array>

#include "fast/method.hpp"
#include "fast/tight_inclusion/box_kernel.hpp"
#include "touchstone/query.hpp"
#include "touchstone/tight_inclusion.hpp"

namespace touchstone::fast {

struct TightInclusionVariant {
  const BoxKernel& kernel;
  ErrorFilter filter;  ///< In the place of error_filter().
};

/// Solves one query on straight lines, as tight_inclusion() does.
[[nodiscard]] TightInclusionResult tight_inclusion(ContactKind kind, const Query& query,
                                                   const TightInclusionOptions& options,
                                                   const TightInclusionVariant& variant);

}  // namespace touchstone::fast
