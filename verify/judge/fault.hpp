#pragma once

/// \file
/// The faults of a solver's answers: the one enumeration by which jobs, tables, pictures and
/// printed programs tell them apart. A failure is a fault too: an answer that is missing.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "fast/method.hpp"

namespace touchstone::verify::judge {

/// A fault of an answer.
enum class Fault : std::uint8_t {
  false_negative,   ///< no, but they collide
  false_positive,   ///< yes or undecided, but they do not collide
  late_toi,         ///< toi_lower is above the exact time of impact
  early_toi_upper,  ///< toi_upper is below the exact time of impact
  // Failures, the errors first.
  crash,       ///< a signal ended its process
  exit,        ///< it ended its process with an exit status
  exception,   ///< it threw
  no_verdict,  ///< it answered error, or set no verdict
  not_finite,  ///< it answered yes with an infinite time of impact, or a tolerance below 0
  hang,        ///< it took longer than the limit
  undecided,   ///< it answered undecided by itself
  // Claims of a yes, or of two answers together.
  beyond_tolerance,  ///< yes, but they never come as near as its tolerance claims
                     ///< (claimed_distance.hpp)
  asymmetry,         ///< another answer than to an exact image of the query, and wrong
};
inline constexpr std::size_t fault_count = 13;

/// All faults, in their order.
inline constexpr std::array<Fault, fault_count> all_faults = [] {
  std::array<Fault, fault_count> all{};
  for (std::size_t i = 0; i < all.size(); ++i) all.at(i) = static_cast<Fault>(i);
  return all;
}();

/// The failures, in the same order.
inline constexpr std::span all_failures = std::span(all_faults).subspan<4, 7>();

[[nodiscard]] constexpr bool is_failure(Fault fault) {
  return Fault::crash <= fault && fault <= Fault::undecided;
}

/// True if the failure stands for no verdict at all.
[[nodiscard]] constexpr bool is_error(Fault fault) {
  return Fault::crash <= fault && fault <= Fault::not_finite;
}

/// The name, for files and options: "false_negative", "crash" and so on, as above.
[[nodiscard]] std::string_view to_string(Fault fault);

/// The fault of that name, if there is one.
[[nodiscard]] std::optional<Fault> fault_from_name(std::string_view name);

/// The text, for tables: "false negative", "false positive", "late toi", "early toi_upper", "beyond
/// tolerance", "asymmetry", "hang", "undecided", and "error" for every error.
[[nodiscard]] std::string_view to_text(Fault fault);

/// The reason why there is no answer to a query, in detail.
struct Failure {
  /// \pre is_failure
  Fault kind = Fault::no_verdict;
  /// The signal of a crash, the status of an exit; else 0.
  int number = 0;
  /// The text of an exception, the number that is not finite; else empty.
  std::string what = {};

  friend bool operator==(const Failure&, const Failure&) = default;
};

/// A failure at one of several queries.
struct QueryFailure {
  std::size_t position = 0;
  Failure failure = {};
};

/// The failure at a position, or null. \pre the positions ascend
[[nodiscard]] const Failure* failure_at(std::span<const QueryFailure> failures,
                                        std::size_t position);

/// "crash: SIGSEGV", "exit: status 3", "exception: text", "not_finite: toi_lower inf", and of the
/// others the name alone. Printable (verify/io/printable.hpp).
[[nodiscard]] std::string to_text(const Failure& failure);

/// The reverse of to_text; the kind alone where the rest is none that it writes.
[[nodiscard]] std::optional<Failure> failure_from_text(std::string_view text);

/// The failure that an answer itself shows: no_verdict, not_finite or undecided.
[[nodiscard]] std::optional<Failure> failure_of(const fast::Answer& answer);

/// The verdict that a query with that failure counts as: undecided, a conservative yes, if the
/// solver was undecided or too slow, else error.
[[nodiscard]] fast::Verdict verdict_of(Fault failure);

/// "no", "yes", "undecided" or "error".
[[nodiscard]] std::string_view to_string(fast::Verdict verdict);

}  // namespace touchstone::verify::judge
