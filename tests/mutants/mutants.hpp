#pragma once

/// \file
/// Solvers with small faults, of the sort that people make. The fuzzer has to find each of them, or it is
/// shown here why nothing is to be found: who tests the tester.

#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "exact/query.hpp"
#include "fast/method.hpp"

namespace touchstone::tests {

/// A solver that is wrong, or seems to be.
struct Mutant {
  /// Unique, snake_case.
  std::string_view name;
  /// The method that it is a mutant of, whose promises and tolerances it is held to.
  std::string_view of;
  std::string_view fault;
  std::function<std::unique_ptr<fast::Method>()> make;
  /// Where it is asked.
  Separation separation = {};
  /// Why it is no fault; empty if it is one.
  std::string_view harmless = {};
  /// What a query must be like to show the fault, where that is so rare that the fuzzer is not expected to
  /// find it: a gap in what it generates, or slack in the original's bound.
  std::string_view rare = {};
};

/// All whose parts this build plants (tests/faults), always in the same order.
[[nodiscard]] const std::vector<Mutant>& mutants();

/// \throws std::invalid_argument if none has the name.
[[nodiscard]] const Mutant& find_mutant(std::string_view name);

}  // namespace touchstone::tests
