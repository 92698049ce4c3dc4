#pragma once

/// \file
/// The version of the program.

#include <string_view>

namespace touchstone::verify::cli {

/// "1.2.3 (0123456789)": the version, and the commit of the build, followed by "-dirty" if files
/// were changed; the version alone if the commit is unknown.
[[nodiscard]] std::string_view version();

}  // namespace touchstone::verify::cli
