/// \file
/// What is made of temporaries needs nothing of them afterwards. Under AddressSanitizer (./run
/// asan) a use of their memory ends the program; without it, the memory has other numbers.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "touchstone/broad_phase.hpp"
#include "touchstone/certificate.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/contacts.hpp"
#include "touchstone/curved_query.hpp"
#include "touchstone/intersections.hpp"
#include "touchstone/ipc_toolkit_step.hpp"
#include "touchstone/oracle.hpp"
#include "touchstone/polynomial.hpp"
#include "touchstone/step.hpp"

namespace touchstone::temporaries_test {
namespace {

using fast::Step;

/// Takes memory of all sizes that temporaries have had, and writes into it.
void write_elsewhere() {
  std::vector<std::vector<std::int32_t>> others;
  for (std::size_t i = 1; i < 512; ++i) others.emplace_back(i, 0x7FFFFFFF);
}

/// A triangle falls onto a larger one: its first vertex meets it at t = 1/3, and is within 1/4 at
/// t = 1/4.
Eigen::MatrixX3d places(double fall) {
  Eigen::MatrixX3d result{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 1}, {2, 1, 2}, {1, 2, 2}};
  result.bottomRows<3>().col(2).array() -= fall;
  return result;
}
Eigen::MatrixX3i faces() { return Eigen::MatrixX3i{{0, 1, 2}, {3, 4, 5}}; }
fast::Mesh mesh() { return {.faces = fast::elements_from<fast::Face>(faces())}; }
fast::Motion vertices() { return {places(0), places(3)}; }

template <class Scalar>
std::vector<Scalar> coordinates(double fall) {
  const Eigen::Matrix<Scalar, 6, 3, Eigen::RowMajor> rows = places(fall).cast<Scalar>();
  return {rows.data(), rows.data() + rows.size()};
}

/// Vertices of different triangles can collide.
std::function<bool(std::int32_t, std::int32_t)> rule() {
  return [group = std::vector<std::int32_t>{0, 0, 0, 1, 1, 1}](std::int32_t a, std::int32_t b) {
    return group.at(static_cast<std::size_t>(a)) != group.at(static_cast<std::size_t>(b));
  };
}

/// Contact is a distance of 1/4, of the separation or of the groups.
fast::StepOptions of_separation() {
  return {.solve = {.separation = {.distance = 0.25, .norm = Norm::l2}}, .can_collide = rule()};
}
fast::StepOptions of_groups() {
  return {.groups = {.of_vertices = {0, 0, 0, 1, 1, 1},
                     .apart = {{0, 0}, {1, 1}},
                     .radii = {7.0, 7.0},
                     .separations = {{{0, 1}, 0.25}}}};
}

ipc::CollisionMesh of_toolkit() {
  ipc::CollisionMesh result(
      places(0), Eigen::MatrixXi{{0, 1}, {1, 2}, {0, 2}, {3, 4}, {4, 5}, {3, 5}}, faces());
  result.can_collide = rule();
  return result;
}

const std::vector<std::function<Step()>> steps{
    [] { return Step(places(0), places(3), mesh(), of_groups()); },
    [] { return Step(places(0).cast<float>(), places(3).cast<float>(), mesh(), of_separation()); },
    [] {
      return Step(std::span<const double>(coordinates<double>(0)),
                  std::span<const double>(coordinates<double>(3)), mesh(), of_groups());
    },
    [] {
      return Step(std::span<const float>(coordinates<float>(0)),
                  std::span<const float>(coordinates<float>(3)), mesh(), of_separation());
    },
    [] {
      return Step(vertices(),
                  {.edges = fast::edges_of(mesh().faces),
                   .faces = mesh().faces,
                   .points = std::vector<std::int32_t>{3, 4, 5},
                   .tetrahedra = std::vector<fast::Tetrahedron>{{0, 1, 2, 3}},
                   .plane_triangles = mesh().faces},
                  of_groups());
    },
    [] { return Step(vertices(), mesh(), of_groups()).with_places(vertices(), {}); },
    [] {
      return Step(vertices(), mesh(), {.can_collide = rule()})
          .with_separation(of_separation().solve.separation);
    },
    [] { return Step(vertices(), mesh(), of_separation()).scaled(1.0); },
    [] {
      Step step(vertices(), {}, {});
      step = Step(vertices(), mesh(), of_groups());
      return step;
    },
    [] { return adapters::step_of(of_toolkit(), places(0), places(3), 0.25); },
};

/// The vertex of the fall, and the time.
void expect_contact(const std::optional<fast::StepImpact>& impact) {
  ASSERT_TRUE(impact);
  EXPECT_LE(impact->toi_lower, 0.25);
  EXPECT_GE(impact->toi_upper, 0.25);
  ASSERT_EQ(impact->pairs.size(), 1U);
  EXPECT_EQ(impact->pairs[0].kind, ContactKind::vertex_face);
  EXPECT_EQ(impact->pairs[0].pair, (fast::IndexPair{3, 0}));
}

TEST(Temporaries, AreNotNeededByAStep) {
  for (const auto& make : steps) {
    SCOPED_TRACE(&make - steps.data());
    const Step step = make();
    write_elsewhere();
    EXPECT_EQ(step.mesh().faces, mesh().faces);
    EXPECT_EQ(step.mesh().edges.size(), 6U);
    EXPECT_TRUE(step.intersections_at_start().empty());
    EXPECT_EQ(step.inversions().size(), step.mesh().tetrahedra.size());
    expect_contact(step.earliest());
  }
}

TEST(Temporaries, AreNotNeededByAStepOnCurves) {
  const auto numbers = [] {
    std::vector<double> result;
    for (Eigen::Index vertex = 0; vertex < 6; ++vertex) {
      for (const double fall : {0.0, 1.5, 3.0}) {
        const Eigen::RowVector3d place = places(fall).row(vertex);
        result.insert(result.end(), place.begin(), place.end());
      }
    }
    return result;
  };
  Step step(fast::Motion(2, false, numbers()), mesh(), of_groups());
  const Step moved = std::move(step);
  write_elsewhere();
  expect_contact(moved.earliest());
}

TEST(Temporaries, AreNotNeededByAnswers) {
  const auto query = [] {
    return Step(vertices(), mesh()).query_of(ContactKind::vertex_face, {3, 0});
  };
  const auto found = fast::intersections(places(1.5), mesh(), {.groups = of_groups().groups});
  const fast::MeshDefects defects = fast::mesh_defects(places(0), {.points = {0, 1, 2, 3}});
  const auto active = fast::active_set(Step(vertices(), mesh(), of_groups()), {.distance = 0.0});
  const auto point = [](double x, double y, double z) { return Eigen::Vector3d(x, y, z); };
  const auto solved =
      fast::solve_vertex_face(point(1, 1, 1), point(0, 0, 0), point(4, 0, 0), point(0, 4, 0),
                              point(1, 1, -2), point(0, 0, 0), point(4, 0, 0), point(0, 4, 0));
  const CurvedQuery curved = to_curved(query());
  const exact::Decision decision =
      exact::decide(Queries(ContactKind::vertex_face, std::vector<Query>{query()}), 0);
  const exact::Certificate proof =
      exact::prove(ContactKind::vertex_face, query(),
                   exact::decide(ContactKind::vertex_face, query()), exact::ProveOptions{});
  const exact::AlgebraicNumber third =
      exact::roots_in_unit_interval(exact::Polynomial(std::vector<exact::Integer>{-1, 3})).at(0);
  write_elsewhere();
  EXPECT_EQ(found.size(), 1U);
  EXPECT_EQ(defects.unreferenced_vertices, (std::vector<std::int32_t>{4, 5}));
  ASSERT_FALSE(active.empty());
  EXPECT_EQ(active[0].normal.z(), 1.0);
  EXPECT_EQ(solved.u, 0.25);
  EXPECT_EQ(exact::decide(ContactKind::vertex_face, curved).toi, third);
  EXPECT_EQ(decision.toi, third);
  EXPECT_TRUE(proof.contact);
}

}  // namespace
}  // namespace touchstone::temporaries_test
