/// \file
/// The methods for curves side by side: what each says to queries that tell them apart.

#include "verify/baselines/baselines.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "touchstone/number.hpp"
#include "touchstone/oracle.hpp"
#include "touchstone/query.hpp"

namespace touchstone::baselines::curved_methods_test {
namespace {

using fast::Verdict;

constexpr QueryShape parabolas{.kind = Kind::vertex_face, .degree = 2};

fast::Answer answer_to(const fast::Method& method, const std::vector<double>& numbers,
                       const fast::MethodOptions& options = {}) {
  fast::Answer answer;
  method.solve(Queries(parabolas, numbers), {&answer, 1}, options);
  return answer;
}

/// A vertex at (x, 1, z) whose coordinates have these control values, and a triangle at rest in the
/// plane z=0, with corners 0, (4,0) and (0,4).
std::vector<double> over_triangle(const std::array<double, 3>& x, const std::array<double, 3>& z) {
  std::vector<double> numbers;
  for (std::size_t j = 0; j < 3; ++j) {
    for (const double number : {x.at(j), 1.0, z.at(j), 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 4.0, 0.0})
      numbers.push_back(number);
  }
  return numbers;
}

/// Both primitives bulge towards each other between their ends, by 3/8 each, and are 1/2 apart
/// there: chords come within the sum of the deviations, and not within the greater one.
std::vector<double> bulging() {
  std::vector<double> numbers;
  for (const double bulge : {0.0, 0.75, 0.0}) {
    for (const double x :
         {0.0, 0.0, 0.5 - bulge, -1.0, -1.0, bulge, 2.0, -1.0, bulge, -1.0, 2.0, bulge}) {
      numbers.push_back(x);
    }
  }
  return numbers;
}

/// z = 4 (t − 0.505)² − 1e-5: below the plane for less than 0.01.
std::vector<double> dipping() {
  constexpr double start = 4.0 * 0.505 * 0.505 - 1e-5, end = 4.0 * 0.495 * 0.495 - 1e-5;
  return over_triangle({1, 1, 1}, {start, start - 4.0 * 0.505, end});
}

/// x = t − 0.505 in the plane of the triangle.
std::vector<double> sliding() { return over_triangle({-0.505, -0.005, 0.495}, {0, 0, 0}); }

/// z = 4 (t − 0.3)² + 5e-7: never in contact, and within the tolerance.
std::vector<double> near_miss() {
  constexpr double start = 0.36 + 5e-7;
  return over_triangle({1, 1, 1}, {start, start - 1.2, 1.96 + 5e-7});
}

struct Row {
  const char* name;
  std::vector<double> numbers;
  bool collides;
  /// The verdicts of subdivision, with the largest deviation, of sampling and of advancement.
  std::array<Verdict, 4> said;
};

TEST(CurvedMethods, AreWrongWhereKnown) {
  constexpr Verdict yes = Verdict::yes, no = Verdict::no;
  const std::array methods{subdivision_method(), subdivision_largest_deviation_method(),
                           sampling_method(), advancement_method()};
  for (const Row& row : {Row{"bulging", bulging(), true, {yes, no, no, yes}},
                         {"dipping", dipping(), true, {yes, yes, no, yes}},
                         {"sliding", sliding(), true, {yes, yes, yes, yes}},
                         {"near miss", near_miss(), false, {yes, yes, yes, yes}},
                         {"far", over_triangle({1, 1, 1}, {1, 2, 1}), false, {no, no, no, no}}}) {
    EXPECT_EQ(exact::decide(Queries(parabolas, row.numbers), 0).collides(), row.collides)
        << row.name;
    for (std::size_t i = 0; i < methods.size(); ++i) {
      EXPECT_EQ(answer_to(*methods.at(i), row.numbers).verdict, row.said.at(i))
          << row.name << ' ' << methods.at(i)->name();
    }
  }
}

TEST(CurvedMethods, SamplingIsLateAndSubdivisionIsNot) {
  const exact::Decision truth = exact::decide(Queries(parabolas, sliding()), 0);
  const double sampled = answer_to(*sampling_method(), sliding()).toi_lower;
  EXPECT_EQ(sampled, 0.51);
  EXPECT_LT(*truth.toi, exact::Rational(sampled));
  EXPECT_NEAR(answer_to(*subdivision_method(), sliding()).toi_lower, 0.505, 1e-5);
}

TEST(CurvedMethods, HeedTMaxAndRefuseWhatIsNotFinite) {
  for (const auto& method : {subdivision_method(), subdivision_largest_deviation_method(),
                             sampling_method(), advancement_method()}) {
    EXPECT_EQ(answer_to(*method, sliding(), {.t_max = 0.5}).verdict, Verdict::no) << method->name();
    std::vector<double> bad = sliding();
    bad[20] = std::nan("");
    EXPECT_EQ(answer_to(*method, bad).verdict, Verdict::error) << method->name();
    const fast::Terms& terms = method->info().terms;
    EXPECT_FALSE(terms.answers({.kind = Kind::edge_edge})) << "straight lines";
    EXPECT_TRUE(terms.answers({.kind = Kind::edge_edge, .degree = 8}));
    EXPECT_FALSE(terms.answers({.kind = Kind::edge_edge, .degree = 2, .is_rational = true}));
  }
}

}  // namespace
}  // namespace touchstone::baselines::curved_methods_test
