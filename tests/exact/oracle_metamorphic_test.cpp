/// \file
/// Changes of a query that keep its truth, or change it in a known way.
///
/// Renaming points, invertible linear maps of space and a common motion of all points change no
/// root of F: verdict and toi stay. Reversing time keeps the verdict. Cutting time at τ maps
/// contact at t to contact at t/τ or (t−τ)/(1−τ). None of this requires the answer. Every change is
/// exact; if that is impossible in doubles, the query is left out and counted.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <stdexcept>
#include <vector>

#include "exact/oracle.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"

namespace touchstone::exact::oracle_metamorphic_test {
namespace {

using tests::all_families;
using tests::Family;
using tests::has_integer_coordinates;
using tests::PosedQuery;
using tests::Random;
using tests::random_query;
using tests::trials;

constexpr int queries_per_family_and_kind = trials(700);
constexpr std::array<Kind, 2> both_kinds{Kind::vertex_face, Kind::edge_edge};

Decision decide(const PosedQuery& posed) { return exact::decide(posed.kind, posed.query); }

// ------------------------------------------------------------------ exact changes of a query

/// The same query with every point replaced: point i becomes `order[i]`.
Query with_points(const Query& query, const std::array<std::size_t, moving_points>& order) {
  Query result{};
  for (const std::size_t end : {0U, 1U}) {
    for (std::size_t i = 0; i < moving_points; ++i) {
      result.point(end, i) = query.point(end, order.at(i));
    }
  }
  return result;
}

using AxisMap = std::function<double(std::size_t end, std::size_t point, std::size_t axis)>;

Query with_coordinates(const AxisMap& coordinate) {
  Query result{};
  for (const std::size_t end : {0U, 1U}) {
    for (std::size_t point = 0; point < moving_points; ++point) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        result.at(end, point, axis) = coordinate(end, point, axis);
      }
    }
  }
  return result;
}

Query with_axes(const Query& query, const std::array<std::size_t, 3>& order) {
  return with_coordinates([&](std::size_t end, std::size_t point, std::size_t axis) {
    return query.at(end, point, order.at(axis));
  });
}

/// Multiplies each axis by 2^exponent; nothing if a coordinate would lose bits.
std::optional<Query> scaled(const Query& query, const std::array<int, 3>& exponents) {
  bool exact = true;
  const Query result = with_coordinates([&](std::size_t end, std::size_t point, std::size_t axis) {
    const double x = query.at(end, point, axis), y = std::ldexp(x, exponents.at(axis));
    exact = exact && std::ldexp(y, -exponents.at(axis)) == x;
    return y;
  });
  return exact ? std::optional(result) : std::nullopt;
}

Query flipped(const Query& query, std::size_t flipped_axis) {
  return with_coordinates([&](std::size_t end, std::size_t point, std::size_t axis) {
    const double x = query.at(end, point, axis);
    return axis == flipped_axis ? -x : x;
  });
}

/// Moves all points along with a frame that goes from `start` to `end`. \pre integer coordinates.
Query carried(const Query& query, const std::array<int, 3>& start, const std::array<int, 3>& end) {
  return with_coordinates([&](std::size_t time, std::size_t point, std::size_t axis) {
    return query.at(time, point, axis) + (time == 0 ? start : end).at(axis);
  });
}

/// Adds a multiple of one axis to another. \pre integer coordinates.
Query sheared(const Query& query, std::size_t to, std::size_t from, int factor) {
  return with_coordinates([&](std::size_t end, std::size_t point, std::size_t axis) {
    const double x = query.at(end, point, axis);
    return axis == to ? x + factor * query.at(end, point, from) : x;
  });
}

Query reversed(const Query& query) {
  return with_coordinates([&](std::size_t end, std::size_t point, std::size_t axis) {
    return query.at(1 - end, point, axis);
  });
}

/// The motion between the times `from` and `to`; nothing if a position then is not a double.
std::optional<Query> cut(const Query& query, const Rational& from, const Rational& to) {
  bool exact = true;
  const Query result = with_coordinates([&](std::size_t end, std::size_t point, std::size_t axis) {
    const Rational& t = end == 0 ? from : to;
    const Rational position =
        (1 - t) * Rational(query.at(0, point, axis)) + t * Rational(query.at(1, point, axis));
    const double rounded = round_to_nearest(position);
    exact = exact && Rational(rounded) == position;
    return rounded;
  });
  return exact ? std::optional(result) : std::nullopt;
}

// ------------------------------------------------------------------ comparing answers

void expect_same_answer(const Decision& original, Kind kind, const Query& changed) {
  const Decision verdict = decide({kind, changed});
  ASSERT_EQ(verdict.collides(), original.collides()) << PosedQuery{kind, changed};
  if (!verdict.collides()) return;
  EXPECT_TRUE(*verdict.toi == *original.toi) << PosedQuery{kind, changed};
  EXPECT_EQ(verdict.toi->enclosure(), original.toi->enclosure());
}

/// The number 1 − α.
AlgebraicNumber one_minus(const AlgebraicNumber& alpha) {
  if (alpha.rational()) return AlgebraicNumber(1 - *alpha.rational());
  // p(1−t) by Horner's rule, and its root in the mirrored cell.
  const Polynomial mirror(Integer(1), Integer(-1)), &p = alpha.polynomial();
  Polynomial mirrored(Integer(0));
  for (std::size_t i = p.degree() + 1; i-- > 0;) {
    mirrored = mirrored * mirror + Polynomial(p[i]);
  }
  const auto [lower, upper] = alpha.interval();
  for (const AlgebraicNumber& root : roots_in_unit_interval(mirrored)) {
    if (root > Rational(1 - upper) && root < Rational(1 - lower)) return root;
  }
  throw std::logic_error("the mirrored polynomial has no root in the mirrored interval");
}

/// Expects that part = (toi − from)/(to − from): exactly if rational, otherwise to 2^-200.
void expect_toi_of_part(AlgebraicNumber part, AlgebraicNumber toi, const Rational& from,
                        const Rational& to) {
  const Rational width = power_of_two(-200);
  part.refine(width);
  toi.refine(width);
  const RationalInterval p = part.interval(), t = toi.interval();
  EXPECT_LE(Rational(from + (to - from) * p.lower), t.upper);
  EXPECT_GE(Rational(from + (to - from) * p.upper), t.lower);
}

struct Tally {
  int collisions = 0;
  int no_collisions = 0;
  int left_out = 0;

  void count(bool collides) { ++(collides ? collisions : no_collisions); }
};

using Check = std::function<void(Random&, const PosedQuery&, const Decision&, Tally&)>;

/// Applies the check to the same random queries in every test, and requires many of both verdicts.
Tally check_families(const std::vector<Family>& families, const Check& check) {
  Tally total;
  for (const Family family : families) {
    for (const Kind kind : both_kinds) {
      Random random(1000 + 10 * static_cast<unsigned>(family) + static_cast<unsigned>(kind));
      Tally tally;
      for (int i = 0; i < queries_per_family_and_kind; ++i) {
        const PosedQuery posed = random_query(random, kind, family);
        SCOPED_TRACE(posed);
        const Decision verdict = decide(posed);
        tally.count(verdict.collides());
        check(random, posed, verdict, tally);
        if (testing::Test::HasFailure()) return total;
      }
      EXPECT_GT(tally.collisions, trials(15)) << to_string(kind) << ' ' << static_cast<int>(family);
      EXPECT_GT(tally.no_collisions, trials(100))
          << to_string(kind) << ' ' << static_cast<int>(family);
      total.collisions += tally.collisions;
      total.no_collisions += tally.no_collisions;
      total.left_out += tally.left_out;
    }
  }
  return total;
}

const std::vector<Family> every_family(all_families.begin(), all_families.end());
const std::vector<Family> integer_families{Family::tiny_integers, Family::small_integers};

// ------------------------------------------------------------------ the changes

TEST(OracleMetamorphic, RenamingPointsChangesNothing) {
  using Order = std::array<std::size_t, moving_points>;
  static constexpr std::array<Order, 5> faces{
      {{0, 1, 3, 2}, {0, 2, 1, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {0, 3, 2, 1}}};
  static constexpr std::array<Order, 5> edges{
      {{1, 0, 2, 3}, {0, 1, 3, 2}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 0, 1}}};
  check_families(every_family,
                 [](Random&, const PosedQuery& posed, const Decision& verdict, Tally&) {
                   for (const Order& order : posed.kind == Kind::vertex_face ? faces : edges) {
                     expect_same_answer(verdict, posed.kind, with_points(posed.query, order));
                   }
                 });
}

TEST(OracleMetamorphic, PermutingAndFlippingAxesChangesNothing) {
  static constexpr std::array<std::array<std::size_t, 3>, 5> orders{
      {{0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  check_families(every_family,
                 [](Random&, const PosedQuery& posed, const Decision& verdict, Tally&) {
                   for (const auto& order : orders) {
                     expect_same_answer(verdict, posed.kind, with_axes(posed.query, order));
                   }
                   for (const std::size_t axis : {0U, 1U, 2U}) {
                     expect_same_answer(verdict, posed.kind, flipped(posed.query, axis));
                   }
                 });
}

TEST(OracleMetamorphic, ScalingByPowersOfTwoChangesNothing) {
  const Tally tally = check_families(
      every_family, [](Random& random, const PosedQuery& posed, const Decision& verdict, Tally& t) {
        const std::array<int, 3> own{random.between(-900, 900), random.between(-900, 900),
                                     random.between(-900, 900)};
        for (const auto& exponents : {std::array{300, 300, 300}, {-300, -300, -300}, own}) {
          const std::optional<Query> changed = scaled(posed.query, exponents);
          if (!changed) {
            ++t.left_out;
            continue;
          }
          expect_same_answer(verdict, posed.kind, *changed);
        }
      });
  EXPECT_EQ(tally.left_out, 0);
}

TEST(OracleMetamorphic, CarryingAllPointsAlongChangesNothing) {
  const auto vector = [](Random& random) {
    return std::array{random.between(-1000, 1000), random.between(-1000, 1000),
                      random.between(-1000, 1000)};
  };
  check_families(integer_families,
                 [&](Random& random, const PosedQuery& posed, const Decision& verdict, Tally&) {
                   const std::array<int, 3> start = vector(random), end = vector(random);
                   expect_same_answer(verdict, posed.kind, carried(posed.query, start, start));
                   expect_same_answer(verdict, posed.kind, carried(posed.query, start, end));
                 });
}

TEST(OracleMetamorphic, ShearingSpaceChangesNothing) {
  check_families(integer_families,
                 [](Random& random, const PosedQuery& posed, const Decision& verdict, Tally&) {
                   const auto to = static_cast<std::size_t>(random.between(0, 2));
                   const std::size_t from = (to + (random.coin() ? 1 : 2)) % 3;
                   expect_same_answer(verdict, posed.kind,
                                      sheared(posed.query, to, from, random.between(-1000, 1000)));
                 });
}

TEST(OracleMetamorphic, ReversingTimeKeepsTheVerdictAndBoundsTheToi) {
  int single_instants = 0, longer = 0;
  check_families(every_family,
                 [&](Random&, const PosedQuery& posed, const Decision& verdict, Tally&) {
                   const Decision backward = decide({posed.kind, reversed(posed.query)});
                   ASSERT_EQ(backward.collides(), verdict.collides());
                   if (!verdict.collides()) return;
                   const AlgebraicNumber last = one_minus(*backward.toi);
                   EXPECT_TRUE(*verdict.toi <= last);
                   ++(*verdict.toi == last ? single_instants : longer);
                 });
  EXPECT_GT(single_instants, trials(100));
  EXPECT_GT(longer, trials(100));
}

// ------------------------------------------------------------------ parts of the motion

/// Times k/1024 around the toi: at most `lower` < toi if there is one, and toi ≤ upper.
struct GridTimes {
  Rational lower;
  Rational upper;
};

GridTimes grid_times(const AlgebraicNumber& toi) {
  static constexpr int cells = 1024;
  int k = 0;
  while (toi > Rational(k) / cells) ++k;
  return {Rational(k - 1) / cells, Rational(k) / cells};
}

TEST(OracleMetamorphic, StoppingBeforeTheToiMissesAndAfterItCollides) {
  int stopped_before = 0, stopped_after = 0;
  check_families(integer_families,
                 [&](Random&, const PosedQuery& posed, const Decision& verdict, Tally&) {
                   if (!verdict.collides()) return;
                   const AlgebraicNumber& toi = *verdict.toi;
                   const auto [lower, upper] = grid_times(toi);
                   if (sgn(upper) > 0) {
                     const std::optional<Query> before = cut(posed.query, 0, lower);
                     const std::optional<Query> after = cut(posed.query, 0, upper);
                     ASSERT_TRUE(before && after);
                     EXPECT_FALSE(decide({posed.kind, *before}).collides());
                     const Decision stopped = decide({posed.kind, *after});
                     ASSERT_TRUE(stopped.collides());
                     expect_toi_of_part(*stopped.toi, toi, 0, upper);
                     ++stopped_before;
                   }
                   const double end = toi.enclosure().upper;
                   const std::optional<Query> at_enclosure = cut(posed.query, 0, Rational(end));
                   if (end == 0.0 || !at_enclosure) return;
                   const Decision stopped = decide({posed.kind, *at_enclosure});
                   ASSERT_TRUE(stopped.collides());
                   expect_toi_of_part(*stopped.toi, toi, 0, Rational(end));
                   ++stopped_after;
                 });
  EXPECT_GT(stopped_before, trials(300));
  EXPECT_GT(stopped_after, trials(100));
}

TEST(OracleMetamorphic, StartingLaterKeepsTheContactAtTheToi) {
  int started_later = 0;
  check_families(integer_families,
                 [&](Random&, const PosedQuery& posed, const Decision& verdict, Tally&) {
                   if (!verdict.collides()) return;
                   const AlgebraicNumber& toi = *verdict.toi;
                   const Rational from = grid_times(toi).lower;
                   if (sgn(from) <= 0) return;
                   const std::optional<Query> later = cut(posed.query, from, 1);
                   ASSERT_TRUE(later.has_value());
                   const Decision rest = decide({posed.kind, *later});
                   ASSERT_TRUE(rest.collides());
                   expect_toi_of_part(*rest.toi, toi, from, 1);
                   ++started_later;
                 });
  EXPECT_GT(started_later, trials(300));
}

TEST(OracleMetamorphic, CollidesIffOneOfItsHalvesDoes) {
  const Rational half = Rational(1) / 2;
  int in_first = 0, in_second = 0;
  check_families(integer_families, [&](Random&, const PosedQuery& original,
                                       const Decision& original_verdict, Tally&) {
    // Even coordinates have integer midpoints.
    const Query even = *scaled(original.query, {1, 1, 1});
    const Decision first = decide({original.kind, *cut(even, 0, half)});
    const Decision second = decide({original.kind, *cut(even, half, 1)});
    ASSERT_EQ(original_verdict.collides(), first.collides() || second.collides());
    if (!original_verdict.collides()) return;
    const AlgebraicNumber& toi = *original_verdict.toi;
    EXPECT_EQ(first.collides(), toi <= half);
    if (first.collides()) {
      expect_toi_of_part(*first.toi, toi, 0, half);
      ++in_first;
    } else {
      expect_toi_of_part(*second.toi, toi, half, 1);
      ++in_second;
    }
  });
  EXPECT_GT(in_first, trials(300));
  EXPECT_GT(in_second, trials(150));
}

}  // namespace
}  // namespace touchstone::exact::oracle_metamorphic_test
