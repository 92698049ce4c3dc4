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
    "usage: touchstone-check FILE|-\n"
    "\n"
    "Checks the certificates in a file, or on standard input for '-': each is accepted only if it\n"
    "proves its claim. The format and what is proved: exact/CERTIFICATES.md.\n"
    "Exit status: 0 all accepted, 1 at least one rejected, 2 unreadable input or wrong usage.\n"
    "\n"
    "Example: zstdcat proofs.cert.zst | touchstone-check -\n";

void print(const touchstone::checker::Report& report) {
  std::cout << "accepted         " << report.accepted() << "\n  no_collision   "
            << report.no_collision << "\n  collision      " << report.collision
            << "\n  time_of_impact " << report.time_of_impact << "\nrejected         "
            << report.rejected << '\n';
  for (const auto& [line, label, reason] : report.rejections) {
    const std::string name = label.empty() ? "" : " (" + label + ")";
    std::cout << "  line " << line << name << ": " << reason << '\n';
  }
  const auto hidden = report.rejected - report.rejections.size();
  if (hidden > 0) std::cout << "  and " << hidden << " more\n";
}

}  // namespace

int main(int argc, char** argv) {
  // Without this std::cin takes an error for the end.
  std::ios::sync_with_stdio(false);
  const std::string path = argc == 2 ? argv[1] : "";
  if (path.empty() || (path.front() == '-' && path != "-")) {
    (path == "--help" ? std::cout : std::cerr) << usage;
    return path == "--help" ? 0 : 2;
  }
  try {
    std::ifstream file;
    if (path != "-") file.open(path, std::ios::binary);
    if (!file) throw std::runtime_error("the file cannot be opened");
    std::istream& stream = path == "-" ? std::cin : file;
    const auto report = touchstone::checker::check(stream);
    print(report);
    if (!std::cout.flush()) throw std::runtime_error("the report cannot be written");
    return report.all_accepted() ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << "touchstone-check: " << path << ": " << error.what() << '\n';
    return 2;
  }
}
