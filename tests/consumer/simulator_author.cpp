// The includes of a simulator: single queries by both solvers, and a whole step.

#include <touchstone/fast.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <cstdio>
#include <vector>

namespace {

using namespace touchstone;

constexpr double expected_toi = 1.0 / 3.0;

bool answers_single_queries() {
  // A vertex falls through a resting triangle: v, f0, f1, f2 at t=0, then at t=1.
  const Query query{{1, 1, 1,  0, 0, 0, 4, 0, 0, 0, 4, 0,  //
                     1, 1, -2, 0, 0, 0, 4, 0, 0, 0, 4, 0}};
  const fast::CertifiedResult certified = fast::solve(ContactKind::vertex_face, query);
  const fast::TightInclusionResult inclusion =
      fast::tight_inclusion(ContactKind::vertex_face, query);
  const Eigen::Vector3d above(1, 1, 1), below(1, 1, -2), o(0, 0, 0), a(4, 0, 0), b(0, 4, 0);
  const fast::CertifiedResult of_points = fast::solve_vertex_face(above, o, a, b, below, o, a, b);
  return of_points.toi_lower == certified.toi_lower && certified.verdict == fast::Verdict::yes &&
         certified.toi_lower <= expected_toi && certified.toi_upper >= expected_toi &&
         inclusion.verdict == fast::Verdict::yes && inclusion.toi <= expected_toi;
}

bool answers_a_solver(const fast::Step& step) {
  const auto least = fast::least_distance(step);
  const fast::LineSearchLimit limit = fast::line_search_limit(step, 0.5);
  const std::vector<fast::ActiveContact> active =
      fast::active_set(step, {.distance = 0.25, .norm = Norm::l2});
  return least && least->distance.lower == 1.0 && limit.step_size <= 0.5 * expected_toi &&
         limit.step_size > 0.1 && active.size() == 3 && active[0].normal.z() == 1.0;
}

bool answers_a_step() {
  // A triangle falls through a larger one that rests.
  Eigen::MatrixXd before(6, 3);
  before << 0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, 1, 1.5, 1, 1, 1, 1.5, 1;
  Eigen::MatrixXd after = before;
  after.bottomRows(3).col(2).array() -= 3.0;
  const std::vector<fast::Face> faces{{0, 1, 2}, {3, 4, 5}};
  const fast::Step step(before, after, {.faces = faces});
  const auto impact = step.earliest();
  std::size_t candidates = 0;
  step.candidates([&](const fast::StepCandidates& some) { candidates += some.pairs.size(); });
  return impact && impact->toi_lower <= expected_toi && impact->toi_upper >= expected_toi &&
         step.collisions().size() == 3 && candidates >= 3 && !step.is_free() &&
         step.scaled(0.25).is_free() && answers_a_solver(step);
}

}  // namespace

int main() {
  const bool right = answers_single_queries() && answers_a_step();
  std::printf("simulator: %s\n", right ? "right" : "wrong");
  return right ? 0 : 1;
}
