#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <tuple>

#include "fast/certified/exact/closest_point_parameters.hpp"
#include "fast/distance/contact_enclosure.hpp"
#include "fast/platform/floating_point_state.hpp"
#include "fast/platform/threads.hpp"
#include "fast/step/scene.hpp"
#include "touchstone/contacts.hpp"

namespace touchstone::fast {
namespace {

using exact_stage::nearest_parameters;

/// True if the primitives have a common point at the time.
bool touch_at(ContactKind kind, const Query& query, double t) {
  return distance(kind, query, t).upper == 0.0;
}

ActiveContact contact_between(const StepCollision& collision, const ContactEnclosure& enclosure) {
  ActiveContact result{collision,         enclosure.first,       enclosure.second,
                       enclosure.normal,  enclosure.point_error, enclosure.normal_error,
                       enclosure.has_side};
  result.u = enclosure.at.u;
  result.v = enclosure.at.v;
  return result;
}

/// \pre strict floating point
ActiveContact contact_in(const Step& step, const StepCollision& collision) {
  if (!(collision.toi_lower >= 0.0 && collision.toi_upper >= collision.toi_lower &&
        collision.toi_upper <= 1.0)) {
    throw std::invalid_argument("contact_of: the times of a collision must be in [0,1], in order");
  }
  const Separation separation = step.separation_of(collision.kind, collision.pair);
  const ContactKind kind = decided_as(collision.kind);
  const Query query = step.query_of(collision.kind, collision.pair);
  TimeEnclosure time{collision.toi_lower, collision.toi_upper};
  bool is_touching = is_zero(separation);
  if (!is_touching && time.lower == 0.0 && touch_at(kind, query, 0.0)) {
    is_touching = true;
    time.upper = 0.0;
  }
  const bool has_parameters = is_touching || separation.norm == Norm::l2;
  const exact_stage::Parameters at = has_parameters
                                         ? exact_stage::Parameters{collision.u, collision.v}
                                         : nearest_parameters(kind, query, time.upper, Norm::l2);
  return contact_between(collision, enclose_contact(kind, query, time, at, is_touching));
}

}  // namespace

ActiveContact contact_of(const Step& step, const StepCollision& collision) {
  const StrictFloatingPoint strict;
  return contact_in(step, collision);
}

std::vector<ActiveContact> contacts_of(const Step& step,
                                       std::span<const StepCollision> collisions) {
  require_straight(step.vertices(), "contacts");
  constexpr std::size_t collisions_of_task = 256;
  std::vector<ActiveContact> result(collisions.size());
  with_threads(scene_of(step).certified().max_threads, [&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, collisions.size(), collisions_of_task),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        const StrictFloatingPoint strict;
                        for (std::size_t i = range.begin(); i < range.end(); ++i) {
                          result[i] = contact_in(step, collisions[i]);
                        }
                      });
  });
  return result;
}

std::vector<ActiveContact> active_set(const Step& step, const Separation& separation) {
  require_straight(step.vertices(), "contacts");
  const Step at_distance = step.with_separation(separation);
  std::vector<ActiveContact> result = contacts_of(at_distance, at_distance.collisions());
  std::ranges::sort(result, [](const ActiveContact& a, const ActiveContact& b) {
    return std::tie(a.toi_lower, a.toi_upper, a.kind, a.pair) <
           std::tie(b.toi_lower, b.toi_upper, b.kind, b.pair);
  });
  return result;
}

ActiveContact contact_at(const Step& step, ContactKind kind, const IndexPair& pair, double t) {
  if (!(t >= 0.0 && t <= 1.0))
    throw std::invalid_argument("contact_at: the time must be in [0, 1]");
  const StrictFloatingPoint strict;
  const ContactKind query_kind = decided_as(kind);
  const Query query = step.query_of(kind, pair);
  const StepCollision collision{.kind = kind, .pair = pair, .toi_lower = t, .toi_upper = t};
  return contact_between(
      collision,
      enclose_contact(query_kind, query, {t, t}, nearest_parameters(query_kind, query, t, Norm::l2),
                      touch_at(query_kind, query, t)));
}

}  // namespace touchstone::fast
