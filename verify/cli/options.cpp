#include "verify/cli/options.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <stdexcept>

#include "verify/cli/option_table.hpp"
#include "verify/data/ground_truth_files.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/terminal.hpp"
#include "verify/judge/separation_inference.hpp"

namespace touchstone::verify::cli {

Separation SeparationArguments::given() const {
  return {.distance = distance.value_or(0.0), .norm = norm.value_or(Separation{}.norm)};
}

Separation SeparationArguments::settle(const Separation& recorded) const {
  if (is_zero(recorded)) return given();
  const Separation asked{.distance = distance.value_or(recorded.distance),
                         .norm = norm.value_or(recorded.norm)};
  if (judge::same_separation(asked, recorded)) return asked;
  throw std::invalid_argument(
      fmt::format("a minimum separation of {} is requested, but its separation.json has {}",
                  judge::to_text(asked), judge::to_text(recorded)));
}

void add_separation_options(CLI::App& command, SeparationArguments& arguments) {
  // Uses strtod, because CLI11 would round twice.
  add_option(command, "--min-separation", [&arguments](const std::string& text) {
    arguments.distance = data::distance_from_text(text);
  });
  add_option(command, "--norm",
             [&arguments](const std::string& text) { arguments.norm = norm_from_string(text); });
}

void report_error(std::string_view message) {
  io::print(stderr, fmt::format("touchstone: error: {}\n", io::printable(message)));
}

void report_warning(std::string_view message) {
  io::print(stderr, fmt::format("touchstone: warning: {}\n", io::printable(message)));
}

std::string contact_alone(std::string_view what, Kind kind) {
  return fmt::format("{} takes vertex-face and edge-edge alone, not a {}", what, to_string(kind));
}

void require_contact_for(std::string_view option, bool is_used, const std::string& kind) {
  if (!is_used || kind.empty() || !is_element(kind_from_string(kind))) return;
  throw std::invalid_argument(contact_alone(option, kind_from_string(kind)) +
                              ": leave it out, or choose another --kind");
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
