#pragma once

/// \file
/// The fuzzer against solvers with a planted fault (planted_faults.hpp), until it has found the
/// fault: a test of the tester.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "fast/method.hpp"
#include "tests/faults/planted_faults.hpp"
#include "verify/base/any_query.hpp"
#include "verify/fuzz/fuzz.hpp"

namespace touchstone::tests {

struct FaultySolver {
  FaultInfo fault;
  /// The method with the planted fault.
  std::string_view of;
  std::function<std::unique_ptr<fast::Method>()> make;
  /// True if queries on curves show the fault, of which those are asked.
  bool is_on_curves = false;
};

/// One solver for each fault in a solver that this build plants.
[[nodiscard]] const std::vector<FaultySolver>& faulty_solvers();

/// \throws std::invalid_argument if no fault has that name.
[[nodiscard]] const FaultySolver& find_faulty_solver(std::string_view fault);

struct HuntOptions {
  double seconds = 60.0;      ///< wall clock; 0: no limit
  std::uint64_t queries = 0;  ///< 0: no limit
  std::uint64_t seed = 1;
};

struct Hunt {
  std::optional<verify::fuzz::Finding> finding;  ///< the first
  double seconds = 0.0;                          ///< wall clock, to the end of the run
  std::uint64_t queries = 0;                     ///< asked until the end
};

/// Hunts one fault by a fuzzer with its default generators and without initial queries.
[[nodiscard]] Hunt hunt(const FaultySolver& solver, const HuntOptions& options);

/// The simplest query with the same fault of the solver (verify/fuzz/recheck.hpp).
[[nodiscard]] verify::base::AnyQuery simplest(const FaultySolver& solver,
                                              const verify::fuzz::Finding& finding);

}  // namespace touchstone::tests
