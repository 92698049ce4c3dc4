#include "verify/cli/options.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <stdexcept>

#include "verify/data/separation_file.hpp"
#include "verify/io/number_text.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/terminal.hpp"
#include "verify/judge/separation_inference.hpp"

namespace touchstone::verify::cli {

CLI::Validator whole_number(std::uint64_t least, std::uint64_t greatest) {
  const auto check = [least, greatest](const std::string& text) -> std::string {
    const auto value = io::number_from_text<std::uint64_t>(text);
    if (value && *value >= least && *value <= greatest) return {};
    return fmt::format("{} is not a whole number from {} to {}", text, least, greatest);
  };
  return {check, ""};
}

CLI::Validator real_number(double least, double greatest) {
  const auto check = [least, greatest](const std::string& text) -> std::string {
    const auto value = io::number_from_text<double>(text);
    if (value && *value >= least && *value <= greatest) return {};
    return fmt::format("{} is not a number from {} to {}", text, least, greatest);
  };
  return {check, ""};
}

CLI::Validator distance_number() {
  const auto check = [](const std::string& text) -> std::string {
    if (data::distance_from_text(text)) return {};
    return fmt::format("{} must be a finite number ≥ 0", text);
  };
  return {check, ""};
}

Separation SeparationArguments::given() const {
  return {.distance = distance.value_or(0.0), .norm = norm.value_or(Norm::linf)};
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

CLI::Option* add_distance_option(CLI::App& command, std::optional<double>& distance,
                                 const std::string& description) {
  // Uses strtod, because CLI11 would round twice.
  return command
      .add_option_function<std::string>(
          "--min-separation",
          [&distance](const std::string& text) { distance = data::distance_from_text(text); },
          description)
      ->type_name("D")
      ->check(distance_number());
}

void add_separation_options(CLI::App& command, SeparationArguments& arguments) {
  add_distance_option(command, arguments.distance,
                      "Contact: distance ≤ D, 0.5 or 0x1p-1 (default: separation.json, or 0)");
  command
      .add_option_function<std::string>(
          "--norm",
          [&arguments](const std::string& text) { arguments.norm = norm_from_string(text); },
          "Norm of the distance: linf (greatest component, the default) or l2")
      ->type_name("NORM")
      ->check(CLI::IsMember({"linf", "l2"}).description(""));
}

void add_json_option(CLI::App& command, std::string& file) {
  command.add_option("--json", file, "Write the result as JSON")->type_name("FILE");
}

void add_kind_option(CLI::App& command, std::string& kind, const std::string& description) {
  command.add_option("--kind", kind, description)
      ->type_name("KIND")
      ->check(CLI::IsMember({"vertex-face", "edge-edge"}).description(""));
}

CLI::Option* add_degree_option(CLI::App& command, std::vector<std::string>& degrees) {
  return command
      .add_option(
          "--degree", degrees,
          "Built-in queries on curves of this degree, 1 (straight lines), 2 or 3, or rational "
          "ones; repeatable")
      ->type_name("D")
      ->allow_extra_args(false)
      ->check(CLI::IsMember({"1", "2", "3", "rational"}).description(""));
}

void add_seed_option(CLI::App& command, std::uint64_t& seed, const std::string& description) {
  command.add_option("--seed", seed, description)
      ->type_name("N")
      ->capture_default_str()
      ->check(whole_number(0, UINT64_MAX));
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
