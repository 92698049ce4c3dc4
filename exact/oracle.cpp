#include "touchstone/oracle.hpp"

#include <stdexcept>
#include <string>

#include "exact/contact/contact_oracle.hpp"
#include "exact/contact/corner_motion.hpp"
#include "exact/distance/distance_oracle.hpp"

namespace touchstone::exact {

Decision decide(Kind kind, const Query& query, const Separation& separation) {
  Decision decision = is_zero(separation)
                          ? decide_contact(scale_to_integers(kind, query))
                          : decide_distance(scale_uniformly(kind, query, separation));
  decision.separation = separation;
  return decision;
}

Decision decide(Kind kind, const CurvedQuery& query, const Separation& separation) {
  const MotionOf<Curved> motion = scale(kind, query, separation);
  Decision decision = is_zero(separation) ? decide_contact(motion) : decide_distance(motion);
  decision.separation = separation;
  return decision;
}

Decision decide(const Queries& queries, std::size_t i, const Separation& separation) {
  try {
    if (queries.is_straight()) return decide(queries.kind, queries.straight()[i], separation);
    return decide(queries.kind, to_curved(queries, i), separation);
  } catch (const std::domain_error& error) {
    throw std::domain_error("query " + std::to_string(i) + ": " + error.what());
  }
}

std::vector<Decision> decide(const Queries& queries, const Separation& separation) {
  std::vector<Decision> decisions;
  decisions.reserve(queries.size());
  for (std::size_t i = 0; i < queries.size(); ++i) {
    decisions.push_back(decide(queries, i, separation));
  }
  return decisions;
}

ContactParameters contact_parameters(const Decision& decision, const Rational& width) {
  if (!decision.contact) throw std::invalid_argument("the place of contact is not known");
  const auto& [u, v, denominator] = *decision.contact;
  return {enclose_quotient(u, denominator, *decision.toi, width),
          enclose_quotient(v, denominator, *decision.toi, width)};
}

}  // namespace touchstone::exact
