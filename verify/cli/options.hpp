#pragma once

/// \file
/// Common options of subcommands.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "touchstone/query.hpp"
#include "verify/cli/commands.hpp"

namespace touchstone::verify::cli {

/// The default seed of generated queries.
inline constexpr std::uint64_t default_seed = 2021;

/// The requested separation.
struct SeparationArguments {
  std::optional<double> distance;
  std::string norm;  ///< empty: the usual one

  /// The separation of the command line; by default distance 0.
  [[nodiscard]] Separation given() const;

  /// The separation for queries whose recorded answers are for `recorded`: by default that one.
  /// Answers for distance 0 contradict no option.
  /// \throws std::invalid_argument naming both if the option contradicts the record.
  [[nodiscard]] Separation settle(const Separation& recorded) const;
};

/// Adds --min-separation and --norm; the arguments must live until the command line is parsed.
void add_separation_options(Command& command, SeparationArguments& arguments);

/// Prints "touchstone: error: …" on standard error, printable (printable.hpp).
void report_error(std::string_view message);

/// Prints "touchstone: warning: …" on standard error, printable.
void report_warning(std::string_view message);

/// The command line of this process, quoted for a shell, with the program's name without a path.
[[nodiscard]] std::string command_line();

// The version of the program.

/// "1.2.3 (0123456789)": the version, and the commit of the build, followed by "-dirty" if files
/// were changed; the version alone if the commit is unknown.
[[nodiscard]] std::string_view version();

}  // namespace touchstone::verify::cli
