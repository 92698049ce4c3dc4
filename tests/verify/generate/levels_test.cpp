#include "verify/generate/levels.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>

#include "tests/support/trials.hpp"
#include "touchstone/mesh.hpp"
#include "verify/base/any_decision.hpp"
#include "verify/data/query_group.hpp"
#include "verify/generate/random_stream.hpp"

namespace touchstone::verify::generate::levels_test {
namespace {

constexpr std::uint64_t seed = 7;

data::QueryGroup group_of(std::string_view name, ContactKind kind, int level,
                          std::uint64_t count = 16) {
  return level_group(level_family(name), kind, level, seed, tests::trials(count));
}

/// Calls use(level, kind, queries) for all levels and kinds of a family.
template <class Use>
void for_each_level(std::string_view name, const Use& use) {
  for (int level = 1; level <= greatest_level; ++level) {
    for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
      SCOPED_TRACE(::testing::Message() << name << " " << level << " " << to_string(kind));
      use(level, kind, group_of(name, kind, level).queries());
    }
  }
}

TEST(Levels, AreHalfCollisionsOrContactsAlone) {
  for (const LevelFamily& family : level_families()) {
    const bool is_contact = family.name.ends_with("end-contact");
    for_each_level(family.name, [&](int, ContactKind, const AnyQueries& queries) {
      for (std::size_t i = 0; i < queries.size(); ++i) {
        ASSERT_EQ(base::decide(queries, i).collides(), is_contact || i % 2 == 0) << i;
      }
    });
  }
}

/// The least distance is that of the level, to the last bit.
TEST(Levels, AreNearByExactlyTheDistance) {
  for (const std::string_view name : {"near", "near-on-curves"}) {
    for_each_level(name, [&](int level, ContactKind, const AnyQueries& queries) {
      const double distance =
          3.0 * (name == "near" ? std::ldexp(1.0, -4 * level) : std::ldexp(4.0, -3 * level));
      for (std::size_t i = 1; i < queries.size(); i += 2) {
        const auto collides_at = [&](double d) {
          return base::decide(queries, i, {.distance = d, .norm = Norm::l2}).collides();
        };
        EXPECT_TRUE(collides_at(distance));
        EXPECT_FALSE(collides_at(std::nextafter(distance, 0.0)));
      }
    });
  }
}

Eigen::Vector3d normal(ContactKind kind, const Query& query) {
  const auto side = [&](std::size_t a, std::size_t b) -> Eigen::Vector3d {
    return point_of(query, 0, b) - point_of(query, 0, a);
  };
  return kind == ContactKind::vertex_face ? side(1, 2).cross(side(1, 3))
                                          : side(0, 1).cross(side(2, 3));
}

TEST(Levels, HaveTheirAngle) {
  for_each_level("parallel", [](int level, ContactKind kind, const AnyQueries& queries) {
    for (const Query& query : queries.straight()) {
      const Eigen::Vector3d up = normal(kind, query);
      double tangent = 0.0;
      if (kind == ContactKind::edge_edge) {
        const Eigen::Vector3d a = point_of(query, 0, 1) - point_of(query, 0, 0),
                              b = point_of(query, 0, 3) - point_of(query, 0, 2);
        tangent = up.norm() / std::abs(a.dot(b));
      } else {
        const Eigen::Vector3d motion = (point_of(query, 1, 0) - point_of(query, 0, 0)) -
                                       (point_of(query, 1, 1) - point_of(query, 0, 1));
        const double down = std::abs(motion.dot(up)) / up.norm();
        tangent = down / std::sqrt(motion.squaredNorm() - down * down);
      }
      // The drift along x changes the way by a tenth.
      EXPECT_NEAR(std::ldexp(tangent, 3 * level), 1.0, 0.15);
    }
  });
}

TEST(Levels, AreFarFromTheOrigin) {
  for_each_level("far", [](int level, ContactKind, const AnyQueries& queries) {
    for (const Query& query : queries.straight()) {
      const double away = std::ldexp(point_of(query, 0, 0).norm(), -3 * level);
      EXPECT_GE(away, 3.0 * 0.7);
      EXPECT_LE(away, 3.0 * 1.9);
    }
  });
}

TEST(Levels, HaveTheirScaleAndDecimals) {
  for (const std::string_view name : {"end-contact", "decimal-end-contact"}) {
    for_each_level(name, [&](int level, ContactKind, const AnyQueries& queries) {
      const double scale = std::pow(10.0, level - 4);
      double greatest = 0.0;
      for (const double x : queries.numbers) {
        greatest = std::max(greatest, std::abs(x));
        if (name.starts_with("decimal")) {
          EXPECT_EQ(std::stod(fmt::format("{:.11g}", x)), x) << "a short decimal";
        }
      }
      EXPECT_LE(greatest, scale * (1.0 + 1e-15));
      EXPECT_GT(greatest, 0.9 * scale);
    });
  }
}

TEST(Levels, AreTheSameEverywhereAndDifferByEveryArgument) {
  const auto digest = [](std::string_view name, ContactKind kind, int level,
                         std::uint64_t of_seed) {
    std::uint64_t value = 0;
    const data::QueryGroup group = level_group(level_family(name), kind, level, of_seed, 4);
    for (const double x : group.queries().numbers)
      value = mix(value ^ std::bit_cast<std::uint64_t>(x));
    return value;
  };
  const std::uint64_t one = digest("near", ContactKind::vertex_face, 5, seed);
  const std::set<std::uint64_t> all{one, digest("near", ContactKind::edge_edge, 5, seed),
                                    digest("near", ContactKind::vertex_face, 6, seed),
                                    digest("near", ContactKind::vertex_face, 5, seed + 1),
                                    digest("far", ContactKind::vertex_face, 5, seed)};
  EXPECT_EQ(all.size(), 5U);
  EXPECT_EQ(one, 4364827704357140360U);
  EXPECT_EQ(group_of("near-on-curves", ContactKind::edge_edge, 1).shape(),
            (AnyShape{.kind = ContactKind::edge_edge, .degree = 2}));
  EXPECT_THROW((void)level_family("easy"), std::invalid_argument);
}

}  // namespace
}  // namespace touchstone::verify::generate::levels_test
