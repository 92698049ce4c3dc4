#include "touchstone/inversion_oracle.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "exact/contact/corner_motion.hpp"

namespace touchstone::exact {
namespace {

/// The corners of a vertex a and a face b, c, d are a − b, a − c, a − d, whose determinant is
/// −det(b − a, c − a, d − a).
template <class Order>
InversionDecision decide(const MotionOf<Order>& motion) {
  const auto volume = -determinant(motion);
  const int start = sgn(volume.c.front());
  if (start <= 0) return {start, AlgebraicNumber(0)};
  if (std::ranges::all_of(volume.c, [](const Integer& c) { return sgn(c) > 0; })) return {start};
  std::vector<AlgebraicNumber> roots = roots_in_unit_interval(to_polynomial(volume));
  if (roots.empty()) return {start};
  return {start, std::move(roots.front())};
}

}  // namespace

InversionDecision decide_inversion(const Query& tetrahedron) {
  return decide(scale_to_integers(Kind::vertex_face, tetrahedron));
}

InversionDecision decide_inversion(const CurvedQuery& tetrahedron) {
  return decide(scale(Kind::vertex_face, tetrahedron, {}));
}

InversionDecision decide_inversion(const PlaneTriangle& triangle) {
  return decide_inversion(to_tetrahedron(triangle));
}

InversionDecision decide_inversion(const CurvedTriangle& triangle) {
  return decide_inversion(to_tetrahedron(triangle));
}

}  // namespace touchstone::exact
