#pragma once

/// \file
/// The fuzzer against a mutant, until it has found what is wrong.

#include <cstdint>
#include <optional>

#include "tests/mutants/mutants.hpp"
#include "verify/fuzz/fuzz.hpp"

namespace touchstone::tests {

struct HuntOptions {
  double seconds = 60.0;      ///< wall clock; 0: no limit
  std::uint64_t queries = 0;  ///< 0: no limit
  std::uint64_t seed = 1;
};

/// What came of it.
struct Hunt {
  std::optional<verify::fuzz::Finding> finding;  ///< the first
  double seconds = 0.0;                          ///< wall clock, to the end of the run
  std::uint64_t queries = 0;                     ///< asked until then
};

/// Hunts one mutant: the fuzzer as anyone runs it, with its default generators and no queries to begin with.
[[nodiscard]] Hunt hunt(const Mutant& mutant, const HuntOptions& options);

/// The simplest query in which the mutant does the same wrong (verify/fuzz/recheck.hpp).
[[nodiscard]] Query simplest(const Mutant& mutant, const verify::fuzz::Finding& finding);

}  // namespace touchstone::tests
