#pragma once

/// \file
/// Paths of the sources and of built programs, for tests that read files of the project or
/// run its programs. These paths are compiled into one file (built_files.cpp), so that the objects
/// of the tests do not depend on the folder they were built in.

#include <string>
#include <string_view>

namespace touchstone::tests {

/// The project's folder.
[[nodiscard]] std::string source_folder();

/// The program `touchstone`.
[[nodiscard]] std::string touchstone_program();

/// A solver as a shared library, by the name of its target.
[[nodiscard]] std::string plugin_library(std::string_view name);

}  // namespace touchstone::tests
