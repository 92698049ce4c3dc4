#pragma once

/// \file
/// The work of exact_that_counts and exact_that_counts_on_curves, which are decide_exactly with
/// this count.

#include <cstdint>

namespace touchstone::tests {

/// Products of limbs since it was last set.
extern std::uint64_t limb_products;  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

}  // namespace touchstone::tests
