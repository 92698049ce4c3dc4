#include "exact/distance/distance_oracle.hpp"

#include <stdexcept>
#include <utility>

#include "exact/contact/contact_conditions.hpp"
#include "exact/distance/separating_axes.hpp"
#include "exact/oracle.hpp"

namespace touchstone::exact {

DistanceVerdict decide_by_walk(const Motion& motion) {
  std::optional<AlgebraicNumber> toi = first_contact(motion);
  if (toi && !find_near_contact(motion, *toi)) {
    throw std::logic_error("touchstone: the walk ended where nothing is within the distance");
  }
  return {std::move(toi)};
}

DistanceVerdict decide(Kind kind, const Query& query, const Separation& separation) {
  const Motion motion = scale_uniformly(kind, query, separation);
  if (sgn(motion.distance) > 0) return decide_by_walk(motion);
  Verdict plain = decide(kind, query);
  if (!plain.impact) return {};
  return {std::move(plain.impact->toi)};
}

}  // namespace touchstone::exact
