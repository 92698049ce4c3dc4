// A program built with contraction on. It succeeds iff the self-check refuses this build with its
// reason.

#include <iostream>
#include <stdexcept>
#include <string>

#include "fast/platform/arithmetic_check.hpp"

int main() {
  try {
    touchstone::fast::require_strict_arithmetic();
  } catch (const std::runtime_error& error) {
    std::cout << error.what() << '\n';
    return std::string(error.what()).find("contracted") == std::string::npos ? 1 : 0;
  }
  std::cout << "a contracted build was accepted\n";
  return 1;
}
