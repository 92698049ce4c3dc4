// A program written for Tight-Inclusion.

#include <cstdio>
#include <tight_inclusion/ccd.hpp>

int main() {
  const ticcd::Vector3 a(0, 0, 0), b(4, 0, 0), c(0, 4, 0), above(1, 1, 1), below(1, 1, -1);
  ticcd::Scalar toi = 0, tolerance = 0;
  const bool collision = ticcd::vertexFaceCCD(above, a, b, c, below, a, b, c, {-1, -1, -1}, 0, toi,
                                              1e-6, 1, -1, tolerance);
  std::printf("%s at %.17g\n", collision ? "collision" : "none", toi);
  return collision && toi < 0.5 ? 0 : 1;
}
