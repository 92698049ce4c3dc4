#include "verify/generate/hardness.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "tests/support/trials.hpp"
#include "touchstone/mesh.hpp"
#include "touchstone/number.hpp"
#include "touchstone/oracle.hpp"
#include "verify/fuzz/plainness.hpp"
#include "verify/generate/everyday.hpp"
#include "verify/generate/family_builder.hpp"
#include "verify/generate/random_stream.hpp"

namespace touchstone::verify::generate::hardness_test {
namespace {

using exact::Rational;
using tests::trials;

constexpr std::array kinds{Kind::vertex_face, Kind::edge_edge};
constexpr std::uint64_t seed = 7;
/// The size of every scene without scaling, in its coordinates.
constexpr double size = 3.0;

/// Calls use(level, kind, query, collides) for some queries of every level, on curves or lines.
template <class Use>
void for_each_query_of_any_shape(std::string_view name, std::uint64_t count, const Use& use) {
  const Hardness& hardness = hardness_from_name(name);
  for (const int level : hardness.levels) {
    for (const Kind kind : kinds) {
      SCOPED_TRACE(::testing::Message() << name << " " << level << " " << to_string(kind));
      for (std::uint64_t index = 0; index < trials(count); ++index) {
        const data::RecordedQuery made =
            make_hard_query({.hardness = &hardness, .level = level, .kind = kind}, seed, index);
        use(level, kind, made.query, made.collides.value());
      }
    }
  }
}

template <class Use>
void for_each_query(std::string_view name, std::uint64_t count, const Use& use) {
  for_each_query_of_any_shape(
      name, count, [&](int level, Kind kind, const base::AnyQuery& query, bool collides) {
        use(level, kind, query.straight(), collides);
      });
}

/// The number of the second primitive's first point.
std::size_t second(Kind kind) { return kind == Kind::vertex_face ? 1 : 2; }

using Vector = std::array<Rational, 3>;

Vector vector(const Query& query, std::size_t end, std::size_t from, std::size_t to) {
  Vector result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result[axis] = Rational(query.at(end, to, axis)) - Rational(query.at(end, from, axis));
  }
  return result;
}

Rational dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// The square of the length of `a` along a direction.
Rational square_along(const Vector& a, const Vector& direction) {
  const Rational product = dot(a, direction);
  return product * product / dot(direction, direction);
}

Vector normal(Kind kind, const Query& query, std::size_t end) {
  return kind == Kind::vertex_face ? cross(vector(query, end, 1, 2), vector(query, end, 1, 3))
                                   : cross(vector(query, end, 0, 1), vector(query, end, 2, 3));
}

/// Without a separation those of even numbers collide, which are half of the others too.
TEST(HardQueries, AreHalfCollisionsByTheOracle) {
  const Separation contact{};
  for (const Separation& asked : {contact, Separation{.distance = 1e-3, .norm = Norm::l2},
                                  Separation{.distance = 0.7, .norm = Norm::linf},
                                  Separation{.distance = 300.0, .norm = Norm::l2}}) {
    for (const Hardness& hardness : asked == contact ? all_hardnesses() : hardnesses()) {
      for (const int level : hardness.levels) {
        const bool is_end = level == hardness.levels.front() || level == hardness.levels.back();
        if (asked != contact && !is_end) continue;
        const Separation separation = separation_at(hardness, level, asked);
        for (const Kind kind : kinds) {
          SCOPED_TRACE(::testing::Message() << hardness.name << " " << level << " "
                                            << to_string(kind) << " " << asked.distance);
          std::uint64_t collisions = 0;
          for (std::uint64_t index = 0; index < trials(16U); ++index) {
            const data::RecordedQuery made = make_hard_query(
                {.hardness = &hardness, .level = level, .kind = kind, .separation = asked}, seed,
                index);
            ASSERT_EQ(exact::decide(made.query.queries(), 0, separation).collides(), made.collides);
            ASSERT_TRUE(asked != contact || made.collides == (index % 2 == 0)) << index;
            collisions += made.collides.value() ? 1U : 0U;
          }
          EXPECT_EQ(collisions, trials(16U) / 2);
        }
      }
    }
  }
}

/// The least distance is that of the level, to the last bit.
TEST(HardQueries, MissByExactlyTheDistance) {
  for (const std::string_view name : {"distance", "curve-distance"}) {
    const double unit = name == "distance" ? size : 4.0 * size;
    for_each_query_of_any_shape(
        name, 16, [&](int exponent, Kind, const base::AnyQuery& query, bool collides) {
          if (collides) return;
          const auto collides_at = [&](double distance) {
            return exact::decide(query.queries(), 0, {.distance = distance, .norm = Norm::l2})
                .collides();
          };
          const double distance = std::ldexp(unit, exponent);
          EXPECT_TRUE(collides_at(distance));
          EXPECT_FALSE(collides_at(std::nextafter(distance, 0.0)));
        });
  }
}

/// The overlap of collisions is the distance: across the plane at the end, or across a side within
/// the plane.
TEST(HardQueries, OverlapByExactlyTheDistance) {
  for_each_query("distance", 16, [](int exponent, Kind kind, const Query& query, bool collides) {
    if (!collides) return;
    const Rational distance = Rational(size) * exact::power_of_two(exponent);
    const Rational square = distance * distance;
    std::vector<Rational> overlaps{
        square_along(vector(query, 1, second(kind), 0), normal(kind, query, 1))};
    const Vector up = normal(kind, query, 0);
    for (std::size_t edge = 0; edge < 12; ++edge) {
      const std::size_t from = edge / 4, to = edge % 4;
      if (from == to || (from < second(kind)) != (to < second(kind))) continue;
      const Vector across = cross(vector(query, 0, from, to), up);
      for (std::size_t point = 0; point < 4; ++point) {
        if ((point < second(kind)) == (from < second(kind))) continue;
        overlaps.push_back(square_along(vector(query, 0, from, point), across));
      }
    }
    EXPECT_NE(std::ranges::find(overlaps, square), overlaps.end());
  });
}

TEST(HardQueriesOnCurves, HaveTheirShapes) {
  const auto shape = [](std::string_view name, int level) {
    const HardSort sort{.hardness = &hardness_from_name(name), .level = level};
    const auto source = open_hard_queries(sort, seed, 2);
    EXPECT_EQ(source->next()->query.shape(), source->shape());
    return source->shape();
  };
  EXPECT_EQ(shape("curve-distance", -20), (QueryShape{.degree = 3}));
  EXPECT_EQ(shape("rotation-distance", -36), (QueryShape{.degree = 2, .is_rational = true}));
  EXPECT_EQ(shape("curve-degree", 8), (QueryShape{.degree = 8}));
  EXPECT_EQ(shape("distance", -20), QueryShape{});
  EXPECT_EQ(level_text(hardness_from_name("curve-degree"), 5), "degree 5");
}

// ---- Scenes in a frame --------------------------------------------------------------------------

/// The least height of a triangle over its longest side; or the lengths of two edges, of which the
/// symmetry chooses the shorter one.
double aspect(Kind kind, const Query& query) {
  const auto side = [&](std::size_t a, std::size_t b) {
    return Eigen::Vector3d(point_of(query, 0, b) - point_of(query, 0, a)).norm();
  };
  if (kind == Kind::edge_edge) {
    return std::min(side(0, 1), side(2, 3)) / std::max(side(0, 1), side(2, 3));
  }
  const double longest = std::max({side(1, 2), side(1, 3), side(2, 3)});
  const Vector up = normal(kind, query, 0);
  return std::sqrt(dot(up, up).get_d()) / longest / longest;
}

/// The tangent of the angle between the edges, or between the motion and the face.
double angle(Kind kind, const Query& query) {
  const Vector up = normal(kind, query, 0);
  if (kind == Kind::edge_edge) {
    const Rational along = dot(vector(query, 0, 0, 1), vector(query, 0, 2, 3));
    return std::sqrt(Rational(dot(up, up) / (along * along)).get_d());
  }
  Vector motion = vector(query, 1, 1, 0);
  const Vector before = vector(query, 0, 1, 0);
  for (std::size_t axis = 0; axis < 3; ++axis) motion[axis] -= before[axis];
  const Rational down = square_along(motion, up);
  return std::sqrt(Rational(down / (dot(motion, motion) - down)).get_d());
}

/// The motion of the first primitive relative to the second one's first point.
double speed(Kind kind, const Query& query) {
  const std::size_t other = second(kind);
  const Eigen::Vector3d motion = (point_of(query, 1, 0) - point_of(query, 0, 0)) -
                                 (point_of(query, 1, other) - point_of(query, 0, other));
  return motion.norm() / size;
}

double offset(Kind, const Query& query) { return point_of(query, 0, 0).norm() / size; }

double scale(Kind, const Query& query) {
  double greatest = 0.0;
  for (const double x : query.coordinates) greatest = std::max(greatest, std::abs(x));
  return greatest / size;
}

TEST(HardQueries, HaveTheirLevel) {
  struct Row {
    const char* name;
    double (*measure)(Kind, const Query&);
    double low;
    std::array<double, 2> high;  // of both kinds
  };
  for (const Row& row : {Row{"aspect", aspect, 0.65, {1.2, 1.5}},
                         {"angle", angle, 0.85, {1.2, 1.2}},
                         {"speed", speed, 0.7, {1.1, 1.1}},
                         {"offset", offset, 0.7, {1.9, 1.9}},
                         {"scale", scale, 0.3, {3.0, 3.0}}}) {
    for_each_query(row.name, 16, [&](int exponent, Kind kind, const Query& query, bool) {
      if (row.measure == offset && exponent == 0) return;
      const double found = std::ldexp(row.measure(kind, query), -exponent);
      EXPECT_GE(found, row.low);
      EXPECT_LE(found, row.high.at(kind == Kind::edge_edge ? 1 : 0));
    });
  }
}

/// Only rounded values test a filter.
TEST(HardQueries, HaveFullSignificands) {
  for (const std::string_view name : {"distance", "aspect", "angle", "scale"}) {
    for_each_query(name, 8, [](int, Kind, const Query& query, bool) {
      EXPECT_TRUE(uses_full_significands(query));
    });
  }
  for (const Hardness& hardness : curve_hardnesses()) {
    const HardSort sort{.hardness = &hardness, .level = hardness.levels.back()};
    const data::RecordedQuery made = make_hard_query(sort, seed, 0);
    const auto has_many_bits = [](double x) {
      return std::ldexp(x, 30) != std::rint(std::ldexp(x, 30));
    };
    EXPECT_GT(2 * std::ranges::count_if(made.query.numbers(), has_many_bits),
              std::ssize(made.query.numbers()));
  }
}

// ---- Scenes of decimals -------------------------------------------------------------------------

bool is_at_an_end(Kind kind, const Query& query) {
  const exact::Decision truth = exact::decide(kind, query);
  const auto [lower, upper] = truth.toi->enclosure();
  return upper == 0.0 || lower == 1.0;
}

/// Contacts are exactly at t=0 or t=1 at all levels, or earlier than at t=1, because a whole motion
/// may be in contact.
TEST(HardQueries, OfDecimalsCollideMostlyAtTheEnds) {
  for (const std::string_view name : {"everyday-scale", "digits", "frame"}) {
    int collisions = 0, at_ends = 0;
    for_each_query(name, 16, [&](int, Kind kind, const Query& query, bool collides) {
      if (!collides) return;
      ++collisions;
      at_ends += is_at_an_end(kind, query) ? 1 : 0;
    });
    EXPECT_GT(at_ends, collisions / 2) << name;
  }
}

TEST(HardQueries, OfDecimalsHaveTheScale) {
  for_each_query("everyday-scale", 16, [](int level, Kind, const Query& query, bool) {
    EXPECT_LE(fuzz::size_exponent({Kind::vertex_face, query}), level - 1);
    EXPECT_GE(fuzz::size_exponent({Kind::vertex_face, query}), level - 8);
    for (const double x : fuzz::magnitudes({Kind::vertex_face, query})) {
      EXPECT_LE(shortest_decimal(std::ldexp(x, -level)).count, 4) << x;
    }
  });
}

TEST(HardQueries, OfDecimalsHaveTheDigits) {
  for_each_query("digits", 16, [](int level, Kind, const Query& query, bool) {
    int most = 0;
    for (const double x : fuzz::magnitudes({Kind::vertex_face, query})) {
      // The distance without contact may be several times the size.
      const Decimal decimal = shortest_decimal(x);
      EXPECT_GE(decimal.exponent, -level - 1) << x;
      most = std::max(most, decimal.count);
    }
    EXPECT_LE(most, level + 2);
    EXPECT_GE(most, level > 3 ? level - 2 : 0);
  });
}

TEST(HardQueries, HaveTheShareOfContactsAtTheEnds) {
  const Hardness& hardness = hardness_from_name("ends");
  constexpr int count = 200;
  for (const int level : hardness.levels) {
    int at_ends = 0;
    for (int i = 0; i < count; ++i) {
      const Kind kind = kinds.at(static_cast<std::size_t>(i % 2));
      const data::RecordedQuery made =
          make_hard_query({.hardness = &hardness, .level = level, .kind = kind}, seed,
                          static_cast<std::uint64_t>(2 * i));
      ASSERT_TRUE(made.collides.value());
      at_ends += is_at_an_end(kind, made.query.straight()) ? 1 : 0;
    }
    EXPECT_TRUE(level != 0 || at_ends == 0) << at_ends;
    // Some queries with contact at t=1 have contact earlier.
    EXPECT_LE(at_ends, count * (level + 10) / 100) << level;
    EXPECT_GE(at_ends, count * (level - 20) / 200) << level;
  }
}

TEST(HardQueries, HaveTheFrame) {
  for_each_query("frame", 16, [](int level, Kind, const Query& query, bool) {
    if (level < 8) return;
    for (const double x : query.coordinates) {
      EXPECT_NEAR(x / (0.1 * std::ldexp(1.0, level)), 1.0, 0x1p-3);
    }
  });
}

TEST(HardQueries, AreTheSameEverywhereAndDifferByEveryArgument) {
  const HardSort sort{.hardness = &hardness_from_name("distance"), .level = -20};
  HardSort other_level = sort, other_kind = sort, other_hardness = sort;
  other_level.level = -25;
  other_kind.kind = Kind::edge_edge;
  other_hardness.hardness = &hardness_from_name("angle");
  const auto hash = [&](const HardSort& some, std::uint64_t of_seed, std::uint64_t index) {
    std::uint64_t value = 0;
    for (const double x : make_hard_query(some, of_seed, index).query.numbers()) {
      value = mix(value ^ std::bit_cast<std::uint64_t>(x));
    }
    return value;
  };
  const std::set<std::uint64_t> all{hash(sort, seed, 3),       hash(sort, seed, 4),
                                    hash(sort, seed + 1, 3),   hash(other_level, seed, 3),
                                    hash(other_kind, seed, 3), hash(other_hardness, seed, 3)};
  EXPECT_EQ(all.size(), 6U);
  EXPECT_EQ(hash(sort, seed, 3), 10027675287850289189U);
}

/// Curves are about contact alone, and the others about a limited distance.
TEST(HardQueries, AreOfTheLevelsAndDistancesThereAre) {
  const auto refused = [](std::string_view name, int level, double distance) {
    const HardSort sort{.hardness = &hardness_from_name(name),
                        .level = level,
                        .separation = {.distance = distance, .norm = Norm::l2}};
    EXPECT_THROW((void)make_hard_query(sort, seed, 0), std::invalid_argument) << name;
    EXPECT_THROW((void)open_hard_queries(sort, seed, 1), std::invalid_argument) << name;
  };
  refused("distance", -2, 0.0);
  refused("scale", 1000, 1e5);
  for (const Hardness& hardness : curve_hardnesses()) {
    refused(hardness.name, hardness.levels.front(), 1e-3);
  }
  EXPECT_TRUE(has_hard_queries({}));
  EXPECT_TRUE(has_hard_queries({.distance = 0x1p14, .norm = Norm::linf}));
  EXPECT_FALSE(has_hard_queries({.distance = 0x1.1p14, .norm = Norm::linf}));
  EXPECT_FALSE(has_hard_queries({.distance = -1.0, .norm = Norm::linf}));
  const HardSort greatest{.hardness = &hardness_from_name("scale"),
                          .level = 1000,
                          .separation = {.distance = 0x1p14, .norm = Norm::l2}};
  EXPECT_TRUE(is_finite(make_hard_query(greatest, seed, 0).query.numbers()));
}

}  // namespace
}  // namespace touchstone::verify::generate::hardness_test
