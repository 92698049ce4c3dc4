// What a simulator includes: single queries by both solvers, and a whole step through the broad phase.

#include <exact/query.hpp>
#include <fast/broad_phase.hpp>
#include <fast/certified.hpp>
#include <fast/mesh.hpp>
#include <fast/platform/arithmetic_check.hpp>
#include <fast/tight_inclusion.hpp>

#include <Eigen/Core>

#include <array>
#include <cstdio>
#include <vector>

namespace {

using namespace touchstone;

constexpr double expected_toi = 1.0 / 3.0;

bool answers_single_queries() {
  // A vertex falls through a resting triangle: v, f0, f1, f2 at t=0, then at t=1.
  const Query query{{1, 1, 1,  0, 0, 0, 4, 0, 0, 0, 4, 0,  //
                     1, 1, -2, 0, 0, 0, 4, 0, 0, 0, 4, 0}};
  const fast::CertifiedResult certified = fast::certified(Kind::vertex_face, query);
  const fast::TightInclusionResult inclusion = fast::tight_inclusion(Kind::vertex_face, query);
  return certified.verdict == fast::Verdict::yes && certified.toi_lower <= expected_toi &&
         certified.toi_upper >= expected_toi && inclusion.verdict == fast::Verdict::yes &&
         inclusion.toi <= expected_toi;
}

bool answers_a_step() {
  // A triangle falls through a larger one that rests.
  Eigen::MatrixXd before(6, 3);
  before << 0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, 1, 1.5, 1, 1, 1, 1.5, 1;
  Eigen::MatrixXd after = before;
  after.bottomRows(3).col(2).array() -= 3.0;
  const std::vector<fast::Face> faces{{0, 1, 2}, {3, 4, 5}};
  const std::vector<fast::Edge> edges = fast::edges_of(faces);
  const fast::MovingVertices vertices(before, after);
  const auto pairs = fast::vertex_face_candidates(vertices, faces);
  const fast::Candidates candidates{Kind::vertex_face, pairs, edges, faces};
  const auto impact = fast::earliest(vertices, candidates);
  const auto collisions = fast::collisions(vertices, candidates);
  const auto edge_pairs = fast::edge_edge_candidates(vertices, edges);
  const bool edges_touch =
      fast::earliest(vertices, {Kind::edge_edge, edge_pairs, edges, faces}).has_value();
  return impact && impact->toi_lower <= expected_toi && impact->toi_upper >= expected_toi &&
         collisions.size() == 3 && !edges_touch;
}

}  // namespace

int main() {
  fast::require_strict_arithmetic();
  const bool right = answers_single_queries() && answers_a_step();
  std::printf("simulator: %s\n", right ? "right" : "wrong");
  return right ? 0 : 1;
}
