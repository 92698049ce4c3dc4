#include "verify/report/page.hpp"

#include <fmt/format.h>

#include <cctype>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "verify/report/figures.hpp"
#include "verify/report/page_texts.hpp"
#include "verify/report/tables.hpp"
#include "verify/stability/svg.hpp"

namespace touchstone::verify {
namespace {

/// Nothing may be loaded from anywhere.
constexpr std::string_view policy =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:";

constexpr std::string_view filter_title = "What Tight-Inclusion misses with each filter";

/// Bytes as they may stand in a data URL.
std::string percent_encoded(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0 || c == '-' || c == '.' || c == '_' || c == ',') {
      result += c;
    } else {
      fmt::format_to(std::back_inserter(result), "%{:02X}", byte);
    }
  }
  return result;
}

/// JSON as it may stand in a script element: no "<" ends it.
std::string script_json(const nlohmann::json& json) {
  std::string result;
  for (const char c : json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)) {
    if (c == '<') {
      result += "\\u003c";
    } else {
      result += c;
    }
  }
  return result;
}

class Writer {
 public:
  explicit Writer(const Measurements& measurements)
      : measurements_(with_printable_texts(measurements)) {}

  [[nodiscard]] std::string page() {
    const std::vector<Figure> figures = figures_of(measurements_);
    write_head();
    write_introduction(figures);
    write_tables("table_1", "Table 1: all methods", field_tables(measurements_));
    for (const Figure& figure : figures) write_figure(figure);
    for (const Section& section : separation_sections()) {
      write_tables(section.id, section.title, section.tables);
    }
    write_tables("filters", filter_title, filter_tables(measurements_));
    write_scripts(figures);
    return std::move(text_);
  }

 private:
  struct Section {
    std::string_view id;
    std::string_view title;
    std::vector<Table> tables;
  };

  /// The tables over d: of the baselines that were measured, or of ours.
  [[nodiscard]] std::vector<Section> separation_sections() const {
    std::vector<Section> sections{{"table_2", "Table 2: MSRF over the minimum separation d",
                                   separation_tables(measurements_, "msrf")},
                                  {"table_3", "Table 3: FPRF over the minimum separation d",
                                   separation_tables(measurements_, "fprf")}};
    const auto is_empty = [](const Section& section) { return section.tables.empty(); };
    std::erase_if(sections, is_empty);
    if (sections.empty()) {
      sections.push_back({"table_2", "Table 2: over the minimum separation d",
                          separation_tables(measurements_, "tight_inclusion")});
      std::erase_if(sections, is_empty);
    }
    return sections;
  }

  void write_head() {
    text_ += fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta name=\"color-scheme\" content=\"light dark\">\n"
        "<title>Touchstone report</title>\n<style>\n{}</style>\n</head>\n<body>\n",
        policy, page_style());
  }

  void write_introduction(const std::vector<Figure>& figures) {
    text_ +=
        "<header>\n<h1>Touchstone report</h1>\n<p>Methods of continuous collision detection, their "
        "speed against their error. The truth is the exact oracle’s.</p>\n";
    text_ += fmt::format("<p>Made on {} by</p>\n<pre class=\"command\">{}</pre>\n",
                         xml_escaped(measurements_.machine), xml_escaped(measurements_.command));
    if (measurements_.interrupted) {
      text_ += "<p class=\"warning\">Interrupted: not all that was asked for is here.</p>\n";
    }
    text_ += "</header>\n<nav aria-label=\"Contents\"><ul>\n";
    text_ += "<li><a href=\"#table_1\">Table 1</a></li>\n";
    for (const Figure& figure : figures) {
      text_ +=
          fmt::format("<li><a href=\"#{}\">{}</a></li>\n", figure.id, xml_escaped(figure.title));
    }
    for (const Section& section : separation_sections()) {
      text_ += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", section.id, section.title);
    }
    if (!filter_tables(measurements_).empty()) {
      text_ += fmt::format("<li><a href=\"#filters\">{}</a></li>\n", filter_title);
    }
    text_ += "</ul></nav>\n<main>\n";
  }

  // ---- Tables -----------------------------------------------------------------------------------

  void write_tables(std::string_view id, std::string_view title, const std::vector<Table>& tables) {
    if (tables.empty()) return;
    text_ += fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n", id, title);
    for (std::size_t i = 0; i < tables.size(); ++i) {
      write_table(tables[i]);
      write_origin(fmt::format("{}_{}", id, i + 1), tables[i]);
    }
    text_ += "<details><summary>What the columns mean</summary>\n<ul>\n";
    for (const std::string& meaning : column_meanings()) {
      text_ += fmt::format("<li>{}</li>\n", xml_escaped(meaning));
    }
    text_ += "</ul>\n</details>\n</section>\n";
  }

  void write_table(const Table& table) {
    text_ += fmt::format(
        "<div class=\"scroll\" tabindex=\"0\"><table>\n<caption>{}</caption>\n<thead><tr>",
        xml_escaped(table.title));
    for (const std::string& column : table.columns) {
      text_ += fmt::format("<th scope=\"col\">{}</th>", xml_escaped(column));
    }
    text_ += "</tr></thead>\n<tbody>\n";
    for (const auto& row : table.rows) {
      text_ += "<tr>";
      for (std::size_t i = 0; i < row.size(); ++i) {
        text_ += i == 0 ? fmt::format("<th scope=\"row\">{}</th>", xml_escaped(row[i]))
                        : fmt::format("<td{}>{}</td>",
                                      is_word(table.columns[i]) ? " class=\"word\"" : "",
                                      xml_escaped(row[i]));
      }
      text_ += "</tr>\n";
    }
    text_ += "</tbody>\n</table></div>\n";
  }

  /// Does the column hold words?
  static bool is_word(std::string_view column) {
    return column == "method" || column == "norm" || column == "kind";
  }

  /// The numbers as CSV, and the command that made them.
  void write_origin(std::string_view id, const Table& data) {
    text_ += fmt::format(
        "<p class=\"origin\"><a class=\"csv\" download=\"{0}.csv\" "
        "href=\"data:text/csv;charset=utf-8,{1}\">CSV</a> <code>{2}</code></p>\n",
        id, percent_encoded(to_csv(data)), xml_escaped(measurements_.command));
  }

  // ---- Figures ----------------------------------------------------------------------------------

  void write_figure(const Figure& figure) {
    text_ += fmt::format(
        "<section class=\"figure\" id=\"{}\">\n<h2>{}</h2>\n<p>{}</p>\n"
        "<div class=\"legend\"></div>\n<div class=\"panels\"></div>\n",
        figure.id, xml_escaped(figure.title), xml_escaped(figure.description));
    write_origin(figure.id, figure.data);
    text_ += "</section>\n";
  }

  void write_scripts(const std::vector<Figure>& figures) {
    text_ +=
        "</main>\n<noscript><p class=\"warning\">The figures are drawn by a "
        "script.</p></noscript>\n";
    text_ += fmt::format("<script type=\"application/json\" id=\"figures\">{}</script>\n",
                         script_json(to_json(figures)));
    text_ += fmt::format("<script>\n{}</script>\n<script>\n{}</script>\n</body>\n</html>\n",
                         d3_script(), page_script());
  }

  Measurements measurements_;
  std::string text_;
};

}  // namespace

std::string report_page(const Measurements& measurements) { return Writer(measurements).page(); }

}  // namespace touchstone::verify
