#include "exact/query.hpp"

#include <gtest/gtest.h>

#include <array>
#include <initializer_list>
#include <limits>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exact/algebra/number.hpp"
#include "tests/support/random.hpp"

namespace touchstone::query_test {
namespace {

using exact::Rational;
using tests::Random;
using Vector = std::array<Rational, 3>;

constexpr std::array kinds{Kind::vertex_face, Kind::edge_edge};

/// The query whose coordinates are 1, 2, …, 24.
Query counting_query() {
  Query query{};
  std::iota(query.coordinates.begin(), query.coordinates.end(), 1.0);
  return query;
}

Query random_query(Random& random) {
  Query query{};
  for (double& x : query.coordinates) x = random.few_bit_double(53, -80, 80);
  return query;
}

Rational random_fraction(Random& random) { return {Rational(random.between(0, 1000)) / 1000}; }

/// The corner w_i(t) from the documented pairs of points, without contact_function.
Vector corner_at(const Query& query, const Corner& corner, const Rational& t) {
  Vector w;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto difference = [&](std::size_t end) {
      return Rational(Rational(query.at(end, corner.plus, axis)) -
                      Rational(query.at(end, corner.minus, axis)));
    };
    w[axis] = difference(0) + t * (difference(1) - difference(0));
  }
  return w;
}

TEST(Query, AnArrayOfDoublesIsASpanOfQueries) {
  static constexpr std::size_t count = 5;
  std::vector<double> values(count * 24);
  std::iota(values.begin(), values.end(), 0.0);
  const std::span<const Query> queries(reinterpret_cast<const Query*>(values.data()), count);
  ASSERT_EQ(queries.size_bytes(), values.size() * sizeof(double));
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(&queries[i / 24].coordinates[i % 24], &values[i]);
  }
}

TEST(Query, ABatchRefersToTheQueriesThatItWasGiven) {
  const std::vector<Query> queries(3, counting_query());
  const QueryBatch batch{Kind::edge_edge, queries};
  EXPECT_EQ(batch.kind, Kind::edge_edge);
  EXPECT_EQ(batch.queries.data(), queries.data());
  EXPECT_EQ(batch.queries.size(), 3U);
}

TEST(Query, CoordinatesStandInTheOrderEndPointAxis) {
  const Query query = counting_query();
  double expected = 1.0;
  for (std::size_t end = 0; end < 2; ++end) {
    for (std::size_t point = 0; point < moving_points; ++point) {
      for (std::size_t axis = 0; axis < 3; ++axis, ++expected) {
        EXPECT_EQ(query.at(end, point, axis), expected);
        EXPECT_EQ(query.point(end, point)[static_cast<Eigen::Index>(axis)], expected);
      }
    }
  }
}

TEST(Query, AccessorsWriteThrough) {
  Query query = counting_query();
  query.at(1, 2, 1) = -7.0;
  query.point(0, 3) = Eigen::Vector3d(100.0, 200.0, 300.0);
  query.point(1, 0) += Eigen::Vector3d::Ones();
  Query expected = counting_query();
  expected.coordinates[3 * (4 + 2) + 1] = -7.0;
  expected.coordinates[9] = 100.0;
  expected.coordinates[10] = 200.0;
  expected.coordinates[11] = 300.0;
  for (std::size_t i = 12; i < 15; ++i) expected.coordinates[i] += 1.0;
  EXPECT_EQ(query, expected);
}

TEST(Query, PointsReferToTheQuerysOwnMemory) {
  Query query = counting_query();
  const Query& constant = query;
  for (std::size_t end = 0; end < 2; ++end) {
    for (std::size_t point = 0; point < moving_points; ++point) {
      const double* expected = &query.coordinates[12 * end + 3 * point];
      EXPECT_EQ(query.point(end, point).data(), expected);
      EXPECT_EQ(constant.point(end, point).data(), expected);
    }
  }
}

TEST(Query, EqualityComparesEveryCoordinate) {
  const Query query = counting_query();
  EXPECT_EQ(query, counting_query());
  for (std::size_t i = 0; i < query.coordinates.size(); ++i) {
    Query other = query;
    other.coordinates[i] = -1.0;
    EXPECT_FALSE(query == other) << i;
  }
}

TEST(Query, IsFiniteIfAllCoordinatesAre) {
  using Limits = std::numeric_limits<double>;
  EXPECT_TRUE(is_finite(Query{}));
  for (std::size_t i = 0; i < Query{}.coordinates.size(); ++i) {
    Query query{};
    query.coordinates[i] = -Limits::max();
    EXPECT_TRUE(is_finite(query)) << i;
    for (const double bad : {Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN()}) {
      query.coordinates[i] = bad;
      EXPECT_FALSE(is_finite(query)) << i << ' ' << bad;
    }
  }
}

TEST(Corners, AreTheDocumentedDifferences) {
  const auto pairs = [](Kind kind) {
    std::vector<std::pair<std::size_t, std::size_t>> result;
    for (const Corner& corner : corners(kind)) result.emplace_back(corner.plus, corner.minus);
    return result;
  };
  using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;
  EXPECT_EQ(pairs(Kind::vertex_face), (Pairs{{0, 1}, {0, 2}, {0, 3}}));
  EXPECT_EQ(pairs(Kind::edge_edge), (Pairs{{0, 2}, {1, 2}, {1, 3}, {0, 3}}));
}

TEST(Corners, StandAtTheVerticesOfTheDomainInCyclicOrder) {
  const auto parameters = [](Kind kind) {
    std::vector<std::pair<int, int>> result;
    for (const Corner& corner : corners(kind)) result.emplace_back(corner.u, corner.v);
    return result;
  };
  using Pairs = std::vector<std::pair<int, int>>;
  EXPECT_EQ(parameters(Kind::vertex_face), (Pairs{{0, 0}, {1, 0}, {0, 1}}));
  EXPECT_EQ(parameters(Kind::edge_edge), (Pairs{{0, 0}, {1, 0}, {1, 1}, {0, 1}}));
}

TEST(AffineVectors, AreDifferencesOfCorners) {
  Random random(3);
  const Query query = random_query(random);
  const Rational t = random_fraction(random);
  for (const Kind kind : kinds) {
    const auto difference = [&](const std::array<std::size_t, 2>& points) {
      return corner_at(query, {points[0], points[1], 0, 0}, t);
    };
    const auto [r, p, q] = affine_vectors(kind);
    const Vector w0 = corner_at(query, corners(kind).front(), t);
    EXPECT_EQ(difference(r), w0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(difference(p)[axis], w0[axis] - corner_at(query, corners(kind)[1], t)[axis]);
      EXPECT_EQ(difference(q)[axis], w0[axis] - corner_at(query, corners(kind).back(), t)[axis]);
    }
  }
}

TEST(ContactFunction, EqualsTheCornerAtEveryVertexOfTheDomain) {
  Random random(1);
  for (int round = 0; round < 50; ++round) {
    const Query query = random_query(random);
    const Rational t = random_fraction(random);
    for (const Kind kind : kinds) {
      for (std::size_t i = 0; i < corners(kind).size(); ++i) {
        const Corner& corner = corners(kind)[i];
        const Rational u(corner.u), v(corner.v);
        EXPECT_EQ(contact_function(kind, query, t, u, v), corner_at(query, corner, t))
            << to_string(kind) << " corner " << i;
      }
    }
  }
}

TEST(ContactFunction, IsAffineBetweenTheCorners) {
  Random random(2);
  for (int round = 0; round < 50; ++round) {
    const Query query = random_query(random);
    const Rational t = random_fraction(random), u = random_fraction(random),
                   v = random_fraction(random);
    for (const Kind kind : kinds) {
      // Corner 0 is at (0,0), corner 1 at (1,0), the last one at (0,1), for both kinds.
      const auto along = [&](const Corner& corner) { return corner_at(query, corner, t); };
      const Vector origin = along(corners(kind).front()), first = along(corners(kind)[1]),
                   second = along(corners(kind).back());
      const Vector value = contact_function(kind, query, t, u, v);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(value[axis], Rational(origin[axis] + u * (first[axis] - origin[axis]) +
                                        v * (second[axis] - origin[axis])));
      }
    }
  }
}

TEST(ContactFunction, HasTheValuesComputedByHand) {
  // Point k stands at (k, k², 1) at t=0 and moves by (4, 0, −2k).
  Query query{};
  for (std::size_t k = 0; k < moving_points; ++k) {
    const auto x = static_cast<double>(k);
    query.point(0, k) = Eigen::Vector3d(x, x * x, 1.0);
    query.point(1, k) = Eigen::Vector3d(x + 4.0, x * x, 1.0 - 2.0 * x);
  }
  // At t=1/2 point k is at (k+2, k², 1−k).
  const Rational t(1, 2), u(1, 4), v(1, 3);
  // v = (2,0,1); the face at (5/12, 1/4, 1/3): (3,1,0)·5/12 + (4,4,−1)·1/4 + (5,9,−2)·1/3.
  EXPECT_EQ(contact_function(Kind::vertex_face, query, t, u, v),
            (Vector{Rational(-23, 12), Rational(-53, 12), Rational(23, 12)}));
  // ea: (2,0,1)·3/4 + (3,1,0)·1/4; eb: (4,4,−1)·2/3 + (5,9,−2)·1/3.
  EXPECT_EQ(contact_function(Kind::edge_edge, query, t, u, v),
            (Vector{Rational(-25, 12), Rational(-65, 12), Rational(25, 12)}));
}

std::string join(std::initializer_list<std::string_view> parts) {
  std::string result;
  for (const std::string_view part : parts) result += part;
  return result;
}

/// A scalar that records the operations on it.
struct Recorded {
  Recorded() = default;
  explicit Recorded(double value) : text(std::to_string(static_cast<int>(value))) {}
  explicit Recorded(std::string formula) : text(std::move(formula)) {}

  std::string text;
};

Recorded operator+(const Recorded& a, const Recorded& b) {
  return Recorded(join({"(", a.text, "+", b.text, ")"}));
}
Recorded operator-(const Recorded& a, const Recorded& b) {
  return Recorded(join({"(", a.text, "-", b.text, ")"}));
}
Recorded operator*(const Recorded& a, const Recorded& b) {
  return Recorded(join({"(", a.text, "*", b.text, ")"}));
}

TEST(ContactFunction, PerformsTheOperationsInTheOrderOfItsFormula) {
  const Recorded t(std::string("t")), u(std::string("u")), v(std::string("v"));
  const auto value = [&](Kind kind, int axis) {
    return contact_function(kind, counting_query(), t, u, v)[static_cast<std::size_t>(axis)].text;
  };
  const auto position = [](int start, int end) {
    return join({"(((1-t)*", std::to_string(start), ")+(t*", std::to_string(end), "))"});
  };
  for (int axis = 0; axis < 3; ++axis) {
    const std::string a = position(1 + axis, 13 + axis), b = position(4 + axis, 16 + axis),
                      c = position(7 + axis, 19 + axis), d = position(10 + axis, 22 + axis);
    EXPECT_EQ(value(Kind::vertex_face, axis),
              join({"(", a, "-(((((1-u)-v)*", b, ")+(u*", c, "))+(v*", d, ")))"}));
    EXPECT_EQ(value(Kind::edge_edge, axis),
              join({"((((1-u)*", a, ")+(u*", b, "))-(((1-v)*", c, ")+(v*", d, ")))"}));
  }
}

TEST(Kind, TextsAreThoseOfTheDatasets) {
  EXPECT_EQ(to_string(Kind::vertex_face), "vertex-face");
  EXPECT_EQ(to_string(Kind::edge_edge), "edge-edge");
  for (const Kind kind : kinds) EXPECT_EQ(kind_from_string(to_string(kind)), kind);
}

TEST(Kind, AnyOtherTextIsAnError) {
  for (const std::string_view text : {"", "vertex", "vertex_face", "Vertex-Face", "edge-edge ",
                                      " edge-edge", "edge-edgeedge-edge", "face-vertex"}) {
    EXPECT_THROW(static_cast<void>(kind_from_string(text)), std::invalid_argument) << text;
  }
  using namespace std::string_view_literals;
  EXPECT_THROW(static_cast<void>(kind_from_string("edge-edge\0"sv)), std::invalid_argument);
}

TEST(Norm, TextsAndNormsAreEachOthersInverse) {
  EXPECT_EQ(to_string(Norm::linf), "linf");
  EXPECT_EQ(to_string(Norm::l2), "l2");
  for (const Norm norm : {Norm::linf, Norm::l2}) EXPECT_EQ(norm_from_string(to_string(norm)), norm);
  for (const std::string_view text : {"", "l", "L2", "linf ", "l1", "inf"}) {
    EXPECT_THROW(static_cast<void>(norm_from_string(text)), std::invalid_argument) << text;
  }
}

TEST(Separation, DistancesAreFiniteAndNotNegative) {
  using Limits = std::numeric_limits<double>;
  for (const double d : {0.0, -0.0, Limits::denorm_min(), 1e-100, 1.0, Limits::max()}) {
    EXPECT_TRUE(is_valid(Separation{.distance = d, .norm = Norm::l2})) << d;
  }
  for (const double d : {-Limits::denorm_min(), -1.0, Limits::infinity(), -Limits::infinity(),
                         Limits::quiet_NaN()}) {
    EXPECT_FALSE(is_valid(Separation{.distance = d})) << d;
  }
}

TEST(Separation, OnlyZeroIsContact) {
  using Limits = std::numeric_limits<double>;
  for (const double d : {0.0, -0.0}) EXPECT_TRUE(is_zero({.distance = d})) << d;
  for (const double d : {Limits::denorm_min(), -Limits::denorm_min(), 1.0, Limits::quiet_NaN()}) {
    EXPECT_FALSE(is_zero({.distance = d})) << d;
  }
}

}  // namespace
}  // namespace touchstone::query_test
