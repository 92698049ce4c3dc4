// clang-format off
// Against github.com/ipc-sim/ipc-toolkit.
#include <ipc/ccd/additive_ccd.hpp>

#include <cstdio>

int main() {
  const double x[8][3] = {  // at t=0, then at t=1
      {0, 0, 0},  // ea0
      {4, 0, 0},  // ea1
      {0.5, -0.25, 0.1},  // eb0
      {0.5, 3.75, 0.1},  // eb1
      {0, 0, 0},  // ea0
      {4, 0, 0},  // ea1
      {0.5, -0.25, -0.1},  // eb0
      {0.5, 3.75, -0.1},  // eb1
  };
  const auto p = [&x](int i) { return Eigen::Vector3d(x[i][0], x[i][1], x[i][2]); };
  double toi = 0;
  const bool collides = ipc::AdditiveCCD(1000).edge_edge_ccd(
      p(0), p(1), p(2), p(3), p(4), p(5), p(6), p(7), toi, 0, 1);
  std::printf("%s, toi %.17g; truth: collision at 0.5\n", collides ? "yes" : "no", toi);
  return !collides ? 1 : 0;
}
