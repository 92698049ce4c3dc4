#pragma once

/// \file
/// The answers of solvers to a viewed query, and queries of the judge as a view shows them.

#include <span>
#include <string>
#include <vector>

#include "verify/judge/judgement.hpp"
#include "verify/solvers/solver.hpp"
#include "verify/view/viewed_query.hpp"

namespace touchstone::verify::view {

/// The replies of solvers to a query.
struct Replies {
  /// The answers of all solvers for which the query is within their terms.
  std::vector<judge::GivenAnswer> answers = {};
  /// A sentence for each solver that is not asked; on straight lines only for those that take none.
  std::vector<std::string> notes = {};
};

/// Asks them.
[[nodiscard]] Replies ask(std::span<const solvers::Solver* const> solvers,
                          const ViewedQuery& viewed);

/// A query that the judge found a fault in: its faults are the notes.
[[nodiscard]] ViewedQuery viewed_query(judge::WrongQuery wrong);

}  // namespace touchstone::verify::view
