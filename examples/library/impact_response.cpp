/// \file
/// A body that falls onto a sloping roof. At each impact its velocity is reflected at the normal of
/// the contact, and no motion collides.

#include <touchstone/contacts.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstdio>
#include <vector>

using namespace touchstone;
using Places = Eigen::Matrix<double, 8, 3>;

// Vertices 0 to 3 are the roof at rest, z = x/2, and 4 to 7 the body.
const std::vector<fast::Face> faces{{0, 1, 2}, {0, 2, 3}, {4, 6, 5},
                                    {4, 5, 7}, {4, 7, 6}, {5, 6, 7}};

// Leaves nothing of the velocity that leads into the contact, and gives a part of it back.
void respond(const fast::Step& step, const fast::ActiveContact& contact,
             Eigen::Vector3d& velocity) {
  if (!contact.has_normal() || !contact.has_side) return;  // degenerate: no direction to go by
  // The normal points from the second primitive to the first, which may be the body's or not.
  const bool body_is_first = step.vertices_of(contact.kind, contact.pair)[0] >= 4;
  const Eigen::Vector3d away = body_is_first ? contact.normal : -contact.normal;
  velocity -= 1.5 * std::min(0.0, velocity.dot(away)) * away;
  std::printf("impact at %.3f %.3f %.3f, normal %.3f %.3f %.3f, both known to %.0e\n",
              contact.first.x(), contact.first.y(), contact.first.z(), away.x(), away.y(), away.z(),
              std::max(contact.point_error, contact.normal_error));
}

int main() {
  Places x;
  x << -4, -4, -2, 4, -4, 2, 4, 4, 2, -4, 4, -2,  // the roof
      0.25, 0.5, 1, 1, 0, 2, -1, 1, 2, -1, -1, 2;
  Eigen::Vector3d velocity(0, 0, 0);
  for (int i = 0; i < 10; ++i) {
    velocity.z() -= 1;
    Places wanted = x;
    wanted.bottomRows<4>().rowwise() += 0.1 * velocity.transpose();
    const fast::Step step(x, wanted, {.faces = faces});
    if (const auto impact = step.earliest()) {
      for (const auto& contact : fast::contacts_of(step, impact->pairs)) {
        respond(step, contact, velocity);
      }
    }
    // Up to the impact, but for a tenth of the distance.
    x += fast::line_search_limit(step, 0.1).step_size * (wanted - x);
  }
  std::printf("the body is above the roof: %.0e\n", x(4, 2) - x(4, 0) / 2);
}
