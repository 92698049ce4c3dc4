// The README's example of the oracle as a library.

#include <touchstone/exact.hpp>

#include <cstdio>

int main() {
  using namespace touchstone;
  // A vertex falls through a resting triangle: v, f0, f1, f2 at t=0, then at t=1.
  const Query query{{1, 1, 1,  0, 0, 0, 4, 0, 0, 0, 4, 0,  //
                     1, 1, -2, 0, 0, 0, 4, 0, 0, 0, 4, 0}};
  const exact::Decision verdict = exact::decide(ContactKind::vertex_face, query);
  if (!verdict.collides()) return 1;
  const exact::Rational width = exact::power_of_two(-60);
  const exact::ContactParameters at = exact::contact_parameters(verdict, width);
  const exact::DoubleInterval toi = verdict.toi->enclosure();
  std::printf("toi in [%.17g, %.17g], u = %s, v = %s\n", toi.lower, toi.upper,
              at.u.lower.get_str().c_str(), at.v.lower.get_str().c_str());
  return *verdict.toi == exact::Rational(1, 3) ? 0 : 1;
}
