/// \file
/// libFuzzer on the command line: no words make its parser crash, hang, or throw anything but
/// errors with an exit status; and the shared options accept only the values that they promise.
///
/// The words are the lines of the input. The commands themselves are not run.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "touchstone/query.hpp"
#include "verify/cli/commands.hpp"
#include "verify/cli/options.hpp"
#include "verify/cli/solver_options.hpp"
#include "verify/cli/sources.hpp"

/// The build of the tool has a different definition.
std::string_view touchstone::verify::cli::version() { return "fuzzed"; }

namespace {

using namespace touchstone::verify::cli;

void require(bool holds) {
  if (!holds) std::abort();
}

/// The words in the order of CLI11: the last one first.
std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    words.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return {words.rbegin(), words.rend()};
}

/// Parses a command line. True if it is valid.
bool parse(CLI::App& app, std::vector<std::string> words) {
  try {
    app.parse(words);
    return true;
  } catch (const CLI::ParseError& error) {
    require(!std::string_view(error.what()).empty() || error.get_exit_code() == 0);
    return false;
  }
}

/// A command that ends before its subcommand runs.
class ParsedOnly : public CLI::App {
 public:
  using CLI::App::App;

 protected:
  void pre_callback() override { throw CLI::Success(); }
};

/// Parses all subcommands. (Their callbacks stay, because they own the variables of the options.)
void parse_commands(const std::vector<std::string>& words) {
  ParsedOnly app{"fuzzed"};
  app.require_subcommand(1);
  Status status = Status::all_well;
  add_commands(app, status);
  parse(app, words);
}

/// Parses the options that commands share, and checks their values.
void parse_shared_options(const std::vector<std::string>& words) {
  CLI::App app{"fuzzed"};
  SourceArguments sources;
  SolverArguments solvers;
  add_source_options(app, sources);
  add_solver_options(app, solvers);
  if (!parse(app, words)) return;
  require(sources.count >= 1);
  require(std::isfinite(solvers.options.tolerance) && solvers.options.tolerance > 0.0);
  require(solvers.options.max_checks >= 0);
  require(solvers.query_limit >= 0.0 && solvers.query_limit <= 1e6);
  require(sources.kind.empty() ||
          to_string(touchstone::kind_from_string(sources.kind)) == sources.kind);
  require(touchstone::is_valid(sources.separation.given()));
  require(sources.separation.settle({}) == sources.separation.given());
  try {
    settle_solver_options(app, sources.built_in_set(), solvers);
  } catch (const std::invalid_argument&) {
    require(solvers.empty());
  }
}

}  // namespace

// The name is libFuzzer's.
// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::vector<std::string> words = words_of(std::string(data, data + size));
  parse_commands(words);
  parse_shared_options(words);
  return 0;
}
