/// \file
/// touchstone-check: the checker as a program.

#include <exception>
#include <fstream>
#include <iostream>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "exact/checker/checker.hpp"

namespace {

constexpr std::string_view usage =
    "usage: touchstone-check [OPTIONS] FILE|- [SCENES]\n"
    "\n"
    "Checks the certificates in a file, or on standard input for '-': each is accepted only if it\n"
    "proves its claim. The format and what is proved: exact/CERTIFICATES.md.\n"
    "SCENES: the certificates are of steps or of meshes, and of these scenes.\n"
    "\n"
    "--claim CLAIM     Reject whatever claims anything else: no_collision, collision,\n"
    "                  'time_of_impact [LO HI]', no_inversion, inversion, 'time_of_inversion [LO\n"
    "                  HI]'; of steps free, 'no_contact T', 'earliest [LO HI]', or sequence:\n"
    "                  free, and each begins where the last one ended;\n"
    "                  of meshes free, 'intersections [N]', 'welded_intersections [N]'\n"
    "--rules RULES     Reject whatever has other rules, which weaken a claim, than these, in the "
    "words\n"
    "                  of the report: '1 pair of groups held apart'. Without it and without "
    "SCENES\n"
    "                  free and sequence reject all rules\n"
    "--separation D    Reject whatever is about another distance (0: contact itself)\n"
    "--norm NORM       The norm of --separation: l2 (the default) or linf\n"
    "\n"
    "Exit status: 0 all accepted and the stream complete, 1 one rejected or the stream cut, 2\n"
    "unreadable input, unwritable output or wrong usage.\n"
    "\n"
    "Example: zstdcat proofs.cert.zst | touchstone-check -\n"
    "         touchstone-check --claim free --separation 0 step.cert scenes.txt\n";

/// The words of a command line.
struct Arguments {
  bool is_help = false;
  std::string path;
  std::string scenes;
  touchstone::checker::Options options;
};

/// Parses a command line; empty if the words are no command.
std::optional<Arguments> parsed(std::span<char*> words) {
  Arguments arguments;
  std::string separation;
  std::string norm;
  std::vector<std::string> files;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string word = words[i];
    const std::string value = i + 1 < words.size() ? words[i + 1] : "";
    if (word == "--help") {
      arguments.is_help = true;
      return arguments;
    }
    if (word == "-" || !word.starts_with('-')) {
      files.push_back(word);
      continue;
    }
    if (value.empty()) return std::nullopt;
    ++i;
    if (word == "--claim") {
      arguments.options.claim = touchstone::checker::demanded_claim(value);
    } else if (word == "--rules") {
      arguments.options.rules = value;
    } else if (word == "--separation") {
      separation = value;
    } else if (word == "--norm") {
      norm = value;
    } else {
      return std::nullopt;
    }
  }
  if (files.empty() || files.size() > 2 || files[0].empty()) return std::nullopt;
  if (files.size() == 2 && (files[1] == "-" || files[1].empty())) return std::nullopt;
  if (separation.empty() && !norm.empty()) return std::nullopt;
  if (!separation.empty()) {
    arguments.options.separation =
        touchstone::checker::demanded_separation(separation, norm.empty() ? "l2" : norm);
  }
  arguments.path = files[0];
  if (files.size() == 2) arguments.scenes = files[1];
  return arguments;
}

void print(const touchstone::checker::Report& report) {
  std::cout << "accepted         " << report.accepted() << "\n  no_collision   "
            << report.no_collision << "\n  collision      " << report.collision
            << "\n  time_of_impact " << report.time_of_impact << '\n';
  if (report.inversions() > 0) {
    std::cout << "  no_inversion      " << report.no_inversion << "\n  inversion         "
              << report.inversion << "\n  time_of_inversion " << report.time_of_inversion << '\n';
  }
  std::cout << "rejected         " << report.rejected << '\n';
  for (const std::string& step : report.steps) std::cout << step;
  for (const std::string& mesh : report.meshes) std::cout << mesh;
  for (const auto& [line, label, reason] : report.rejections) {
    const std::string name = label.empty() ? "" : " (" + label + ")";
    std::cout << "  line " << line << name << ": " << reason << '\n';
  }
  const auto hidden = report.rejected - report.rejections.size();
  if (hidden > 0) std::cout << "  and " << hidden << " more\n";
  if (!report.summary.empty()) std::cout << report.summary << '\n';
}

/// Checks a file and prints the outcome. \returns true if everything was accepted.
bool check(Arguments arguments) {
  std::ifstream file;
  std::ifstream scenes;
  if (arguments.path != "-") file.open(arguments.path, std::ios::binary);
  if (!arguments.scenes.empty()) {
    scenes.open(arguments.scenes, std::ios::binary);
    arguments.options.scenes = &scenes;
  }
  if (!file || !scenes) throw std::runtime_error("the file cannot be opened");
  const auto report =
      touchstone::checker::check(arguments.path == "-" ? std::cin : file, arguments.options);
  print(report);
  return report.all_accepted();
}

}  // namespace

int main(int argc, char** argv) {
  // A synchronised std::cin takes an error for the end.
  std::ios::sync_with_stdio(false);
  std::string path;
  try {
    const auto arguments = parsed(std::span(argv, std::size_t(argc)).subspan(1));
    if (!arguments) {
      std::cerr << usage;
      return 2;
    }
    path = arguments->path;
    if (arguments->is_help) std::cout << usage;
    const bool is_good = arguments->is_help || check(*arguments);
    if (!std::cout.flush()) throw std::runtime_error("standard output cannot be written");
    return is_good ? 0 : 1;
  } catch (const touchstone::checker::Rejection& rejection) {
    std::cerr << "touchstone-check: " << rejection.reason << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "touchstone-check: " << path << ": " << error.what() << '\n';
    return 2;
  }
}
