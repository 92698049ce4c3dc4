#pragma once

/// \file
/// Runs over queries on Bézier curves: of `touchstone curved`, and of certify, prove and solve
/// where their files have such queries.

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "fast/method.hpp"
#include "verify/cli/commands.hpp"
#include "verify/cli/options.hpp"
#include "verify/cli/solver_options.hpp"
#include "verify/cli/sources.hpp"

namespace touchstone::verify::cli {

struct CurvedArguments {
  std::vector<std::filesystem::path> paths;
  std::string kind;
  SeparationArguments separation;
  std::uint64_t count = 1000;
  std::uint64_t seed = default_seed;
  bool judges_others = false;
  SolverArguments judged = {};  ///< plugins
  unsigned threads = 0;
  std::string truth_file;
  std::string proof_file;
  std::string json_file;
};

/// Decides the queries of the files, or of families of known truth, judges the certified solver,
/// and writes what the arguments name.
[[nodiscard]] Status run_curves(const CurvedArguments& arguments);

/// The same for files, with the answers of a method as `solve` writes them: "certified", or
/// "tight_inclusion" for curves of degree 2 or 3.
/// \throws std::invalid_argument for another method, or one that does not answer such queries.
[[nodiscard]] Status solve_curves(const CurvedArguments& arguments, std::string_view method,
                                  const fast::MethodOptions& options, const std::string& out_file);

/// True if the files of the sources have queries on curves.
/// \throws std::invalid_argument if only some of them do.
[[nodiscard]] bool have_curves(const SourceArguments& sources);

/// \throws std::invalid_argument that names an option of the command line which is not among those
/// that apply to queries on curves.
void refuse_for_curves(const CLI::App& command, const std::vector<std::string>& options);

/// The arguments for such files. \param options Those of the command that apply, besides those of
/// sources. \throws as refuse_for_curves.
[[nodiscard]] CurvedArguments curved_arguments(const CLI::App& command,
                                               const SourceArguments& sources,
                                               std::vector<std::string> options);

}  // namespace touchstone::verify::cli
