#pragma once

/// \file
/// The methods that are built in, by their names on the command line: a new one is judged, timed
/// and named in the help once it is in the list. fast::MethodInfo describes each.

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/any_kind.hpp"

namespace touchstone::verify::solvers {

/// All of them, always in the same order; they live as long as the program.
[[nodiscard]] const std::vector<std::unique_ptr<const fast::Method>>& methods();

/// The names of those that are judged where the user names none: all that promise something, in
/// their default setting, and answer one of the kinds, without the baselines.
[[nodiscard]] std::vector<std::string> default_methods(
    std::span<const AnyKind> kinds = std::span(all_kinds).first(contact_kinds.size()));

/// The method of that name.
/// \throws std::invalid_argument, with the names there are, if there is none.
[[nodiscard]] const fast::Method& find_method(std::string_view name);

/// The description of the method of that name; null if there is none.
[[nodiscard]] const fast::MethodInfo* find_info(std::string_view name);

/// "none", "conservative" or "exact".
[[nodiscard]] std::string_view to_string(fast::Promise promise);

}  // namespace touchstone::verify::solvers
