#include "verify/view/view_page.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "verify/io/html.hpp"
#include "verify/io/printable.hpp"
#include "verify/report/bench_page.hpp"

namespace touchstone::verify::view {

std::string view_page(const std::vector<nlohmann::json>& queries, const std::string& command,
                      const nlohmann::json& step, const std::string& solvers) {
  const std::string style = std::string(report::page_style()) + std::string(view_style());
  std::string page = io::html_beginning(
      solvers.empty() ? "Touchstone view" : "Touchstone playground", style, !solvers.empty());
  page +=
      "<noscript><p class=\"warning\">The pictures are drawn by a script.</p></noscript>\n"
      "<main id=\"view\"></main>\n";
  page += fmt::format("<footer><p>Made by</p>\n<pre class=\"command\">{}</pre></footer>\n",
                      io::html_escaped(command));
  page += io::json_element("queries", queries);
  if (!step.is_null()) page += io::json_element("step_facts", step);
  if (!solvers.empty()) page += io::script_element(solvers, "solvers");
  page += io::script_element(view_script());
  return page + "</body>\n</html>\n";
}

}  // namespace touchstone::verify::view
