#include "verify/cli/option_table.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cfloat>
#include <climits>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "verify/cli/options.hpp"
#include "verify/cli/solver_options.hpp"
#include "verify/data/ground_truth_files.hpp"
#include "verify/io/number_text.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/terminal.hpp"
#include "verify/judge/fault.hpp"
#include "verify/report/step_report.hpp"
#include "verify/solvers/published.hpp"

namespace touchstone::verify::cli {
namespace {

std::vector<std::string> fault_names() {
  std::vector<std::string> names;
  names.reserve(judge::all_faults.size());
  for (const judge::Fault fault : judge::all_faults) names.emplace_back(judge::to_string(fault));
  return names;
}

std::vector<OptionRow> make_table() {
  using enum OptionForm;
  const OneOf contact{{"vertex-face", "edge-edge"}};
  const OneOf kinds{{"vertex-face", "edge-edge", "tetrahedron", "plane-triangle"}};
  const std::string certificates = "compressed if the name ends in .zst";
  return {
      // clang-format off
      // Queries: files, or the built-in set.
      {"PATH", "", {}, "Datasets (.csv, .npy), also of queries on curves, or folders of them, findings (.json of fuzz), or certificates (.cert, .cert.zst)", "view", list},
      {"PATH", "", {}, "Dataset files (.csv, .npy) or folders; default: the built-in set", "", list},
      {"--kind", "KIND", kinds, "Only these queries; otherwise vertex-face and edge-edge", "fuzz"},
      {"--kind", "KIND", kinds, "Only these queries; otherwise vertex-face and edge-edge", "generate"},
      {"--kind", "KIND", contact, "vertex-face or edge-edge, if the input does not tell", "view"},
      {"--kind", "KIND", contact, "vertex-face or edge-edge, if the path does not tell", "bench"},
      {"--kind", "KIND", kinds, "vertex-face, edge-edge, or a cell, if the path does not tell", "prove"},
      {"--kind", "KIND", kinds, "vertex-face, edge-edge, or a cell, if the path does not tell; also: only these of the built-in set"},
      {"--round", "", {}, "Round coordinates of datasets that are not doubles", "view"},
      {"--round", "", {}, "Round coordinates that are not doubles, and count them"},
      {"--keep-going", "", {}, "Skip and count invalid queries and files (exit status 2)"},
      {"--threads", "N", Whole{0, INT_MAX}, "Cores to use (0: all)"},
      {"--seed", "N", Whole{}, "Seed of all queries", "fuzz"},
      {"--seed", "N", Whole{}, "Seed of the built-in set"},
      {"--count", "N", Whole{1}, "Queries of each family and kind, and level", "bench"},
      {"--count", "N", Whole{1}, "Queries of each family and kind of the built-in set"},
      {"--degree", "D", OneOf{{"1", "2", "3", "4", "5", "6", "7", "8", "rational"}}, "Degree of the Bézier curves that points move on, 1 (straight lines, the default) to 8, or rational (of degrees 1 and 2); repeatable", "fuzz"},
      {"--degree", "D", OneOf{{"1", "2", "3", "rational"}}, "Built-in queries of this degree: 1 (lines), 2, 3, or rational; repeatable"},
      {"--level", "L:M", {}, "Families of growing difficulty, from level L (1) to M (12)"},
      {"--min-separation", "D", Distance{}, "Contact: distance ≤ D (default: separation.json, or 0); repeatable", "bench"},
      {"--min-separation", "D", Distance{}, "Contact: distance ≤ D, 0.5 or 0x1p-1 (default: separation.json, or 0)"},
      {"--norm", "NORM", OneOf{{"linf", "l2"}}, "Norm of the distance: l2 (default) or linf (greatest component)"},
      {"--family", "NAME", {}, "Only these families of growing difficulty; repeatable", "bench"},
      {"--family", "NAME", {}, "Only these families (see --list)", "generate", list},
      {"--patches", "N", Whole{1, 20'000}, "Write two patches of mesh instead of queries, before and after a step, with N cells per side: 4 N² faces"},
      {"--index", "N", Whole{}, "Only the query at this position of a file, from 0; repeatable"},
      {"--most", "N", Whole{1, 1000}, "Maximum number of queries", "view"},
      {"--points", "NUMBERS", {}, "The 24 coordinates of a query, in one word: decimal, hexadecimal or fractions"},

      // Meshes.
      {"frames", "FRAME", {}, "Frames in order: .ply or .obj files, a folder of them, or one .npz of V (T,n,3), F, E and T", "step", required},
      {"meshes", "MESH", {}, "Meshes: .ply, .obj or .npz files; several also with each other", "intersections", required},
      {"--step", "FRAME FRAME", {}, "The step between two frames of a mesh (.ply, .obj) with its collisions", "view", pair},
      {"--step", "FRAME0 FRAME1", {}, "Measure a step instead of queries: meshes before and after it", "bench", pair},
      {"--groups", "FILE", {}, "Group names of the vertices, one per line (default: o, g of an OBJ)"},
      {"--most", "N", Whole{1, 100'000'000}, fmt::format("Maximum number of pairs that are told (default {})", report::most_intersections), "intersections"},
      {"--weld", "", {}, "Vertices at the same place, of the same group, are one"},
      {"--apart", "GROUP GROUP", {}, "Ignore collisions between groups A and B (A A: within A); repeatable", "", list},
      {"--radii", "FILE", {}, "Lines GROUP,RADIUS: in contact within the sum of two radii, in l2"},
      {"--separations", "FILE", {}, "Lines GROUP,GROUP,DISTANCE, in place of the sum of two radii"},

      // Parts of a run.
      {"--shard", "I/N", {}, "Do part I of N, from 0 on (touchstone merge adds up the JSON of all)"},
      {"parts", "FILE.json", {}, "The JSON of all parts of a run (--shard I/N --json FILE.json)", "merge", required},

      // Solvers.
      {"--method", "NAME", {}, fmt::format("Built-in or published solver; repeatable: {}", fmt::join(solvers::all_names(), ", "))},
      {"--plugin", "LIB.so", {}, "Your solver: a shared library (touchstone/plugin.h); repeatable"},
      {"--answers-kinds", "KIND", kinds, "The plugin answers only these queries; repeatable"},
      {"--float-coordinates", "", {}, "The plugin takes float: round queries to float first, and judge by these"},
      {"--starts-apart{0}", "", Real{0.0, DBL_MAX}, "The plugin needs primitives that are apart at t=0; with =D, by more than the minimum separation plus D"},
      {"--times", "WHAT", OneOf{{"bounds", "estimates", "none"}}, "The plugin's times of impact: bounds, estimates or none"},
      {"--time-error", "E", Real{0.0, 1.0}, "Allowed error of estimated times, in units of the step (default 1e-6)"},
      {"--tolerance", "X", Real{DBL_TRUE_MIN, DBL_MAX}, "Tolerance of conservative methods (default 1e-06); repeatable", "bench"},
      {"--tolerance", "X", Real{DBL_TRUE_MIN, DBL_MAX}, "Tolerance of conservative methods, in units of the coordinates"},
      {"--max-checks", "N", Whole{0, INT64_MAX}, "Maximum steps per query (0: no limit); repeatable", "bench"},
      {"--max-checks", "N", Whole{0, INT64_MAX}, fmt::format("Maximum steps per query (0: no limit; built-in set: {})", built_in_max_checks)},
      {"--query-limit", "S", Real{0.0, 1e6}, "Seconds that a query may take before it counts as undecided (0: no limit)"},
      {"--memory-limit", "GIB", Real{0.0, 1e6}, fmt::format("Memory of a child process in GiB (default {:g}, 0: no limit)", static_cast<double>(solvers::ChildLimits{}.memory_bytes) / bytes_of_gibibyte)},
      {"--allow-processes", "", {}, "Allow plugins to start processes"},
      {"--show-output", "", {}, "Show the output of plugins on standard error"},
      {"--results", "FILE", {}, "Recorded answers to judge, as touchstone solve writes them; repeatable"},
      {"--exact", "", {}, "Judge every solver as exact: false positives are wrong answers too"},
      {"--t-max", "T", Real{0.0, 1.0}, "Only contacts up to this time of a step", "step"},
      {"--t-max", "T", Real{0.0, 1.0}, "Only impacts up to this time count, for methods that have this option", "solve"},

      // The work.
      {"--seconds", "S", Real{1e-3, 1e7}, fmt::format("Seconds to search (default {} unless --queries is given)", usual_fuzz_seconds), "fuzz"},
      {"--seconds", "S", Real{1e-6, 1e6}, "Seconds for a method and repetition; slower methods are timed on a sample", "bench"},
      {"--seconds", "S", Real{0.0, 1e7}, "Seconds of the whole run, shared over sources and solvers (0: no limit)"},
      {"--queries", "N", Whole{1}, "Number of queries"},
      {"--most-findings", "N", Whole{0, UINT32_MAX}, "End after this number of groups of findings (0: never)"},
      {"--only", "KIND", OneOf{fault_names()}, fmt::format("Report findings of this kind only; repeatable: {}", fmt::join(fault_names(), ", "))},
      {"--corpus", "PATH", {}, "Datasets whose queries are mutated", "fuzz", list},
      {"--kernel", "NAME", OneOf{{"scalar", "avx2", "avx512", "neon", "best"}}, "Kernel of certified and steps: scalar, avx2, avx512, neon or best"},
      {"--repetitions", "N", Whole{1, 1'000'000}, "Repetitions; times are medians"},
      {"--singles", "N", Whole{0, UINT32_MAX}, "Also time so many queries alone, one call each"},
      {"--judge", "N", Whole{0, INT64_MAX}, "Queries to judge per group, plus every reported collision"},
      {"--all", "", {}, "Find every collision, with its times (the default)"},
      {"--earliest", "", {}, "Find only the earliest impact and its pairs"},
      {"--free", "", {}, "Find only whether there is a collision"},
      {"--candidates", "", {}, "Count the candidate pairs also with --earliest and --free"},
      {"--no-intersections", "", {}, "Do not search the frames for intersections, which can take longer than --free"},
      {"--alpha", "A", Real{0.0, 1.0}, "Judge the step with this step size, to the rounded x0 + alpha (x1 - x0), and report a maximal one"},
      {"--claim", "CLAIM", OneOf{{"time_of_impact", "collision"}}, "Claim for a collision: its time_of_impact, or only the collision"},
      {"--width", "W", {}, "Width of the interval around a time of impact, a decimal number (default: neighbouring doubles)"},

      // Output.
      {"--json", "FILE", {}, "Write each row as a line of JSON", "bench"},
      {"--json", "FILE", {}, "Write the result as JSON"},
      {"--table", "", {}, "Print every file and column instead of the summary"},
      {"--baseline", "FILE.json", {}, "Known wrong answers: only new ones fail, mended ones are named"},
      {"--write-baseline", "", {}, "Write what is wrong now as the baseline"},
      {"--badge", "FILE.svg", {}, "Write an image with the solver's misses and false alarms"},
      {"--truth", "FILE", {}, "Write the truth as CSV: file,index,kind,collides,toi_lower,toi_upper"},
      {"--prove", "FILE", {}, "Write the certificates; " + certificates, "prove", required},
      {"--prove", "FILE", {}, "Write a proof of each step, for touchstone-check: no collision (up to --t-max), or the time of the earliest contact; " + certificates, "step"},
      {"--prove", "FILE", {}, "Write a proof that these pairs intersect and no others, for touchstone-check; " + certificates, "intersections"},
      {"--prove", "FILE", {}, "Write a proof of every verdict, as touchstone prove does"},
      {"--view", "FILE.html", {}, "Write an HTML viewer of the first step with a collision", "step"},
      {"--view", "FILE.html", {}, "Write an HTML viewer of the mesh and its intersections", "intersections"},
      {"--view", "FILE.html", {}, "Write an HTML viewer of the first 100 findings", "fuzz"},
      {"--view", "FILE.html", {}, "Write an HTML viewer of the first 100 queries with a wrong answer or label"},
      {"--out", "FILE", {}, "Write file,index,kind,verdict,toi_lower,toi_upper,tolerance,failure", "solve", required},
      {"--out", "FILE.csv", {}, "Write the queries found, with their truth, as a dataset", "fuzz"},
      {"--out", "FILE.html", {}, "Write the page", "view", required},
      {"--out", "FOLDER", {}, "Folder to write to", "generate"},
      {"--csv", "FILE", {}, "Write a row for each pair, with its place", "intersections"},
      {"--csv", "FILE", {}, "Write a row for each collision"},
      {"--list", "", {}, "List the families with the proofs of their truth"},
      {"--npy", "", {}, "Write float64 arrays of shape (N, 8, 3), on curves (N, K+1, 4, 3) or (N, K+1, 4, 4) with weights, without the truth, instead of CSV"},
      {"--page", "FILE.html", {}, "Draw the rows: speed against error, and error over the level"},
      {"--from", "FILE", {}, "Rows of an earlier run (--json), to be drawn by --page; repeatable"},
      {"--live", "FILE.js", {}, "Embed the solvers in WebAssembly (./run playground), so that the page decides other queries"},
      // clang-format on
  };
}

/// Two options of a command that exclude each other, or one that needs the other.
struct Relation {
  std::string_view command;
  std::string_view option;
  std::string_view other;
  bool needs = false;
};

constexpr auto relations = std::to_array<Relation>({
    {"certify", "--seconds", "--shard"},
    {"certify", "--baseline", "--shard"},
    {"certify", "--write-baseline", "--baseline", true},
    {"generate", "--degree", "--family"},
    {"generate", "--patches", "--family"},
    {"generate", "--patches", "--degree"},
    {"step", "--earliest", "--all"},
    {"step", "--free", "--all"},
    {"step", "--free", "--earliest"},
    {"step", "--alpha", "--t-max"},
    {"bench", "--step", "PATH"},
    {"bench", "--from", "PATH"},
    {"bench", "--level", "PATH"},
    {"bench", "--family", "PATH"},
});

/// Options about contact, of a command or of all.
constexpr auto about_contact = std::to_array<std::pair<std::string_view, std::string_view>>(
    {{"", "--min-separation"}, {"certify", "--view"}, {"fuzz", "--view"}});

bool is_about_contact(std::string_view command, std::string_view option) {
  return std::ranges::any_of(about_contact, [&](const auto& of) {
    return of.second == option && (of.first.empty() || of.first == command);
  });
}

}  // namespace

bool OptionRow::is_of(std::string_view command, std::string_view option) const {
  return std::string_view(name).substr(0, name.find_first_of(",{")) == option &&
         (commands.empty() || commands == command);
}

const std::vector<OptionRow>& option_table() {
  static const std::vector<OptionRow> table = make_table();
  return table;
}

const OptionRow& option_row(std::string_view command, std::string_view option) {
  const auto row = std::ranges::find_if(
      option_table(), [&](const OptionRow& one) { return one.is_of(command, option); });
  if (row != option_table().end()) return *row;
  throw std::logic_error(fmt::format("{} of {} is not in the table of options", option, command));
}

std::string fault_of_value(const Values& values, const std::string& text) {
  if (const auto* whole = std::get_if<Whole>(&values)) {
    const auto value = io::number_from_text<std::uint64_t>(text);
    if (value && *value >= whole->least && *value <= whole->greatest) return {};
    return fmt::format("{} is not a whole number from {} to {}", text, whole->least,
                       whole->greatest);
  }
  if (const auto* real = std::get_if<Real>(&values)) {
    const auto value = io::number_from_text<double>(text);
    if (value && *value >= real->least && *value <= real->greatest) return {};
    return fmt::format("{} is not a number from {} to {}", text, real->least, real->greatest);
  }
  if (const auto* one_of = std::get_if<OneOf>(&values)) {
    if (std::ranges::find(one_of->words, text) != one_of->words.end()) return {};
    return fmt::format("{} not in {{{}}}", text, fmt::join(one_of->words, ","));
  }
  if (std::holds_alternative<Text>(values) || data::distance_from_text(text)) return {};
  return fmt::format("{} must be a finite number ≥ 0", text);
}

// ---- The parser ---------------------------------------------------------------------------------

namespace {

using Words = std::vector<std::string>;

template <class Number>
void read(const OptionRow& /*row*/, const std::string& word, Number& number) {
  number = io::number_from_text<Number>(word).value();
}
void read(const OptionRow& row, const std::string& word, double& number) {
  // CLI11 would round twice.
  number = std::holds_alternative<Distance>(row.values)
               ? data::distance_from_text(word).value()
               : io::number_from_text<double>(word).value();
}
void read(const OptionRow& row, const std::string& word, std::optional<double>& number) {
  read(row, word, number.emplace());
}
void read(const OptionRow& /*row*/, const std::string& word, std::string& text) { text = word; }
void read(const OptionRow& /*row*/, const std::string& word, std::filesystem::path& path) {
  path = word;
}

void read_all(const OptionRow& row, const Words& words, auto& value) {
  read(row, words.at(0), value);
}
template <class Value>
void read_all(const OptionRow& row, const Words& words, std::vector<Value>& values) {
  values.clear();
  for (const std::string& word : words) read(row, word, values.emplace_back());
}
using Pairs = std::vector<std::pair<std::string, std::string>>;
void read_all(const OptionRow& /*row*/, const Words& words, Pairs& pairs) {
  pairs.clear();
  for (std::size_t i = 0; i + 1 < words.size(); i += 2) pairs.emplace_back(words[i], words[i + 1]);
}

template <class Value>
constexpr bool is_vector = false;
template <class Value>
constexpr bool is_vector<std::vector<Value>> = true;

/// Shows the variable's value as the default, if the option takes it.
template <class Value>
void show_default(CLI::Option& option, const OptionRow& row, const Value& value) {
  if constexpr (std::is_arithmetic_v<Value> || std::is_same_v<Value, std::string>) {
    std::ostringstream text;
    text << value;
    const bool is_text = std::holds_alternative<Text>(row.values);
    if (!is_text && fault_of_value(row.values, text.str()).empty()) option.default_str(text.str());
  }
}

template <class Value>
CLI::Option* added(CLI::App& command, const OptionRow& row, Value* value) {
  CLI::Option* const option = command.add_option(
      row.name,
      [&row, value](const Words& words) {
        read_all(row, words, *value);
        return true;
      },
      row.text);
  if constexpr (std::is_same_v<Value, Pairs>) option->type_size(2);
  if constexpr (is_vector<Value>) option->expected(CLI::detail::expected_max_vector_size);
  show_default(*option, row, *value);
  return option;
}
CLI::Option* added(CLI::App& command, const OptionRow& row, std::string* value) {
  if (row.name.ends_with('}')) return command.add_flag(row.name, *value, row.text);
  return added<std::string>(command, row, value);
}
CLI::Option* added(CLI::App& command, const OptionRow& row, bool* value) {
  return command.add_flag(row.name, *value, row.text);
}
CLI::Option* added(CLI::App& command, const OptionRow& row, const std::function<void()>& action) {
  return command.add_flag_callback(row.name, action, row.text);
}

/// Gives the option the properties of its row.
void finish_option(CLI::Option* option, const OptionRow& row) {
  const bool is_flag = option->get_expected_min() == 0;
  if (!is_flag) option->type_name(row.type);
  if (!std::holds_alternative<Text>(row.values)) {
    option->check([&row](const std::string& text) { return fault_of_value(row.values, text); }, "");
  }
  if (row.form == OptionForm::required) option->required();
  if (row.form == OptionForm::pair) option->expected(2);
  if (row.form == OptionForm::usual && option->get_expected_max() > 1)
    option->allow_extra_args(false);
}

/// Lets the option exclude and need those that the command has already.
void relate(CLI::App& command, std::string_view name) {
  for (const Relation& relation : relations) {
    if (relation.command != command.get_name()) continue;
    if (name != relation.option && name != relation.other) continue;
    CLI::Option* const option = command.get_option_no_throw(std::string(relation.option));
    CLI::Option* const other = command.get_option_no_throw(std::string(relation.other));
    if (option == nullptr || other == nullptr) continue;
    if (relation.needs) {
      option->needs(other);
    } else {
      option->excludes(other);
    }
  }
}

}  // namespace

Command* add_command(Command& program, const std::string& name, const std::string& description) {
  return program.add_subcommand(name, description);
}

void begin_group(Command& command, const std::string& name) {
  command.option_defaults()->group(name);
}

void add_option(Command& command, std::string_view name, const Target& target) {
  const OptionRow& row = option_row(command.get_name(), name);
  finish_option(std::visit([&](const auto& of) { return added(command, row, of); }, target), row);
  relate(command, name);
}

void set_action(Command& command, const std::function<void()>& action) { command.callback(action); }

std::string name_of(const Command& command) { return command.get_name(); }

bool is_given(const Command& command, const std::string& option) {
  const CLI::Option* const found = command.get_option_no_throw(option);
  return found != nullptr && found->count() != 0;
}

std::vector<std::pair<std::string, std::string>> given_options(const Command& command) {
  std::vector<std::pair<std::string, std::string>> given;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& value : option->results())
      given.emplace_back(option->get_name(), value);
  }
  return given;
}

void require_kind(const Command& command, AnyKind kind, const std::filesystem::path& file) {
  const std::string& name = command.get_name();
  const auto refuse = [&](std::string_view what, std::string_view way_out) {
    throw std::invalid_argument(
        fmt::format("{}{} takes vertex-face and edge-edge alone, not a {}: {}{}",
                    file.empty() ? "" : file.string() + ": ", what, to_string(kind), way_out,
                    file.empty() ? "choose another --kind" : "name other files"));
  };
  if (!kind.is_cell()) return;
  for (const auto& [option, value] : given_options(command)) {
    // A distance of 0 is contact itself.
    if (!is_about_contact(name, option) || data::distance_from_text(value) == 0.0) continue;
    refuse(option, "leave it out, or ");
  }
  const Values& kinds = option_row(name, "--kind").values;
  if (!fault_of_value(kinds, std::string(to_string(kind))).empty()) refuse(name, "");
}

// ---- Help ---------------------------------------------------------------------------------------

namespace {

/// The longest line, in characters.
constexpr std::size_t help_width = 100;
/// The column of the descriptions of options.
constexpr std::size_t description_column = 26;
/// The separator between examples and notes in a footer, because CLI11 stores one text for both.
constexpr char separator = '\f';

std::string heading(std::string_view text) { return "\n" + std::string(text) + ":\n"; }

/// The text in lines of at most `help_width` characters, broken between words; the first line
/// begins at column `start`, the others are indented by `indent`.
std::string wrapped(std::string_view text, std::size_t start, std::size_t indent) {
  std::string result, word;
  std::size_t column = start;
  for (std::istringstream words{std::string(text)}; words >> word;) {
    const bool is_first = result.empty();
    if (!is_first && column + 1 + word.size() > help_width) {
      result += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (!is_first) {
      result += ' ';
      ++column;
    }
    result += word;
    column += word.size();
  }
  return result;
}

class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode /*mode*/) const override {
    const std::string footer = app->get_footer();
    const std::size_t end = std::min(footer.find(separator), footer.size());
    std::string help = wrapped(app->get_description(), 0, 0) +
                       "\n\nExample: " + footer.substr(0, end) + "\n\n" + usage(*app, name);
    for (const std::string& group : app->get_groups()) help += options_of(*app, group);
    help += make_subcommands(app, CLI::AppFormatMode::Normal);
    return help + "\n" + notes(footer.substr(std::min(end + 1, footer.size())));
  }

  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    return entry("  " + make_option_name(option, is_positional) + make_option_opts(option),
                 make_option_desc(option));
  }

  std::string make_option_opts(const CLI::Option* option) const override {
    std::string text = option->get_type_name().empty() ? "" : " " + option->get_type_name();
    if (!option->get_default_str().empty()) text += "=" + option->get_default_str();
    return option->get_required() ? text + " (required)" : text;
  }

  std::string make_subcommand(const CLI::App* command) const override {
    return entry("  " + command->get_name(), command->get_description());
  }

 private:
  [[nodiscard]] std::string usage(const CLI::App& app, const std::string& name) const {
    const std::string line = make_usage(&app, name);
    return line.substr(line.find_first_not_of('\n'));
  }

  /// A subcommand's help omits the help option itself, and options without a group.
  [[nodiscard]] std::string options_of(const CLI::App& app, const std::string& group) const {
    if (group.empty()) return {};
    std::string lines;
    for (const CLI::Option* option : app.get_options()) {
      if (option->get_group() != group) continue;
      if (option == app.get_help_ptr() && app.get_parent() != nullptr) continue;
      lines += make_option(option, !option->nonpositional());
    }
    return lines.empty() ? lines : heading(group) + lines;
  }

  static std::string entry(std::string name, const std::string& description) {
    const bool fits = name.size() + 1 < description_column;
    name += fits ? std::string(description_column - name.size(), ' ')
                 : "\n" + std::string(description_column, ' ');
    return name + wrapped(description, description_column, description_column) + "\n";
  }

  static std::string notes(const std::string& text) {
    std::string result, line;
    for (std::istringstream lines(text); std::getline(lines, line);)
      result += wrapped(line, 0, 0) + "\n";
    return result;
  }
};

}  // namespace

void set_help(Command& command, std::string_view examples, std::string_view notes) {
  std::string text(examples);
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1)) {
    text.insert(at + 1, std::string("Example: ").size(), ' ');
  }
  command.footer(text + separator + std::string(notes));
}

namespace {

/// The reason of an error of usage, also of an option that takes one value and is given twice.
std::string reason_of(const CLI::Error& error) {
  const std::string reason = error.what();
  const std::size_t end = reason.find(": At Most 1 required but received ");
  return end == std::string::npos ? reason : reason.substr(0, end) + " is given more than once";
}

}  // namespace

Status run_command_line(int argc, char** argv) {
  CLI::App app{
      "Exact ground truth, verified solvers and test tools for continuous collision detection",
      "touchstone"};
  app.formatter(std::make_shared<HelpFormatter>());
  app.set_help_flag("-h,--help", "Print this help");
  set_help(
      app, "touchstone certify path/to/queries",
      "touchstone COMMAND --help describes a command.\n"
      "Exit status: 0 success, 1 wrong answers, collisions or intersections, 2 bad input or usage, "
      "130 interrupted.");
  app.set_version_flag("--version", std::string(version()), "Print the version");
  // The message quotes the command line.
  app.failure_message([](const CLI::App*, const CLI::Error& error) {
    return io::printable(reason_of(error)) + "\nRun with --help for more information.\n";
  });
  app.require_subcommand(0, 1);
  Status status = Status::all_well;
  add_commands(app, status);
  const auto is_named = [&](const CLI::App* command) { return command->check_name(argv[1]); };
  if (argc > 1 && argv[1][0] != '-' && app.get_subcommands(is_named).empty()) {
    report_error(fmt::format("no command {}; touchstone --help lists them", argv[1]));
    return Status::bad_input;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // Help and version are exceptions too.
    std::ostringstream help, reason;
    const int code = app.exit(error, help, reason);
    io::print(stdout, help.str());
    io::print(stderr, reason.str());
    return code == 0 ? Status::all_well : Status::bad_input;
  }
  if (app.get_subcommands().empty()) {
    io::print(stderr, app.help());
    return Status::bad_input;
  }
  return status;
}

}  // namespace touchstone::verify::cli
