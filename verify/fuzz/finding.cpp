#include "verify/fuzz/finding.hpp"

#include <stdexcept>

namespace touchstone::verify {

std::string_view to_string(FindingKind what) {
  switch (what) {
    case FindingKind::false_negative:
      return "false_negative";
    case FindingKind::false_positive:
      return "false_positive";
    case FindingKind::late_toi:
      return "late_toi";
    case FindingKind::early_toi_upper:
      return "early_toi_upper";
    case FindingKind::beyond_tolerance:
      return "beyond_tolerance";
    case FindingKind::asymmetry:
      return "asymmetry";
    case FindingKind::crash:
      return to_string(FailureKind::crash);
    case FindingKind::exit:
      return to_string(FailureKind::exit);
    case FindingKind::exception:
      return to_string(FailureKind::exception);
    case FindingKind::no_verdict:
      return to_string(FailureKind::no_verdict);
    case FindingKind::not_finite:
      return to_string(FailureKind::not_finite);
    case FindingKind::hang:
      return to_string(FailureKind::hang);
    case FindingKind::undecided:
      return to_string(FailureKind::undecided);
  }
  throw std::invalid_argument("no kind of finding");
}

std::optional<FindingKind> finding_kind_from_string(std::string_view name) {
  for (std::size_t i = 0; i < finding_kinds; ++i) {
    const auto kind = static_cast<FindingKind>(i);
    if (to_string(kind) == name) return kind;
  }
  return std::nullopt;
}

FindingKind finding_kind_of(FailureKind kind) {
  switch (kind) {
    case FailureKind::crash:
      return FindingKind::crash;
    case FailureKind::exit:
      return FindingKind::exit;
    case FailureKind::exception:
      return FindingKind::exception;
    case FailureKind::no_verdict:
      return FindingKind::no_verdict;
    case FailureKind::not_finite:
      return FindingKind::not_finite;
    case FailureKind::hang:
      return FindingKind::hang;
    case FailureKind::undecided:
      return FindingKind::undecided;
  }
  throw std::invalid_argument("no kind of failure");
}

std::string_view to_string(Shrinking shrinking) {
  switch (shrinking) {
    case Shrinking::not_tried:
      return "not tried";
    case Shrinking::complete:
      return "complete";
    case Shrinking::cut_short:
      return "cut short";
    default:
      return "not reproduced";
  }
}

}  // namespace touchstone::verify
