#pragma once

/// \file
/// An HTML viewer of one query or a list of queries, without network access and other files.
///
/// The page shows one query at a time: its primitives at a time that a slider chooses, with their
/// traces; in a second picture the corners w_i(t) and the origin, which is in their convex hull iff
/// there is contact (docs/theory.md, section 1.3); below them the line of time with the time of
/// impact, the subintervals of a certificate and the answers of solvers. The page computes
/// positions exactly, in integers, and rounds only for drawing, relative to the place of contact
/// and the size of the visible part; so it shows coordinates and gaps of any size.
///
/// A step may precede them: its mesh at the time of a slider, and the colliding pairs by time, each
/// with a link to its query.

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone::verify::view {

/// The page as HTML.
/// \param queries from query_facts()
/// \param command the command line of this run
/// \param step from step_facts(), whose first pairs are the queries; null: none
/// \param solvers the script of verify/playground, by which the page decides other queries; empty:
/// no script
[[nodiscard]] std::string view_page(const std::vector<nlohmann::json>& queries,
                                    const std::string& command, const nlohmann::json& step = {},
                                    const std::string& solvers = {});

// The texts of a view, embedded in the tool at build time: the modules of verify/view/page/
// with three.js as one script, and their style.

/// The script of a view, three.js with its licence's notice included.
[[nodiscard]] std::string_view view_script();

/// The style of a view in addition to that of a report.
[[nodiscard]] std::string_view view_style();

}  // namespace touchstone::verify::view
