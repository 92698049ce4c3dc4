/// \file
/// The oracle against an SMT solver (Z3, nonlinear real arithmetic).
///
/// The solver gets only the definition: unknown reals t, u, v in the domain and the three equations
/// F = 0 with the coordinates as exact rationals, times the weights' sums if the curves are
/// rational. It answers whether there is a solution, whether there is one before the oracle's time
/// of impact, and whether there is one until then. Hard queries come first. What the solver does
/// not decide within its steps is no agreement: it is counted, and the count is bounded. The
/// environment variable TOUCHSTONE_SOAK multiplies the number of random queries by fifty.

#include <gtest/gtest.h>
#include <z3++.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <limits>
#include <optional>
#include <type_traits>
#include <vector>

#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/curved_query.hpp"
#include "touchstone/oracle.hpp"
#include "verify/generate/families.hpp"

namespace touchstone::exact::oracle_smt_test {
namespace {

using tests::edge_edge;
using tests::Family;
using tests::over_edge;
using tests::over_triangle;
using tests::PosedCurves;
using tests::PosedQuery;
using tests::Random;
using tests::random_query;
using tests::to_curves;
using tests::turning_triangle;
using tests::twisting_triangle;
using tests::vertex_face;

/// The steps that the solver may take for a question: its own measure of work.
constexpr unsigned most_steps = 200'000;
constexpr double least = std::numeric_limits<double>::denorm_min();

// ------------------------------------------------------------------ the solver

/// The times that a question is about: t < limit, or t ≤ limit.
struct Times {
  Rational limit;
  bool includes_limit = false;
};

/// The query's definition in the language of the solver.
class Definition {
 public:
  explicit Definition(const PosedCurves& posed)
      : t_(context_.real_const("t")),
        u_(context_.real_const("u")),
        v_(context_.real_const("v")),
        solver_(z3::tactic(context_, "qfnra-nlsat").mk_solver()) {
    z3::params parameters(context_);
    parameters.set("rlimit", most_steps);
    solver_.set(parameters);
    require_domain(posed.kind);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      solver_.add(contact_function(posed, axis) == number(0));
    }
  }

  /// Asks whether there is a solution, at these times if they are given. The result is empty if the
  /// solver gives up.
  std::optional<bool> has_solution(const std::optional<Times>& times = std::nullopt) {
    if (times) {
      const z3::expr limit = number(times->limit);
      solver_.add(times->includes_limit ? t_ <= limit : t_ < limit);
    }
    const z3::check_result result = solver_.check();
    if (result == z3::unknown) return std::nullopt;
    return result == z3::sat;
  }

 private:
  z3::expr number(const Rational& x) { return context_.real_val(x.get_str().c_str()); }

  void require_domain(ContactKind kind) {
    const z3::expr zero = number(0), one = number(1);
    for (const z3::expr& x : {t_, u_, v_}) {
      solver_.add(x >= zero);
      solver_.add(x <= one);
    }
    if (kind == ContactKind::vertex_face) solver_.add(u_ + v_ <= one);
  }

  /// Σ_j B_j(t) values_j.
  z3::expr bezier(const std::vector<Rational>& values) {
    const std::size_t degree = values.size() - 1;
    z3::expr sum = number(0);
    Rational binomial = 1;
    for (std::size_t j = 0; j <= degree; ++j) {
      z3::expr term = number(binomial * values[j]);
      for (std::size_t i = 0; i < degree; ++i) term = term * (i < j ? t_ : number(1) - t_);
      sum = sum + term;
      binomial = binomial * Rational(degree - j) / Rational(j + 1);
    }
    return sum;
  }

  /// A point's coordinate times all denominators of the query, which are positive.
  z3::expr position(const CurvedQuery& query, std::size_t point, std::size_t axis) {
    const Trajectory& curve = query.at(point);
    std::vector<Rational> values;
    for (std::size_t j = 0; j < curve.control.size(); ++j) {
      const Rational weight(curve.weights.empty() ? 1.0 : curve.weights[j]);
      values.push_back(weight * Rational(curve.control[j].at(axis)));
    }
    z3::expr product = bezier(values);
    std::vector<std::vector<double>> done{{}, curve.weights};
    for (const Trajectory& other : query) {
      if (std::ranges::find(done, other.weights) != done.end()) continue;
      done.push_back(other.weights);
      product = product * bezier({other.weights.begin(), other.weights.end()});
    }
    return product;
  }

  z3::expr contact_function(const PosedCurves& posed, std::size_t axis) {
    const z3::expr one = number(1);
    const auto at = [&](std::size_t point) { return position(posed.query, point, axis); };
    const z3::expr a = at(0), b = at(1), c = at(2), d = at(3);
    if (posed.kind == ContactKind::vertex_face) return a - ((one - u_ - v_) * b + u_ * c + v_ * d);
    return ((one - u_) * a + u_ * b) - ((one - v_) * c + v_ * d);
  }

  z3::context context_;
  z3::expr t_;
  z3::expr u_;
  z3::expr v_;
  z3::solver solver_;
};

// ------------------------------------------------------------------ the queries

/// Queries that chance does not find: double roots and their neighbours, published cases, near
/// misses.
std::vector<PosedQuery> constructed_queries() {
  std::vector<PosedQuery> queries{
      vertex_face({0.1, 0.1, 0.1, 0, 0, 1, 1, 0, 1, 0, 1, 1},  //
                  {0.1, 0.1, 0.1, 0, 0, 0, 0, 1, 0, 1, 0, 0}),
      vertex_face({1, 1, 0, 0, 0, 5, 2, 0, 2, 0, 1, 0}, {1, 1, 0, 0, 0, -1, 0, 0, -2, 0, 7, 0}),
      vertex_face({1, 0.5, 1, 0, 0.57, 1, 1, 0.57, 1, 1, 1.57, 1},
                  {1, 0.5, 1, 0, 0.28, 1, 1, 0.28, 1, 1, 1.28, 1}),
      // Collinear edges, coplanar edges that meet only for an instant, and edges with a gap.
      edge_edge({0, 0, 0, 1, 2, -3, 3, 6, -9, 4, 8, -12},
                {0, 0, 0, 1, 2, -3, -3, -6, 9, -2, -4, 6}),
      edge_edge({0, 0, 0, 0, 2, 0, -1, 0, 0, -1, -2, 0}, {0, 0, 0, 0, 2, 0, 2, 0, 0, 2, -2, 0}),
      edge_edge({0, 0, 0, 0, 2, 0, -1, -least, 0, -1, -2, 0},
                {0, 0, 0, 0, 2, 0, 2, -least, 0, 2, -2, 0})};
  for (const double y : {0.25, 0.1875, std::nextafter(0.25, 0.0), std::nextafter(0.25, 1.0)}) {
    for (const double size : {1.0, 0.5, 0.125}) {
      queries.push_back(turning_triangle(size, 1, 0, y));
    }
  }
  for (const double z : {0.0, -0.25, -0.5, -0.75}) {
    queries.push_back(twisting_triangle({0.75, 0.125, z}, {0.75 + z, 0.125, 1 + z}));
    queries.push_back(twisting_triangle({0, -0.09375, z - 0.125}, {1.375 + z, 0.59375, 0.875 + z}));
  }
  for (const double x : {-least, 0.0, least, 2.0, 4.0, std::nextafter(4.0, 5.0)}) {
    for (const double z : {-1.0, least, 0.0}) {
      queries.push_back(over_triangle(x, 0, 1, z));
      queries.push_back(over_edge(x, 4, 1, z));
    }
  }
  return queries;
}

/// Queries in order: degenerate, then near contact, then generic.
std::vector<PosedQuery> queries_to_ask(int scale) {
  std::vector<PosedQuery> queries = constructed_queries();
  Random random(99);
  const auto draw = [&](Family family, int count) {
    for (int i = 0; i < count; ++i) {
      const ContactKind kind = i % 2 == 0 ? ContactKind::vertex_face : ContactKind::edge_edge;
      queries.push_back(random_query(random, kind, family));
    }
  };
  draw(Family::tiny_integers, 14 * scale);
  draw(Family::small_integers, 14 * scale);
  draw(Family::near_contact, 20 * scale);
  draw(Family::full_significands, 8 * scale);
  return queries;
}

/// Which denominators a query has: none, one for all points, or one for each primitive.
enum class Weights : std::uint8_t { none, common, of_primitives };

/// Curves of small whole numbers: many contacts are at boundaries. All points are in a common
/// plane, or the second primitive rests; general positions take the solver too long.
PosedCurves small_curves(Random& random, ContactKind kind, std::size_t degree, Weights weights) {
  PosedCurves posed{kind, {}};
  const bool is_flat = random.coin();
  const auto flat_axis = static_cast<std::size_t>(random.between(0, 2));
  const std::size_t second = kind == ContactKind::vertex_face ? 1 : 2;
  for (std::size_t k = 0; k <= degree; ++k) {
    const std::array<int, 2> drawn{random.between(1, 3), random.between(1, 3)};
    for (std::size_t point = 0; point < moving_points; ++point) {
      Trajectory& curve = posed.query.at(point);
      std::array<double, 3> place{};
      for (double& x : place) x = random.between(-2, 2);
      if (is_flat) place.at(flat_axis) = 0.0;
      const bool rests = !is_flat && point >= second;
      curve.control.push_back(rests && k > 0 ? curve.control.front() : place);
      if (weights == Weights::none) continue;
      const bool has_second = weights == Weights::of_primitives && point >= second;
      curve.weights.push_back(drawn.at(has_second ? 1 : 0));
    }
  }
  return posed;
}

/// The families of known truth, then small whole numbers.
std::vector<PosedCurves> curves_to_ask(int scale) {
  std::vector<PosedCurves> queries;
  for (const auto& family : verify::generate::curved_families()) {
    for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
      const auto source =
          verify::generate::open_family(family, kind, 98, static_cast<std::uint64_t>(scale));
      while (const auto record = source->next()) {
        queries.push_back({kind, to_curved(record->query.queries(), 0)});
      }
    }
  }
  Random random(98);
  const auto draw = [&](std::size_t degree, Weights weights, int count) {
    for (int i = 0; i < count; ++i) {
      const ContactKind kind = i % 2 == 0 ? ContactKind::vertex_face : ContactKind::edge_edge;
      queries.push_back(small_curves(random, kind, degree, weights));
    }
  };
  // (Of degree 3 some take the solver minutes.)
  draw(2, Weights::none, 8 * scale);
  draw(2, Weights::common, 4 * scale);
  draw(2, Weights::of_primitives, 4 * scale);
  draw(3, Weights::none, 8);
  return queries;
}

// ------------------------------------------------------------------ the comparison

struct Tally {
  std::size_t decided = 0;
  std::size_t unknown = 0;
  std::size_t tois = 0;
  std::size_t unknown_tois = 0;
  /// The queries that the solver decided, by kind and verdict.
  std::array<std::array<std::size_t, 2>, 2> agreed{};
};

void compare_verdict(const PosedCurves& posed, bool collides, Tally& tally) {
  const std::optional<bool> answer = Definition(posed).has_solution();
  if (!answer) {
    ++tally.unknown;
    std::cout << "no answer within the steps: " << posed << '\n';
    return;
  }
  ++tally.decided;
  ASSERT_EQ(*answer, collides);
  ++tally.agreed.at(static_cast<std::size_t>(posed.kind)).at(collides ? 1 : 0);
}

/// Expects a solution at these times, or none.
void compare_toi(const PosedCurves& posed, const Times& times, bool expected, Tally& tally) {
  const std::optional<bool> answer = Definition(posed).has_solution(times);
  if (!answer) {
    ++tally.unknown_tois;
    return;
  }
  ++tally.tois;
  ASSERT_EQ(*answer, expected) << (expected ? "no contact until " : "a contact before ")
                               << times.limit;
}

/// Compares the verdict, and expects no contact before the toi's lower bound, and one until its
/// upper bound.
void compare(const PosedCurves& posed, const Decision& verdict, Tally& tally) {
  compare_verdict(posed, verdict.collides(), tally);
  if (!verdict.collides()) return;
  const Rational lower(verdict.toi->enclosure().lower), upper(verdict.toi->enclosure().upper);
  if (sgn(lower) > 0) compare_toi(posed, {lower}, false, tally);
  compare_toi(posed, {upper, true}, true, tally);
}

TEST(OracleSmt, TheSolverWouldFindAContactBeforeAToiThatIsTooLate) {
  const Rational half = Rational(1) / 2, little = power_of_two(-60);
  for (const PosedQuery& straight : {over_triangle(1, 1, 1, -1), over_edge(1, 1, 1, -1)}) {
    const PosedCurves posed = to_curves(straight);
    EXPECT_EQ(Definition(posed).has_solution(), true);
    EXPECT_EQ(Definition(posed).has_solution(Times{half + little}), true);
    EXPECT_EQ(Definition(posed).has_solution(Times{half}), false);
    EXPECT_EQ(Definition(posed).has_solution(Times{half, true}), true);
    EXPECT_EQ(Definition(posed).has_solution(Times{half - little, true}), false);
  }
}

/// A point on a quarter of the unit circle is on the line 3x + 4y = 5 at t = 1/2 and never beyond.
TEST(OracleSmt, TheDefinitionOfARationalCurveIsThatOfACircle) {
  const auto at_rest = [](double x, double y, double z) { return Trajectory{{{x, y, z}}, {3.0}}; };
  const Trajectory circle{{{1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {1, 1, 2}};
  const PosedCurves touches{ContactKind::vertex_face,
                            {circle, at_rest(3, -1, -1), at_rest(-1, 2, -1), at_rest(-1, 2, 5)}};
  PosedCurves misses = touches;
  misses.query[0].control[1][0] -= 0x1p-40;
  const Rational half = Rational(1) / 2;
  EXPECT_EQ(Definition(touches).has_solution(Times{half, true}), true);
  EXPECT_EQ(Definition(touches).has_solution(Times{half}), false);
  EXPECT_EQ(Definition(misses).has_solution(), false);
}

/// Expects agreement about lines or curves, and at least so many decided verdicts, of all and of
/// each kind and verdict.
template <class Posed>
void expect_agreement(const std::vector<Posed>& queries, std::size_t decided, std::size_t of_each) {
  Tally tally;
  for (const Posed& posed : queries) {
    SCOPED_TRACE(posed);
    const Decision verdict = decide(posed.kind, posed.query);
    if constexpr (std::is_same_v<Posed, PosedCurves>) {
      compare(posed, verdict, tally);
    } else {
      compare(to_curves(posed), verdict, tally);
    }
  }
  EXPECT_GE(tally.decided, decided);
  EXPECT_LE(20 * tally.unknown, tally.decided + tally.unknown) << "more than 5% unknown";
  EXPECT_LE(10 * tally.unknown_tois, tally.tois + tally.unknown_tois) << "more than 10% unknown";
  EXPECT_GE(tally.tois, 40U);
  for (const auto& verdicts : tally.agreed) {
    for (const std::size_t count : verdicts) EXPECT_GE(count, of_each);
  }
}

TEST(OracleSmt, AgreesWithAnSmtSolver) {
  expect_agreement(queries_to_ask(tests::soak_trials(1, 50)), 100, 10);
}

TEST(OracleSmt, AgreesWithAnSmtSolverOnCurves) {
  expect_agreement(curves_to_ask(tests::soak_trials(1, 25)), 50, 5);
}

}  // namespace
}  // namespace touchstone::exact::oracle_smt_test
