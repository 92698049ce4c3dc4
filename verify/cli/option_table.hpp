#pragma once

/// \file
/// The table of options: each is described once, for all commands that have it. A command takes its
/// options from here by name and binds them to variables (add_option); --help, the page of all
/// options (docs/site) and the test that tries every option at its limits use the same rows.

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace touchstone::verify::cli {

/// Seconds of touchstone fuzz without --seconds and --queries.
inline constexpr double usual_fuzz_seconds = 60.0;

/// The maximum number of queries on a page of touchstone view.
inline constexpr std::uint64_t most_viewed_queries = 1000;

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

/// Gives the option the properties of its row.
CLI::Option* finish_option(CLI::Option* option, const OptionRow& row);

/// Adds the command's option of that name, in the present group of its help. The target is a
/// variable, which must live until the command line is parsed, or a function of the value, or of
/// nothing for a flag. The help shows the variable's value as the default, if the option takes it.
template <class Target>
CLI::Option* add_option(CLI::App& command, std::string_view name, Target&& target) {
  using Value = std::remove_cvref_t<Target>;
  const OptionRow& row = option_row(command.get_name(), name);
  if constexpr (std::is_same_v<Value, bool>) {
    return finish_option(command.add_flag(row.name, target, row.text), row);
  } else if constexpr (std::is_invocable_v<Value>) {
    return finish_option(
        command.add_flag_callback(row.name, std::forward<Target>(target), row.text), row);
  } else if constexpr (std::is_invocable_v<Value, std::string>) {
    return finish_option(command.add_option_function(
                             row.name, std::function<void(const std::string&)>(target), row.text),
                         row);
  } else if constexpr (std::is_invocable_v<Value, double>) {
    return finish_option(
        command.add_option_function(row.name, std::function<void(const double&)>(target), row.text),
        row);
  } else {
    CLI::Option* option = nullptr;
    if constexpr (std::is_same_v<Value, std::string>) {
      if (row.name.ends_with('}')) option = command.add_flag(row.name, target, row.text);
    }
    if (option == nullptr) option = command.add_option(row.name, target, row.text);
    if constexpr (std::is_arithmetic_v<Value> || std::is_same_v<Value, std::string>) {
      const bool is_text = std::holds_alternative<Text>(row.values);
      const std::string value = CLI::detail::to_string(target);
      if (!is_text && fault_of_value(row.values, value).empty()) option->capture_default_str();
    }
    return finish_option(option, row);
  }
}

// The help of a command: what it does, examples, its options by group (input, solver, output),
// then notes and exit statuses, in lines of at most 100 characters.

/// The longest line of a help text, in characters.
inline constexpr std::size_t help_width = 100;

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
void set_help(CLI::App& command, std::string_view examples, std::string_view notes);

/// Makes the program and its later subcommands print their help in this form.
void use_help_format(CLI::App& app);

/// The probably intended name for a word: the closest one, if its distance is at most two letters;
/// empty if there is none.
[[nodiscard]] std::string nearest_name(std::string_view word,
                                       const std::vector<std::string>& names);

/// The text in lines of at most `help_width` characters, broken between words; the first line
/// begins at column `start`, the others are indented by `indent`.
[[nodiscard]] std::string wrapped(std::string_view text, std::size_t start, std::size_t indent);

}  // namespace touchstone::verify::cli
