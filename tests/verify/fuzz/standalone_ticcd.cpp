// clang-format off
// Against github.com/Continuous-Collision-Detection/Tight-Inclusion.
#include <tight_inclusion/ccd.hpp>

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
  const auto p = [&x](int i) { return ticcd::Vector3(x[i][0], x[i][1], x[i][2]); };
  ticcd::Scalar toi = 0, tolerance = 0;
  const bool collides = ticcd::edgeEdgeCCD(p(0), p(1), p(2), p(3), p(4), p(5), p(6), p(7),
                              ticcd::Array3(-1, -1, -1), 0, toi, 1e-06, 1, 1000, tolerance);
  std::printf("%s, toi %.17g; truth: collision at 0.5\n", collides ? "yes" : "no", toi);
  return !collides ? 1 : 0;
}
