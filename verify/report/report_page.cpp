#include "verify/report/report_page.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string_view>

#include "verify/io/html.hpp"
#include "verify/judge/separation_inference.hpp"
#include "verify/report/measurement.hpp"

namespace touchstone::verify::report {
namespace {

using Json = nlohmann::json;

/// The top of a page, besides the findings that its script computes from the measurements.
struct Opening {
  std::string_view title;
  std::string about;
  Json findings = Json::array();  ///< sentences
  Json tables = Json::array();    ///< sections of tables, as report.js has them
};

Json json_of(const Measurements& measurements) {
  return to_json(with_printable_texts(measurements));
}

std::string page_of(const Opening& opening, const Measurements& measured) {
  const Json data{{"title", opening.title},
                  {"about", opening.about},
                  {"findings", opening.findings},
                  {"tables", opening.tables},
                  {"measurements", json_of(measured)}};
  std::string page = io::html_beginning(opening.title, page_style()) +
                     "<header></header>\n<main></main>\n"
                     "<noscript><p class=\"warning\">This page is written by a script.</p>"
                     "</noscript>\n";
  page += io::json_element("report", data);
  page += io::json_element("published", Json::parse(published_numbers()));
  for (const std::string_view script : {d3_script(), report_script(), page_script()}) {
    page += io::script_element(script);
  }
  return page + "</body>\n</html>\n";
}

}  // namespace

std::string report_page(const Measurements& measured) {
  return page_of({.title = "Touchstone report",
                  .about = "Methods of continuous collision detection, their speed against their "
                           "error. The truth is the exact oracle’s."},
                 measured);
}

std::string stability_page(const StabilityResult& result, const std::string& command) {
  Opening opening{
      .title = "Stability of solvers",
      .about = result.cells.empty()
                   ? "No cell was judged."
                   : fmt::format(
                         "{} queries a cell, half of them collisions; seed {}{}. Errors of times "
                         "of impact are in units of the motion's duration.",
                         result.count, result.seed,
                         is_zero(result.separation)
                             ? ""
                             : "; minimum separation " + judge::to_text(result.separation))};
  for (const jobs::MethodResult& method : result.total.methods) {
    opening.findings.push_back(promise_text(method) + ".");
  }
  opening.tables.push_back(
      {{"id", "overview"}, {"title", "Overview"}, {"tables", {overview_of(result)}}});
  return page_of(opening, {.command = command,
                           .version = {},
                           .machine = {},
                           .date = {},
                           .groups = {},
                           .all = {},
                           .stability = marks_of(result),
                           .interrupted = result.total.interrupted});
}

}  // namespace touchstone::verify::report
