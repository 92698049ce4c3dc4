#include "verify/cli/options.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <stdexcept>

#include "verify/cli/option_table.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/terminal.hpp"
#include "verify/judge/separation_inference.hpp"

namespace touchstone::verify::cli {

namespace {

/// The separation of the command line; what it does not name, as in `otherwise`.
Separation asked(const SeparationArguments& arguments, const Separation& otherwise) {
  return {.distance = arguments.distance.value_or(otherwise.distance),
          .norm = arguments.norm.empty() ? otherwise.norm : norm_from_string(arguments.norm)};
}

}  // namespace

Separation SeparationArguments::given() const { return asked(*this, {}); }

Separation SeparationArguments::settle(const Separation& recorded) const {
  if (is_zero(recorded)) return given();
  const Separation settled = asked(*this, recorded);
  if (judge::same_separation(settled, recorded)) return settled;
  throw std::invalid_argument(
      fmt::format("a minimum separation of {} is requested, but its separation.json has {}",
                  judge::to_text(settled), judge::to_text(recorded)));
}

void add_separation_options(Command& command, SeparationArguments& arguments) {
  add_option(command, "--min-separation", arguments.distance);
  add_option(command, "--norm", arguments.norm);
}

void report_error(std::string_view message) {
  io::print(stderr, fmt::format("touchstone: error: {}\n", io::printable(message)));
}

void report_warning(std::string_view message) {
  io::print(stderr, fmt::format("touchstone: warning: {}\n", io::printable(message)));
}

std::string command_line() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::string command;
  for (std::string word; std::getline(file, word, '\0');) {
    command += command.empty() ? "touchstone" : " " + io::shell_word(word);
  }
  return command;
}

}  // namespace touchstone::verify::cli
