/// \file
/// The shortest simulator with collision detection: a pyramid falls onto a resting square. Each
/// motion is shortened by a line search, so none collides.

#include <touchstone/contacts.hpp>

#include <Eigen/Core>

#include <cstdio>
#include <vector>

using namespace touchstone;
using Places = Eigen::Matrix<double, 8, 3>;

// Vertices 0 to 3 are the square at rest, 4 to 7 the pyramid, with its tip below.
const std::vector<fast::Face> faces{{0, 1, 2}, {0, 2, 3}, {4, 6, 5},
                                    {4, 5, 7}, {4, 7, 6}, {5, 6, 7}};

Places start(double height) {
  Places x;
  x << -2, -2, 0, 2, -2, 0, 2, 2, 0, -2, 2, 0,  // the square
      0.25, 0.5, height, 1, 0, height + 1, -1, 1, height + 1, -1, -1, height + 1;
  return x;
}

// A start in contact allows no step. The pairs in contact tell the direction of the way out.
void separate(Places& x) {
  const fast::Step rest(x, x, {.faces = faces});
  for (const fast::ActiveContact& contact : fast::active_set(rest, {})) {
    std::printf("in contact: vertex %d, face %d\n", contact.pair[0], contact.pair[1]);
    const Eigen::Vector3d up = contact.normal.z() < 0 ? -contact.normal : contact.normal;
    x.bottomRows<4>().rowwise() += 0.2 * up.transpose();
  }
}

int main() {
  Places x = start(0);  // the tip touches the square
  double speed = 0;
  for (int i = 0; i < 10; ++i) {
    speed -= 0.1;
    Places wanted = x;
    wanted.bottomRows<4>().col(2).array() += 0.1 * speed;
    const fast::Step step(x, wanted, {.faces = faces});
    const fast::LineSearchLimit limit = fast::line_search_limit(step, 0.2);
    if (limit.status == fast::LineSearchStatus::in_contact) {
      separate(x);
      continue;
    }
    x += limit.step_size * (wanted - x);
    if (limit.status == fast::LineSearchStatus::limited) speed = -0.8 * speed;  // bounce
    const auto least = fast::least_distance(fast::Step(x, x, {.faces = faces}));
    std::printf("step %d: size %.3f, distance %.6f\n", i, limit.step_size, least->distance.lower);
  }
}
