#include "verify/solvers/failure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <csignal>
#include <cstring>
#include <stdexcept>

#include "verify/io/printable.hpp"

namespace touchstone::verify::solvers {
namespace {

constexpr std::string_view status_prefix = "status ";
constexpr std::string_view signal_prefix = "signal ";

std::string signal_text(int number) {
  const char* const name = ::sigabbrev_np(number);
  return name == nullptr ? fmt::format("{}{}", signal_prefix, number) : fmt::format("SIG{}", name);
}

std::string detail(const Failure& failure) {
  switch (failure.kind) {
    case FailureKind::crash:
      return signal_text(failure.number);
    case FailureKind::exit:
      return fmt::format("{}{}", status_prefix, failure.number);
    default:
      return io::printable(failure.what);
  }
}

std::optional<int> number_behind(std::string_view prefix, std::string_view text) {
  if (!text.starts_with(prefix)) return std::nullopt;
  text.remove_prefix(prefix.size());
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

int signal_from_text(std::string_view text) {
  for (int number = 1; number < NSIG; ++number) {
    if (text == signal_text(number)) return number;
  }
  return number_behind(signal_prefix, text).value_or(0);
}

}  // namespace

std::string_view to_string(FailureKind kind) {
  switch (kind) {
    case FailureKind::crash:
      return "crash";
    case FailureKind::exit:
      return "exit";
    case FailureKind::exception:
      return "exception";
    case FailureKind::no_verdict:
      return "no_verdict";
    case FailureKind::not_finite:
      return "not_finite";
    case FailureKind::hang:
      return "hang";
    case FailureKind::undecided:
      return "undecided";
  }
  throw std::invalid_argument("no kind of failure");
}

std::optional<FailureKind> failure_kind_from_string(std::string_view name) {
  const auto* const found = std::ranges::find_if(
      all_failure_kinds, [&](FailureKind kind) { return to_string(kind) == name; });
  return found == all_failure_kinds.end() ? std::nullopt : std::optional(*found);
}

std::string to_text(const Failure& failure) {
  const std::string more = detail(failure);
  const std::string_view kind = to_string(failure.kind);
  return more.empty() ? std::string(kind) : fmt::format("{}: {}", kind, more);
}

std::optional<Failure> failure_from_text(std::string_view text) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  const auto kind = failure_kind_from_string(text.substr(0, colon));
  if (!kind) return std::nullopt;
  Failure failure{.kind = *kind};
  std::string_view more = text.substr(std::min(colon + 1, text.size()));
  if (more.starts_with(' ')) more.remove_prefix(1);
  if (*kind == FailureKind::crash) {
    failure.number = signal_from_text(more);
  } else if (*kind == FailureKind::exit) {
    failure.number = number_behind(status_prefix, more).value_or(0);
  } else {
    failure.what = more;
  }
  return failure;
}

std::optional<Failure> failure_of(const fast::Answer& answer) {
  using fast::Verdict;
  if (answer.verdict == Verdict::error) return Failure{.kind = FailureKind::no_verdict};
  if (answer.verdict == Verdict::undecided) return Failure{.kind = FailureKind::undecided};
  if (answer.verdict != Verdict::yes) return std::nullopt;
  if (std::isinf(answer.toi_lower)) {
    return Failure{.kind = FailureKind::not_finite,
                   .what = fmt::format("toi_lower {}", answer.toi_lower)};
  }
  if (std::isinf(answer.toi_upper)) {
    return Failure{.kind = FailureKind::not_finite,
                   .what = fmt::format("toi_upper {}", answer.toi_upper)};
  }
  return std::nullopt;
}

fast::Verdict verdict_of(FailureKind kind) {
  const bool is_undecided = kind == FailureKind::undecided || kind == FailureKind::hang;
  return is_undecided ? fast::Verdict::undecided : fast::Verdict::error;
}

}  // namespace touchstone::verify::solvers
