#pragma once

/// \file
/// What solvers answer to a query that is viewed, and queries of the judge as a view shows them.

#include <span>
#include <vector>

#include "verify/judge/judgement.hpp"
#include "verify/solvers/solver.hpp"
#include "verify/view/query_facts.hpp"

namespace touchstone::verify::view {

/// The answers of all solvers for which the query is within their terms.
[[nodiscard]] std::vector<judge::GivenAnswer> answers_of(
    std::span<const solvers::Solver* const> solvers, const ViewedQuery& viewed);

/// A query that the judge found a fault in: its faults are the notes.
[[nodiscard]] ViewedQuery viewed_query(judge::WrongQuery wrong);

}  // namespace touchstone::verify::view
