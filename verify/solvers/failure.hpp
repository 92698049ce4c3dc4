#pragma once

/// \file
/// The ways in which a solver can fail to answer a query, told apart everywhere by one enumeration.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "fast/method.hpp"

namespace touchstone::verify::solvers {

/// Why there is no answer to a query.
enum class FailureKind : std::uint8_t {
  crash,       ///< a signal ended its process
  exit,        ///< it ended its process with an exit status
  exception,   ///< it threw
  no_verdict,  ///< it answered error, or set no verdict
  not_finite,  ///< it answered yes with an infinite time of impact
  hang,        ///< it took longer than the limit
  undecided    ///< it answered undecided by itself
};
inline constexpr std::size_t failure_kinds = 7;

/// All of them, in their order.
inline constexpr std::array<FailureKind, failure_kinds> all_failure_kinds{
    FailureKind::crash,      FailureKind::exit, FailureKind::exception, FailureKind::no_verdict,
    FailureKind::not_finite, FailureKind::hang, FailureKind::undecided};

/// "crash", "exit", "exception", "no_verdict", "not_finite", "hang" or "undecided".
[[nodiscard]] std::string_view to_string(FailureKind kind);

/// The kind of that name, if there is one.
[[nodiscard]] std::optional<FailureKind> failure_kind_from_string(std::string_view name);

/// Why there is no answer to a query, in particular.
struct Failure {
  FailureKind kind = FailureKind::no_verdict;
  /// The signal of a crash, the status of an exit; else 0.
  int number = 0;
  /// The text of an exception, the time that is not finite; else empty.
  std::string what = {};

  friend bool operator==(const Failure&, const Failure&) = default;
};

/// A failure at one of several queries.
struct QueryFailure {
  std::size_t position = 0;
  Failure failure = {};
};

/// "crash: SIGSEGV", "exit: status 3", "exception: text", "not_finite: toi_lower inf", and of the
/// others the kind alone. Printable (verify/io/printable.hpp).
[[nodiscard]] std::string to_text(const Failure& failure);

/// The reverse of to_text; the kind alone where the rest is none that it writes.
[[nodiscard]] std::optional<Failure> failure_from_text(std::string_view text);

/// The failure that an answer itself shows: no_verdict, not_finite or undecided.
[[nodiscard]] std::optional<Failure> failure_of(const fast::Answer& answer);

/// The verdict that a query with that failure counts as: undecided, a conservative yes, if the solver was
/// undecided or too slow, else error.
[[nodiscard]] fast::Verdict verdict_of(FailureKind kind);

}  // namespace touchstone::verify::solvers
