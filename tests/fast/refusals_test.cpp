/// \file
/// Every function that takes a number refuses one out of range.

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <ostream>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/messages.hpp"
#include "tests/support/queries.hpp"
#include "touchstone/broad_phase.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/contacts.hpp"
#include "touchstone/step.hpp"
#include "touchstone/tight_inclusion.hpp"

namespace touchstone::fast::refusals_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Invalid distances and tolerances; times and shares of a step; numbers of threads.
const std::vector<double> no_distance{-1.0, -1e-300, infinity, nan},
    no_time{-0.5, -1e-300, 1.5, nan}, no_count{-1.0};

struct Refusal {
  std::string name;
  std::vector<double> bad;
  std::function<void(double)> call;

  friend std::ostream& operator<<(std::ostream& out, const Refusal& one) { return out << one.name; }
};

/// A vertex that falls onto a triangle, in the form of each function.
const tests::PosedQuery posed = tests::over_triangle(1, 1, 1, -1);

Step step(const StepOptions& options = {}) {
  Eigen::MatrixX3d before(4, 3), after(4, 3);
  before << 0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, 1;
  after = before;
  after(3, 2) = -1;
  return {before, after, {.faces = {{0, 1, 2}}, .points = {3}}, options};
}

void solve_one(const CertifiedOptions& options) {
  CertifiedResult result;
  solve({posed.kind, std::span(&posed.query, 1)}, std::span(&result, 1), options);
}

/// All functions that take the options of the certified solver, with one option set.
template <class Set>
std::vector<Refusal> of_solver(const std::string& name, const std::vector<double>& bad,
                               const Set& set) {
  const auto with = [set](const auto& use) {
    return [=](double x) {
      CertifiedOptions options;
      set(options, x);
      use(options);
    };
  };
  return {{name + "_of_certified", bad,
           with([](const auto& o) { (void)fast::solve(posed.kind, posed.query, o); })},
          {name + "_of_solve", bad, with(solve_one)},
          {name + "_of_points", bad, with([](const auto& o) {
             const Eigen::Vector3d at(1, 2, 3);
             (void)solve_vertex_vertex(at, at, at, at, o);
           })},
          {name + "_of_step", bad, with([](const auto& o) { (void)step({.solve = o}); })}};
}

std::vector<Refusal> refusals() {
  std::vector<Refusal> all{
      {"separation_of_another_step", no_distance,
       [](double x) { (void)step().with_separation({.distance = x}); }},
      {"distance_of_active_set", no_distance,
       [](double x) { (void)active_set(step(), {.distance = x}); }},
      {"separation_of_broad_phase", no_distance,
       [](double x) {
         (void)edge_edge_candidates(step().vertices(), step().mesh().edges,
                                    {.separation = {.distance = x}});
       }},
      {"threads_of_broad_phase", no_count,
       [](double x) {
         (void)edge_edge_candidates(step().vertices(), step().mesh().edges,
                                    {.max_threads = static_cast<int>(x)});
       }},
      {"time_of_contact", no_time,
       [](double x) {
         (void)contact_at(step(), ContactKind::vertex_face, {3, 0}, x);
       }},
      {"time_of_collision", no_time,
       [](double x) {
         (void)contact_of(step(), {.pair = {3, 0}, .toi_lower = 0.0, .toi_upper = x});
       }},
      {"time_before_collision",
       {-1.0, 0.75, nan},
       [](double x) {
         (void)contact_of(step(), {.pair = {3, 0}, .toi_lower = x, .toi_upper = 0.5});
       }},
      {"time_of_distance", no_time, [](double x) { (void)distance(posed.kind, posed.query, x); }},
      {"time_of_least_distance", no_time, [](double x) { (void)least_distance(step(), x); }},
      {"threads_of_distances", no_count,
       [](double x) {
         Distance result;
         distances(posed.kind, std::span(&posed.query, 1), 0.0, Norm::l2, std::span(&result, 1),
                   static_cast<int>(x));
       }},
      {"tolerance_of_tight_inclusion",
       {0.0, -1.0, infinity, nan},
       [](double x) { (void)tight_inclusion(posed.kind, posed.query, {.tolerance = x}); }},
      {"separation_of_tight_inclusion", no_distance,
       [](double x) {
         (void)tight_inclusion(posed.kind, posed.query, {.separation = {.distance = x}});
       }},
      {"time_of_tight_inclusion", no_time,
       [](double x) { (void)tight_inclusion(posed.kind, posed.query, {.t_max = x}); }},
      {"scene_filter_of_tight_inclusion",
       {-1.0, nan},
       [](double x) {
         (void)tight_inclusion(posed.kind, posed.query, {.scene_filter = {{0.0, x, 0.0}}});
       }},
      {"size_of_scaled_step", no_time, [](double x) { (void)step().scaled(x); }},
      {"time_of_inversion", no_time,
       [](double x) { (void)inversion(CellKind::tetrahedron, posed.query, {.t_max = x}); }},
      {"tolerance_of_inversion", no_distance,
       [](double x) { (void)inversion(CellKind::tetrahedron, posed.query, {.toi_tolerance = x}); }},
      {"threads_of_inversion", no_count,
       [](double x) {
         (void)inversion(CellKind::tetrahedron, posed.query, {.max_threads = static_cast<int>(x)});
       }},
      {"share_of_line_search", {0.0, -0.5, 1.0, 1.0 - 0x1p-52, nan}, [](double x) {
         (void)line_search_limit(step(), x);
       }}};
  const auto add = [&](const char* name, const std::vector<double>& bad, auto set) {
    for (Refusal& one : of_solver(name, bad, set)) all.push_back(std::move(one));
  };
  add("separation", no_distance, [](auto& options, double x) { options.separation.distance = x; });
  add("tolerance", no_distance, [](auto& options, double x) { options.toi_tolerance = x; });
  add("t_max", no_time, [](auto& options, double x) { options.t_max = x; });
  add("threads", no_count,
      [](auto& options, double x) { options.max_threads = static_cast<int>(x); });
  return all;
}

class Refused : public testing::TestWithParam<Refusal> {};

TEST_P(Refused, OutOfRange) {
  for (const double bad : GetParam().bad) {
    EXPECT_THROW(GetParam().call(bad), std::invalid_argument) << bad;
  }
}

INSTANTIATE_TEST_SUITE_P(Is, Refused, testing::ValuesIn(refusals()),
                         [](const auto& tested) { return tested.param.name; });

TEST(Refusals, OfCellsOutOfRange) {
  const Eigen::MatrixX3d x = Eigen::MatrixX3d::Zero(4, 3);
  EXPECT_THROW(Step(x, x, {.tetrahedra = {{0, 1, 2, 4}}}), std::out_of_range);
  const Step of_flat(x, x, {.plane_triangles = {{0, 1, 2}}});
  EXPECT_EQ(of_flat.inversions().size(), 1U);
  for (const auto& [kind, number] : {std::pair(CellKind::plane_triangle, 1),
                                     {CellKind::plane_triangle, -1},
                                     {CellKind::tetrahedron, 0}}) {
    EXPECT_THROW((void)of_flat.tetrahedron_of(kind, number), std::out_of_range);
  }
  for (const double kept : {-0x1p-1074, 1.0, infinity, nan}) {
    EXPECT_THROW((void)line_search_limit(step(), 0.5, {.kept_volume = kept}),
                 std::invalid_argument);
  }
}

/// Spans of results that do not fit the queries.
TEST(Refusals, OfSpansOfOtherLengths) {
  std::vector<CertifiedResult> results(2);
  EXPECT_THROW(solve({posed.kind, std::span(&posed.query, 1)}, results), std::invalid_argument);
  std::vector<Inversion> inverted(2);
  EXPECT_THROW(inversions({CellKind::tetrahedron, std::span(&posed.query, 1)}, inverted),
               std::invalid_argument);
  std::vector<Distance> apart(2);
  EXPECT_THROW(distances(posed.kind, std::span(&posed.query, 1), 0.0, Norm::l2, apart),
               std::invalid_argument);
}

/// Functions without a verdict for each query name the first one.
TEST(Refusals, OfDistancesOfWhatIsNotFinite) {
  Query query = posed.query;
  query.coordinates[5] = infinity;
  EXPECT_THROW((void)distance(posed.kind, query, 0.5), std::domain_error);
  std::vector<Query> queries(1000, posed.query);
  queries[777] = query;
  std::vector<Distance> apart(queries.size());
  const auto all = [&] { distances(posed.kind, queries, 0.0, Norm::l2, apart); };
  EXPECT_EQ(tests::message_of<std::domain_error>(all),
            "distances: query 777: a coordinate is not finite");
}

/// The scene has 4 vertices, 1 face and 3 edges.
TEST(Refusals, OfPairsOutOfRange) {
  const Step asked = step();
  const std::vector<std::pair<ContactKind, IndexPair>> kinds{{ContactKind::vertex_face, {3, 0}},
                                                             {ContactKind::edge_edge, {2, 2}},
                                                             {ContactKind::vertex_edge, {3, 2}},
                                                             {ContactKind::vertex_vertex, {3, 3}}};
  for (const auto& [kind, last] : kinds) {
    EXPECT_NO_THROW((void)asked.query_of(kind, last));
    for (const std::size_t which : {0U, 1U}) {
      for (const std::int32_t beyond : {last[which] + 1, -1}) {
        IndexPair bad = last;
        bad[which] = beyond;
        EXPECT_THROW((void)asked.query_of(kind, bad), std::out_of_range);
        EXPECT_THROW((void)asked.vertices_of(kind, bad), std::out_of_range);
        EXPECT_THROW((void)contact_at(asked, kind, bad, 0.5), std::out_of_range);
        EXPECT_THROW((void)contact_of(asked, {.kind = kind, .pair = bad}), std::out_of_range);
      }
    }
  }
}

}  // namespace
}  // namespace touchstone::fast::refusals_test
