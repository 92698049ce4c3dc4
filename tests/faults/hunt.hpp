#pragma once

/// \file
/// The fuzzer against solvers with a planted fault (planted_faults.hpp), until it has found what is
/// wrong: who tests the tester.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "fast/method.hpp"
#include "tests/faults/planted_faults.hpp"
#include "verify/fuzz/fuzz.hpp"

namespace touchstone::tests {

struct FaultySolver {
  FaultInfo fault;
  /// The method that the fault is planted in.
  std::string_view of;
  std::function<std::unique_ptr<fast::Method>()> make;
};

/// One for each fault in a solver that this build plants.
[[nodiscard]] const std::vector<FaultySolver>& faulty_solvers();

/// \throws std::invalid_argument if none has a fault of that name.
[[nodiscard]] const FaultySolver& find_faulty_solver(std::string_view fault);

struct HuntOptions {
  double seconds = 60.0;      ///< wall clock; 0: no limit
  std::uint64_t queries = 0;  ///< 0: no limit
  std::uint64_t seed = 1;
};

struct Hunt {
  std::optional<verify::fuzz::Finding> finding;  ///< the first
  double seconds = 0.0;                          ///< wall clock, to the end of the run
  std::uint64_t queries = 0;                     ///< asked until then
};

/// Hunts one fault: the fuzzer as anyone runs it, with its default generators and no queries to
/// begin with.
[[nodiscard]] Hunt hunt(const FaultySolver& solver, const HuntOptions& options);

/// The simplest query in which the solver does the same wrong (verify/fuzz/recheck.hpp).
[[nodiscard]] Query simplest(const FaultySolver& solver, const verify::fuzz::Finding& finding);

}  // namespace touchstone::tests
