#pragma once

/// \file
/// The texts that a view is made of, embedded when the tool is built: the modules of verify/view/page/
/// with three.js as one script, and their style.

#include <string_view>

namespace touchstone::verify::view {

/// The script of a view, three.js with its licence's notice included.
[[nodiscard]] std::string_view view_script();

/// What a view's style has beyond that of a report.
[[nodiscard]] std::string_view view_style();

}  // namespace touchstone::verify::view
