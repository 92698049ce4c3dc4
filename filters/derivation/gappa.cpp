#include "filters/derivation/gappa.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <regex>
#include <string_view>
#include <system_error>

namespace touchstone::filters {
namespace {

// ---- Script -------------------------------------------------------------------------------------

/// An exact number in Gappa's spelling: "<integer>b<exponent of two>".
std::string dyadic(const mpq_class& x) {
  const mp_bitcnt_t exponent = mpz_scan1(x.get_den_mpz_t(), 0);
  if (x.get_den() != mpz_class(1) << exponent) {
    throw std::invalid_argument("gappa: " + x.get_str() + " is no dyadic number");
  }
  return fmt::format("{}b-{}", x.get_num().get_str(), exponent);
}

std::string polynomial(const ExactValue& value) {
  std::string text;
  for (const ExactValue::Term& term : value.terms) {
    text += text.empty() ? "" : " + ";
    text += dyadic(term.coefficient);
    for (const std::size_t coordinate : term.monomial) text += fmt::format(" * x{}", coordinate);
  }
  return text.empty() ? "0" : text;
}

/// A script in the making. Small letters are computed values, capital ones exact.
class Script {
 public:
  Script(const ExpressionGraph& graph, const Format& format, GappaGoal goal,
         const std::vector<int>& weights)
      : graph_(graph), weights_(weights), digits_(format.digits), goal_(goal) {
    const std::vector<ExactValue> values = expand(graph, weights);
    for (std::size_t place = 0; place < graph.nodes.size(); ++place) {
      add_input(graph.nodes[place]);
      if (is_input(place)) continue;
      define_computed(place);
      if (goal != GappaGoal::rounding) continue;
      define_exact(place, values[place]);
      add_cancellation(place, values);
    }
  }

  [[nodiscard]] std::string text(const std::optional<mpq_class>& bound) const {
    const std::string error = goal_ == GappaGoal::underflow
                                  ? computed(graph_.result)
                                  : computed(graph_.result) + " - " + exact(graph_.result);
    return fmt::format("{}{{ {}\n->\n  |{}| {} }}\n{}", definitions_, ranges_, error,
                       bound ? "<= " + dyadic(*bound) : "in ?", rules_);
  }

 private:
  [[nodiscard]] bool is_input(std::size_t place) const {
    const Operation operation = graph_.nodes[place].operation;
    return operation == Operation::coordinate || operation == Operation::weight;
  }

  [[nodiscard]] std::string computed(std::size_t place) const {
    const Node& node = graph_.nodes[place];
    if (node.operation == Operation::coordinate) return fmt::format("x{}", node.left);
    if (node.operation == Operation::weight) return fmt::format("w{}", node.left);
    return fmt::format("n{}", place);
  }

  [[nodiscard]] std::string exact(std::size_t place) const {
    const Node& node = graph_.nodes[place];
    if (node.operation == Operation::coordinate) return computed(place);
    if (node.operation == Operation::weight) return fmt::format("({})", weights_[node.left]);
    return fmt::format("N{}", place);
  }

  /// An operation on the operands as they are named.
  [[nodiscard]] static std::string plain(Operation operation, std::string_view a,
                                         std::string_view b) {
    const char sign = operation == Operation::multiply ? '*' : sum_sign(operation);
    return fmt::format("{} {} {}", a, sign, b);
  }

  [[nodiscard]] static char sum_sign(Operation operation) {
    return operation == Operation::subtract ? '-' : '+';
  }

  void add_range(std::string_view name, std::string_view range) {
    ranges_ += fmt::format("{}{} in [{}]", ranges_.empty() ? "" : " /\\ ", name, range);
  }

  void add_input(const Node& node) {
    if (node.operation == Operation::coordinate) {
      add_range(fmt::format("x{}", node.left), goal_ == GappaGoal::rounding ? "-1,1" : "0,0");
    } else if (node.operation == Operation::weight) {
      const int value = weights_[node.left];
      add_range(fmt::format("w{}", node.left), fmt::format("{},{}", value, value));
    }
  }

  void define_computed(std::size_t place) {
    const auto& [operation, left, right] = graph_.nodes[place];
    const bool multiplies = operation == Operation::multiply;
    const std::string_view function = multiplies                         ? "mul_rel"
                                      : operation == Operation::subtract ? "sub_rel"
                                                                         : "add_rel";
    definitions_ += fmt::format("n{} = {}<{}>({}, {})", place, function, digits_, computed(left),
                                computed(right));
    if (multiplies && goal_ == GappaGoal::underflow) {
      definitions_ += fmt::format(" + e{}", place);
      add_range(fmt::format("e{}", place), "-1,1");
    }
    definitions_ += ";\n";
  }

  void define_exact(std::size_t place, const ExactValue& value) {
    const auto& [operation, left, right] = graph_.nodes[place];
    definitions_ += fmt::format("N{} = {};\n", place, plain(operation, exact(left), exact(right)));
    rules_ += fmt::format("N{} -> {};\n", place, polynomial(value));
  }

  /// A sum's rounding error is relative to the sum of the computed operands. Where things cancel,
  /// that is best bounded by the exact sum and the operands' errors.
  void add_cancellation(std::size_t place, const std::vector<ExactValue>& values) {
    const auto& [operation, left, right] = graph_.nodes[place];
    if (operation == Operation::multiply) return;
    if (values[place].magnitude() == values[left].magnitude() + values[right].magnitude()) return;
    rules_ += fmt::format("{} -> N{} + (({} - {}) {} ({} - {}));\n",
                          plain(operation, computed(left), computed(right)), place, computed(left),
                          exact(left), sum_sign(operation), computed(right), exact(right));
  }

  const ExpressionGraph& graph_;
  const std::vector<int>& weights_;
  int digits_;
  GappaGoal goal_;
  std::string definitions_, ranges_, rules_;
};

std::string introduction(const ExpressionGraph& graph, const Format& format, GappaGoal goal) {
  std::string text = fmt::format("# {} in {}: ", graph.name, format.name);
  text += goal == GappaGoal::rounding
              ? "rounding errors for coordinates up to 1.\n"
              : "what underflow adds, in units of half the least subnormal.\n";
  text +=
      "# The error is convex in each group of weights: it is greatest at a vertex of the groups.\n"
      "# This is one of the vertices. n: computed, N: exact.\n";
  text +=
      goal == GappaGoal::rounding
          ? "# The model has no least exponent, so that the bound scales with the coordinates:\n"
            "# proved for 1 it is proved for every x, times x to the expression's degree.\n"
          : "# The value is linear in coordinates and underflows (degree 1), so that the "
            "coordinates\n# may be 0 here: their part is the other script.\n";
  return text;
}

void require_degree_one(const ExpressionGraph& graph, const Format& format) {
  if (derive_bound(graph, format).coefficients.size() != 2) {
    throw std::invalid_argument("expression " + graph.name +
                                ": underflow is proved apart only where the degree is 1");
  }
}

// ---- Process ------------------------------------------------------------------------------------

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

[[noreturn]] void fail(int error, const std::string& what) {
  throw std::system_error(error, std::generic_category(), what);
}

/// A file without a name. Files rather than pipes: nobody waits for the other to read.
File temporary_file() {
  File file(std::tmpfile(), std::fclose);
  if (!file) fail(errno, "gappa: no temporary file");
  return file;
}

std::string contents(std::FILE* file) {
  std::string text;
  std::array<char, 4096> block{};
  std::rewind(file);
  for (std::size_t length = 1; length > 0;) {
    length = std::fread(block.data(), 1, block.size(), file);
    text.append(block.data(), length);
  }
  return text;
}

pid_t start_gappa(std::FILE* input, std::FILE* output) {
  std::string program = "gappa", precision = "-Eprecision=256";
  const std::array<char*, 3> arguments{program.data(), precision.data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, fileno(input), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(output), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(output), STDERR_FILENO);
  pid_t process = 0;
  const int error =
      posix_spawnp(&process, program.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error == ENOENT) {
    throw GappaMissing("gappa: not found; install the Debian package gappa");
  }
  if (error != 0) fail(error, "gappa: cannot be started");
  return process;
}

int exit_status(pid_t process) {
  int status = 0;
  while (waitpid(process, &status, 0) < 0) {
    if (errno != EINTR) fail(errno, "gappa: lost");
  }
  if (!WIFEXITED(status)) throw std::runtime_error("gappa: ended by a signal");
  return WEXITSTATUS(status);
}

/// The upper end of the interval that Gappa prints as its answer.
std::optional<mpq_class> answered_bound(const std::string& output) {
  static const std::regex interval(R"( in \[[^\n]*, (-?[0-9]+)(b(-?[0-9]+))?( \{[^}\n]*\})?\]\n)");
  std::smatch match;
  if (!std::regex_search(output, match, interval)) return std::nullopt;
  mpq_class value(match[1].str());
  const long exponent = match[3].matched ? std::stol(match[3].str()) : 0;
  const auto shift = static_cast<mp_bitcnt_t>(std::abs(exponent));
  if (exponent < 0) {
    value >>= shift;
  } else {
    value <<= shift;
  }
  return value;
}

}  // namespace

std::string gappa_script(const ExpressionGraph& graph, const Format& format, GappaGoal goal,
                         const std::vector<int>& weights, const std::optional<mpq_class>& bound) {
  if (goal == GappaGoal::underflow) require_degree_one(graph, format);
  return introduction(graph, format, goal) + Script(graph, format, goal, weights).text(bound);
}

GappaAnswer run_gappa(const std::string& script) {
  const File input = temporary_file(), output = temporary_file();
  if (std::fwrite(script.data(), 1, script.size(), input.get()) != script.size() ||
      std::fflush(input.get()) != 0) {
    fail(errno, "gappa: script cannot be written");
  }
  std::rewind(input.get());
  const int status = exit_status(start_gappa(input.get(), output.get()));
  GappaAnswer answer{.proved = status == 0, .bound = {}, .output = contents(output.get())};
  if (answer.proved) answer.bound = answered_bound(answer.output);
  return answer;
}

std::optional<mpq_class> gappa_bound(const ExpressionGraph& graph, const Format& format,
                                     GappaGoal goal) {
  mpq_class greatest;
  for (const std::vector<int>& weights : graph.weight_vertices()) {
    const GappaAnswer answer = run_gappa(gappa_script(graph, format, goal, weights));
    if (!answer.bound) return std::nullopt;
    greatest = std::max(greatest, *answer.bound);
  }
  return greatest;
}

bool gappa_proves(const ExpressionGraph& graph, const Format& format, GappaGoal goal,
                  const mpq_class& bound) {
  return std::ranges::all_of(graph.weight_vertices(), [&](const std::vector<int>& weights) {
    return run_gappa(gappa_script(graph, format, goal, weights, bound)).proved;
  });
}

}  // namespace touchstone::filters
