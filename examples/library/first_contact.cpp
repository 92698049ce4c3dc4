// The first contact in a step of a mesh: one triangle falls onto another one.
#include <touchstone/step.hpp>

#include <cstdio>

using namespace touchstone;

int main() {
  const Eigen::MatrixX3d before{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 1}, {2, 1, 2}, {1, 2, 2}};
  Eigen::MatrixX3d after = before;
  after.bottomRows<3>().col(2).array() -= 3;  // the second one falls
  const std::vector<fast::Face> faces{{0, 1, 2}, {3, 4, 5}};
  const auto impact = fast::Step(before, after, {.faces = faces}).earliest();
  if (!impact) return 1;
  const auto [vertex, face] = impact->pairs.front().pair;
  std::printf("free up to %.12f: vertex %d, face %d\n", impact->toi_lower, vertex, face);
}
