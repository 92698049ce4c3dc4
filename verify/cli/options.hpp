#pragma once

/// \file
/// Common options of subcommands.

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "touchstone/query.hpp"

namespace touchstone::verify::cli {

/// The default seed of generated queries.
inline constexpr std::uint64_t default_seed = 2021;

/// Accepts whole numbers from `least` to `greatest` (CLI11 alone lets "-1" wrap around).
[[nodiscard]] CLI::Validator whole_number(std::uint64_t least, std::uint64_t greatest);

/// Accepts finite numbers from `least` to `greatest`.
[[nodiscard]] CLI::Validator real_number(double least, double greatest);

/// Accepts finite numbers ≥ 0 in the forms of strtod, including hexadecimal ones, except positive
/// ones that would become 0.
[[nodiscard]] CLI::Validator distance_number();

/// The requested separation.
struct SeparationArguments {
  std::optional<double> distance;
  std::optional<Norm> norm;

  /// The separation of the command line; by default distance 0.
  [[nodiscard]] Separation given() const;

  /// The separation for queries whose recorded answers are for `recorded`: by default that one.
  /// Answers for distance 0 contradict no option.
  /// \throws std::invalid_argument naming both if the option contradicts the record.
  [[nodiscard]] Separation settle(const Separation& recorded) const;
};

/// Adds --min-separation; the double must live until the command line is parsed.
CLI::Option* add_distance_option(CLI::App& command, std::optional<double>& distance,
                                 const std::string& description);

/// Adds --min-separation and --norm; the arguments must live until the command line is parsed.
void add_separation_options(CLI::App& command, SeparationArguments& arguments);

/// Adds --json FILE. The text must live until the command line is parsed, as all arguments below.
void add_json_option(CLI::App& command, std::string& file);

/// Adds --kind, which selects queries of one kind, or declares the kind of all.
void add_kind_option(CLI::App& command, std::string& kind, const std::string& description);

/// Adds --degree, which selects built-in families by generate::degree_text; repeatable. The texts
/// must live until the command line is parsed.
CLI::Option* add_degree_option(CLI::App& command, std::vector<std::string>& degrees);

/// Adds --seed.
void add_seed_option(CLI::App& command, std::uint64_t& seed, const std::string& description);

/// Prints "touchstone: error: …" on standard error, printable (printable.hpp).
void report_error(std::string_view message);

/// Prints "touchstone: warning: …" on standard error, printable.
void report_warning(std::string_view message);

/// The command line of this process, quoted for a shell, with the program's name without a path.
[[nodiscard]] std::string command_line();

}  // namespace touchstone::verify::cli
