// The author of a filtered predicate derives the bound of its error from the predicate's own text.

#include <touchstone/derivation/rounding_model.hpp>
#include <touchstone/derivation/shipped_bound.hpp>

#include <array>
#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>

namespace {

using namespace touchstone::filters;

/// Twice the signed area of a triangle: ax, ay, bx, by, cx, cy.
struct Orientation {
  static constexpr std::string_view name = "orientation";
  static constexpr std::size_t coordinates = 6;
  static constexpr std::size_t weights = 0;

  template <class Visitor>
  static constexpr void visit_groups(const Visitor& /*visit*/) {}

  template <class Scalar>
  [[nodiscard]] static constexpr Scalar evaluate(const std::array<Scalar, coordinates>& x,
                                                 const std::array<Scalar, weights>& /*weights*/) {
    return (x[0] - x[4]) * (x[3] - x[5]) - (x[1] - x[5]) * (x[2] - x[4]);
  }
};

}  // namespace

int main() {
  const ExpressionGraph graph = record<Orientation>();
  const DerivedBound bound = derive_bound(graph, double_format);
  const mpq_class units = bound.rounding() / double_format.unit_roundoff();
  const std::string declaration = error_bound_declaration(graph, double_format);
  std::printf("%s%g u\n", declaration.c_str(), units.get_d());
  // filters/README.md, "Worked example: your own predicate".
  return units >= 30 && units < 31 && declaration.find("orientation_double") != std::string::npos
             ? 0
             : 1;
}
