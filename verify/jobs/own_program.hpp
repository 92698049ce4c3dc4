#pragma once

/// \file
/// A run of this program in a process of its own.

#include <string>
#include <vector>

namespace touchstone::verify::jobs {

/// Runs this program with other arguments, the program's name first, without standard output, and
/// returns its exit status; 128 and the signal's number if one ended it. An interrupt of this
/// process is passed on; if this process is killed, so is the other. \throws std::system_error if
/// it cannot be run.
[[nodiscard]] int run_own_program(std::vector<std::string> arguments);

}  // namespace touchstone::verify::jobs
