#pragma once

/// \file
/// What solvers answer to a query that is viewed, and queries of the judge as a view shows them.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fast/method.hpp"
#include "verify/judge/judgement.hpp"
#include "verify/solvers/solver.hpp"
#include "verify/view/query_facts.hpp"

namespace touchstone::verify::view {

/// The answers of all solvers for which the query is within their terms. \pre not on curves
[[nodiscard]] std::vector<judge::GivenAnswer> answers_of(
    std::span<const solvers::Solver* const> solvers, const ViewedQuery& viewed);

/// What a method that answers queries on curves does to this one; nothing unless the curves have
/// one degree or are constant, with `tight_inclusion` 2 or 3. \pre viewed.curves
[[nodiscard]] std::optional<judge::GivenAnswer> answer_on_curves(const ViewedQuery& viewed,
                                                                 const std::string& method,
                                                                 fast::MethodOptions options);

/// A query that the judge found a fault in: its faults are the notes.
[[nodiscard]] ViewedQuery viewed_query(judge::WrongQuery wrong);

}  // namespace touchstone::verify::view
