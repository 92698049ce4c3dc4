#pragma once

/// \file
/// Methods by name, with the published ones that are not built in: plugins of verify/published/.
///
/// NAME is `published/NAME.so` beside this program, where the target touchstone_published puts it.

#include <string>
#include <string_view>
#include <vector>

#include "fast/method.hpp"

namespace touchstone::verify::solvers {

/// The names of the built-in methods, and of the published ones between ours and the baselines.
[[nodiscard]] std::vector<std::string> all_names();

/// The method of that name, which lives as long as the program; a plugin is loaded once.
/// \throws std::invalid_argument, with the names there are, if there is none, and with the way out
/// if it is a plugin that is not built; the exceptions of load_plugin.
[[nodiscard]] const fast::Method& find_any(std::string_view name);

}  // namespace touchstone::verify::solvers
