#pragma once

/// \file
/// What a run of the fuzzer reports: as text for a person, as JSON for a program.

#include <nlohmann/json.hpp>
#include <string>

#include "fast/method.hpp"
#include "verify/fuzz/finding.hpp"
#include "verify/fuzz/fuzz.hpp"

namespace touchstone::verify {

/// A run and what was asked for.
struct FuzzReport {
  std::string method;
  fast::Promise promise = fast::Promise::none;  ///< what it was held to
  std::uint64_t seed = 0;
  Separation separation = {};
  FuzzResult result;
};

/// "false_negative of METHOD, vertex-face (contact_on_grid, after 1.5 s and 3200 queries)", then
/// what is wrong and the truth, a line each.
[[nodiscard]] std::string to_text(const Finding& finding);

/// The numbers of a run: queries a second with and without the method's time, how many the oracle
/// judged, a line for each generator, and last how many findings there are.
[[nodiscard]] std::string to_text(const FuzzReport& report);

/// An object of `what`, `kind`, `separation` (`min_separation`, `norm`), `method`, `collides`,
/// `truth`, `detail`, `answer` (`verdict` and of `toi_lower`, `toi_upper`, `tolerance` what is
/// finite, else null), `generator`, `seconds`, `queries`, `coordinates` (24 numbers in hexadecimal,
/// as text) and `certificate`.
[[nodiscard]] nlohmann::json to_json(const Finding& finding);

/// An object of `method`, `promise`, `seed`, `separation`, `queries`, `images`, `collisions`,
/// `judged_by_oracle`, `seconds`, `method_seconds`, `other_seconds`, `queries_per_second`,
/// `judged_per_second`, `all_findings`, `unplaced_crashes`, `interrupted`, `generators` (a list of
/// `name`, `queries`, `collisions`, `signatures`, `findings`) and `findings`, a list as above.
[[nodiscard]] nlohmann::json to_json(const FuzzReport& report);

}  // namespace touchstone::verify
