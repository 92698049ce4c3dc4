#pragma once

/// \file
/// Our solvers under the names the command line knows them by. This is the one list of them: a new
/// solver is judged, timed and named in the help by standing in it.

#include <memory>
#include <string_view>
#include <vector>

#include "fast/method.hpp"
#include "verify/judge/claimed_distance.hpp"

namespace touchstone::verify {

/// All methods, always in the same order; they live as long as the program.
[[nodiscard]] const std::vector<std::unique_ptr<const fast::Method>>& methods();

/// Is that the name of a baseline: a known method that is here to be compared with (verify/baselines/, and
/// the public Tight-Inclusion), known errors and all?
[[nodiscard]] bool is_baseline(std::string_view name);

/// The names of those that are judged where nobody names any: all that promise something, in their
/// default setting, without the baselines.
[[nodiscard]] std::vector<std::string_view> default_methods();

/// The method of that name.
/// \throws std::invalid_argument, with the names there are, if there is none.
[[nodiscard]] const fast::Method& find_method(std::string_view name);

/// What the tolerances of the method of that name claim.
[[nodiscard]] Reach reach_of(std::string_view name);

/// "none", "conservative" or "exact".
[[nodiscard]] std::string_view to_string(fast::Promise promise);

}  // namespace touchstone::verify
