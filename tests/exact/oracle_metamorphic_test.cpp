/// \file
/// Changes of a query that keep its truth, or change it in a known way: on straight lines, on
/// curves and on rational ones, in contact and at a distance.
///
/// Renaming points, invertible linear maps of space and a common motion of all points change no
/// root of F: verdict and toi stay. At a distance they do so if the map keeps the norm, or scales
/// it with the distance. Reversing time keeps the verdict. Cutting time at τ maps contact at t to
/// contact at t/τ or (t−τ)/(1−τ). At distance 0 two rules find the same, and a greater distance is
/// reached no later. None of this requires the answer. Every change is exact; what cannot be exact
/// in doubles is left out, and the rest counted.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <stdexcept>
#include <vector>

#include "exact/distance/distance_oracle.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::exact::oracle_metamorphic_test {
namespace {

using tests::Family;
using tests::PosedCurves;
using tests::Random;
using tests::trials;
using Point = std::array<double, 3>;

/// The same query on straight lines, if all curves are such.
std::optional<Query> straight(const PosedCurves& posed) {
  Query lines{};
  for (std::size_t point = 0; point < moving_points; ++point) {
    const Trajectory& curve = posed.query.at(point);
    if (curve.degree() != 1 || !curve.weights.empty()) return std::nullopt;
    for (const std::size_t end : {0U, 1U}) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        lines.at(end, point, axis) = curve.control[end].at(axis);
      }
    }
  }
  return lines;
}

/// Decides straight lines as such, and all else as curves.
Decision decide(const PosedCurves& posed) {
  const auto& [kind, query, separation] = posed;
  const std::optional<Query> lines = straight(posed);
  return lines ? exact::decide(kind, *lines, separation) : exact::decide(kind, query, separation);
}

bool is_rational(const PosedCurves& posed) {
  return std::ranges::any_of(posed.query, [](const auto& curve) { return !curve.weights.empty(); });
}

// ------------------------------------------------------------------ exact changes of a query

/// The same query with every point replaced: point i becomes `order[i]`.
PosedCurves with_points(PosedCurves posed, const std::array<std::size_t, moving_points>& order) {
  const CurvedQuery original = posed.query;
  for (std::size_t i = 0; i < moving_points; ++i) posed.query.at(i) = original.at(order.at(i));
  return posed;
}

/// The query under a map of space that keeps curves.
PosedCurves mapped(PosedCurves posed, const std::function<Point(const Point&)>& map) {
  for (Trajectory& curve : posed.query) {
    for (Point& point : curve.control) point = map(point);
  }
  return posed;
}

PosedCurves with_axes(const PosedCurves& posed, const std::array<std::size_t, 3>& order) {
  return mapped(posed, [&](const Point& x) {
    return Point{x.at(order[0]), x.at(order[1]), x.at(order[2])};
  });
}

PosedCurves flipped(const PosedCurves& posed, std::size_t axis) {
  return mapped(posed, [&](Point x) {
    x.at(axis) = -x.at(axis);
    return x;
  });
}

/// Multiplies each axis by 2^exponent, and the distance as the first; nothing if a number would
/// lose bits.
std::optional<PosedCurves> scaled(const PosedCurves& posed, const std::array<int, 3>& exponents) {
  bool exact = true;
  const auto times = [&](double x, int exponent) {
    const double y = std::ldexp(x, exponent);
    exact = exact && std::ldexp(y, -exponent) == x;
    return y;
  };
  PosedCurves result = mapped(posed, [&](Point x) {
    for (std::size_t axis = 0; axis < 3; ++axis) x.at(axis) = times(x.at(axis), exponents.at(axis));
    return x;
  });
  result.separation.distance = times(posed.separation.distance, exponents[0]);
  return exact ? std::optional(result) : std::nullopt;
}

/// Moves all points along with a frame that goes from `start` by `step`. \pre integer coordinates;
/// each degree divides the step, which is 0 for rational curves.
PosedCurves carried(PosedCurves posed, const Point& start, const Point& step) {
  for (Trajectory& curve : posed.query) {
    if (curve.degree() == 0) curve.control.push_back(curve.control.front());
    for (std::size_t j = 0; j <= curve.degree(); ++j) {
      const double part = static_cast<double>(j) / static_cast<double>(curve.degree());
      for (std::size_t axis = 0; axis < 3; ++axis) {
        curve.control[j].at(axis) += start.at(axis) + std::round(part * step.at(axis));
      }
    }
  }
  return posed;
}

/// Adds a multiple of one axis to another. \pre integer coordinates.
PosedCurves sheared(const PosedCurves& posed, std::size_t to, std::size_t from, int factor) {
  return mapped(posed, [&](Point x) {
    x.at(to) += factor * x.at(from);
    return x;
  });
}

PosedCurves reversed(PosedCurves posed) {
  for (Trajectory& curve : posed.query) {
    std::ranges::reverse(curve.control);
    std::ranges::reverse(curve.weights);
  }
  return posed;
}

/// The motion between two times, by de Casteljau's algorithm with one of them in each step; nothing
/// if a control point is not a double. \pre the curves are not rational.
std::optional<PosedCurves> cut(const PosedCurves& posed, const Rational& from, const Rational& to) {
  PosedCurves result = posed;
  for (std::size_t point = 0; point < moving_points; ++point) {
    const std::vector<Point>& control = posed.query.at(point).control;
    for (std::size_t j = 0; j < control.size(); ++j) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        std::vector<Rational> row;
        for (const Point& x : control) row.emplace_back(x.at(axis));
        for (std::size_t step = 0; row.size() > 1; ++step) {
          const Rational& t = step < j ? to : from;
          for (std::size_t i = 0; i + 1 < row.size(); ++i) row[i] += t * (row[i + 1] - row[i]);
          row.pop_back();
        }
        double& x = result.query.at(point).control[j].at(axis);
        x = round_to_nearest(row.front());
        if (Rational(x) != row.front()) return std::nullopt;
      }
    }
  }
  return result;
}

// ------------------------------------------------------------------ comparing answers

void expect_same_answer(const Decision& original, const PosedCurves& changed) {
  const Decision verdict = decide(changed);
  ASSERT_EQ(verdict.collides(), original.collides()) << changed;
  if (!verdict.collides()) return;
  EXPECT_TRUE(*verdict.toi == *original.toi) << changed;
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

// ------------------------------------------------------------------ the queries

/// Queries of one sort, and how many of each kind are changed.
struct Source {
  /// Straight lines of the family, or else curves of whole numbers, each of its own degree.
  std::optional<Family> family;
  int greatest_degree;
  bool is_rational, is_at_a_distance;
  int count;

  /// Coordinates are small whole numbers: sums and midpoints are exact.
  [[nodiscard]] bool has_integers() const {
    return !family || tests::has_integer_coordinates(*family);
  }
};

constexpr std::array sources{
    Source{Family::tiny_integers, 1, false, false, trials(700)},
    Source{Family::small_integers, 1, false, false, trials(700)},
    Source{Family::full_significands, 1, false, false, trials(700)},
    Source{Family::near_contact, 1, false, false, trials(700)},
    Source{Family::tiny_integers, 1, false, true, trials(240)},
    Source{Family::near_contact, 1, false, true, trials(240)},
    Source{std::nullopt, 3, true, false, trials(400)},
    Source{std::nullopt, 4, false, false, trials(400)},
    Source{std::nullopt, 4, false, true, trials(120)},
    Source{std::nullopt, 3, true, true, trials(120)},
};

/// Moves half of the queries apart, as almost all are near otherwise, and sets a distance.
void set_distance(Random& random, PosedCurves& posed) {
  static constexpr std::array distances{0.5, 1.0, 1.0, 2.0, 3.0, 1.25, 0x1p-10};
  posed.separation = {.distance = distances.at(static_cast<std::size_t>(random.between(0, 6))),
                      .norm = random.coin() ? Norm::linf : Norm::l2};
  const auto axis = static_cast<std::size_t>(random.between(0, 2));
  const double shift = random.coin() ? random.between(2, 5) : 0.0;
  for (std::size_t point = 0; point < (posed.kind == Kind::vertex_face ? 1U : 2U); ++point) {
    for (Point& x : posed.query.at(point).control) x.at(axis) += shift;
  }
}

PosedCurves drawn(const Source& source, Random& random, Kind kind) {
  PosedCurves posed{kind, {}};
  if (source.family) posed = tests::to_curves(tests::random_query(random, kind, *source.family));
  for (Trajectory& curve : posed.query) {
    if (source.family) break;
    const auto coordinate = [&] { return static_cast<double>(random.between(-2, 2)); };
    for (int j = random.between(0, source.greatest_degree); j >= 0; --j) {
      curve.control.push_back({coordinate(), coordinate(), coordinate()});
    }
    if (source.is_rational && curve.degree() == 2) curve.weights = {1.0, 1.0, 2.0};
  }
  if (source.is_at_a_distance) set_distance(random, posed);
  return posed;
}

enum class Of : bool { every_source, integers };

/// Applies the check to the same random queries in every test, and requires many of both verdicts.
void for_queries(Of which, const std::function<void(const PosedCurves&, const Decision&)>& check) {
  for (std::size_t number = 0; number < sources.size(); ++number) {
    const Source& source = sources.at(number);
    if (which == Of::integers && !source.has_integers()) continue;
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      Random random(1000 + 10 * number + static_cast<unsigned>(kind));
      std::array<int, 2> verdicts{};
      const int count = tests::is_soak() ? 20 * source.count : source.count;
      for (int i = 0; i < count; ++i) {
        const PosedCurves posed = drawn(source, random, kind);
        SCOPED_TRACE(posed);
        const Decision verdict = decide(posed);
        ++verdicts.at(verdict.collides() ? 1 : 0);
        check(posed, verdict);
        if (testing::Test::HasFailure()) return;
      }
      EXPECT_GT(verdicts[0], count / 8) << to_string(kind) << " of source " << number;
      EXPECT_GT(verdicts[1], count / 50) << to_string(kind) << " of source " << number;
    }
  }
}

// ------------------------------------------------------------------ two rules

TEST(OracleMetamorphic, TheRulesOfDistancesFindTheContactsAtDistanceZero) {
  for_queries(Of::every_source, [](const PosedCurves& posed, const Decision& verdict) {
    if (!is_zero(posed.separation)) return;
    const std::optional<Query> lines = straight(posed);
    for (const Norm norm : {Norm::linf, Norm::l2}) {
      const Decision found =
          lines ? decide_distance(scale_uniformly(posed.kind, *lines, {0.0, norm}))
                : decide_distance(scale_uniformly(posed.kind, posed.query, {0.0, norm}));
      ASSERT_EQ(found.collides(), verdict.collides());
      EXPECT_TRUE(!found.collides() || *found.toi == *verdict.toi);
    }
  });
}

TEST(OracleMetamorphic, GreaterDistancesAndTheOtherNormBoundTheToi) {
  Random random(14);
  for_queries(Of::every_source, [&](const PosedCurves& posed, const Decision& verdict) {
    if (is_zero(posed.separation) || !straight(posed) || !verdict.collides()) return;
    const auto expect_no_later = [&](const Separation& separation) {
      PosedCurves changed = posed;
      changed.separation = separation;
      const Decision found = decide(changed);
      ASSERT_TRUE(found.collides()) << changed;
      EXPECT_TRUE(*found.toi <= *verdict.toi) << changed;
    };
    const auto& [distance, norm] = posed.separation;
    expect_no_later({std::nextafter(distance, HUGE_VAL), norm});
    expect_no_later({distance + random.uniform(), norm});
    // 7/4 > √3, and the product is rounded up.
    if (norm == Norm::l2) expect_no_later({distance, Norm::linf});
    if (norm == Norm::linf) expect_no_later({std::nextafter(1.75 * distance, HUGE_VAL), Norm::l2});
  });
}

// ------------------------------------------------------------------ the changes

TEST(OracleMetamorphic, RenamingPointsChangesNothing) {
  using Order = std::array<std::size_t, moving_points>;
  static constexpr std::array<Order, 5> faces{
      {{0, 1, 3, 2}, {0, 2, 1, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {0, 3, 2, 1}}};
  static constexpr std::array<Order, 5> edges{
      {{1, 0, 2, 3}, {0, 1, 3, 2}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 0, 1}}};
  for_queries(Of::every_source, [](const PosedCurves& posed, const Decision& verdict) {
    for (const Order& order : posed.kind == Kind::vertex_face ? faces : edges) {
      expect_same_answer(verdict, with_points(posed, order));
    }
  });
}

TEST(OracleMetamorphic, PermutingAndFlippingAxesChangesNothing) {
  static constexpr std::array<std::array<std::size_t, 3>, 5> orders{
      {{0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  for_queries(Of::every_source, [](const PosedCurves& posed, const Decision& verdict) {
    for (const auto& order : orders) expect_same_answer(verdict, with_axes(posed, order));
    for (const std::size_t axis : {0U, 1U, 2U}) expect_same_answer(verdict, flipped(posed, axis));
  });
}

TEST(OracleMetamorphic, ScalingByPowersOfTwoChangesNothing) {
  Random random(21);
  int subnormal = 0;
  for_queries(Of::every_source, [&](const PosedCurves& posed, const Decision& verdict) {
    std::array<int, 3> own{random.between(-900, 900), random.between(-900, 900),
                           random.between(-900, 900)};
    if (!is_zero(posed.separation)) own.fill(own[0]);
    for (const auto& exponents : {std::array{300, 300, 300}, {-300, -300, -300}, own}) {
      const auto changed = scaled(posed, exponents);
      ASSERT_TRUE(changed.has_value());
      expect_same_answer(verdict, *changed);
    }
    if (const auto changed = scaled(posed, {-1074, -1074, -1074})) {
      expect_same_answer(verdict, *changed);
      ++subnormal;
    }
  });
  EXPECT_GT(subnormal, trials(2800));
}

TEST(OracleMetamorphic, CarryingAllPointsAlongChangesNothing) {
  Random random(22);
  for_queries(Of::integers, [&](const PosedCurves& posed, const Decision& verdict) {
    Point start, step;
    for (double& x : start) x = random.between(-1000, 1000);
    for (double& x : step) x = 12 * random.between(-160, 160);
    expect_same_answer(verdict, carried(posed, start, {}));
    if (!is_rational(posed)) expect_same_answer(verdict, carried(posed, start, step));
  });
}

TEST(OracleMetamorphic, ShearingSpaceChangesNothing) {
  Random random(23);
  for_queries(Of::integers, [&](const PosedCurves& posed, const Decision& verdict) {
    if (!is_zero(posed.separation)) return;
    const auto to = static_cast<std::size_t>(random.between(0, 2));
    const std::size_t from = (to + (random.coin() ? 1 : 2)) % 3;
    expect_same_answer(verdict, sheared(posed, to, from, random.between(-1000, 1000)));
  });
}

TEST(OracleMetamorphic, ReversingTimeKeepsTheVerdictAndBoundsTheToi) {
  int single_instants = 0, longer = 0;
  for_queries(Of::every_source, [&](const PosedCurves& posed, const Decision& verdict) {
    const Decision backward = decide(reversed(posed));
    ASSERT_EQ(backward.collides(), verdict.collides());
    if (!verdict.collides()) return;
    const AlgebraicNumber last = one_minus(*backward.toi);
    EXPECT_TRUE(*verdict.toi <= last);
    ++(*verdict.toi == last ? single_instants : longer);
  });
  EXPECT_GT(single_instants, trials(100));
  EXPECT_GT(longer, trials(100));
}

/// Expects the motion from one time to another to collide if the toi is in it, there, and not to
/// collide if the toi is after it. \pre the control points of the part are doubles.
void expect_part(const PosedCurves& posed, const Decision& whole, const Rational& from,
                 const Rational& to) {
  const auto part = cut(posed, from, to);
  ASSERT_TRUE(part.has_value());
  const Decision found = decide(*part);
  if (!whole.collides() || *whole.toi > to) {
    EXPECT_FALSE(found.collides()) << from << ' ' << to;
  } else if (*whole.toi >= from) {
    ASSERT_TRUE(found.collides()) << from << ' ' << to;
    expect_toi_of_part(*found.toi, *whole.toi, from, to);
  }
}

TEST(OracleMetamorphic, PartsOfTheMotionCollideWhereTheWholeDoes) {
  static constexpr int cells = 1024;
  int stopped = 0, stopped_at_enclosure = 0, started_later = 0;
  for_queries(Of::integers, [&](const PosedCurves& posed, const Decision& verdict) {
    if (is_rational(posed)) return;
    expect_part(posed, verdict, 0, Rational(1, 2));
    expect_part(posed, verdict, Rational(1, 2), 1);
    if (!verdict.collides() || *verdict.toi == Rational(0)) return;
    // The times k/1024 around the toi: lower < toi ≤ upper.
    AlgebraicNumber toi = *verdict.toi;
    toi.refine_to_level(20);
    int k = static_cast<int>(Rational(toi.interval().lower * cells).get_d());
    while (toi > Rational(k) / cells) ++k;
    const Rational lower = Rational(k - 1) / cells, upper = Rational(k) / cells;
    expect_part(posed, verdict, 0, lower);
    expect_part(posed, verdict, 0, upper);
    expect_part(posed, verdict, lower, 1);
    ++stopped;
    started_later += sgn(lower) > 0 ? 1 : 0;
    const Rational end(toi.enclosure().upper);
    if (!cut(posed, 0, end)) return;
    expect_part(posed, verdict, 0, end);
    ++stopped_at_enclosure;
  });
  EXPECT_GT(stopped, trials(300));
  EXPECT_GT(started_later, trials(300));
  EXPECT_GT(stopped_at_enclosure, trials(100));
}

}  // namespace
}  // namespace touchstone::exact::oracle_metamorphic_test
