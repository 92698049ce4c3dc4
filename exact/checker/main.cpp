/// \file
/// touchstone-check: the checker as a program.

#include <exception>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "exact/checker/checker.hpp"

namespace {

constexpr std::string_view usage =
    "usage: touchstone-check FILE|- [SCENES]\n"
    "\n"
    "Checks the certificates in a file, or on standard input for '-': each is accepted only if it\n"
    "proves its claim. The format and what is proved: exact/CERTIFICATES.md.\n"
    "SCENES: the certificates are of steps, and of these scenes.\n"
    "Exit status: 0 all accepted and the stream complete, 1 one rejected or the stream cut, 2\n"
    "unreadable input, unwritable output or wrong usage.\n"
    "\n"
    "Example: zstdcat proofs.cert.zst | touchstone-check -\n";

void print(const touchstone::checker::Report& report) {
  std::cout << "accepted         " << report.accepted() << "\n  no_collision   "
            << report.no_collision << "\n  collision      " << report.collision
            << "\n  time_of_impact " << report.time_of_impact << "\nrejected         "
            << report.rejected << '\n';
  for (const std::string& step : report.steps) std::cout << step;
  for (const auto& [line, label, reason] : report.rejections) {
    const std::string name = label.empty() ? "" : " (" + label + ")";
    std::cout << "  line " << line << name << ": " << reason << '\n';
  }
  const auto hidden = report.rejected - report.rejections.size();
  if (hidden > 0) std::cout << "  and " << hidden << " more\n";
}

/// Checks the file of this name, and says what comes of it. \returns whether all was accepted.
bool check(const std::string& path, const char* scenes_path) {
  std::ifstream file, scenes;
  if (path != "-") file.open(path, std::ios::binary);
  if (scenes_path != nullptr) scenes.open(scenes_path, std::ios::binary);
  if (!file || !scenes) throw std::runtime_error("the file cannot be opened");
  const auto report = touchstone::checker::check(
      path == "-" ? std::cin : file, {.scenes = scenes_path != nullptr ? &scenes : nullptr});
  print(report);
  return report.all_accepted();
}

}  // namespace

int main(int argc, char** argv) {
  // Without this std::cin takes an error for the end.
  std::ios::sync_with_stdio(false);
  const std::string path = argc == 2 || argc == 3 ? argv[1] : "";
  const bool is_help = path == "--help";
  if (path.empty() || (path.front() == '-' && path != "-" && !is_help)) {
    std::cerr << usage;
    return 2;
  }
  try {
    if (is_help) std::cout << usage;
    const bool is_good = is_help || check(path, argv[2]);
    if (!std::cout.flush()) throw std::runtime_error("standard output cannot be written");
    return is_good ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << "touchstone-check: " << path << ": " << error.what() << '\n';
    return 2;
  }
}
