/// \file
/// touchstone-derive: the bounds of the filtered expressions, and the header that ships them.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <exception>
#include <fstream>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "touchstone/derivation/bound_table.hpp"
#include "touchstone/derivation/catalogue.hpp"

namespace {

using namespace touchstone::filters;

constexpr std::string_view usage =
    "usage: touchstone-derive [OPTIONS]\n"
    "\n"
    "Derives the error bounds of the filtered expressions (filters/README.md), and prints them in\n"
    "units of u times a power of the greatest coordinate, the expression's degree.\n"
    "\n"
    "--model NAME      A column to compute: published, rigorous, gappa, observed; repeatable\n"
    "                  (default: all; without gappa its column is empty, which is an error only\n"
    "                  if it is named)\n"
    "--precision NAME  Only double, float or double_double\n"
    "--evaluations N   Evaluations of the search for the worst error, for each row\n"
    "--seed N          Its seed\n"
    "--threads N       Cores to use (0, the default: all)\n"
    "--emit FILE       Write the header of bounds (touchstone/filters/error_bounds.hpp)\n"
    "--json FILE       Write the result as JSON\n"
    "\n"
    "Exit status: 0 success, 2 bad input or usage, or no gappa for --model gappa.\n"
    "\n"
    "Example: touchstone-derive --model published --model rigorous --precision double\n";

/// The words of a command line.
struct Arguments {
  DeriveOptions options;
  bool needs_gappa = false;
  std::string header_file;
  std::string json_file;
};

std::uint64_t whole_number(std::string_view option, std::string_view word) {
  std::uint64_t number = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, number);
  if (error == std::errc() && stop == end) return number;
  throw std::invalid_argument(fmt::format("{}: {} is not a whole number", option, word));
}

Model model_of(std::string_view name) {
  if (name == "published") return Model::published;
  if (name == "rigorous") return Model::rigorous;
  if (name == "gappa") return Model::gappa;
  if (name == "observed") return Model::observed;
  throw std::invalid_argument(
      fmt::format("--model: there are published, rigorous, gappa and observed, no {}", name));
}

/// \throws std::invalid_argument that says what is wrong.
Arguments parsed(std::span<char*> words) {
  Arguments arguments;
  std::set<Model> models;
  for (std::size_t i = 0; i < words.size(); i += 2) {
    const std::string option = words[i];
    if (i + 1 == words.size())
      throw std::invalid_argument(option + " is unknown, or needs a value");
    const std::string value = words[i + 1];
    if (option == "--model") {
      models.insert(model_of(value));
    } else if (option == "--precision") {
      std::vector<Format>& formats = arguments.options.formats;
      std::erase_if(formats, [&](const Format& format) { return format.name != value; });
      if (formats.empty()) {
        throw std::invalid_argument("--precision: there are double, float and double_double, no " +
                                    value);
      }
    } else if (option == "--evaluations") {
      arguments.options.search.evaluations =
          std::max<std::uint64_t>(1, whole_number(option, value));
    } else if (option == "--seed") {
      arguments.options.search.seed = whole_number(option, value);
    } else if (option == "--threads") {
      arguments.options.threads = static_cast<unsigned>(whole_number(option, value));
    } else if (option == "--emit") {
      arguments.header_file = value;
    } else if (option == "--json") {
      arguments.json_file = value;
    } else {
      throw std::invalid_argument(option + " is unknown");
    }
  }
  arguments.needs_gappa = models.contains(Model::gappa);
  if (!models.empty()) arguments.options.models = models;
  return arguments;
}

// ---- JSON ---------------------------------------------------------------------------------------

std::string json(const std::optional<double>& number) {
  return number ? fmt::format("{}", *number) : "null";
}

/// A bound as a multiple of u and as the constant itself.
std::string json_bound(std::string_view name, const std::optional<double>& units, double u) {
  return fmt::format(R"(, "{0}": {1}, "{0}_units": {2})", name,
                     json(units ? std::optional(*units * u) : units), json(units));
}

/// A row, all of whose texts are plain.
std::string json(const DeriveRow& row) {
  std::string text = fmt::format(R"({{"expression": "{}", "precision": "{}", "tightness": {})",
                                 row.expression, row.format.name, json(row.tightness()));
  const bool has_constant = !row.published_constant.empty();
  text += fmt::format(R"(, "published_constant": {})",
                      has_constant ? '"' + row.published_constant + '"' : "null");
  const double u = row.format.unit_roundoff().get_d();
  const auto add = [&](std::string_view name, const auto& bound, const auto& units_of) {
    text += json_bound(name, bound ? std::optional<double>(units_of(*bound)) : std::nullopt, u);
  };
  const auto as_double = [](const mpq_class& bound) { return bound.get_d(); };
  add("published", row.published, as_double);
  add("rigorous", row.rigorous, as_double);
  add("gappa", row.gappa, as_double);
  add("observed", row.observed, [](const WorstCase& worst) { return worst.units; });
  if (!row.observed) return text + "}";
  return text + fmt::format(R"(, "worst_input": {{"coordinates": [{}], "weights": [{}]}}}})",
                            fmt::join(row.observed->inputs.coordinates, ", "),
                            fmt::join(row.observed->inputs.weights, ", "));
}

std::string json(const DeriveOptions& options, const DeriveResult& result) {
  std::vector<std::string> rows;
  for (const DeriveRow& row : result.rows) rows.push_back(json(row));
  return fmt::format(
      "{{\"seed\": {}, \"evaluations\": {}, \"gappa_missing\": {}, \"bounds\": [\n{}\n]}}\n",
      options.search.seed, options.search.evaluations, result.gappa_missing,
      fmt::join(rows, ",\n"));
}

// ---- The run ------------------------------------------------------------------------------------

/// Writes the text; no text: tells early whether that can be done.
void write(const std::string& file, const std::optional<std::string>& text) {
  if (file.empty()) return;
  std::ofstream out(file, text ? std::ios::trunc : std::ios::app);
  if (text) out << *text;
  if (!out.flush()) throw std::runtime_error(file + ": cannot be written");
}

int run(const Arguments& arguments) {
  write(arguments.header_file, std::nullopt);
  write(arguments.json_file, std::nullopt);
  const DeriveResult result = derive(arguments.options);
  write(arguments.header_file, error_bounds_header());
  write(arguments.json_file, json(arguments.options, result));
  fmt::print("{}", to_table(result));
  if (std::fflush(stdout) != 0) throw std::runtime_error("standard output cannot be written");
  if (!result.gappa_missing) return 0;
  fmt::print(stderr,
             "touchstone-derive: gappa is not found, and its column empty; install the Debian "
             "package gappa\n");
  return arguments.needs_gappa ? 2 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::span words = std::span(argv, static_cast<std::size_t>(argc)).subspan(1);
    if (words.size() == 1 && std::string_view(words[0]) == "--help") {
      fmt::print("{}", usage);
      return 0;
    }
    return run(parsed(words));
  } catch (const std::exception& error) {
    fmt::print(stderr, "touchstone-derive: {}\n", error.what());
    return 2;
  }
}
