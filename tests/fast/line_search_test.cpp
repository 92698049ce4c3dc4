#include "touchstone/contacts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "fast/distance/exact_distance.hpp"
#include "tests/faults/planted_faults.hpp"
#include "tests/support/inverting_cells.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/number.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::fast::line_search_test {
namespace {

using exact::Rational;
using tests::Places;
using tests::Random;
using tests::Scene;

constexpr double tiniest = std::numeric_limits<double>::denorm_min();

/// A triangle at a height over the origin of a larger one, and its place at t=1.
Scene falling_triangle(double height, double end) {
  Scene scene{.start = Places(6, 3), .end = {}, .faces = {{0, 1, 2}, {3, 4, 5}}};
  scene.start << -4, -4, 0, 8, -4, 0, -4, 8, 0,  //
      -1, -1, height, 1, -1, height + 1, -1, 1, height + 2;
  scene.end = scene.start;
  scene.end.bottomRows(3).col(2).array() += end - height;
  scene.edges = edges_of(scene.faces);
  return scene;
}

// ---- One step -----------------------------------------------------------------------------------

TEST(LineSearch, SaysWhatIsTooSmallForDoubles) {
  for (const StartDistance start : {StartDistance::of_scene, StartDistance::of_pair}) {
    const LineSearchOptions options{.start_distance = start};
    // No double lies between half of the least double and itself. It is half of the second one; the
    // time to get there is 2^-1073 2^-10.
    for (const Scene& scene :
         {falling_triangle(tiniest, -1.0), falling_triangle(4 * tiniest, -0x1p10)}) {
      const auto limit = line_search_limit(scene.step(), 0.5, options);
      EXPECT_EQ(limit.status, LineSearchStatus::too_small);
      EXPECT_EQ(limit.step_size, 0.0);
      EXPECT_EQ(limit.pairs.size(), 1U);
    }
    const auto slow = line_search_limit(falling_triangle(8 * tiniest, 0.0).step(), 0.5, options);
    EXPECT_EQ(slow.status, LineSearchStatus::limited);
    EXPECT_GT(slow.step_size, 0.3);
  }
}

// ---- What it promises ---------------------------------------------------------------------------

/// True if a pair, up to that time, comes nearer than p times its distance or the scene's, by the
/// oracle.
bool comes_nearer(ContactKind kind, const Query& query, double time, Norm norm, double p,
                  double distance, double thickness) {
  // A pair is nearer than p d if it is within the next lower double.
  const Rational kept = Rational(thickness) + Rational(p) * Rational(distance);
  const double less = std::nextafter(exact::round_down(kept), 0.0);
  const exact::Decision verdict = exact::decide(kind, query, {.distance = less, .norm = norm});
  return verdict.collides() && *verdict.toi <= exact::AlgebraicNumber(Rational(time));
}

/// The fault of a limit by the scene's distance, or nothing.
std::string fault(const Scene& scene, const LineSearchLimit& limit, double p, Norm norm) {
  const auto least = least_distance(scene.step(), 0.0, norm);
  const bool is_in_contact = least && least->distance.upper <= 0.0;
  if ((limit.status == LineSearchStatus::in_contact) != is_in_contact) return "contact";
  if (!least || limit.step_size == 0.0) return "";
  if (limit.distance != least->distance) return "distance";
  const tests::AllPairs all(scene);
  for (const auto& named : all.pairs()) {
    const ContactKind kind = decided_as(named.first);
    const double distance = least->distance.lower;
    if (comes_nearer(kind, all.query(named), limit.step_size, norm, p, distance,
                     all.thickness(named))) {
      return "too far";
    }
  }
  if (limit.status == LineSearchStatus::whole) return "";
  // The first pair comes to about this distance up to the upper end of its enclosure.
  const StepCollision& first = limit.pairs.at(0);
  const double thickness = all.thickness({first.kind, first.pair});
  const double kept = (thickness + p * least->distance.upper) * (1.0 + 0x1p-40) + 2 * tiniest;
  const auto verdict =
      exact::decide(decided_as(first.kind), scene.step().query_of(first.kind, first.pair),
                    {.distance = kept, .norm = norm});
  if (!verdict.collides()) return "not limited";
  const bool is_first = *verdict.toi <= exact::AlgebraicNumber(Rational(first.toi_upper));
  return is_first ? "" : "not so soon";
}

/// The limit by the rule for pairs, from all pairs one by one; 0 if there is none.
double limit_of_pairs(const Scene& scene, double p, Norm norm, double t_max) {
  const tests::AllPairs all(scene);
  double result = t_max;
  for (const auto& named : all.pairs()) {
    const double thickness = all.thickness(named);
    if (!all.are_near(named, thickness)) continue;
    const ContactKind kind = decided_as(named.first);
    const Query query = all.query(named);
    const Distance apart = exact_distance(kind, query, 0.0, norm);
    const double between = exact::round_up(Rational(apart.upper) - Rational(thickness));
    const double kept =
        std::nextafter(thickness + p * between, std::numeric_limits<double>::infinity());
    if (kept > apart.lower || kept == apart.upper) return 0.0;
    const auto found =
        fast::solve(kind, query, {.t_max = t_max, .separation = {.distance = kept, .norm = norm}});
    if (found.verdict == Verdict::yes) result = std::min(result, found.toi_lower);
  }
  return result;
}

using Seen = std::map<std::pair<StartDistance, LineSearchStatus>, int>;

/// The first fault in random scenes, by either rule.
std::string first_fault(tests::LimitStep& limit_of, int rounds, Seen& seen) {
  Random random(2301);
  for (int round = 0; round < rounds; ++round) {
    for (const tests::Shape& shape : tests::shapes()) {
      Scene scene = tests::random_scene(random, shape, random.between(2, 9));
      if (round % 3 == 0) scene.can_collide = tests::random_rule(random);
      if (round % 4 == 3)
        tests::add_thickness(scene, std::min(0.5 * shape.separation, 1e300), random);
      const Norm norm = random.coin() ? Norm::l2 : Norm::linf;
      const double p = random.uniform(0.05, 0.95);
      const double t_max = random.between(0, 3) == 0 ? 0.25 * random.between(1, 4) : 1.0;
      const Step step = scene.step({.solve = {.t_max = t_max}});
      const LineSearchLimit limit = limit_of(step, p, {.norm = norm});
      std::string what = fault(scene, limit, p, norm);
      if (limit.status == LineSearchStatus::whole && limit.step_size != t_max) what = "not whole";
      if (!what.empty()) return shape.name + ": " + what;
      const LineSearchLimit of_pairs =
          limit_of(step, p, {.norm = norm, .start_distance = StartDistance::of_pair});
      if (of_pairs.step_size != limit_of_pairs(scene, p, norm, t_max))
        return shape.name + ": of pairs";
      ++seen[{StartDistance::of_scene, limit.status}];
      ++seen[{StartDistance::of_pair, of_pairs.status}];
    }
  }
  return "";
}

TEST(LineSearch, KeepsAllApartAndGoesAsFarAsThatAllows) {
  Seen seen;
  EXPECT_EQ(first_fault(line_search_limit, tests::trials(40), seen), "");
  for (const StartDistance start : {StartDistance::of_scene, StartDistance::of_pair}) {
    EXPECT_GT((seen[{start, LineSearchStatus::limited}]), tests::trials(40));
  }
  EXPECT_GT((seen[{StartDistance::of_scene, LineSearchStatus::whole}]), tests::trials(20));
}

/// The first fault of a limit with cells: it has to be the lesser one of the limit without them
/// and of their own first times, and to name all that may set it.
std::string fault_of_volumes(tests::LimitStep& limit_of, int rounds,
                             std::map<LineSearchStatus, int>& seen) {
  Random random(2302);
  for (int round = 0; round < rounds; ++round) {
    for (const tests::Shape& shape : tests::shapes()) {
      Scene scene = tests::random_scene(random, shape, random.between(4, 9));
      const Scene of_pairs = scene;
      tests::add_volumes(scene, 4, 20, random);
      const double p = random.uniform(0.05, 0.95);
      LineSearchOptions options{.start_distance = round % 2 == 0 ? StartDistance::of_scene
                                                                 : StartDistance::of_pair};
      LineSearchLimit expected = limit_of(of_pairs.step(), p, options);
      options.kept_volume = random.coin() ? 0.0 : random.uniform(0.0, 1.0);
      double upper = 2.0, lower = expected.step_size;
      for (const auto& one : expected.pairs) upper = std::min(upper, one.toi_upper);
      bool all_start = true;
      tests::for_each_volume(scene, [&](CellKind kind, std::size_t i, const Query& query) {
        const auto truth = tests::inversions_keeping({&query, 1}, options.kept_volume)[0];
        if (truth.verdict != Verdict::yes) return;
        all_start = all_start && truth.start > 0;
        upper = std::min(upper, truth.toi_upper);
        lower = std::min(lower, truth.toi_lower);
        expected.inversions.push_back({.kind = kind,
                                       .cell = static_cast<std::int32_t>(i),
                                       .start = truth.start,
                                       .toi_lower = truth.toi_lower,
                                       .toi_upper = truth.toi_upper});
      });
      const auto is_late = [&](const auto& one) { return one.toi_lower > upper; };
      std::erase_if(expected.inversions, is_late);
      std::erase_if(expected.pairs, is_late);
      if (lower < expected.step_size) {
        expected.status = !all_start    ? LineSearchStatus::inverted
                          : lower > 0.0 ? LineSearchStatus::limited
                                        : LineSearchStatus::too_small;
      }
      const LineSearchLimit limit = limit_of(scene.step(), p, options);
      ++seen[limit.inversions.empty() ? LineSearchStatus::whole : limit.status];
      if (limit.step_size != lower || limit.status != expected.status) return shape.name;
      if (limit.inversions != expected.inversions) return shape.name + ": other cells";
      if (limit.pairs != expected.pairs) return shape.name + ": other pairs";
    }
  }
  return "";
}

TEST(LineSearch, KeepsVolumes) {
  std::map<LineSearchStatus, int> seen;
  EXPECT_EQ(fault_of_volumes(line_search_limit, tests::trials(60), seen), "");
  EXPECT_GT(seen[LineSearchStatus::limited], 100);
  EXPECT_GT(seen[LineSearchStatus::inverted], 10);
}

TEST(LineSearch, PlantedFaultsAreFound) {
  for (const auto& fault : tests::planted_faults().line_search) {
    Seen seen;
    std::map<LineSearchStatus, int> seen_of_volumes;
    EXPECT_NE(
        first_fault(*fault.part, 40, seen) + fault_of_volumes(*fault.part, 40, seen_of_volumes), "")
        << fault.name;
  }
}

TEST(LineSearch, IsTheSameForAllNumbersOfThreads) {
  Random random(2302);
  const Scene scene = tests::soup(random, 200, 0.02);
  for (const StartDistance start : {StartDistance::of_scene, StartDistance::of_pair}) {
    const LineSearchOptions options{.start_distance = start};
    const auto expected =
        line_search_limit(scene.step({.solve = {.max_threads = 1}}), 0.5, options);
    EXPECT_EQ(expected.status, LineSearchStatus::limited);
    for (int i = 0; i < 5; ++i) {
      const auto limit = line_search_limit(scene.step(), 0.5, options);
      EXPECT_EQ(limit.step_size, expected.step_size);
      EXPECT_EQ(limit.distance, expected.distance);
      EXPECT_EQ(limit.pairs, expected.pairs);
    }
  }
}

// ---- Again and again ----------------------------------------------------------------------------

/// Scenes in which a primitive falls from height 1 to −1 onto another in the plane z=0.
std::vector<Scene> falls() {
  Places start(4, 3);
  start << -1, 0, 0, 1, 0, 0, 0, -1, 1, 0.125, 1, 1;
  Scene edges{.start = start, .end = start, .edges = {{0, 1}, {2, 3}}};
  edges.end.bottomRows(2).col(2).setConstant(-1);
  Scene point = edges;
  point.start.row(2) << 0, 0, 1;
  point.end.row(2) << 0, 0, -1;
  point.edges = {{0, 1}};
  point.points = {2};
  Scene points = point;
  points.edges.clear();
  points.points = {1, 2};
  points.start.row(1).setZero();
  points.end.row(1).setZero();
  return {falling_triangle(1.0, -1.0), edges, point, points};
}

/// The number of line searches along one direction until the distance is at most `until`. Checks
/// each step: it keeps the share p of the distance, to the tolerance of the time and the rounding
/// of places, which are computed as simulators do.
long steps_until(Scene scene, double p, StartDistance start_distance, double until) {
  long steps = 0;
  for (double least = 1.0; least > until && !testing::Test::HasFailure(); ++steps) {
    const auto limit = line_search_limit(scene.step({.solve = {.max_threads = 1}}), p,
                                         {.start_distance = start_distance});
    EXPECT_EQ(limit.status, LineSearchStatus::limited);
    EXPECT_GT(limit.step_size, 0.0);
    EXPECT_EQ(limit.distance.lower, least);
    scene.start = Places(scene.start + limit.step_size * (scene.end - scene.start));
    const double now = least_distance(scene.step({.solve = {.max_threads = 1}}))->distance.lower;
    EXPECT_LT(now, least);
    EXPECT_GE(now, p * least * (1.0 - 0x1p-50));
    EXPECT_LE(now, p * least * (1.0 + 0x1p-36));
    least = now;
  }
  return steps;
}

TEST(LineSearch, RepeatedGoesOnToTheLeastDistances) {
  long steps = 0;
  for (const Scene& scene : falls()) {
    for (const StartDistance start : {StartDistance::of_scene, StartDistance::of_pair}) {
      for (const double p : {0.25, 0.5, 0.9, 0.98}) {
        if (p > 0.25 && !tests::is_soak()) continue;
        const long of_scene = steps_until(scene, p, start, 1e-300);
        // p^steps = 1e-300
        EXPECT_NEAR(static_cast<double>(of_scene), std::log(1e-300) / std::log(p), 2.0);
        steps += of_scene;
      }
    }
  }
  EXPECT_GT(steps, tests::is_soak() ? 300'000 : 3'900);
}

}  // namespace
}  // namespace touchstone::fast::line_search_test
