#pragma once

/// \file
/// Runs over many machines and in pieces (verify/jobs/pieces.hpp): the options --shard and --resume
/// of commands, which run themselves as a process for each piece.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "verify/cli/commands.hpp"
#include "verify/cli/sources.hpp"
#include "verify/jobs/pieces.hpp"

namespace touchstone::verify::cli {

struct PieceArguments {
  std::string shard;             ///< "I/N", "auto" or empty
  std::filesystem::path folder;  ///< of the results; empty: no pieces
};

/// Adds --shard and --resume. The arguments must live until the command line is parsed.
void add_piece_options(CLI::App& command, PieceArguments& arguments);

/// The shard of the command line; "auto": of SLURM_ARRAY_TASK_ID and _COUNT if the array has the
/// tasks 0 to N-1, or of OMPI_COMM_WORLD_RANK and _SIZE.
/// \throws std::invalid_argument if it is none.
[[nodiscard]] Shard shard_of(const PieceArguments& arguments);

/// The run of a command in pieces.
struct PieceRun {
  /// The argument that pieces stand for.
  std::string input = "PATH";
  std::vector<jobs::Piece> pieces = {};
  /// Options that name output files.
  std::vector<std::string> outputs = {};
  /// Options that name other outputs, which pieces do not have.
  std::vector<std::string> refused = {};
};

/// Runs the unfinished pieces of the shard, in a process each, and merges the results if all are
/// there. Errors are reported on standard error. \pre arguments.folder is not empty
[[nodiscard]] Status run_pieces(const CLI::App& command, const PieceArguments& arguments,
                                const PieceRun& run);

/// Runs the command on the sources of its shard; with a folder in pieces, which are the sources.
/// \param in_pieces without pieces
[[nodiscard]] Status run_in_pieces(const CLI::App& command, const PieceArguments& arguments,
                                   SourceArguments& sources, PieceRun in_pieces,
                                   const std::function<Status()>& run);

/// Writes the results of all pieces as one, to the files that the run's command line named; a
/// summary goes to standard output. \param json_file Instead of the named JSON file, if not empty.
[[nodiscard]] Status merge_pieces(const std::filesystem::path& path, const std::string& json_file);

}  // namespace touchstone::verify::cli
