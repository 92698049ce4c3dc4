#pragma once

/// \file
/// A query, or a list of them, as one HTML page to look at that needs nothing else: no network, no other file.
///
/// The page shows one query at a time: its primitives at a time that a slider chooses, with their traces;
/// in a second picture the corners w_i(t) and the origin, which is in their convex hull iff the primitives touch (docs/theory.md,
/// section 1.3); below them the line of time with the time of impact, the pieces of a certificate and the answers of solvers.
/// Positions are computed by the page exactly, in integers, and only what is drawn is rounded, relative to
/// the place of contact and the size of what is seen; so coordinates of any size show, and gaps of any.
///
/// Before them a step may stand: its mesh at the time of a slider, and the pairs that touch by their time, each of which leads
/// to its query.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace touchstone::verify::view {

/// The page as HTML.
/// \param queries as query_facts() gives them
/// \param command the command line that made it
/// \param step as step_facts() gives it, whose first pairs the queries are; null: none
[[nodiscard]] std::string view_page(const std::vector<nlohmann::json>& queries,
                                    const std::string& command, const nlohmann::json& step = {});

}  // namespace touchstone::verify::view
