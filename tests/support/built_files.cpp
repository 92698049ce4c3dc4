#include "tests/support/built_files.hpp"

namespace touchstone::tests {

std::string source_folder() { return TOUCHSTONE_SOURCE_FOLDER; }

std::string touchstone_program() { return TOUCHSTONE_PROGRAM; }

std::string plugin_library(std::string_view name) {
  return std::string(TOUCHSTONE_PLUGIN_FOLDER "/").append(name).append(".so");
}

}  // namespace touchstone::tests
