#pragma once

/// \file
/// A query as a person reads it, as a dataset holds it, and as a command that shows what is wrong.

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "fast/method.hpp"
#include "touchstone/query.hpp"
#include "verify/base/any_query.hpp"
#include "verify/fuzz/finding.hpp"
#include "verify/solvers/child_process.hpp"

namespace touchstone::verify::fuzz {

using base::AnyQuery;

/// "v", "f0" and so on of a vertex and a triangle, "ea0" and so on of two edges.
[[nodiscard]] std::string_view point_name(Kind kind, std::size_t point);

/// A line a point, at t=0 and then at t=1, or a line a control point: its name in the kind, and its
/// coordinates and weight in decimal and in hexadecimal. Both give the very doubles.
[[nodiscard]] std::string as_points(const AnyQuery& query);

/// The same in decimal only, each point at t=0 and at t=1, or all its control points, on one line.
[[nodiscard]] std::string as_short_points(const AnyQuery& query);

/// A solver, and what it is asked with besides the query.
struct SolverCall {
  /// The name of one of methods(), or what a plugin calls itself.
  std::string method;
  /// The plugin's library; empty for one of methods().
  std::filesystem::path plugin = {};
  /// The promise it is judged by.
  fast::Promise promise = fast::Promise::conservative;
  /// The terms of the promise, stated by the solver or on the command line.
  fast::Terms terms = {};
  /// With the separation that counts as contact.
  fast::MethodOptions options = {};
  /// Wall-clock seconds that a query may take; 0: no limit.
  double query_limit_seconds = 0.0;
  /// Limits of its process.
  solvers::ChildLimits limits = {};
};

/// A query and the wrong answer to it.
struct Reproduction {
  judge::Fault what = judge::Fault::false_negative;
  FailingCase failing;
  /// Of what is wrong only in that.
  MissingBounds missing = {};
  SolverCall solver;
};

/// The reproduction of a finding's simplest query.
/// \param asked the solver of the run; a finding against the judge is about `certified` instead
[[nodiscard]] Reproduction reproduction_of(const Finding& finding, const SolverCall& asked);

/// Commands for a POSIX shell that write the query as a dataset and ask the solver again, with all
/// that it was asked with; `touchstone certify` then judges it.
/// \pre all coordinates are finite.
[[nodiscard]] std::string as_command(const Reproduction& found);

}  // namespace touchstone::verify::fuzz
