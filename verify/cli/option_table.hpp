#pragma once

/// \file
/// The table of options: each is described once, for all commands that have it. A command takes its
/// options from here by name and binds them to variables (add_option); --help, the page of all
/// options (docs/site) and the test that tries every option at its limits use the same rows. Which
/// options exclude or need each other, and which take no cells, is data there, too.
///
/// option_table.cpp is the only source that includes the parser, CLI11, whose headers take longer
/// to compile than most commands.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "touchstone/any_kind.hpp"
#include "verify/cli/commands.hpp"

namespace touchstone::verify::cli {

/// Seconds of touchstone fuzz without --seconds and --queries.
inline constexpr double usual_fuzz_seconds = 60.0;

/// Any text.
struct Text {};

/// A whole number. (CLI11 alone lets "-1" wrap around.)
struct Whole {
  std::uint64_t least = 0;
  std::uint64_t greatest = UINT64_MAX;
};

/// A finite number.
struct Real {
  double least;
  double greatest;
};

/// A finite number ≥ 0 in the forms of strtod, including hexadecimal ones, except positive ones
/// that would become 0.
struct Distance {};

/// One of these words.
struct OneOf {
  std::vector<std::string> words;
};

using Values = std::variant<Text, Whole, Real, Distance, OneOf>;

enum class OptionForm : std::uint8_t {
  usual,     ///< optional, and with one value each time that it is given
  required,  ///< has to be given
  list,      ///< with one value or more each time
  pair       ///< with two values
};

/// An option of some commands. A name without "--" is that of positional arguments; an option whose
/// name ends in {V} can be given without a value, and then has the value V.
struct OptionRow {
  std::string name;
  std::string type;  ///< a word for its value in the help; empty for flags
  Values values;
  std::string text;
  std::string commands = {};  ///< those with this row; empty: those that no other row names
  OptionForm form = OptionForm::usual;

  /// True if this is the row of the option with that name (of several the first) and command.
  [[nodiscard]] bool is_of(std::string_view command, std::string_view option) const;
};

/// All rows; of one name, those for named commands stand before the row for all others.
[[nodiscard]] const std::vector<OptionRow>& option_table();

/// The row of an option. \throws std::logic_error if there is none.
[[nodiscard]] const OptionRow& option_row(std::string_view command, std::string_view option);

/// The fault of a text as one of these values; empty if it is valid.
[[nodiscard]] std::string fault_of_value(const Values& values, const std::string& text);

// A command in the parser.

/// The variable of an option, which must live until the command line is parsed, or what a flag
/// does.
using Target =
    std::variant<bool*, int*, unsigned*, std::int64_t*, std::uint64_t*, double*,
                 std::optional<double>*, std::string*, std::vector<std::uint64_t>*,
                 std::vector<std::string>*, std::vector<std::filesystem::path>*,
                 std::vector<std::pair<std::string, std::string>>*, std::function<void()>>;

/// Adds a command to the program.
Command* add_command(Command& program, const std::string& name, const std::string& description);

/// Begins a group of the command's help, which has the options that are added from here on.
void begin_group(Command& command, const std::string& name);

/// Adds the command's option of that name. The help shows the variable's value as the default, if
/// the option takes it.
void add_option(Command& command, std::string_view name, const Target& target);
template <class Variable>
void add_option(Command& command, std::string_view name, Variable& variable) {
  add_option(command, name, Target(&variable));
}

/// Sets what the command does.
void set_action(Command& command, const std::function<void()>& action);

[[nodiscard]] std::string name_of(const Command& command);

/// True if the command line has that option of the command.
[[nodiscard]] bool is_given(const Command& command, const std::string& option);

/// The options on the command line with their values, in the order of the help.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> given_options(
    const Command& command);

/// \throws std::invalid_argument, naming file and option, if the command, or an option that it was
/// given, takes no queries of that kind.
/// \param file of these queries; empty: --kind asks for them
void require_kind(const Command& command, AnyKind kind, const std::filesystem::path& file = {});

/// Parses the command line and runs its command. Prints help, version and errors of usage.
[[nodiscard]] Status run_command_line(int argc, char** argv);

// The help of a command: what it does, examples, its options by group (input, solver, output),
// then notes and exit statuses, in lines of at most 100 characters.

/// The exit statuses of a command that judges answers.
inline constexpr std::string_view judging_statuses =
    "Exit status: 0 success, 1 wrong answers, 2 bad input or usage, 130 interrupted (results so "
    "far are written).";

/// The same if a solver that does not answer counts as well.
inline constexpr std::string_view answering_statuses =
    "Exit status: 0 success, 1 wrong answers, or a solver that hangs (docs/testing.md), 2 bad "
    "input or "
    "usage, or nothing asked or answered, 130 interrupted (results so far are written).";

/// The exit statuses of a command that judges nothing.
inline constexpr std::string_view writing_statuses =
    "Exit status: 0 success, 2 bad input or usage, 130 interrupted (results so far are written).";

/// Sets the command's examples, one on each line, and its notes, one paragraph on each line.
void set_help(Command& command, std::string_view examples, std::string_view notes);

}  // namespace touchstone::verify::cli
