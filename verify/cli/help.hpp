#pragma once

/// \file
/// The help of a command: what it does, examples, its options by group (input, solver, output), then notes and exit
/// statuses, in lines of at most 100 characters.

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone::verify::cli {

/// The longest line of a help text, in characters.
inline constexpr std::size_t help_width = 100;

/// The exit statuses of a command whose wrong answers are those of others.
inline constexpr std::string_view judging_statuses =
    "Exit status: 0 all is well, 1 wrong answers, 2 bad input or usage, 130 interrupted (what is "
    "done is written).";

/// The exit statuses of a command that judges nothing.
inline constexpr std::string_view writing_statuses =
    "Exit status: 0 all is written, 2 bad input or usage, 130 interrupted (what is done is "
    "written).";

/// Gives the command its examples, a line each, and its notes, a paragraph a line.
void set_help(CLI::App& command, std::string_view examples, std::string_view notes);

/// Has the program and its subcommands, those that are added later, print their help in this form.
void use_help_format(CLI::App& app);

/// The name that a word may be meant for: the nearest one, if at most two letters are missing, wrong or
/// too many; empty if none is that near.
[[nodiscard]] std::string nearest_name(std::string_view word,
                                       const std::vector<std::string>& names);

/// The text in lines of at most `help_width` characters, broken between words; the first line is taken to begin at
/// column `start`, the others are indented by `indent`.
[[nodiscard]] std::string wrapped(std::string_view text, std::size_t start, std::size_t indent);

}  // namespace touchstone::verify::cli
