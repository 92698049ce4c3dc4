// Proves a step and the mesh at its start, for touchstone-check: prover STEP.cert MESH.cert

#include <touchstone/scene_certificate.hpp>

#include <fstream>

int main(int, char** files) {
  using namespace touchstone;
  // A triangle falls onto another one.
  const Eigen::MatrixX3d before{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 1}, {2, 1, 2}, {1, 2, 2}};
  Eigen::MatrixX3d after = before;
  after.bottomRows<3>().col(2).array() -= 4;
  const fast::Mesh mesh{.faces = {{0, 1, 2}, {3, 4, 5}}};
  const exact::SceneProof step = exact::prove_step(fast::Step(before, after, mesh));
  const exact::SceneProof start = exact::prove_mesh(before, mesh);
  std::ofstream(files[1]) << step.stream;
  std::ofstream(files[2]) << start.stream;
  const bool is_right = step.claim == "earliest 0x1.fffffffffffffp-3 1/4";
  return is_right && start.claim == "intersections 0" ? 0 : 1;
}
