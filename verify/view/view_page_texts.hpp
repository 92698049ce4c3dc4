#pragma once

/// \file
/// The texts of a view, embedded in the tool at build time: the modules of verify/view/page/
/// with three.js as one script, and their style.

#include <string_view>

namespace touchstone::verify::view {

/// The script of a view, three.js with its licence's notice included.
[[nodiscard]] std::string_view view_script();

/// The style of a view in addition to that of a report.
[[nodiscard]] std::string_view view_style();

}  // namespace touchstone::verify::view
