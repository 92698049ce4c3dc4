#include "verify/report/bench_page.hpp"

#include <nlohmann/json.hpp>

#include "verify/io/html.hpp"
#include "verify/io/printable.hpp"

namespace touchstone::verify::report {
namespace {

/// The rows with the names of others printable.
nlohmann::json with_printable_names(nlohmann::json rows) {
  for (nlohmann::json& row : rows) {
    for (const char* const name : {"source", "method"}) {
      if (row.contains(name)) row[name] = io::printable(row[name].get<std::string>());
    }
  }
  return rows;
}

}  // namespace

std::string bench_page(const nlohmann::json& rows) {
  std::string page =
      io::html_beginning("Touchstone: speed and error", page_style()) +
      "<main></main>\n<noscript><p>This page is written by a script.</p></noscript>\n" +
      io::json_element("rows", with_printable_names(rows));
  for (const std::string_view script : {d3_script(), page_script()}) {
    page += io::script_element(script);
  }
  return page + "</body>\n</html>\n";
}

}  // namespace touchstone::verify::report
