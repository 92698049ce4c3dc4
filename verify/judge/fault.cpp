#include "verify/judge/fault.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <stdexcept>

#include "verify/io/number_text.hpp"
#include "verify/io/printable.hpp"

namespace touchstone::verify::judge {
namespace {

/// The names of a fault.
struct Words {
  std::string_view name;
  std::string_view text;
};

constexpr std::array<Words, fault_count> words{{
    {"false_negative", "false negative"},
    {"false_positive", "false positive"},
    {"late_toi", "late toi"},
    {"early_toi_upper", "early toi_upper"},
    {"crash", "error"},
    {"exit", "error"},
    {"exception", "error"},
    {"no_verdict", "error"},
    {"not_finite", "error"},
    {"hang", "hang"},
    {"undecided", "undecided"},
    {"beyond_tolerance", "beyond tolerance"},
    {"asymmetry", "asymmetry"},
}};

const Words& words_of(Fault fault) { return words.at(static_cast<std::size_t>(fault)); }

constexpr std::string_view status_prefix = "status ";
constexpr std::string_view signal_prefix = "signal ";

std::string signal_text(int number) {
#ifdef __GLIBC__
  if (const char* const name = ::sigabbrev_np(number)) return fmt::format("SIG{}", name);
#endif
  return fmt::format("{}{}", signal_prefix, number);
}

std::string detail(const Failure& failure) {
  switch (failure.kind) {
    case Fault::crash:
      return signal_text(failure.number);
    case Fault::exit:
      return fmt::format("{}{}", status_prefix, failure.number);
    default:
      return io::printable(failure.what);
  }
}

std::optional<int> number_behind(std::string_view prefix, std::string_view text) {
  if (!text.starts_with(prefix)) return std::nullopt;
  text.remove_prefix(prefix.size());
  return io::number_from_text<int>(text);
}

int signal_from_text(std::string_view text) {
  for (int number = 1; number < NSIG; ++number) {
    if (text == signal_text(number)) return number;
  }
  return number_behind(signal_prefix, text).value_or(0);
}

}  // namespace

std::string_view to_string(Fault fault) { return words_of(fault).name; }

std::optional<Fault> fault_from_name(std::string_view name) {
  const auto* const found = std::ranges::find(words, name, &Words::name);
  return found == words.end() ? std::nullopt
                              : std::optional(static_cast<Fault>(found - words.begin()));
}

std::string_view to_text(Fault fault) { return words_of(fault).text; }

const Failure* failure_at(std::span<const QueryFailure> failures, std::size_t position) {
  const auto found = std::ranges::lower_bound(failures, position, {}, &QueryFailure::position);
  return found != failures.end() && found->position == position ? &found->failure : nullptr;
}

std::string to_text(const Failure& failure) {
  const std::string more = detail(failure);
  const std::string_view kind = to_string(failure.kind);
  return more.empty() ? std::string(kind) : fmt::format("{}: {}", kind, more);
}

std::optional<Failure> failure_from_text(std::string_view text) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  const auto kind = fault_from_name(text.substr(0, colon));
  if (!kind || !is_failure(*kind)) return std::nullopt;
  Failure failure{.kind = *kind};
  std::string_view more = text.substr(std::min(colon + 1, text.size()));
  if (more.starts_with(' ')) more.remove_prefix(1);
  if (*kind == Fault::crash) {
    failure.number = signal_from_text(more);
  } else if (*kind == Fault::exit) {
    failure.number = number_behind(status_prefix, more).value_or(0);
  } else {
    failure.what = more;
  }
  return failure;
}

std::optional<Failure> failure_of(const fast::Answer& answer) {
  using fast::Verdict;
  if (answer.verdict == Verdict::error) return Failure{.kind = Fault::no_verdict};
  if (answer.verdict == Verdict::undecided) return Failure{.kind = Fault::undecided};
  if (answer.verdict != Verdict::yes) return std::nullopt;
  const auto not_finite = [](std::string_view name, double value) {
    return Failure{.kind = Fault::not_finite, .what = fmt::format("{} {}", name, value)};
  };
  if (std::isinf(answer.toi_lower)) return not_finite("toi_lower", answer.toi_lower);
  if (std::isinf(answer.toi_upper)) return not_finite("toi_upper", answer.toi_upper);
  // No comparison holds for a NaN, which marks a missing field.
  if (answer.tolerance < 0.0) return not_finite("tolerance", answer.tolerance);
  return std::nullopt;
}

fast::Verdict verdict_of(Fault failure) {
  return is_error(failure) ? fast::Verdict::error : fast::Verdict::undecided;
}

std::string_view to_string(fast::Verdict verdict) {
  switch (verdict) {
    case fast::Verdict::no:
      return "no";
    case fast::Verdict::yes:
      return "yes";
    case fast::Verdict::undecided:
      return "undecided";
    case fast::Verdict::error:
      return "error";
  }
  throw std::invalid_argument("no verdict");
}

}  // namespace touchstone::verify::judge
