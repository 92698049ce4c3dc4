/// \file
/// The oracle against an SMT solver (Z3, nonlinear real arithmetic).
///
/// The solver gets only the definition: unknown reals t, u, v in the domain and the three equations
/// F = 0 with the coordinates as exact rationals. It answers whether there is a solution, and
/// whether there is one before the oracle's time of impact. Hard queries come first. The
/// environment variable TOUCHSTONE_SOAK multiplies the number of random queries by fifty.

#include <gtest/gtest.h>
#include <z3++.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <iostream>
#include <limits>
#include <optional>
#include <vector>

#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::exact::oracle_smt_test {
namespace {

using tests::edge_edge;
using tests::Family;
using tests::over_edge;
using tests::over_triangle;
using tests::PosedQuery;
using tests::Random;
using tests::random_query;
using tests::turning_triangle;
using tests::twisting_triangle;
using tests::vertex_face;

constexpr unsigned timeout_milliseconds = 20000;
constexpr double least = std::numeric_limits<double>::denorm_min();

// ------------------------------------------------------------------ the solver

/// The query's definition in the language of the solver.
class Definition {
 public:
  explicit Definition(const PosedQuery& posed)
      : t_(context_.real_const("t")),
        u_(context_.real_const("u")),
        v_(context_.real_const("v")),
        solver_(z3::tactic(context_, "qfnra-nlsat").mk_solver()) {
    z3::params parameters(context_);
    parameters.set("timeout", timeout_milliseconds);
    solver_.set(parameters);
    require_domain(posed.kind);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      solver_.add(contact_function(posed, axis) == number(0));
    }
  }

  /// Asks whether there is a solution, with t < bound if there is a bound. The result is empty if
  /// the solver gives up.
  std::optional<bool> has_solution(const std::optional<Rational>& bound) {
    if (bound) solver_.add(t_ < number(*bound));
    const z3::check_result result = solver_.check();
    if (result == z3::unknown) return std::nullopt;
    return result == z3::sat;
  }

 private:
  z3::expr number(const Rational& x) { return context_.real_val(x.get_str().c_str()); }

  void require_domain(Kind kind) {
    const z3::expr zero = number(0), one = number(1);
    for (const z3::expr& x : {t_, u_, v_}) {
      solver_.add(x >= zero);
      solver_.add(x <= one);
    }
    if (kind == Kind::vertex_face) solver_.add(u_ + v_ <= one);
  }

  z3::expr contact_function(const PosedQuery& posed, std::size_t axis) {
    const z3::expr one = number(1);
    const auto position = [&](std::size_t point) {
      return (one - t_) * number(Rational(posed.query.at(0, point, axis))) +
             t_ * number(Rational(posed.query.at(1, point, axis)));
    };
    const z3::expr a = position(0), b = position(1), c = position(2), d = position(3);
    if (posed.kind == Kind::vertex_face) return a - ((one - u_ - v_) * b + u_ * c + v_ * d);
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
      const Kind kind = i % 2 == 0 ? Kind::vertex_face : Kind::edge_edge;
      queries.push_back(random_query(random, kind, family));
    }
  };
  draw(Family::tiny_integers, 14 * scale);
  draw(Family::small_integers, 14 * scale);
  draw(Family::near_contact, 20 * scale);
  draw(Family::full_significands, 8 * scale);
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
  /// Seconds for each question.
  std::vector<double> times;
};

std::optional<bool> ask(const PosedQuery& posed, const std::optional<Rational>& bound,
                        Tally& tally) {
  const auto start = std::chrono::steady_clock::now();
  const std::optional<bool> answer = Definition(posed).has_solution(bound);
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
  tally.times.push_back(time.count());
  return answer;
}

void compare_verdict(const PosedQuery& posed, bool collides, Tally& tally) {
  const std::optional<bool> answer = ask(posed, std::nullopt, tally);
  if (!answer) {
    ++tally.unknown;
    std::cout << "no answer within the time: " << posed << '\n';
    return;
  }
  ++tally.decided;
  ASSERT_EQ(*answer, collides);
  ++tally.agreed.at(static_cast<std::size_t>(posed.kind)).at(collides ? 1 : 0);
}

/// Expects no solution before the toi's lower bound.
void compare_toi(const PosedQuery& posed, const AlgebraicNumber& toi, Tally& tally) {
  const Rational lower(toi.enclosure().lower);
  if (sgn(lower) == 0) return;
  const std::optional<bool> answer = ask(posed, lower, tally);
  if (!answer) {
    ++tally.unknown_tois;
    return;
  }
  ++tally.tois;
  ASSERT_FALSE(*answer) << "contact before " << lower;
}

void print_summary(const Tally& tally) {
  std::vector<double> times = tally.times;
  std::ranges::sort(times);
  double total = 0.0;
  for (const double time : times) total += time;
  std::cout << "verdicts: " << tally.decided << " decided, " << tally.unknown
            << " unknown; tois: " << tally.tois << " decided, " << tally.unknown_tois
            << " unknown\nseconds a question: median " << times[times.size() / 2] << ", worst "
            << times.back() << ", total " << total << '\n';
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    const auto& [no_collisions, collisions] = tally.agreed.at(static_cast<std::size_t>(kind));
    std::cout << to_string(kind) << ": " << collisions << " collisions, " << no_collisions
              << " others agreed\n";
  }
}

TEST(OracleSmt, TheSolverWouldFindAContactBeforeAToiThatIsTooLate) {
  const Rational half = Rational(1) / 2, little = power_of_two(-60);
  for (const PosedQuery& posed : {over_triangle(1, 1, 1, -1), over_edge(1, 1, 1, -1)}) {
    EXPECT_EQ(Definition(posed).has_solution(std::nullopt), true);
    EXPECT_EQ(Definition(posed).has_solution(half + little), true);
    EXPECT_EQ(Definition(posed).has_solution(half), false);
  }
}

TEST(OracleSmt, AgreesWithAnSmtSolver) {
  const int scale = tests::is_soak() ? 50 : 1;
  Tally tally;
  for (const PosedQuery& posed : queries_to_ask(scale)) {
    SCOPED_TRACE(posed);
    const Decision verdict = decide(posed.kind, posed.query);
    compare_verdict(posed, verdict.collides(), tally);
    if (verdict.collides()) compare_toi(posed, *verdict.toi, tally);
  }
  print_summary(tally);
  EXPECT_GE(tally.decided, 100U);
  EXPECT_LE(20 * tally.unknown, tally.decided + tally.unknown) << "more than 5% unknown";
  EXPECT_GE(tally.tois, 20U);
  for (const auto& verdicts : tally.agreed) {
    for (const std::size_t count : verdicts) EXPECT_GE(count, 10U);
  }
}

}  // namespace
}  // namespace touchstone::exact::oracle_smt_test
