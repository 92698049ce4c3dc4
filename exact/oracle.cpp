#include "touchstone/oracle.hpp"

#include <stdexcept>
#include <string>

#include "exact/contact/contact_oracle.hpp"
#include "exact/contact/corner_motion.hpp"
#include "exact/distance/distance_oracle.hpp"
#include "touchstone/inversion_oracle.hpp"

namespace touchstone::exact {
namespace {

/// The first time at which an element's volume is not positive, as a time of impact.
/// \param triangle its first three points
template <class AnyQuery, class Triangle>
Decision decide_element(Kind kind, const AnyQuery& query, const Triangle& triangle,
                        const Separation& separation) {
  if (!is_zero(separation)) throw std::invalid_argument("an element has no separation");
  return {.separation = separation,
          .toi = kind == Kind::tetrahedron ? decide_inversion(query).time
                                           : decide_inversion(triangle).time};
}

}  // namespace

Decision decide(Kind kind, const Query& query, const Separation& separation) {
  if (is_element(kind)) return decide_element(kind, query, to_plane_triangle(query), separation);
  Decision decision = is_zero(separation)
                          ? decide_contact(scale_to_integers(kind, query))
                          : decide_distance(scale_uniformly(kind, query, separation));
  decision.separation = separation;
  return decision;
}

Decision decide(Kind kind, const CurvedQuery& query, const Separation& separation) {
  if (is_element(kind)) {
    return decide_element(kind, query, CurvedTriangle{query[0], query[1], query[2]}, separation);
  }
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
