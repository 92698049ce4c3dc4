#pragma once

/// \file
/// Which version of the program this is.

#include <string_view>

namespace touchstone::verify::cli {

/// "1.2.3 (0123456789)": the version, and the commit that it was built from, "-dirty" behind it if files had been changed;
/// the version alone where that is not known.
[[nodiscard]] std::string_view version();

}  // namespace touchstone::verify::cli
