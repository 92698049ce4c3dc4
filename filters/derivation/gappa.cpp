#include "touchstone/derivation/gappa.hpp"

#include <fmt/format.h>
#ifndef _WIN32
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#endif

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <map>
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

/// A script under construction. Small letters are computed values, capital ones exact values. Names
/// are numbered in the order of a traversal from the result down.
class Script {
 public:
  Script(const ExpressionGraph& graph, const Format& format, GappaGoal goal,
         const std::vector<int>& weights)
      : graph_(graph),
        weights_(weights),
        digits_(format.digits),
        goal_(goal),
        values_(expand(graph, weights)),
        numbers_(graph.nodes.size()) {
    define(graph.result);
  }

  [[nodiscard]] std::string text(const std::optional<mpq_class>& bound) const {
    const std::string error = goal_ == GappaGoal::underflow
                                  ? computed(graph_.result)
                                  : computed(graph_.result) + " - " + exact(graph_.result);
    return fmt::format("{}{{ {}\n->\n  |{}| {} }}\n{}", definitions_, ranges_, error,
                       bound ? "<= " + dyadic(*bound) : "in ?", rules_);
  }

 private:
  [[nodiscard]] bool is_zero_weight(std::size_t place) const {
    const Node& node = graph_.nodes[place];
    return node.operation == Operation::weight && weights_[node.left] == 0;
  }

  /// True for a product with a weight that is 0. Its computed value is 0, as its exact one, for any
  /// error (in a format without a least exponent).
  [[nodiscard]] bool vanishes(std::size_t place) const {
    const auto& [operation, left, right] = graph_.nodes[place];
    return goal_ == GappaGoal::rounding && operation == Operation::multiply &&
           (is_zero_weight(left) || is_zero_weight(right));
  }

  // ---- Names ----

  [[nodiscard]] std::string computed(std::size_t place) const {
    const Operation operation = graph_.nodes[place].operation;
    const char letter = operation == Operation::coordinate ? 'x'
                        : operation == Operation::weight   ? 'w'
                                                           : 'n';
    return fmt::format("{}{}", letter, *numbers_[place]);
  }

  [[nodiscard]] std::string exact(std::size_t place) const {
    const Node& node = graph_.nodes[place];
    if (node.operation == Operation::coordinate) return computed(place);
    if (node.operation == Operation::weight) return fmt::format("({})", weights_[node.left]);
    return vanishes(place) ? "0" : fmt::format("N{}", *numbers_[place]);
  }

  /// The sum of the terms, in an order that depends on the names alone.
  [[nodiscard]] std::string polynomial(const ExactValue& value) const {
    std::vector<std::string> terms;
    for (const ExactValue::Term& term : value.terms) {
      std::vector<std::string> factors;
      for (const std::size_t coordinate : term.monomial) {
        factors.push_back(coordinate_names_.at(coordinate));
      }
      std::ranges::sort(factors);
      terms.push_back(fmt::format("{} * {}", fmt::join(factors, " * "), dyadic(term.coefficient)));
    }
    std::ranges::sort(terms);
    return terms.empty() ? "0" : fmt::format("{}", fmt::join(terms, " + "));
  }

  /// An operation on the named operands.
  [[nodiscard]] static std::string plain(Operation operation, std::string_view a,
                                         std::string_view b) {
    const char sign = operation == Operation::multiply ? '*' : sum_sign(operation);
    return fmt::format("{} {} {}", a, sign, b);
  }

  [[nodiscard]] static char sum_sign(Operation operation) {
    return operation == Operation::subtract ? '-' : '+';
  }

  // ---- Definitions ----

  /// The operands of a node. In a sum a zero comes last, whatever its original place.
  [[nodiscard]] std::pair<std::size_t, std::size_t> operands(std::size_t place) const {
    const auto& [operation, left, right] = graph_.nodes[place];
    if (operation == Operation::add && vanishes(left)) return {right, left};
    return {left, right};
  }

  /// Defines a node after its operands.
  void define(std::size_t place) {
    if (numbers_[place]) return;
    const Operation operation = graph_.nodes[place].operation;
    if (operation == Operation::coordinate || operation == Operation::weight) {
      add_input(place);
    } else if (vanishes(place)) {
      numbers_[place] = next_number_++;
      add_range(computed(place), "0,0");
    } else {
      const auto [left, right] = operands(place);
      define(left);
      define(right);
      numbers_[place] = next_number_++;
      define_computed(place);
      if (goal_ != GappaGoal::rounding) return;
      definitions_ +=
          fmt::format("{} = {};\n", exact(place), plain(operation, exact(left), exact(right)));
      add_cancellation(place);
    }
  }

  void add_range(std::string_view name, std::string_view range) {
    ranges_ += fmt::format("{}{} in [{}]", ranges_.empty() ? "" : " /\\ ", name, range);
  }

  void add_input(std::size_t place) {
    const Node& node = graph_.nodes[place];
    numbers_[place] = next_number_++;
    if (node.operation == Operation::coordinate) {
      coordinate_names_[node.left] = computed(place);
      add_range(computed(place), goal_ == GappaGoal::rounding ? "-1,1" : "0,0");
    } else {
      const int value = weights_[node.left];
      add_range(computed(place), fmt::format("{},{}", value, value));
    }
  }

  void define_computed(std::size_t place) {
    const Operation operation = graph_.nodes[place].operation;
    const auto [left, right] = operands(place);
    const bool multiplies = operation == Operation::multiply;
    const std::string_view function = multiplies                         ? "mul_rel"
                                      : operation == Operation::subtract ? "sub_rel"
                                                                         : "add_rel";
    definitions_ += fmt::format("{} = {}<{}>({}, {})", computed(place), function, digits_,
                                computed(left), computed(right));
    if (multiplies && goal_ == GappaGoal::underflow) {
      const std::string underflow = fmt::format("e{}", *numbers_[place]);
      definitions_ += " + " + underflow;
      add_range(underflow, "-1,1");
    }
    definitions_ += ";\n";
  }

  /// Writes the remaining sum as a rule if terms cancel. A sum's rounding error is relative to the
  /// sum of the computed operands, and in this case the best bound of that sum is the exact sum
  /// plus the operands' errors.
  void add_cancellation(std::size_t place) {
    const Operation operation = graph_.nodes[place].operation;
    const auto [left, right] = operands(place);
    const bool multiplies = operation == Operation::multiply;
    const mpq_class of_left = values_[left].magnitude(), of_right = values_[right].magnitude();
    const mpq_class product = of_left * of_right, sum = of_left + of_right;
    if (values_[place].magnitude() == (multiplies ? product : sum)) return;
    rules_ += fmt::format("{} -> {};\n", exact(place), polynomial(values_[place]));
    if (multiplies) return;
    rules_ +=
        fmt::format("{} -> {} + (({} - {}) {} ({} - {}));\n",
                    plain(operation, computed(left), computed(right)), exact(place), computed(left),
                    exact(left), sum_sign(operation), computed(right), exact(right));
  }

  const ExpressionGraph& graph_;
  const std::vector<int>& weights_;
  int digits_;
  GappaGoal goal_;
  std::vector<ExactValue> values_;
  std::size_t next_number_ = 0;
  std::vector<std::optional<std::size_t>> numbers_;  ///< of the nodes, once they are defined
  std::map<std::size_t, std::string> coordinate_names_;
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

#ifndef _WIN32
using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

[[noreturn]] void fail(int error, const std::string& what) {
  throw std::system_error(error, std::generic_category(), what);
}

/// A file without a name. With files instead of pipes, neither process waits for the other to read.
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

[[noreturn]] void miss_gappa() {
  throw GappaMissing("gappa: not found; install the Debian package gappa");
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
  if (error == ENOENT) miss_gappa();
  if (error != 0) fail(error, "gappa: cannot be started");
  return process;
}

/// The kernel ends the process by SIGXCPU at the end of its time.
void limit_time(pid_t process, std::chrono::seconds limit) {
  const auto seconds = static_cast<rlim_t>(limit.count());
  const rlimit of_processor{.rlim_cur = seconds, .rlim_max = seconds + 1};
  if (prlimit(process, RLIMIT_CPU, &of_processor, nullptr) != 0 && errno != ESRCH) {
    fail(errno, "gappa: its time cannot be limited");
  }
}

/// The exit status; empty if the time was up.
std::optional<int> exit_status(pid_t process) {
  int status = 0;
  while (waitpid(process, &status, 0) < 0) {
    if (errno != EINTR) fail(errno, "gappa: lost");
  }
  // The child's status if posix_spawnp() cannot report that the program is missing (POSIX).
  constexpr int not_found = 127;
  if (WIFEXITED(status) && WEXITSTATUS(status) == not_found) miss_gappa();
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) return std::nullopt;
  throw std::runtime_error("gappa: ended by a signal");
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
#endif

}  // namespace

std::string gappa_script(const ExpressionGraph& graph, const Format& format, GappaGoal goal,
                         const std::vector<int>& weights, const std::optional<mpq_class>& bound) {
  if (goal == GappaGoal::underflow) require_degree_one(graph, format);
  return introduction(graph, format, goal) + Script(graph, format, goal, weights).text(bound);
}

std::set<std::string> gappa_scripts(const ExpressionGraph& graph, const Format& format,
                                    GappaGoal goal, const std::optional<mpq_class>& bound) {
  std::set<std::string> scripts;
  for (const std::vector<int>& weights : graph.weight_vertices()) {
    scripts.insert(gappa_script(graph, format, goal, weights, bound));
  }
  return scripts;
}

#ifdef _WIN32
GappaAnswer run_gappa(const std::string& /*script*/, std::chrono::seconds /*limit*/) {
  throw GappaMissing("gappa: run on systems with POSIX alone");
}
#else
GappaAnswer run_gappa(const std::string& script, std::chrono::seconds limit) {
  const File input = temporary_file(), output = temporary_file();
  if (std::fwrite(script.data(), 1, script.size(), input.get()) != script.size() ||
      std::fflush(input.get()) != 0) {
    fail(errno, "gappa: script cannot be written");
  }
  std::rewind(input.get());
  const pid_t process = start_gappa(input.get(), output.get());
  limit_time(process, limit);
  const std::optional<int> status = exit_status(process);
  GappaAnswer answer{.proved = status == 0, .bound = {}, .output = contents(output.get())};
  if (answer.proved) answer.bound = answered_bound(answer.output);
  return answer;
}
#endif

std::optional<mpq_class> gappa_bound(const ExpressionGraph& graph, const Format& format,
                                     GappaGoal goal) {
  mpq_class greatest;
  for (const std::string& script : gappa_scripts(graph, format, goal)) {
    const GappaAnswer answer = run_gappa(script);
    if (!answer.bound) return std::nullopt;
    greatest = std::max(greatest, *answer.bound);
  }
  return greatest;
}

bool gappa_proves(const ExpressionGraph& graph, const Format& format, GappaGoal goal,
                  const mpq_class& bound) {
  return std::ranges::all_of(gappa_scripts(graph, format, goal, bound),
                             [](const std::string& script) { return run_gappa(script).proved; });
}

}  // namespace touchstone::filters
