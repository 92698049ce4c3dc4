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
    "Exit status: 0 all accepted and the stream complete, 1 at least one rejected or the stream "
    "cut,\n"
    "2 unreadable input, unwritable output or wrong usage.\n"
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

/// \throws std::runtime_error if standard output did not take all that was printed.
void flush_output() {
  if (!std::cout.flush()) throw std::runtime_error("standard output cannot be written");
}

}  // namespace

int main(int argc, char** argv) {
  // Without this std::cin takes an error for the end.
  std::ios::sync_with_stdio(false);
  const std::string path = argc == 2 ? argv[1] : "";
  try {
    if (path == "--help") {
      std::cout << usage;
      flush_output();
      return 0;
    }
    if (path.empty() || (path.front() == '-' && path != "-")) {
      std::cerr << usage;
      return 2;
    }
    std::ifstream file;
    if (path != "-") file.open(path, std::ios::binary);
    if (!file) throw std::runtime_error("the file cannot be opened");
    std::istream& stream = path == "-" ? std::cin : file;
    const auto report = touchstone::checker::check(stream);
    print(report);
    flush_output();
    return report.all_accepted() ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << "touchstone-check: " << path << ": " << error.what() << '\n';
    return 2;
  }
}
