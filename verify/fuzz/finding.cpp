#include "verify/fuzz/finding.hpp"

#include <stdexcept>

namespace touchstone::verify::fuzz {

std::string_view to_string(judge::Fault what) {
  switch (what) {
    case judge::Fault::false_negative:
      return "false_negative";
    case judge::Fault::false_positive:
      return "false_positive";
    case judge::Fault::late_toi:
      return "late_toi";
    case judge::Fault::early_toi_upper:
      return "early_toi_upper";
    case judge::Fault::beyond_tolerance:
      return "beyond_tolerance";
    case judge::Fault::asymmetry:
      return "asymmetry";
    case judge::Fault::crash:
      return solvers::to_string(judge::Fault::crash);
    case judge::Fault::exit:
      return solvers::to_string(judge::Fault::exit);
    case judge::Fault::exception:
      return solvers::to_string(judge::Fault::exception);
    case judge::Fault::no_verdict:
      return solvers::to_string(judge::Fault::no_verdict);
    case judge::Fault::not_finite:
      return solvers::to_string(judge::Fault::not_finite);
    case judge::Fault::hang:
      return solvers::to_string(judge::Fault::hang);
    case judge::Fault::undecided:
      return solvers::to_string(judge::Fault::undecided);
  }
  throw std::invalid_argument("no kind of finding");
}

std::optional<judge::Fault> judge::fault_from_name(std::string_view name) {
  for (std::size_t i = 0; i < finding_kinds; ++i) {
    const auto kind = static_cast<judge::Fault>(i);
    if (to_string(kind) == name) return kind;
  }
  return std::nullopt;
}

judge::Fault finding_kind_of(judge::Fault kind) {
  switch (kind) {
    case judge::Fault::crash:
      return judge::Fault::crash;
    case judge::Fault::exit:
      return judge::Fault::exit;
    case judge::Fault::exception:
      return judge::Fault::exception;
    case judge::Fault::no_verdict:
      return judge::Fault::no_verdict;
    case judge::Fault::not_finite:
      return judge::Fault::not_finite;
    case judge::Fault::hang:
      return judge::Fault::hang;
    case judge::Fault::undecided:
      return judge::Fault::undecided;
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
