#include "touchstone/oracle.hpp"

#include <stdexcept>

#include "exact/contact/contact_oracle.hpp"
#include "exact/contact/corner_motion.hpp"
#include "exact/distance/distance_oracle.hpp"

namespace touchstone::exact {

Decision decide(Kind kind, const Query& query, const Separation& separation) {
  Decision verdict = is_zero(separation)
                         ? decide_contact(scale_to_integers(kind, query))
                         : decide_distance(scale_uniformly(kind, query, separation));
  verdict.separation = separation;
  return verdict;
}

Decision decide(Kind kind, const CurvedQuery& query, const Separation& separation) {
  const MotionOf<Curved> motion = scale(kind, query, separation);
  Decision verdict = is_zero(separation) ? decide_contact(motion) : decide_distance(motion);
  verdict.separation = separation;
  return verdict;
}

ContactParameters contact_parameters(const Decision& verdict, const Rational& width) {
  if (!verdict.contact) throw std::invalid_argument("the place of contact is not known");
  const auto& [u, v, denominator] = *verdict.contact;
  return {enclose_quotient(u, denominator, *verdict.toi, width),
          enclose_quotient(v, denominator, *verdict.toi, width)};
}

}  // namespace touchstone::exact
