#include "exact/distance/distance_oracle.hpp"

#include <stdexcept>
#include <utility>

#include "exact/contact/contact_conditions.hpp"
#include "exact/distance/separating_axes.hpp"

namespace touchstone::exact {

template <class Order>
Decision decide_distance(const MotionOf<Order>& motion) {
  std::optional<AlgebraicNumber> toi = end_of_separation(motion);
  if (toi && !find_near_contact(motion, *toi)) {
    throw std::logic_error("touchstone: no point is within the distance where the axes end");
  }
  return {.toi = std::move(toi)};
}

template Decision decide_distance(const MotionOf<Straight>& motion);
template Decision decide_distance(const MotionOf<Curved>& motion);

}  // namespace touchstone::exact
