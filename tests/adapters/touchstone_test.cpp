#include "touchstone/touchstone.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/support/certified_against_oracle.hpp"
#include "tests/support/random.hpp"
#include "touchstone/contacts.hpp"
#include "touchstone/inversion.hpp"
#include "touchstone/step.hpp"

namespace touchstone::adapters::touchstone_test {
namespace {

using tests::Random;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Queries of small integers, among which all sorts of contact occur.
std::vector<Query> random_queries(std::size_t count) {
  Random random(77);
  std::vector<Query> queries(count);
  for (Query& query : queries) {
    for (double& x : query.coordinates) x = random.between(-3, 3);
  }
  return queries;
}

TEST(CInterface, SolvesAsTheSolver) {
  std::vector<Query> queries = random_queries(2000);
  queries[7].coordinates[3] = nan;
  for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
    TouchstoneOptions options = touchstone_default_options();
    options.min_separation = 0.25;
    options.t_max = 0.75;
    std::vector<TouchstoneImpact> impacts(queries.size());
    ASSERT_EQ(touchstone_solve(
                  kind == ContactKind::vertex_face ? TOUCHSTONE_VERTEX_FACE : TOUCHSTONE_EDGE_EDGE,
                  queries.size(), queries[0].coordinates.data(), &options, impacts.data()),
              0)
        << touchstone_last_error();
    std::size_t colliding = 0;
    for (std::size_t i = 0; i < queries.size(); ++i) {
      const fast::CertifiedResult expected =
          fast::solve(kind, queries[i], {.t_max = 0.75, .separation = {.distance = 0.25}});
      ASSERT_EQ(impacts[i].verdict, static_cast<std::int32_t>(expected.verdict)) << i;
      if (expected.verdict != fast::Verdict::yes) {
        EXPECT_TRUE(std::isnan(impacts[i].toi_lower));
        continue;
      }
      ++colliding;
      EXPECT_EQ(impacts[i].toi_lower, expected.toi_lower);
      EXPECT_EQ(impacts[i].toi_upper, expected.toi_upper);
      EXPECT_EQ(impacts[i].u, expected.u);
      EXPECT_EQ(impacts[i].v, expected.v);
    }
    EXPECT_GT(colliding, 100U);
    EXPECT_EQ(impacts[7].verdict, TOUCHSTONE_ERROR);
  }
}

/// A triangle that falls through another, beside a point that rests below it and an edge.
struct Scene {
  std::array<double, 27> before{0, 0, 0, 4, 0, 0, 0, 4, 0,  //
                                1, 1, 1, 3, 1, 1, 1, 3, 1, 1, 1, -1, 0, 1, -0.5, 4, 1, -0.5};
  std::array<double, 27> after{0, 0, 0,  4, 0, 0,  0, 4, 0,  //
                               1, 1, -2, 3, 1, -2, 1, 3, -2, 1, 1, 0.5, 0, 1, -0.5, 4, 1, -0.5};
  std::array<std::int32_t, 6> faces{0, 1, 2, 3, 4, 5};
  std::array<std::int32_t, 1> points{6};

  [[nodiscard]] TouchstoneMesh mesh() const {
    TouchstoneMesh mesh = touchstone_empty_mesh();
    mesh.vertices = 9;
    mesh.before = before.data();
    mesh.after = after.data();
    mesh.faces = 2;
    mesh.face_vertices = faces.data();
    mesh.points = 1;
    mesh.point_vertices = points.data();
    return mesh;
  }
};

/// A step that ends with the test.
std::unique_ptr<TouchstoneStep, decltype(&touchstone_step_free)> step_of(
    const TouchstoneMesh& mesh) {
  TouchstoneStep* step = nullptr;
  EXPECT_EQ(touchstone_step_new(&mesh, nullptr, &step), TOUCHSTONE_OK) << touchstone_last_error();
  return {step, &touchstone_step_free};
}

TEST(CInterface, MeasuresDistances) {
  const std::vector<Query> queries = random_queries(1000);
  for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
    for (const Norm norm : {Norm::linf, Norm::l2}) {
      std::vector<fast::Distance> expected(queries.size());
      fast::distances(kind, queries, 0.375, norm, expected);
      std::vector<TouchstoneDistance> found(queries.size());
      ASSERT_EQ(touchstone_distances(static_cast<std::int32_t>(kind), queries.size(),
                                     queries[0].coordinates.data(), 0.375,
                                     static_cast<std::int32_t>(norm), 0, found.data()),
                TOUCHSTONE_OK)
          << touchstone_last_error();
      for (std::size_t i = 0; i < queries.size(); ++i) {
        EXPECT_EQ((fast::Distance{found[i].lower, found[i].upper}), expected[i]);
      }
    }
  }
  EXPECT_EQ(touchstone_distances(0, 0, nullptr, 0.0, 0, 0, nullptr), TOUCHSTONE_OK);
}

TEST(CInterface, DecidesInversions) {
  std::vector<Query> queries = random_queries(1000);
  queries[7].coordinates[5] = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [kind, code] :
       {std::pair(CellKind::tetrahedron, TOUCHSTONE_TETRAHEDRON),
        std::pair(CellKind::plane_triangle, TOUCHSTONE_PLANE_TRIANGLE)}) {
    std::vector<fast::Inversion> expected(queries.size());
    fast::inversions({kind, queries}, expected);
    std::vector<TouchstoneInversion> found(queries.size());
    ASSERT_EQ(touchstone_inversions(code, queries.size(), queries[0].coordinates.data(), nullptr,
                                    found.data()),
              TOUCHSTONE_OK)
        << touchstone_last_error();
    for (std::size_t i = 0; i < queries.size(); ++i) {
      ASSERT_EQ(found[i].verdict, static_cast<std::int32_t>(expected[i].verdict));
      EXPECT_EQ(found[i].start, expected[i].start);
      if (found[i].verdict != TOUCHSTONE_YES) continue;
      EXPECT_EQ(found[i].toi_lower, expected[i].toi_lower);
      EXPECT_EQ(found[i].toi_upper, expected[i].toi_upper);
    }
    // (That is the z of a point.)
    EXPECT_EQ(found[7].verdict == TOUCHSTONE_ERROR, kind == CellKind::tetrahedron);
  }
}

fast::StepCollision converted(const TouchstoneCollision& one) {
  return {static_cast<ContactKind>(one.pair.kind),
          {one.pair.first, one.pair.second},
          one.toi_lower,
          one.toi_upper,
          one.u,
          one.v};
}

std::vector<fast::StepCollision> converted(const TouchstoneCollision* some, std::size_t count) {
  std::vector<fast::StepCollision> result;
  for (std::size_t i = 0; i < count; ++i) result.push_back(converted(some[i]));
  return result;
}

void expect_same(std::span<const TouchstoneActiveContact> found,
                 const std::vector<fast::ActiveContact>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(converted(found[i].collision), expected[i]);
    EXPECT_TRUE(Eigen::Vector3d::Map(found[i].first) == expected[i].first);
    EXPECT_TRUE(Eigen::Vector3d::Map(found[i].second) == expected[i].second);
    EXPECT_TRUE(Eigen::Vector3d::Map(found[i].normal) == expected[i].normal);
    EXPECT_EQ(found[i].point_error, expected[i].point_error);
    EXPECT_EQ(found[i].normal_error, expected[i].normal_error);
    EXPECT_EQ(found[i].has_side != 0, expected[i].has_side);
  }
}

/// The functions of a step give what those of C++ give, for the scene with a point and without.
TEST(CInterface, DecidesAndMeasuresAStep) {
  const Scene scene;
  const std::vector<fast::Face> faces{{0, 1, 2}, {3, 4, 5}};
  for (const std::size_t points : {0U, 1U}) {
    TouchstoneMesh mesh = scene.mesh();
    mesh.points = points;
    const auto owner = step_of(mesh);
    const fast::Step step(std::span<const double>(scene.before),
                          std::span<const double>(scene.after),
                          {.faces = faces, .points = std::vector<std::int32_t>(points, 6)});

    std::int32_t is_free = -1;
    EXPECT_EQ(touchstone_step_is_free(owner.get(), &is_free), TOUCHSTONE_OK);
    EXPECT_EQ(is_free, 0);
    TouchstoneImpact earliest{};
    EXPECT_EQ(touchstone_step_earliest(owner.get(), &earliest), TOUCHSTONE_OK);
    EXPECT_EQ(earliest.verdict, TOUCHSTONE_YES);
    EXPECT_LT(earliest.toi_lower, 1.0 / 3.0);
    EXPECT_GE(earliest.toi_upper, 1.0 / 3.0);
    double alpha = 0.0;
    EXPECT_EQ(touchstone_step_free_step_size(owner.get(), &alpha), TOUCHSTONE_OK);
    EXPECT_GT(alpha, 0.33);
    EXPECT_LT(alpha, 1.0 / 3.0);
    const TouchstoneCollision* collisions = nullptr;
    std::size_t count = 0;
    ASSERT_EQ(touchstone_step_collisions(owner.get(), &collisions, &count), TOUCHSTONE_OK);
    EXPECT_EQ(std::ranges::any_of(std::span(collisions, count),
                                  [](const TouchstoneCollision& one) {
                                    return one.pair.kind == TOUCHSTONE_VERTEX_FACE &&
                                           one.pair.first == 6;
                                  }),
              points == 1)
        << "the point meets both triangles";

    TouchstoneDistance distance{};
    const TouchstonePair* pairs = nullptr;
    ASSERT_EQ(touchstone_step_least_distance(owner.get(), 0.125, TOUCHSTONE_LINF, &distance, &pairs,
                                             &count),
              TOUCHSTONE_OK);
    const auto least = fast::least_distance(step, 0.125, Norm::linf);
    ASSERT_TRUE(least);
    EXPECT_EQ((fast::Distance{distance.lower, distance.upper}), least->distance);
    ASSERT_EQ(count, least->pairs.size());
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(pairs[i].kind, static_cast<std::int32_t>(least->pairs[i].kind));
      EXPECT_EQ((fast::IndexPair{pairs[i].first, pairs[i].second}), least->pairs[i].pair);
    }

    const TouchstoneActiveContact* contacts = nullptr;
    ASSERT_EQ(touchstone_step_active_set(owner.get(), 0.25, TOUCHSTONE_L2, &contacts, &count),
              TOUCHSTONE_OK);
    const auto active = fast::active_set(step, {.distance = 0.25, .norm = Norm::l2});
    ASSERT_EQ(count, active.size());
    EXPECT_GT(count, 3U);
    expect_same(std::span(contacts, count), active);

    ASSERT_EQ(touchstone_step_collisions(owner.get(), &collisions, &count), TOUCHSTONE_OK);
    std::vector<TouchstoneActiveContact> of_collisions(count);
    ASSERT_EQ(touchstone_step_contacts(owner.get(), collisions, count, of_collisions.data()),
              TOUCHSTONE_OK);
    EXPECT_GT(count, 0U);
    expect_same(of_collisions, fast::contacts_of(step, step.collisions()));

    const TouchstoneLineSearchOptions of_pair{sizeof(of_pair), TOUCHSTONE_LINF, TOUCHSTONE_OF_PAIR,
                                              0.0};
    for (const TouchstoneLineSearchOptions* const options :
         {&of_pair, static_cast<const TouchstoneLineSearchOptions*>(nullptr)}) {
      TouchstoneLineSearchLimit limit{};
      ASSERT_EQ(touchstone_step_line_search_limit(owner.get(), 0.5, options, &limit),
                TOUCHSTONE_OK);
      fast::LineSearchOptions expected;
      if (options != nullptr) expected = {Norm::linf, fast::StartDistance::of_pair};
      const fast::LineSearchLimit found = fast::line_search_limit(step, 0.5, expected);
      EXPECT_EQ(limit.reason, static_cast<std::int32_t>(found.status));
      EXPECT_EQ(limit.reason, TOUCHSTONE_LIMITED);
      EXPECT_EQ(limit.step_size, found.step_size);
      EXPECT_EQ((fast::Distance{limit.distance.lower, limit.distance.upper}), found.distance);
      EXPECT_EQ(converted(limit.pairs, limit.count), found.pairs);
    }
  }
}

TEST(CInterface, TakesCurves) {
  const Scene scene;
  const std::vector<fast::Face> faces{{0, 1, 2}, {3, 4, 5}};
  TouchstoneMesh mesh = scene.mesh();
  mesh.before = mesh.after = nullptr;
  for (const bool is_rational : {false, true}) {
    // From place to place with one control point, halfway.
    std::vector<double> points;
    for (std::size_t i = 0; i < scene.before.size(); i += 3) {
      for (const double part : {0.0, 0.5, 1.0}) {
        for (std::size_t k = i; k < i + 3; ++k) {
          points.push_back((1.0 - part) * scene.before[k] + part * scene.after[k]);
        }
        if (is_rational) points.push_back(1.0 + part);
      }
    }
    mesh.degree = 2;
    mesh.is_rational = is_rational ? 1 : 0;
    mesh.control_points = points.data();
    const auto owner = step_of(mesh);
    const TouchstoneCollision* collisions = nullptr;
    std::size_t count = 0;
    ASSERT_EQ(touchstone_step_collisions(owner.get(), &collisions, &count), TOUCHSTONE_OK);
    EXPECT_GT(count, 0U);
    EXPECT_EQ(converted(collisions, count),
              fast::Step(fast::Motion(2, is_rational, points), {.faces = faces, .points = {6}})
                  .collisions());
    double alpha = 0.0;
    EXPECT_EQ(touchstone_step_free_step_size(owner.get(), &alpha), TOUCHSTONE_INVALID_ARGUMENT);
    EXPECT_STREQ(touchstone_last_error(),
                 "step: a step size: straight lines are needed, not curves");
  }
  TouchstoneStep* none = nullptr;
  for (const std::int32_t degree : {-1, 9}) {
    mesh.degree = degree;
    EXPECT_EQ(touchstone_step_new(&mesh, nullptr, &none), TOUCHSTONE_INVALID_ARGUMENT);
  }
}

TEST(CInterface, TakesRadiiAndSeparationsOfGroups) {
  const Scene scene;
  const std::vector<fast::Face> faces{{0, 1, 2}, {3, 4, 5}};
  const std::vector<std::int32_t> groups{0, 0, 0, 1, 1, 1, 2, 0, 0};
  const std::vector<double> radii{0.125, 0.25, 0.5};
  const std::array<std::int32_t, 2> separated{2, 1};
  const std::array<double, 1> distance{0.0625};
  const std::vector<fast::GroupSeparation> separations{{{2, 1}, 0.0625}};
  TouchstoneMesh mesh = scene.mesh();
  mesh.groups = groups.data();
  mesh.radii = radii.size();
  mesh.group_radii = radii.data();
  mesh.separations = 1;
  mesh.separated_groups = separated.data();
  mesh.group_separations = distance.data();
  const auto owner = step_of(mesh);
  const fast::Step step(
      std::span<const double>(scene.before), std::span<const double>(scene.after),
      {.faces = faces, .points = {6}},
      {.groups = {.of_vertices = groups, .radii = radii, .separations = separations}});
  const TouchstoneCollision* collisions = nullptr;
  std::size_t count = 0;
  ASSERT_EQ(touchstone_step_collisions(owner.get(), &collisions, &count), TOUCHSTONE_OK);
  const auto found = converted(collisions, count);
  EXPECT_EQ(found, step.collisions());
  const auto thin = step_of(scene.mesh());
  std::size_t of_thin = 0;
  ASSERT_EQ(touchstone_step_collisions(thin.get(), &collisions, &of_thin), TOUCHSTONE_OK);
  EXPECT_NE(found, converted(collisions, of_thin));
  TouchstoneStep* none = nullptr;
  const std::array<std::int32_t, 2> unknown{0, 3};
  mesh.apart = 1;
  mesh.apart_groups = unknown.data();
  EXPECT_EQ(touchstone_step_new(&mesh, nullptr, &none), TOUCHSTONE_INVALID_ARGUMENT);
  EXPECT_STREQ(touchstone_last_error(), "step: apart names group 3, but no vertex is in it");
  mesh.apart = 0;
  mesh.group_separations = nullptr;
  EXPECT_EQ(touchstone_step_new(&mesh, nullptr, &none), TOUCHSTONE_INVALID_ARGUMENT);
}

/// A tetrahedron that turns over, one that is flat at the start, and their shadows in the plane.
TEST(CInterface, KeepsElementsFromInverting) {
  const std::vector<double> before{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::vector<double> after = before;
  after.back() = -3.0;
  after[3] = -2.0;
  const std::vector<fast::Face> triangles{{0, 1, 2}};
  for (const std::size_t count : {1U, 2U}) {
    std::vector<fast::Tetrahedron> tetrahedra{{0, 1, 2, 3}, {0, 1, 1, 3}};
    tetrahedra.resize(count);
    TouchstoneMesh mesh = touchstone_empty_mesh();
    mesh.vertices = 4;
    mesh.before = before.data();
    mesh.after = after.data();
    const std::array<TouchstoneCells, 2> cells{
        {{TOUCHSTONE_TETRAHEDRON, count, tetrahedra.front().data()},
         {TOUCHSTONE_PLANE_TRIANGLE, 1, triangles.front().data()}}};
    mesh.cell_lists = cells.size();
    mesh.cells = cells.data();
    const auto owner = step_of(mesh);
    const fast::Step step(std::span<const double>(before), std::span<const double>(after),
                          {.tetrahedra = tetrahedra, .plane_triangles = triangles});
    const auto expect_same = [](const TouchstoneStepInversion* found, std::size_t size,
                                const std::vector<fast::StepInversion>& expected) {
      ASSERT_EQ(size, expected.size());
      for (std::size_t i = 0; i < size; ++i) {
        EXPECT_EQ(
            (fast::StepInversion{found[i].kind == TOUCHSTONE_TETRAHEDRON ? CellKind::tetrahedron
                                                                         : CellKind::plane_triangle,
                                 found[i].cell, static_cast<std::int8_t>(found[i].start),
                                 found[i].toi_lower, found[i].toi_upper}),
            expected[i]);
      }
    };
    const TouchstoneStepInversion* inversions = nullptr;
    std::size_t size = 0;
    ASSERT_EQ(touchstone_step_inversions(owner.get(), &inversions, &size), TOUCHSTONE_OK);
    EXPECT_EQ(size, count + 1);
    expect_same(inversions, size, step.inversions());
    TouchstoneImpact impact{};
    ASSERT_EQ(touchstone_step_earliest(owner.get(), &impact), TOUCHSTONE_OK);
    EXPECT_EQ(impact.toi_upper, count == 1 ? step.earliest()->toi_upper : 0.0);
    TouchstoneLineSearchOptions options = touchstone_default_line_search_options();
    options.kept_volume = 0.25;
    TouchstoneLineSearchLimit limit{};
    ASSERT_EQ(touchstone_step_line_search_limit(owner.get(), 0.5, &options, &limit), TOUCHSTONE_OK);
    EXPECT_EQ(limit.reason, count == 1 ? TOUCHSTONE_LIMITED : TOUCHSTONE_INVERTED);
    const auto expected = fast::line_search_limit(step, 0.5, {.kept_volume = 0.25});
    EXPECT_EQ(limit.step_size, expected.step_size);
    expect_same(limit.inversions, limit.inversion_count, expected.inversions);
  }
}

/// Groups or vertices that do not meet, and no pairs at all.
TEST(CInterface, AnswersWhereNothingCanMeet) {
  const Scene scene;
  const std::array<std::int32_t, 9> groups{0, 0, 0, 1, 1, 1, 0, 0, 0};
  const std::array<std::int32_t, 4> apart{0, 1, 0, 0};
  TouchstoneMesh of_groups = scene.mesh(), of_edges = scene.mesh(), of_rule = scene.mesh();
  of_groups.groups = groups.data();
  of_groups.apart = 2;
  of_groups.apart_groups = apart.data();
  of_edges.faces = of_edges.points = 0;
  // The same rule for vertices.
  std::array<std::int32_t, 9> group = groups;
  of_rule.can_collide_context = group.data();
  of_rule.can_collide = [](void* context, std::int32_t a, std::int32_t b) -> std::int32_t {
    const auto* const of = static_cast<const std::int32_t*>(context);
    return of[a] == 1 && of[b] == 1 ? 2 : 0;
  };
  for (const TouchstoneMesh* const mesh : {&of_groups, &of_edges, &of_rule}) {
    const auto owner = step_of(*mesh);
    std::int32_t is_free = 0;
    EXPECT_EQ(touchstone_step_is_free(owner.get(), &is_free), TOUCHSTONE_OK);
    EXPECT_EQ(is_free, 1);
    TouchstoneImpact earliest{};
    EXPECT_EQ(touchstone_step_earliest(owner.get(), &earliest), TOUCHSTONE_OK);
    EXPECT_EQ(earliest.verdict, TOUCHSTONE_NO);
    EXPECT_TRUE(std::isnan(earliest.toi_lower));
    TouchstoneDistance distance{};
    const TouchstonePair* pairs = nullptr;
    std::size_t count = 77;
    EXPECT_EQ(
        touchstone_step_least_distance(owner.get(), 0, TOUCHSTONE_L2, &distance, &pairs, &count),
        TOUCHSTONE_OK);
    EXPECT_EQ(distance.lower, std::numeric_limits<double>::infinity());
    EXPECT_EQ(distance.upper, std::numeric_limits<double>::infinity());
    EXPECT_EQ(count, 0U);
  }
}

/// The message of the last error has this part.
void expect_message(std::string_view part) {
  EXPECT_NE(std::string(touchstone_last_error()).find(part), std::string::npos)
      << touchstone_last_error() << ", not " << part;
}

TEST(CInterface, SaysWhatIsWrongAndWritesNothing) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto with = [](auto change) {
    TouchstoneOptions options = touchstone_default_options();
    change(options);
    return options;
  };
  const TouchstoneOptions bad_norm = with([](auto&o) { o.norm = 5; }),
                          bad_time = with([](auto&o) { o.t_max = 2.0; }),
                          bad_distance = with([](auto&o) { o.min_separation = -1.0; }),
                          distant = with([](auto&o) { o.min_separation = 1.0; });
  const TouchstoneLineSearchOptions other_norm{sizeof(other_norm), 2, TOUCHSTONE_OF_PAIR, 0.0},
      other_start{sizeof(other_start), TOUCHSTONE_L2, 2, 0.0};
  const std::vector<Query> queries = random_queries(1);
  const double* const x = queries[0].coordinates.data();
  Query far = queries[0];
  far.coordinates[11] = infinity;
  const Scene scene;
  const TouchstoneMesh mesh = scene.mesh();
  const auto owner = step_of(mesh);
  TouchstoneStep* const step = owner.get();
  Scene fast = scene;
  fast.before[0] = -std::numeric_limits<double>::max();
  fast.after[0] = std::numeric_limits<double>::max();
  const TouchstoneMesh fast_mesh = fast.mesh();
  const auto fast_step = step_of(fast_mesh);
  const auto solve = [&](std::int32_t kind, const double* given, const TouchstoneOptions* options,
                         TouchstoneImpact* impacts) {
    return touchstone_solve(kind, 1, given, options, impacts);
  };

  TouchstoneImpact impact{};
  impact.verdict = 77;
  TouchstoneInversion inversion{77, 77, 77.0, 77.0};
  TouchstoneDistance distance{77.0, 77.0};
  const TouchstoneCollision none{};
  const TouchstoneCollision *collisions = &none, *before = nullptr;
  const TouchstonePair* pairs = nullptr;
  const TouchstoneActiveContact* contacts = nullptr;
  TouchstoneLineSearchLimit limit{};
  limit.reason = 77;
  std::size_t count = 77, of_before = 0;
  std::int32_t is_free = 77;
  double alpha = 77.0;
  ASSERT_EQ(touchstone_step_collisions(step, &before, &of_before), TOUCHSTONE_OK);
  const double first = before[0].toi_lower;
  TouchstoneCollision no_kind = before[0], no_time = before[0];
  no_kind.pair.kind = 4;
  no_time.toi_lower = nan;
  TouchstoneActiveContact contact{};
  contact.has_side = 77;

  const std::vector<std::pair<std::string_view, std::function<std::int32_t()>>> calls{
      {"kind", [&] { return solve(6, x, nullptr, &impact); }},
      {"touchstone_inversions", [&] { return solve(4, x, nullptr, &impact); }},
      {"touchstone_solve", [&] { return touchstone_inversions(3, 1, x, nullptr, &inversion); }},
      {"min_separation", [&] { return touchstone_inversions(4, 1, x, &distant, &inversion); }},
      {"inversions is null", [&] { return touchstone_inversions(4, 1, x, nullptr, nullptr); }},
      {"coordinates is null", [&] { return solve(0, nullptr, nullptr, &impact); }},
      {"impacts is null", [&] { return solve(0, x, nullptr, nullptr); }},
      {"norm", [&] { return solve(0, x, &bad_norm, &impact); }},
      {"", [&] { return solve(0, x, &bad_time, &impact); }},
      {"", [&] { return solve(0, x, &bad_distance, &impact); }},
      {"", [&] { return touchstone_distances(6, 1, x, 0.0, 0, 1, &distance); }},
      {"", [&] { return touchstone_distances(0, 1, x, 2.0, 0, 1, &distance); }},
      {"", [&] { return touchstone_distances(0, 1, x, 0.0, 2, 1, &distance); }},
      {"", [&] { return touchstone_distances(0, 1, nullptr, 0.0, 0, 1, &distance); }},
      {"", [&] { return touchstone_distances(0, 1, x, 0.0, 0, -1, &distance); }},
      {"", [&] { return touchstone_distances(0, 1, x, 0.0, 0, 1, nullptr); }},
      {"", [&] { return touchstone_distances(4, 1, x, 0.0, 0, 1, &distance); }},
      {"step is null", [&] { return touchstone_step_new(&mesh, nullptr, nullptr); }},
      {"count is null", [&] { return touchstone_step_collisions(step, &collisions, nullptr); }},
      {"collisions is null", [&] { return touchstone_step_collisions(step, nullptr, &count); }},
      {"step is null", [&] { return touchstone_step_collisions(nullptr, &collisions, &count); }},
      {"", [&] { return touchstone_step_is_free(nullptr, &is_free); }},
      {"", [&] { return touchstone_step_is_free(step, nullptr); }},
      {"", [&] { return touchstone_step_earliest(nullptr, &impact); }},
      {"", [&] { return touchstone_step_earliest(step, nullptr); }},
      {"", [&] { return touchstone_step_free_step_size(nullptr, &alpha); }},
      {"", [&] { return touchstone_step_free_step_size(step, nullptr); }},
      {"",
       [&] { return touchstone_step_least_distance(nullptr, 0, 0, &distance, &pairs, &count); }},
      {"", [&] { return touchstone_step_least_distance(step, 0, 0, nullptr, &pairs, &count); }},
      {"", [&] { return touchstone_step_least_distance(step, 0, 0, &distance, nullptr, &count); }},
      {"", [&] { return touchstone_step_least_distance(step, 0, 0, &distance, &pairs, nullptr); }},
      {"", [&] { return touchstone_step_least_distance(step, nan, 0, &distance, &pairs, &count); }},
      {"", [&] { return touchstone_step_least_distance(step, 0, 2, &distance, &pairs, &count); }},
      {"", [&] { return touchstone_step_active_set(nullptr, 0.5, 0, &contacts, &count); }},
      {"", [&] { return touchstone_step_active_set(step, 0.5, 0, nullptr, &count); }},
      {"", [&] { return touchstone_step_active_set(step, 0.5, 0, &contacts, nullptr); }},
      {"", [&] { return touchstone_step_active_set(step, -0.5, 0, &contacts, &count); }},
      {"", [&] { return touchstone_step_active_set(step, 0.5, 2, &contacts, &count); }},
      {"step is null", [&] { return touchstone_step_contacts(nullptr, before, 1, &contact); }},
      {"collisions is null", [&] { return touchstone_step_contacts(step, nullptr, 1, &contact); }},
      {"contacts is null", [&] { return touchstone_step_contacts(step, before, 1, nullptr); }},
      {"kind", [&] { return touchstone_step_contacts(step, &no_kind, 1, &contact); }},
      {"times", [&] { return touchstone_step_contacts(step, &no_time, 1, &contact); }},
      {"", [&] { return touchstone_step_line_search_limit(nullptr, 0.5, nullptr, &limit); }},
      {"", [&] { return touchstone_step_line_search_limit(step, 0.5, nullptr, nullptr); }},
      {"", [&] { return touchstone_step_line_search_limit(step, 1.0, nullptr, &limit); }},
      {"", [&] { return touchstone_step_line_search_limit(step, 0.5, &other_norm, &limit); }},
      {"", [&] { return touchstone_step_line_search_limit(step, 0.5, &other_start, &limit); }}};
  for (std::size_t i = 0; i < calls.size(); ++i) {
    EXPECT_EQ(calls[i].second(), TOUCHSTONE_INVALID_ARGUMENT) << i;
    expect_message(calls[i].first);
  }
  EXPECT_EQ(touchstone_distances(0, 1, far.coordinates.data(), 0.0, 0, 1, &distance),
            TOUCHSTONE_NOT_FINITE);
  expect_message("query 0: a coordinate is not finite");
  EXPECT_EQ(touchstone_step_free_step_size(fast_step.get(), &alpha), TOUCHSTONE_NOT_FINITE);
  expect_message("vertex 0");

  EXPECT_EQ(impact.verdict, 77);
  EXPECT_EQ(inversion.verdict, 77);
  EXPECT_EQ(distance.lower, 77.0);
  EXPECT_EQ(distance.upper, 77.0);
  EXPECT_EQ(collisions, &none);
  EXPECT_EQ(before[0].toi_lower, first) << "what was handed out is valid still";
  EXPECT_EQ(pairs, nullptr);
  EXPECT_EQ(contacts, nullptr);
  EXPECT_EQ(limit.reason, 77);
  EXPECT_EQ(count, 77U);
  EXPECT_EQ(is_free, 77);
  EXPECT_EQ(contact.has_side, 77);
  EXPECT_EQ(alpha, 77.0);
  EXPECT_EQ(touchstone_solve(0, 0, nullptr, nullptr, nullptr), TOUCHSTONE_OK);
}

TEST(CInterface, RefusesMeshesByStatus) {
  Scene out_of_range, not_finite, good;
  out_of_range.faces[2] = 9;
  not_finite.after[4] = nan;
  TouchstoneMesh without_before = good.mesh(), too_many = good.mesh();
  without_before.before = nullptr;
  too_many.faces = std::numeric_limits<std::size_t>::max();
  const TouchstoneMesh beyond = out_of_range.mesh(), infinite = not_finite.mesh();
  TouchstoneStep* step = nullptr;
  for (const auto& [mesh, status, says] :
       {std::tuple<const TouchstoneMesh*, std::int32_t, std::string_view>(
            nullptr, TOUCHSTONE_INVALID_ARGUMENT, "mesh is null"),
        {&beyond, TOUCHSTONE_OUT_OF_RANGE, "face 0"},
        {&infinite, TOUCHSTONE_NOT_FINITE, "vertex 1"},
        {&without_before, TOUCHSTONE_INVALID_ARGUMENT, "before is null"},
        {&too_many, TOUCHSTONE_TOO_MANY, "face_vertices"}}) {
    EXPECT_EQ(touchstone_step_new(mesh, nullptr, &step), status);
    expect_message(says);
    EXPECT_EQ(step, nullptr) << "nothing is written";
  }
}

/// The first header with sizes, without what may be added; a caller that was compiled with it.
struct MeshOfFirstHeader {
  std::size_t size, vertices;
  const double *before, *after;
  std::size_t edges;
  const std::int32_t* edge_vertices;
  std::size_t faces;
  const std::int32_t* face_vertices;
  std::size_t points;
  const std::int32_t *point_vertices, *groups;
  std::size_t apart;
  const std::int32_t* apart_groups;
  std::int32_t (*can_collide)(void*, std::int32_t, std::int32_t);
  void* can_collide_context;
  std::size_t radii;
  const double* group_radii;
  std::size_t separations;
  const std::int32_t* separated_groups;
  const double* group_separations;
};

struct LineSearchOptionsOfFirstHeader {
  std::size_t size;
  std::int32_t norm, start_distance;
};

// The layouts of this SOVERSION, on machines of 64 bits. Only what can grow may grow, at its end.
static_assert(sizeof(MeshOfFirstHeader) == offsetof(TouchstoneMesh, cell_lists));
static_assert(sizeof(TouchstoneOptions) == 40 && offsetof(TouchstoneOptions, max_threads) == 36);
static_assert(sizeof(TouchstoneMesh) == 192 && offsetof(TouchstoneMesh, control_points) == 184);
static_assert(sizeof(TouchstoneLineSearchOptions) == 24 &&
              offsetof(TouchstoneLineSearchOptions, kept_volume) == 16);
static_assert(sizeof(TouchstoneImpact) == 40 && offsetof(TouchstoneImpact, v) == 32);
static_assert(sizeof(TouchstoneInversion) == 24 && sizeof(TouchstoneCells) == 24);
static_assert(sizeof(TouchstoneDistance) == 16 && sizeof(TouchstonePair) == 12);
static_assert(sizeof(TouchstoneCollision) == 48 && offsetof(TouchstoneCollision, v) == 40);
static_assert(sizeof(TouchstoneStepInversion) == 32 &&
              offsetof(TouchstoneStepInversion, toi_upper) == 24);
static_assert(sizeof(TouchstoneActiveContact) == 144 &&
              offsetof(TouchstoneActiveContact, has_side) == 136);
static_assert(sizeof(TouchstoneLineSearchLimit) == 64 &&
              offsetof(TouchstoneLineSearchLimit, inversion_count) == 56);

TEST(CInterface, TakesStructuresOfOlderHeadersAndRefusesOtherSizes) {
  const auto [usual, certified] = std::pair(touchstone_default_options(), fast::CertifiedOptions{});
  EXPECT_EQ(std::tuple(usual.min_separation, usual.t_max, usual.toi_tolerance, usual.max_threads),
            std::tuple(certified.separation.distance, certified.t_max, certified.toi_tolerance,
                       certified.max_threads));
  const Scene scene;
  // Beyond the caller's structures lie numbers that are none of theirs.
  struct {
    MeshOfFirstHeader mesh{};
    std::array<std::size_t, 4> tetrahedra{7, 7, 7, 7};
  } older;
  struct {
    LineSearchOptionsOfFirstHeader options{sizeof(options), TOUCHSTONE_LINF, TOUCHSTONE_OF_PAIR};
    double kept_volume = -7.0;
  } older_search;
  TouchstoneMesh today = scene.mesh();
  std::memcpy(&older.mesh, &today, sizeof(older.mesh));
  older.mesh.size = sizeof(older.mesh);
  const auto* const mesh = reinterpret_cast<const TouchstoneMesh*>(&older.mesh);
  const auto step = step_of(*mesh), same = step_of(today);
  double found = 0.0, expected = 0.0;
  EXPECT_EQ(touchstone_step_free_step_size(step.get(), &found), TOUCHSTONE_OK);
  EXPECT_EQ(touchstone_step_free_step_size(same.get(), &expected), TOUCHSTONE_OK);
  EXPECT_EQ(found, expected);
  TouchstoneLineSearchLimit limit{};
  EXPECT_EQ(
      touchstone_step_line_search_limit(
          step.get(), 0.5,
          reinterpret_cast<const TouchstoneLineSearchOptions*>(&older_search.options), &limit),
      TOUCHSTONE_OK)
      << touchstone_last_error();

  TouchstoneOptions options = usual;
  TouchstoneLineSearchOptions search = touchstone_default_line_search_options();
  TouchstoneStep* none = nullptr;
  TouchstoneImpact impact{};
  const Query query = random_queries(1)[0];
  const auto refuses = [](std::size_t& size, std::size_t first, const std::string& initialiser,
                          const auto& call) {
    const std::size_t known = size;
    for (const std::size_t wrong : {std::size_t{0}, first - 8, first + 4, known + 8}) {
      size = wrong;
      EXPECT_EQ(call(), TOUCHSTONE_INVALID_ARGUMENT) << wrong;
      expect_message("size is " + std::to_string(wrong) + " bytes, " +
                     (wrong > known ? "but this library, version " TOUCHSTONE_VERSION ", knows " +
                                          std::to_string(known)
                                    : "which no version of this structure has"));
      expect_message("start from " + initialiser + "()");
    }
  };
  refuses(today.size, sizeof(older.mesh), "touchstone_empty_mesh",
          [&] { return touchstone_step_new(&today, nullptr, &none); });
  refuses(options.size, sizeof(options), "touchstone_default_options",
          [&] { return touchstone_solve(0, 1, query.coordinates.data(), &options, &impact); });
  refuses(search.size, sizeof(older_search.options), "touchstone_default_line_search_options",
          [&] { return touchstone_step_line_search_limit(step.get(), 0.5, &search, &limit); });
}

TEST(CInterface, KeepsTheErrorsOfThreadsApart) {
  TouchstoneStep* step = nullptr;
  EXPECT_EQ(touchstone_step_new(nullptr, nullptr, &step), TOUCHSTONE_INVALID_ARGUMENT);
  std::thread([] { EXPECT_STREQ(touchstone_last_error(), ""); }).join();
  expect_message("mesh is null");
  EXPECT_STREQ(touchstone_version(), TOUCHSTONE_VERSION);
}

}  // namespace
}  // namespace touchstone::adapters::touchstone_test
