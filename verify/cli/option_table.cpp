#include "verify/cli/option_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cfloat>
#include <climits>
#include <memory>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "verify/cli/solver_options.hpp"
#include "verify/data/ground_truth_files.hpp"
#include "verify/io/number_text.hpp"
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
      {"PATH", "", {}, "Datasets (.csv, .npy), also of queries on curves, or folders of them, findings (.json of fuzz), certificates (.cert, .cert.zst), or eight lines of vertices (.obj)", "view", list},
      {"PATH", "", {}, "Dataset files (.csv, .npy) or folders; default: the built-in set", "", list},
      {"--kind", "KIND", kinds, "Only these queries; otherwise vertex-face and edge-edge", "fuzz"},
      {"--kind", "KIND", kinds, "Only these queries; otherwise vertex-face and edge-edge", "generate"},
      {"--kind", "KIND", contact, "vertex-face or edge-edge, if the input does not tell", "view"},
      {"--kind", "KIND", contact, "vertex-face or edge-edge, if the path does not tell", "bench"},
      {"--kind", "KIND", kinds, "vertex-face, edge-edge, or an element, if the path does not tell", "prove"},
      {"--kind", "KIND", kinds, "vertex-face, edge-edge, or an element, if the path does not tell; also: only these of the built-in set"},
      {"--round", "", {}, "Round coordinates of datasets that are not doubles", "view"},
      {"--round", "", {}, "Round coordinates that are not doubles, and count them"},
      {"--keep-going", "", {}, "Skip and count invalid queries and files (exit status 2)"},
      {"--threads", "N", Whole{0, INT_MAX}, "Cores to use (0: all)"},
      {"--seed", "N", Whole{}, "Seed of all queries", "fuzz"},
      {"--seed", "N", Whole{}, "Seed of the search for the worst error", "derive"},
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
      {"--most", "N", Whole{1, most_viewed_queries}, "Maximum number of queries", "view"},
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
      {"--shard", "I/N", {}, "Do part I of N, from 0 on (touchstone merge adds up the JSON of all); auto: as a Slurm array or mpirun says"},
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
      {"--model", "NAME", OneOf{{"gappa", "observed", "published", "rigorous"}}, "Columns to compute: published, rigorous, gappa, observed; repeatable", "derive", list},
      {"--precision", "NAME", OneOf{{"double", "float", "double_double"}}, "Only double, float or double_double"},
      {"--evaluations", "N", Whole{1}, "Evaluations of the search, for each row"},

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
      {"--emit", "FILE", {}, "Write the header of bounds (touchstone/filters/error_bounds.hpp)"},
      // clang-format on
  };
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

CLI::Option* finish_option(CLI::Option* option, const OptionRow& row) {
  const bool is_flag = option->get_expected_min() == 0;
  if (!is_flag) option->type_name(row.type);
  if (!std::holds_alternative<Text>(row.values)) {
    option->check([&row](const std::string& text) { return fault_of_value(row.values, text); }, "");
  }
  if (row.form == OptionForm::required) option->required();
  if (row.form == OptionForm::pair) option->expected(2);
  if (row.form == OptionForm::usual && option->get_expected_max() > 1)
    option->allow_extra_args(false);
  return option;
}

namespace {

/// The column of the descriptions of options.
constexpr std::size_t description_column = 26;
/// The separator between examples and notes in a footer, because CLI11 stores one text for both.
constexpr char separator = '\f';

std::string heading(std::string_view text) { return "\n" + std::string(text) + ":\n"; }

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

/// The number of missing, wrong and additional letters (the Levenshtein distance).
std::size_t distance_between(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = std::exchange(row[j], std::min({replaced, row[j] + 1, row[j - 1] + 1}));
    }
  }
  return row.back();
}

}  // namespace

std::string nearest_name(std::string_view word, const std::vector<std::string>& names) {
  static constexpr std::size_t farthest = 2;
  std::string nearest;
  std::size_t least = std::min(farthest + 1, word.size());
  for (const std::string& name : names) {
    const std::size_t distance = distance_between(word, name);
    if (distance >= least) continue;
    least = distance;
    nearest = name;
  }
  return nearest;
}

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

void set_help(CLI::App& command, std::string_view examples, std::string_view notes) {
  std::string text(examples);
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1)) {
    text.insert(at + 1, std::string("Example: ").size(), ' ');
  }
  command.footer(text + separator + std::string(notes));
}

void use_help_format(CLI::App& app) {
  app.formatter(std::make_shared<HelpFormatter>());
  app.set_help_flag("-h,--help", "Print this help");
}

}  // namespace touchstone::verify::cli
