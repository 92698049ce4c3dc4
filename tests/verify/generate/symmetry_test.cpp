#include "verify/generate/symmetry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "tests/support/trials.hpp"
#include "touchstone/any_kind.hpp"
#include "touchstone/number.hpp"
#include "touchstone/oracle.hpp"
#include "verify/base/any_decision.hpp"
#include "verify/fuzz/generators.hpp"
#include "verify/generate/random_stream.hpp"

namespace touchstone::verify::generate::symmetry_test {
namespace {

constexpr std::array<ContactKind, 2> both_kinds{ContactKind::vertex_face, ContactKind::edge_edge};

Query counting() {
  Query query{};
  for (std::size_t i = 0; i < query.coordinates.size(); ++i) {
    query.coordinates.at(i) = static_cast<double>(i);
  }
  return query;
}

TEST(Symmetry, IsWhatItSaysAndNothingElse) {
  const Query query = counting();
  EXPECT_EQ(image({}, query), query);

  const Symmetry symmetry{.points = {0, 2, 1, 3},
                          .axes = {1, 0, 2},
                          .factors = {-1.0, 1.0, 4.0},
                          .shifts = {0.0, 0.0, 1.0},
                          .reversed = true};
  const Query result = image(symmetry, query).value();
  for (std::size_t end = 0; end < 2; ++end) {
    for (std::size_t point = 0; point < moving_points; ++point) {
      const std::size_t from = symmetry.points.at(point);
      EXPECT_EQ(result.at(1 - end, point, 0), -query.at(end, from, 1));
      EXPECT_EQ(result.at(1 - end, point, 1), query.at(end, from, 0));
      EXPECT_EQ(result.at(1 - end, point, 2), 4.0 * query.at(end, from, 2) + 1.0);
    }
  }
}

TEST(Symmetry, HasNoImageThatIsRounded) {
  Query query = counting();
  query.at(0, 0, 0) = 0.1;
  EXPECT_FALSE(image({.shifts = {1.0, 0.0, 0.0}}, query));
  EXPECT_TRUE(image({.shifts = {0.0, 1.0, 0.0}}, query));
  EXPECT_TRUE(image({.factors = {0x1p-60, 1.0, 1.0}}, query));
  query.at(0, 0, 0) = 3 * std::numeric_limits<double>::denorm_min();
  EXPECT_FALSE(image({.factors = {0.5, 1.0, 1.0}}, query));
  EXPECT_TRUE(image({.factors = {2.0, 1.0, 1.0}}, query));
  query.at(0, 0, 0) = std::numeric_limits<double>::max();
  EXPECT_FALSE(image({.factors = {2.0, 1.0, 1.0}}, query));
  EXPECT_FALSE(image({.shifts = {std::numeric_limits<double>::max(), 0.0, 0.0}}, query));
}

TEST(Symmetry, DrawsEveryIngredientAndOnlyExactImages) {
  Random random(1);
  const fuzz::GeneratorContext context({});
  const Symmetry identity;
  const auto is_beyond_1 = [](double factor) { return std::abs(factor) > 1.0; };
  std::array<bool, 5> seen{};
  for (int i = 0; i < 2000; ++i) {
    const ContactKind kind = both_kinds.at(static_cast<std::size_t>(i % 2));
    const Query query = fuzz::generators()[1].make({kind}, context, random).straight();
    const Symmetry symmetry = draw_symmetry(kind, query, {}, random);
    ASSERT_TRUE(image(symmetry, query));
    const std::array differs{symmetry.points != identity.points, symmetry.axes != identity.axes,
                             std::ranges::any_of(symmetry.factors, is_beyond_1),
                             symmetry.shifts != identity.shifts, symmetry.reversed};
    for (std::size_t part = 0; part < differs.size(); ++part) {
      seen.at(part) = seen.at(part) || differs.at(part);
    }
  }
  EXPECT_TRUE(std::ranges::all_of(seen, std::identity{}));
}

void expect_same_truth(const AnyQueries& query, const Separation& separation,
                       const Symmetry& symmetry) {
  const exact::Decision truth = base::decide(query, 0, separation);
  const exact::Decision of_image =
      base::decide(AnyQueries(query, image(symmetry, query).value()), 0, separation);
  ASSERT_EQ(truth.collides(), of_image.collides());
  if (!truth.collides() || symmetry.reversed) return;
  const exact::DoubleInterval toi = truth.toi->enclosure(), image_toi = of_image.toi->enclosure();
  EXPECT_EQ(toi.lower, image_toi.lower);
  EXPECT_EQ(toi.upper, image_toi.upper);
}

TEST(Symmetry, KeepsTheOraclesVerdictAndTime) {
  const std::array<Separation, 3> separations{
      {{}, {.distance = 0.25, .norm = Norm::linf}, {.distance = 0.25, .norm = Norm::l2}}};
  Random random(3);
  int collisions = 0, others = 0;
  for (const Separation& separation : separations) {
    const fuzz::GeneratorContext context(separation);
    for (int i = 0; i < tests::trials(240); ++i) {
      const AnyKind kind = all_kinds.at(static_cast<std::size_t>(i % 4));
      if (kind.is_cell() && !is_zero(separation)) continue;
      const auto& generator = fuzz::generators()[1 + static_cast<std::size_t>(i % 7)];
      // Half of them on curves.
      const bool is_curved = !kind.is_cell() && i % 8 > 3;
      const AnyShape shape{kind, is_curved ? 2U : 1U, is_curved && i % 16 > 7};
      const base::AnyQuery query = generator.make(shape, context, random);
      const Symmetry symmetry = draw_symmetry(query.queries(), separation, random);
      expect_same_truth(query.queries(), separation, symmetry);
      ++(base::decide(query.queries(), 0, separation).collides() ? collisions : others);
    }
  }
  EXPECT_GT(collisions, tests::trials(80));
  EXPECT_GT(others, tests::trials(80));
}

}  // namespace
}  // namespace touchstone::verify::generate::symmetry_test
