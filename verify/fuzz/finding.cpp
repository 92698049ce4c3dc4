#include "verify/fuzz/finding.hpp"

#include <fmt/format.h>

#include <array>
#include <span>

namespace touchstone::verify::fuzz {
namespace {

/// "(0, 0.5, 1)", with a weight "(0, 0.5, 1; 2)".
std::string tuple(std::span<const double> point) {
  std::string result;
  for (std::size_t i = 0; i < point.size(); ++i) {
    result += i == 0 ? "(" : i < 3 ? ", " : "; ";
    result += fmt::format("{}", point[i]);
  }
  return result + ")";
}

/// "v", "f0" and so on of a vertex and a triangle, "ea0" and so on of two edges.
std::string_view point_name(AnyKind kind, std::size_t point) {
  static constexpr std::array<std::string_view, moving_points> of_face{"v", "f0", "f1", "f2"};
  static constexpr std::array<std::string_view, moving_points> of_edges{"ea0", "ea1", "eb0", "eb1"};
  static constexpr std::array<std::string_view, moving_points> of_cell{"a", "b", "c", "d"};
  if (kind.is_cell()) return of_cell.at(point);
  return kind == ContactKind::vertex_face ? of_face.at(point) : of_edges.at(point);
}

}  // namespace

std::string to_text(const AnyShape& shape) {
  if (shape.is_straight()) return std::string(to_string(shape.kind));
  return fmt::format("{}, {}degree {}", to_string(shape.kind),
                     shape.is_rational ? "rational, " : "", shape.degree);
}

std::string as_points(const base::AnyQuery& query) {
  const AnyShape& shape = query.shape();
  const std::size_t size = shape.numbers_of_point();
  std::string result;
  for (std::size_t point = 0; point < moving_points; ++point) {
    result += fmt::format("{:<3}  ", point_name(shape.kind, point));
    for (std::size_t j = 0; j <= shape.degree; ++j) {
      const auto place = query.numbers().subspan((moving_points * j + point) * size, size);
      result += (j == 0 ? "" : " → ") + tuple(place);
    }
    result += '\n';
  }
  return result;
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
