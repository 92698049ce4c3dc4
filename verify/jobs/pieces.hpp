#pragma once

/// \file
/// A run in pieces, which any processes may do in any order, be killed, and go on.
///
/// The **plan** of a run is a file that all processes write alike: program, command, options, the
/// digests of the files that options name, and the pieces, each an input. A finished piece has a
/// **record**: the plan's digest, the piece's number, the digests of its inputs, which are the same
/// before and after the work, those of its outputs, its exit status, and a digest of all this. The
/// outputs lie in a folder that only this work has, which the record names; the record gets its
/// name when it is complete. A process that is killed at any moment loses only the piece in work;
/// anything that it or a child of it still writes is ignored.
///
/// The results of all pieces are merged only if the records prove that they are of this plan, that
/// each piece is there exactly once, and that inputs and outputs are unchanged; everything else is
/// an error that names the piece (the rule by which verified merges of proofs account for separate
/// runs: Tan, Heule and Myreen 2021, "cake_lpr: Verified Propagation Redundancy Checking in
/// CakeML", TACAS). The merged result consists of the outputs in the order of the plan, without
/// times; it does not depend on which process did which piece.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone::verify::jobs {

/// An input of its own.
struct Piece {
  std::string name;
  /// All files that its results depend on.
  std::vector<std::filesystem::path> files;
  /// The arguments that select this input on the command line.
  std::vector<std::string> arguments;
};

struct Plan {
  std::string program;                         ///< the version that makes the results
  std::string command;                         ///< the subcommand
  std::vector<std::string> options;            ///< all that results may depend on
  std::map<std::string, std::string> uses;     ///< digests of the files that options name
  std::map<std::string, std::string> outputs;  ///< the merged files, by their options
  std::vector<Piece> pieces;
};

/// The option whose output is JSON.
inline constexpr std::string_view json_option = "--json";

/// The results of a run, in a folder.
class PieceFolder {
 public:
  /// Begins the run, or goes on with it.
  /// \throws std::runtime_error if the folder has the results of another run.
  PieceFolder(std::filesystem::path folder, Plan plan);
  /// The run that a folder has. \throws std::runtime_error if it has none.
  explicit PieceFolder(std::filesystem::path folder);

  [[nodiscard]] const Plan& plan() const { return plan_; }

  /// The reason why the piece is not done; empty if it has a valid record. An invalid record is
  /// ignored.
  [[nodiscard]] std::string fault(std::size_t piece) const;

  /// The work on a piece: it takes the files for the outputs, by their options, and returns an exit
  /// status.
  using Work = std::function<int(const std::map<std::string, std::filesystem::path>&)>;
  /// Does the work on a piece, and writes its record if the status is 0 or 1. Returns the status.
  /// \throws std::runtime_error if an input or a file that an option names cannot be read, changes
  /// meanwhile, or is not as the plan says.
  int finish(std::size_t piece, const Work& work) const;

  /// The reasons why the pieces cannot be merged, a line each that names the piece or file.
  [[nodiscard]] std::vector<std::string> faults() const;
  /// Those of them that are files with the name of a piece that the plan has not.
  [[nodiscard]] std::vector<std::string> foreign_files() const;
  /// The greatest exit status of all pieces. \pre faults() is empty.
  [[nodiscard]] int status() const;
  /// The results of all pieces as one. \pre faults() is empty.
  [[nodiscard]] nlohmann::json merged_json() const;
  /// Passes on the merged text of an output: CSV with one header, certificates with one closing
  /// line. \pre faults() is empty.
  void merged_text(std::string_view option,
                   const std::function<void(std::string_view)>& take) const;

 private:
  [[nodiscard]] std::filesystem::path record_file(std::size_t piece) const;
  [[nodiscard]] nlohmann::json record(std::size_t piece) const;
  /// The file that the piece's record names.
  [[nodiscard]] std::filesystem::path output(std::size_t piece, std::string_view option) const;
  [[nodiscard]] nlohmann::json described_inputs(std::size_t piece) const;
  /// The same, after a check of the files that options name. \throws as finish().
  [[nodiscard]] nlohmann::json checked_inputs(std::size_t piece) const;
  /// The fault of a record; empty if it is valid. \param text of the file
  [[nodiscard]] std::string fault_of(const std::string& text, std::size_t piece) const;

  std::filesystem::path folder_;
  Plan plan_;
  std::string digest_;
};

// A run of this program in a process of its own.

/// Runs this program with other arguments, the program's name first, without standard output, and
/// returns its exit status; 128 and the signal's number if one ended it. An interrupt of this
/// process is passed on; if this process is killed, so is the other. \throws std::system_error if
/// it cannot be run.
[[nodiscard]] int run_own_program(std::vector<std::string> arguments);

}  // namespace touchstone::verify::jobs
