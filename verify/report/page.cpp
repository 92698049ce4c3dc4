#include "verify/report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "verify/io/html.hpp"
#include "verify/io/printable.hpp"
#include "verify/judge/separation_inference.hpp"
#include "verify/report/changes.hpp"
#include "verify/report/figures.hpp"
#include "verify/report/findings.hpp"
#include "verify/report/page_texts.hpp"
#include "verify/report/stability_report.hpp"
#include "verify/report/tables.hpp"

namespace touchstone::verify::report {
namespace {

constexpr std::string_view filter_title = "What Tight-Inclusion misses with each filter";

/// Tables under one heading.
struct Section {
  std::string_view id;
  std::string_view title;
  std::vector<Table> tables;
  bool meanings = true;  ///< with column_meanings() below
};

/// All that a page shows, in its order.
struct Contents {
  std::string_view title;
  std::string about;
  std::vector<std::string> findings;
  /// The first of them stands at the top, the others behind the tables at the top.
  std::vector<Figure> figures;
  std::vector<Section> top_tables;
  std::vector<Section> further_tables;
  /// Where the numbers are from; texts are printable.
  std::vector<MeasuredGroup> groups;
  std::string command;
  std::string origin;  ///< as origin_text() gives it
  bool interrupted = false;
};

/// The tables over d: of the baselines that were measured, or of ours.
std::vector<Section> separation_sections(const Measurements& measurements) {
  std::vector<Section> sections{{"table_2", "Table 2: MSRF over the minimum separation d",
                                 separation_tables(measurements, "msrf")},
                                {"table_3", "Table 3: FPRF over the minimum separation d",
                                 separation_tables(measurements, "fprf")}};
  const auto is_empty = [](const Section& section) { return section.tables.empty(); };
  if (std::ranges::all_of(sections, is_empty)) {
    sections.push_back({"table_2", "Table 2: over the minimum separation d",
                        separation_tables(measurements, "tight_inclusion")});
  }
  sections.push_back({"filters", filter_title, filter_tables(measurements)});
  std::erase_if(sections, is_empty);
  return sections;
}

class Writer {
 public:
  explicit Writer(const Contents& contents) : contents_(contents) {}

  [[nodiscard]] std::string page() {
    text_ += io::html_beginning(contents_.title, page_style());
    write_opening();
    write_navigation();
    for (const Section& section : contents_.top_tables) write_section(section);
    for (std::size_t i = 1; i < contents_.figures.size(); ++i) write_figure(contents_.figures[i]);
    for (const Section& section : contents_.further_tables) write_section(section);
    write_scripts();
    return std::move(text_);
  }

 private:
  /// The beginning of the page.
  void write_opening() {
    text_ += fmt::format("<header>\n<h1>{}</h1>\n<p>{}</p>\n", contents_.title,
                         io::html_escaped(contents_.about));
    if (contents_.interrupted) {
      text_ +=
          "<p class=\"warning\">Not all that was asked for is here: the time was over, or "
          "the run was interrupted.</p>\n";
    }
    text_ += "<ul class=\"findings\">\n";
    for (const std::string& finding : contents_.findings) {
      text_ += fmt::format("<li>{}</li>\n", io::html_escaped(finding));
    }
    text_ += "</ul>\n</header>\n<main>\n";
    if (!contents_.figures.empty()) write_figure(contents_.figures.front());
  }

  void write_navigation() {
    text_ += fmt::format("<p>Made{} by</p>\n<pre class=\"command\">{}</pre>\n",
                         io::html_escaped(contents_.origin), io::html_escaped(contents_.command));
    if (!contents_.groups.empty()) {
      text_ += "<details><summary>Data</summary>\n<ul>\n";
      for (const MeasuredGroup& group : contents_.groups) {
        text_ += fmt::format("<li>{}, {}: {} queries, digest <code>{:016x}</code></li>\n",
                             io::html_escaped(group.name), to_string(group.kind), group.queries,
                             group.digest);
      }
      text_ += "</ul>\n</details>\n";
    }
    text_ += "<nav aria-label=\"Contents\"><ul>\n";
    for (const Section& section : contents_.top_tables) write_link(section.id, section.title);
    for (const Figure& figure : contents_.figures) write_link(figure.id, figure.title);
    for (const Section& section : contents_.further_tables) write_link(section.id, section.title);
    text_ += "</ul></nav>\n";
  }

  void write_link(std::string_view id, std::string_view title) {
    text_ += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", id, io::html_escaped(title));
  }

  // ---- Tables -----------------------------------------------------------------------------------

  void write_section(const Section& section) {
    if (section.tables.empty()) return;
    text_ += fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n", section.id, section.title);
    for (std::size_t i = 0; i < section.tables.size(); ++i) {
      write_table(section.tables[i]);
      write_download(fmt::format("{}_{}", section.id, i + 1), section.tables[i]);
    }
    if (section.meanings) write_meanings();
    text_ += "</section>\n";
  }

  void write_meanings() {
    text_ += "<details><summary>What the columns mean</summary>\n<ul>\n";
    for (const std::string& meaning : column_meanings()) {
      text_ += fmt::format("<li>{}</li>\n", io::html_escaped(meaning));
    }
    text_ += "</ul>\n</details>\n";
  }

  void write_table(const Table& table) {
    text_ += fmt::format(
        "<div class=\"scroll\" tabindex=\"0\"><table{}>\n<caption>{}</caption>\n<thead><tr>",
        table.columns.size() > 1 && is_misses(table.columns[1]) ? " class=\"misses\"" : "",
        io::html_escaped(table.title));
    for (const std::string& column : table.columns) {
      text_ += fmt::format("<th scope=\"col\">{}</th>", io::html_escaped(column));
    }
    text_ += "</tr></thead>\n<tbody>\n";
    for (const auto& row : table.rows) {
      text_ += "<tr>";
      for (std::size_t i = 0; i < row.size(); ++i) {
        text_ += i == 0 ? fmt::format("<th scope=\"row\">{}</th>", io::html_escaped(row[i]))
                        : cell(table.columns[i], row[i]);
      }
      text_ += "</tr>\n";
    }
    text_ += "</tbody>\n</table></div>\n";
  }

  static std::string cell(std::string_view column, std::string_view text) {
    if (is_misses(column) && counts_something(text)) {
      return fmt::format("<td class=\"missed\">✗ {}</td>", io::html_escaped(text));
    }
    return fmt::format("<td{}>{}</td>", is_word(column) ? " class=\"word\"" : "",
                       io::html_escaped(text));
  }

  /// Does the column hold false negatives?
  static bool is_misses(std::string_view column) {
    return column == "FN" || column.ends_with(" FN");
  }

  /// Is it a number above 0, or a change from one or to one?
  static bool counts_something(std::string_view text) {
    return text.find_first_of("123456789") == 0 || text.starts_with("0 of");
  }

  /// Does the column hold words?
  static bool is_word(std::string_view column) {
    return column == "method" || column == "norm" || column == "kind";
  }

  /// The numbers as CSV.
  void write_download(std::string_view id, const Table& data) {
    text_ += fmt::format(
        "<p class=\"origin\"><a class=\"csv\" download=\"{0}.csv\" "
        "href=\"data:text/csv;charset=utf-8,{1}\">CSV</a></p>\n",
        id, io::percent_encoded(to_csv(data)));
  }

  // ---- Figures ----------------------------------------------------------------------------------

  void write_figure(const Figure& figure) {
    text_ += fmt::format(
        "<section class=\"figure\" id=\"{}\">\n<h2>{}</h2>\n<p>{}</p>\n"
        "<div class=\"legend\"></div>\n<div class=\"panels\"></div>\n",
        figure.id, io::html_escaped(figure.title), io::html_escaped(figure.description));
    write_download(figure.id, figure.data);
    text_ += "</section>\n";
  }

  void write_scripts() {
    text_ +=
        "</main>\n<noscript><p class=\"warning\">The figures are drawn by a "
        "script.</p></noscript>\n";
    text_ += io::json_element("figures", to_json(contents_.figures));
    text_ += io::script_element(d3_script()) + io::script_element(page_script());
    text_ += "</body>\n</html>\n";
  }

  const Contents& contents_;
  std::string text_;
};

}  // namespace

std::string report_page(const Measurements& measured, const Measurements* before) {
  const Measurements measurements = with_printable_texts(measured);
  Contents contents{.title = "Touchstone report",
                    .about =
                        "Methods of continuous collision detection, their speed against their "
                        "error. The truth is the exact oracle’s.",
                    .findings = {},
                    .figures = figures_of(measurements),
                    .top_tables = {{"table_1", "Table 1: all methods", field_tables(measurements)}},
                    .further_tables = separation_sections(measurements),
                    .groups = measurements.groups,
                    .command = measurements.command,
                    .origin = origin_text(measurements),
                    .interrupted = measurements.interrupted};
  contents.findings = findings_of(measurements, contents.figures);
  if (before != nullptr) {
    const Table changes = changes_between(with_printable_texts(*before), measurements);
    if (changes.rows.empty()) {
      contents.findings.push_back("Nothing has changed " + changes.title + ".");
    } else {
      contents.top_tables.insert(contents.top_tables.begin(),
                                 {"changes", "What has changed", {changes}, false});
    }
  }
  return Writer(contents).page();
}

std::string stability_page(const stability::StabilityResult& result, const std::string& command) {
  const Measurements measurements = with_printable_texts({.command = command,
                                                          .version = {},
                                                          .machine = {},
                                                          .date = {},
                                                          .groups = {},
                                                          .all = {},
                                                          .stability = marks_of(result)});
  Contents contents{
      .title = "Stability of solvers",
      .about = result.cells.empty()
                   ? "No cell was judged."
                   : fmt::format(
                         "{} queries a cell, half of them collisions; seed {}{}. Errors of times "
                         "of impact are in units of the motion's duration.",
                         result.count, result.seed,
                         is_zero(result.separation)
                             ? ""
                             : "; minimum separation " + judge::to_text(result.separation)),
      .findings = {},
      .figures = figures_of(measurements),
      .top_tables = {{"overview", "Overview", {overview_of(result)}, false}},
      .further_tables = {},
      .groups = {},
      .command = measurements.command,
      .origin = {},
      .interrupted = result.total.interrupted};
  for (const jobs::MethodResult& method : result.total.methods) {
    contents.findings.push_back(promise_text(method) + ".");
  }
  return Writer(contents).page();
}

}  // namespace touchstone::verify::report
