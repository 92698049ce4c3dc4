#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include <tight_inclusion/ccd.hpp>
#include <tight_inclusion/interval_root_finder.hpp>
#include <tight_inclusion/logger.hpp>

#include "tests/support/random.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/tight_inclusion.hpp"

namespace touchstone::adapters::ccd_test {
namespace {

using tests::Random;
using ticcd::Vector3;

/// The results of a call.
struct Said {
  bool collision = false;
  double toi = -1.0;
  double tolerance = -1.0;
};

Said ask(ContactKind kind, const Query& query, double ms = 0.0, double t_max = 1.0) {
  const auto p = [&](std::size_t i) {
    return Vector3(query.coordinates[3 * i], query.coordinates[3 * i + 1],
                   query.coordinates[3 * i + 2]);
  };
  const ticcd::Array3 err(-1, -1, -1);
  Said said;
  said.collision = kind == ContactKind::vertex_face
                       ? ticcd::vertexFaceCCD(p(0), p(1), p(2), p(3), p(4), p(5), p(6), p(7), err,
                                              ms, said.toi, 1e-6, t_max, 10, said.tolerance)
                       : ticcd::edgeEdgeCCD(p(0), p(1), p(2), p(3), p(4), p(5), p(6), p(7), err, ms,
                                            said.toi, 1e-6, t_max, -1, said.tolerance, true,
                                            ticcd::CCDRootFindingMethod::DEPTH_FIRST_SEARCH);
  return said;
}

TEST(TightInclusionAdapter, AnswersAsTheSolver) {
  Random random(5);
  int collisions = 0, no_collisions = 0;
  for (int i = 0; i < 2000; ++i) {
    Query query;
    for (double& x : query.coordinates) x = random.between(-3, 3);
    const ContactKind kind = i % 2 == 0 ? ContactKind::vertex_face : ContactKind::edge_edge;
    const double ms = i % 3 == 0 ? 0.5 : 0.0, t_max = i % 5 == 0 ? 0.5 : 1.0;
    const fast::CertifiedResult expected = fast::solve(
        kind, query, {.t_max = t_max, .separation = {.distance = ms, .norm = Norm::linf}});
    const Said said = ask(kind, query, ms, t_max);
    ASSERT_EQ(said.collision, expected.verdict == fast::Verdict::yes) << i;
    EXPECT_EQ(said.toi,
              said.collision ? expected.toi_lower : std::numeric_limits<double>::infinity());
    EXPECT_EQ(said.tolerance, 1e-6);
    ++(said.collision ? collisions : no_collisions);
  }
  EXPECT_GT(collisions, 200);
  EXPECT_GT(no_collisions, 200);
}

// The usage of a program that knows both libraries.
#if !defined(TIGHT_INCLUSION_WITH_DOUBLE_PRECISION) || !defined(TIGHT_INCLUSION_VER)
#error "the macros of config.hpp are not there"
#endif

TEST(TightInclusionAdapter, StopsWhatIsNotFinite) {
  Query query{{9, 9, 9, 0, 0, 0, 4, 0, 0, 0, 4, 0, 9, 9, 8, 0, 0, 0, 4, 0, 0, 0, 4, 0}};
  EXPECT_FALSE(ask(ContactKind::vertex_face, query).collision);
  query.coordinates[0] = std::numeric_limits<double>::quiet_NaN();
  const Said said = ask(ContactKind::vertex_face, query);
  EXPECT_TRUE(said.collision);
  EXPECT_EQ(said.toi, 0.0);
  query.coordinates[0] = 9;
  EXPECT_THROW(static_cast<void>(ask(ContactKind::vertex_face, query, -1.0)),
               std::invalid_argument);
  EXPECT_THROW(static_cast<void>(ask(ContactKind::vertex_face, query, 0.0, 2.0)),
               std::invalid_argument);
}

/// δ / (3 κ), with κ the greatest change of F along t, u or v ([wang2021], section 4.2).
TEST(TightInclusionAdapter, HasTheTolerancesOfTheParameters) {
  const Vector3 o(0, 0, 0), a(4, 0, 0), b(0, 0, -8), v(1, 1, 0), below(1, -15, 0);
  static_assert(ticcd::DEFAULT_CCD_DISTANCE_TOL == 1e-6);
  const ticcd::Array3 of_face =
      ticcd::compute_vertex_face_tolerances(v, o, a, b, below, o, a, b, 48.0);
  EXPECT_TRUE((of_face == ticcd::Array3(1.0, 4.0, 2.0)).all()) << of_face;
  EXPECT_TRUE(
      (of_face == ticcd::compute_face_vertex_tolerances(v, o, a, b, below, o, a, b, 48.0)).all());
  const ticcd::Array3 of_edges =
      ticcd::compute_edge_edge_tolerances(o, a, v, below, o, a, v, below, 48.0);
  EXPECT_TRUE((of_edges == ticcd::Array3(std::numeric_limits<double>::infinity(), 4.0, 1.0)).all())
      << of_edges;
  EXPECT_EQ(ticcd::compute_edge_edge_tolerances(o, a, v, below, o, a, v, below)[1], 1e-6 / 12.0);
  EXPECT_EQ(ticcd::return_queue_size(), 0);
}

// ---- Its other headers --------------------------------------------------------------------------

TEST(TightInclusionFilter, IsThatOfTheGreatestCoordinates) {
  for (const bool is_vertex_face : {false, true}) {
    for (const bool is_separated : {false, true}) {
      const ticcd::Array3 filter = ticcd::get_numerical_error(
          {Vector3(-8, 1, 0), Vector3(3, -2, 1e9)}, is_vertex_face, is_separated);
      const auto expected =
          fast::error_filter(is_vertex_face ? ContactKind::vertex_face : ContactKind::edge_edge,
                             {8, 2, 1e9}, is_separated ? 1e-300 : 0.0);
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(filter[axis], expected[static_cast<std::size_t>(axis)]);
      }
    }
  }
}

TEST(TightInclusionLogger, IsOfItsNameUntilAnotherIsSet) {
  EXPECT_EQ(ticcd::logger().name(), "ticcd");
  EXPECT_NE(&ticcd::logger(), spdlog::default_logger().get());
  const auto other = std::make_shared<spdlog::logger>("other");
  ticcd::set_logger(other);
  EXPECT_EQ(&ticcd::logger(), other.get());
}

}  // namespace
}  // namespace touchstone::adapters::ccd_test
