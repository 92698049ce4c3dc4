#include "verify/fuzz/finding.hpp"

namespace touchstone::verify {

std::string_view to_string(FindingKind what) {
  switch (what) {
    case FindingKind::false_negative:
      return "false_negative";
    case FindingKind::late_toi:
      return "late_toi";
    case FindingKind::early_toi_upper:
      return "early_toi_upper";
    case FindingKind::beyond_promise:
      return "beyond_promise";
    case FindingKind::asymmetry:
      return "asymmetry";
    case FindingKind::crash:
      return "crash";
    case FindingKind::hang:
      return "hang";
    default:
      return "not_finite";
  }
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
