#pragma once

/// \file
/// The help of a command: what it does, examples, its options by group (input, solver, output),
/// then notes and exit statuses, in lines of at most 100 characters.

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone::verify::cli {

/// The longest line of a help text, in characters.
inline constexpr std::size_t help_width = 100;

/// The exit statuses of a command that judges answers.
inline constexpr std::string_view judging_statuses =
    "Exit status: 0 success, 1 wrong answers, 2 bad input or usage, 130 interrupted (results so "
    "far are written).";

/// The same if a solver that does not answer counts as well.
inline constexpr std::string_view answering_statuses =
    "Exit status: 0 success, 1 wrong answers, or a solver that hangs at more than 1 % of its "
    "queries, 2 bad input or usage, or a solver that answers nothing, 130 interrupted (results so "
    "far are written).";

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
