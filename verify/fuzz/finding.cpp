#include "verify/fuzz/finding.hpp"

#include <fmt/format.h>

namespace touchstone::verify::fuzz {

std::string to_text(const QueryShape& shape) {
  if (shape.is_straight()) return std::string(to_string(shape.kind));
  return fmt::format("{}, {}degree {}", to_string(shape.kind),
                     shape.is_rational ? "rational, " : "", shape.degree);
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
