#include "verify/fuzz/finding.hpp"

#include <stdexcept>

namespace touchstone::verify::fuzz {

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
      return solvers::to_string(solvers::FailureKind::crash);
    case FindingKind::exit:
      return solvers::to_string(solvers::FailureKind::exit);
    case FindingKind::exception:
      return solvers::to_string(solvers::FailureKind::exception);
    case FindingKind::no_verdict:
      return solvers::to_string(solvers::FailureKind::no_verdict);
    case FindingKind::not_finite:
      return solvers::to_string(solvers::FailureKind::not_finite);
    case FindingKind::hang:
      return solvers::to_string(solvers::FailureKind::hang);
    case FindingKind::undecided:
      return solvers::to_string(solvers::FailureKind::undecided);
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

FindingKind finding_kind_of(solvers::FailureKind kind) {
  switch (kind) {
    case solvers::FailureKind::crash:
      return FindingKind::crash;
    case solvers::FailureKind::exit:
      return FindingKind::exit;
    case solvers::FailureKind::exception:
      return FindingKind::exception;
    case solvers::FailureKind::no_verdict:
      return FindingKind::no_verdict;
    case solvers::FailureKind::not_finite:
      return FindingKind::not_finite;
    case solvers::FailureKind::hang:
      return FindingKind::hang;
    case solvers::FailureKind::undecided:
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

}  // namespace touchstone::verify::fuzz
