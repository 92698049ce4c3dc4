/// \file
/// The certified solver for curves against the oracle: the same verdicts, and enclosures that hold
/// the exact time of impact.

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "exact/contact/corner_motion.hpp"
#include "fast/certified/block.hpp"
#include "fast/certified/curves/stages.hpp"
#include "fast/certified/exact/curved_polygon.hpp"
#include "fast/kernels.hpp"
#include "fast/method.hpp"
#include "fast/platform/lanes_scalar.hpp"
#include "tests/faults/limb_products.hpp"
#include "tests/faults/planted_faults.hpp"
#include "tests/support/certified_against_oracle.hpp"
#include "tests/support/messages.hpp"
#include "tests/support/polynomials.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/curved_query.hpp"
#include "touchstone/oracle.hpp"
#include "touchstone/tight_inclusion.hpp"

namespace touchstone::fast::curved_test {
namespace {

using tests::Random;

ContactKind kind_of(int round) {
  return round % 2 == 0 ? ContactKind::vertex_face : ContactKind::edge_edge;
}

/// Curves of one degree with their weights: none, the same for all, for each primitive, or for each
/// point.
enum class Weights : std::uint8_t { none, common, of_primitives, of_points };

struct Sort {
  std::size_t degree;
  Weights weights;
  /// Coordinates are small whole numbers, so that many contacts are degenerate; or any numbers.
  bool is_degenerate;
  double scale = 1.0;  ///< of all coordinates
};

struct Numbers {
  std::vector<double> numbers;
  Queries queries;
};

/// So many random queries.
Numbers random_queries(Random& random, const Sort& sort, ContactKind kind, std::size_t count) {
  Numbers result;
  const bool is_rational = sort.weights != Weights::none;
  const std::size_t second = kind == ContactKind::vertex_face ? 1 : 2;
  for (std::size_t i = 0; i < count; ++i) {
    // Faster motion of the whole than of its parts, so that not all queries collide.
    std::array<double, 3> drift{};
    for (double& x : drift) x = sort.is_degenerate ? 0.0 : 0.25 * random.uniform(-1, 1);
    for (std::size_t k = 0; k <= sort.degree; ++k) {
      std::array<double, 4> weights{};
      for (double& w : weights)
        w = sort.is_degenerate ? random.between(1, 3) : random.uniform(0.5, 2);
      for (std::size_t point = 0; point < moving_points; ++point) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const bool is_second = point >= second;
          const double x =
              sort.is_degenerate
                  ? random.between(-2, 2)
                  : random.uniform(-1, 1) + (is_second ? drift.at(axis) : -drift.at(axis)) / 2;
          result.numbers.push_back(x * sort.scale);
        }
        const std::size_t of = sort.weights == Weights::common ? 0
                               : sort.weights == Weights::of_primitives
                                   ? std::size_t{point >= second}
                                   : point;
        if (is_rational) result.numbers.push_back(weights.at(of));
      }
    }
  }
  result.queries = {{kind, sort.degree, is_rational}, result.numbers};
  return result;
}

/// ‖F‖ at the place and time of a contact, about, as a part of the greatest coordinate.
double distance_at(const Queries& queries, std::size_t i, const CertifiedResult& found) {
  const Query place = exact_stage::at_rest(to_curved(queries, i), found.toi_upper);
  double most = 0.0;
  double greatest = 0.0;
  for (const double x : place.coordinates) greatest = std::max(greatest, std::abs(x));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto x = [&](std::size_t point) { return place.at(0, point, axis); };
    const auto [u, v] = std::pair(found.u, found.v);
    const double f = queries.kind == ContactKind::vertex_face
                         ? x(0) - (x(1) + u * (x(2) - x(1)) + v * (x(3) - x(1)))
                         : x(0) + u * (x(1) - x(0)) - (x(2) + v * (x(3) - x(2)));
    most = std::max(most, std::abs(f) / greatest);
  }
  return most;
}

auto bits_of(const CertifiedResult& x) {
  const auto bits = [](double number) { return std::bit_cast<std::uint64_t>(number); };
  return std::tuple(x.verdict, x.is_exact, bits(x.toi_lower), bits(x.toi_upper), bits(x.u),
                    bits(x.v));
}

void expect_agreement(const Queries& queries, const CertifiedOptions& options, int& exact,
                      int& collisions) {
  std::vector<CertifiedResult> results(queries.size());
  solve(queries, results, options);
  for (const CertifiedKernel* const kernel : certified_kernels()) {
    CertifiedOptions with_kernel = options;
    with_kernel.kernels.certified = kernel;
    std::vector<CertifiedResult> by_kernel(queries.size());
    solve(queries, by_kernel, with_kernel);
    for (std::size_t i = 0; i < results.size(); ++i) {
      ASSERT_EQ(bits_of(by_kernel[i]), bits_of(results[i])) << to_string(kernel->instructions);
    }
  }
  for (std::size_t i = 0; i < results.size(); ++i) {
    const CertifiedResult& found = results[i];
    const exact::Decision truth = exact::decide(queries, i, options.separation);
    for (const CertifiedResult& any : {found, decided_exactly(queries, i, options)}) {
      const auto wrong = tests::fault(queries.kind, truth, any, options);
      ASSERT_FALSE(wrong) << *wrong << ": " << i << (any.is_exact ? " exact" : "");
    }
    exact += found.is_exact ? 1 : 0;
    if (found.verdict != Verdict::yes) continue;
    ++collisions;
    if (found.is_exact || options.separation.distance > 0.0) continue;
    EXPECT_LT(distance_at(queries, i, found), 1e-6) << i;
  }
}

class CurvedSolver : public testing::TestWithParam<Sort> {};

TEST_P(CurvedSolver, AgreesWithTheOracle) {
  const Sort sort = GetParam();
  Random random(91 + 10 * sort.degree + static_cast<std::uint64_t>(sort.weights));
  int exact = 0, otherwise = 0, collisions = 0, queries = 0;
  const int rounds = tests::soak_trials(12, 400);
  for (int round = 0; round < rounds; ++round) {
    const ContactKind kind = kind_of(round);
    CertifiedOptions options{.max_threads = 1};
    // (The oracle takes seconds for curves of four denominators at a distance.)
    const bool is_slow = sort.weights == Weights::of_points && !sort.is_degenerate;
    const bool has_distance = round % 3 == 1 && (!is_slow || sort.degree == 1);
    const Numbers some = random_queries(random, sort, kind, has_distance && is_slow ? 8 : 40);
    queries += static_cast<int>(some.queries.size());
    if (has_distance) {
      options.separation = {.distance = sort.scale * (sort.is_degenerate ? 1.0 : 0.1),
                            .norm = round % 2 == 0 ? Norm::l2 : Norm::linf};
    }
    if (round % 5 == 4) options.t_max = 0.625;
    if (round % 7 == 6) options.toi_tolerance = 0.0;
    const bool is_plain = !has_distance && options.toi_tolerance > 0.0;
    expect_agreement(some.queries, options, is_plain ? exact : otherwise, collisions);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(8 * collisions, queries);
  EXPECT_LT(40 * collisions, 39 * queries);
  // Floating point decides nearly all of usual size without a distance.
  const bool is_usual = !sort.is_degenerate && sort.scale == 1.0 && sort.degree > 1 &&
                        sort.degree < 4 && sort.weights != Weights::of_points;
  EXPECT_TRUE(!is_usual || 50 * exact < queries);
}

INSTANTIATE_TEST_SUITE_P(
    Sorts, CurvedSolver,
    testing::Values(Sort{1, Weights::of_primitives, false}, Sort{2, Weights::none, false},
                    Sort{3, Weights::none, false}, Sort{2, Weights::none, true},
                    Sort{3, Weights::none, true}, Sort{2, Weights::common, false},
                    Sort{2, Weights::common, true}, Sort{2, Weights::of_primitives, false},
                    Sort{2, Weights::of_primitives, true}, Sort{2, Weights::of_points, true},
                    Sort{2, Weights::of_points, false}, Sort{1, Weights::of_points, false},
                    Sort{6, Weights::none, false}, Sort{2, Weights::none, true, 0x1p-1060},
                    Sort{2, Weights::none, false, 0x1p-400}, Sort{2, Weights::none, true, 0x1p90},
                    Sort{2, Weights::none, false, 0x1p400},
                    Sort{2, Weights::none, false, 0x1p1018}));

/// Products of limbs, at most about twice as many as now. With the corners times all denominators
/// the last row took 22 s for one query.
TEST(CurvedSolver, TakesLittleWorkInTheExactStage) {
  struct Row {
    Sort sort;
    Separation separation;
    std::uint64_t most;
  };
  const Separation none{}, linf{1e-3, Norm::linf}, l2{1e-3, Norm::l2};
  for (const auto& [sort, separation, most] :
       {Row{{3, Weights::none, true}, none, 5'000}, Row{{3, Weights::none, true}, l2, 400'000},
        Row{{8, Weights::none, true}, none, 450'000},
        Row{{8, Weights::common, false}, l2, 40'000'000},
        Row{{2, Weights::of_primitives, false}, l2, 800'000},
        Row{{3, Weights::of_primitives, false}, l2, 2'600'000},
        Row{{3, Weights::of_points, false}, none, 110'000},
        Row{{3, Weights::of_points, false}, linf, 400'000},
        Row{{3, Weights::of_points, false}, l2, 3'000'000}}) {
    for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
      Random random(106);
      const Numbers some = random_queries(random, sort, kind, 40);
      for (const auto& counting : tests::planted_faults().counting_on_curves) {
        std::uint64_t found = 0;
        for (std::size_t i = 0; i < some.queries.size(); ++i) {
          tests::limb_products = 0;
          static_cast<void>(
              counting.part(kind, to_curved(some.queries, i), separation, 1e-12, 1.0));
          found = std::max(found, tests::limb_products);
        }
        EXPECT_LE(found, most) << sort.degree << ' ' << separation.distance;
        EXPECT_GT(found, 0U);
      }
    }
  }
}

/// Lines and curves, of several blocks.
TEST(CurvedSolver, HasTheSameResultsAsAnswers) {
  Random random(104);
  const Separation separation{.distance = 0.1, .norm = Norm::l2};
  for (const std::size_t degree : {1U, 2U}) {
    const Numbers some =
        random_queries(random, {degree, Weights::none, false}, ContactKind::edge_edge, 3000);
    std::vector<CertifiedResult> results(some.queries.size());
    solve(some.queries, results, {.t_max = 0.75, .separation = separation});
    std::size_t collisions = 0;
    std::vector<Answer> answers(results.size());
    certified_method()->solve(some.queries, answers, {.separation = separation, .t_max = 0.75});
    for (std::size_t i = 0; i < results.size(); ++i) {
      CertifiedResult answered = results[i];
      answered.verdict = answers[i].verdict;
      answered.toi_lower = answers[i].toi_lower;
      answered.toi_upper = answers[i].toi_upper;
      ASSERT_EQ(bits_of(answered), bits_of(results[i]));
      collisions += answers[i].verdict == Verdict::yes ? 1U : 0U;
    }
    EXPECT_GT(collisions, 300U);
    EXPECT_LT(collisions, 2700U);
    for (const double bad : {-1.0, HUGE_VAL, std::nan("")}) {
      certified_method()->solve(some.queries, answers, {.separation = {.distance = bad}});
      EXPECT_EQ(answers[7].verdict, Verdict::error) << bad;
    }
  }
}

/// True if a kernel's answers are those of the best one, whose answers are compared with the
/// oracle's above.
bool answers_rightly(const CertifiedKernel& kernel, const Separation& separation) {
  Random random(98);
  const CertifiedOptions options{.separation = separation, .max_threads = 1};
  CertifiedOptions with_kernel = options;
  with_kernel.kernels.certified = &kernel;
  for (int round = 0; round < 24; ++round) {
    constexpr std::array sorts{Weights::of_primitives, Weights::none, Weights::none,
                               Weights::of_points};
    const Sort sort{2 + static_cast<std::size_t>(round) % 2,
                    sorts.at(static_cast<std::size_t>(round) % sorts.size()), round % 5 == 0};
    const ContactKind kind = kind_of(round);
    const Numbers some = random_queries(random, sort, kind, 100);
    std::vector<CertifiedResult> expected(some.queries.size()), found = expected;
    solve(some.queries, expected, options);
    solve(some.queries, found, with_kernel);
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (found[i].verdict != expected[i].verdict) return false;
      if (found[i].verdict != Verdict::yes) continue;
      // Both enclose the time of impact.
      if (found[i].toi_lower > expected[i].toi_upper) return false;
      if (found[i].toi_upper < expected[i].toi_lower) return false;
    }
  }
  return true;
}

TEST(CurvedKernels, FindPlantedFaults) {
  for (const CertifiedKernel* const kernel : certified_kernels()) {
    EXPECT_TRUE(answers_rightly(*kernel, {})) << to_string(kernel->instructions);
  }
  for (const auto& fault : tests::planted_faults().curved_kernel) {
    if (!fault.is_to_be_found()) continue;
    std::printf("%s\n", fault.name.data());
    EXPECT_FALSE(answers_rightly(*fault.part, fault.separation)) << fault.name;
  }
}

TEST(TightInclusionOnCurves, MissesNoContact) {
  Random random(99);
  int collisions = 0, false_positives = 0;
  const int rounds = tests::soak_trials(16, 500);
  for (int round = 0; round < rounds; ++round) {
    const ContactKind kind = kind_of(round);
    const auto weights = static_cast<Weights>(round / 4 % 4);
    const Sort sort{2 + static_cast<std::size_t>(round / 2) % 2, weights, round % 3 == 0};
    const Numbers some = random_queries(random, sort, kind, 40);
    TightInclusionOptions options{.tolerance = 1e-4, .max_checks = 20'000};
    if (round % 4 == 3) options.separation = {.distance = 0.125, .norm = Norm::linf};
    std::vector<TightInclusionResult> found(some.queries.size());
    tight_inclusion(some.queries, found, options);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const exact::Decision truth = exact::decide(some.queries, i, options.separation);
      if (truth.collides()) {
        ++collisions;
        ASSERT_EQ(found[i].verdict, Verdict::yes);
        EXPECT_LE(exact::Rational(found[i].toi), *truth.toi);
      } else if (found[i].verdict == Verdict::yes) {
        ++false_positives;
      }
    }
  }
  EXPECT_GT(collisions, 4 * rounds);
  EXPECT_LT(false_positives, 4 * rounds);
}

TEST(TightInclusionOnCurves, RefusesWhatItHasNoFilterFor) {
  const auto refuses = [](const QueryShape& shape, const TightInclusionOptions& options,
                          std::size_t results = 1) {
    const std::vector<double> rest(shape.numbers_of_query(), 1.0);
    std::vector<TightInclusionResult> found(results);
    EXPECT_THROW(tight_inclusion({shape, rest}, found, options), std::invalid_argument)
        << shape.degree;
  };
  for (const QueryShape& shape : {QueryShape{.degree = 4}, {.is_rational = true}}) {
    refuses(shape, {});
  }
  refuses({.degree = 2}, {}, 0);
  refuses({.degree = 2}, {.scene_filter = std::array{1.0, 1.0, 1.0}});
}

/// A vertex through the third side of a triangle, where boxes of (u,v) reach out of the domain.
TEST(TightInclusionOnCurves, FindsContactsAtTheThirdSide) {
  Random random(100);
  for (int round = 0; round < 200; ++round) {
    const double u = std::ldexp(random.between(1, (1 << 20) - 1), -20);
    std::vector<double> numbers;
    for (const double height : {1.0, 0.0, -1.0}) {
      const double weight = round % 2 == 0 ? 1.0 : random.uniform(0.5, 2.0);
      for (const double x : {2.0 - u, 1.0 - u, height, weight}) numbers.push_back(x);
      for (const double x : {0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 2.0, 1.0, 0.0, 1.0}) {
        numbers.push_back(x);
      }
    }
    const Queries queries({.degree = 2, .is_rational = true}, numbers);
    const exact::Decision truth = exact::decide(queries, 0);
    ASSERT_TRUE(truth.collides());
    TightInclusionResult found;
    tight_inclusion(queries, {&found, 1});
    ASSERT_EQ(found.verdict, Verdict::yes) << round;
    EXPECT_LE(exact::Rational(found.toi), *truth.toi);
    EXPECT_GE(exact::Rational(found.toi + 1e-4), *truth.toi);
  }
}

TEST(CurvedSolver, SaysWhereInputIsNone) {
  const std::vector<double> rest(2 * 3 * moving_points, 1.0);
  const Queries queries({.degree = 1}, rest);
  std::array<CertifiedResult, 1> one{};
  solve(queries, one);
  EXPECT_EQ(one[0].verdict, Verdict::yes);
  EXPECT_EQ(one[0].toi_upper, 0.0);
  EXPECT_EQ(tests::message_of<std::invalid_argument>([&] { solve(queries, {}); }),
            "solve: 0 results for 1 queries");
  EXPECT_THROW(Queries({.degree = 9}, {}), std::invalid_argument);
  EXPECT_EQ(
      tests::message_of<std::invalid_argument>([&] { Queries({.degree = 0}, rest); }),
      "the degree of curves must be from 1 to 8, not 0; repeat the control point of a point at "
      "rest");
  EXPECT_THROW(Queries({.degree = 2}, rest), std::invalid_argument);
  EXPECT_THROW(solve(queries, one, {.t_max = 2.0}), std::invalid_argument);
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double bad : {infinite, -infinite, std::nan("")}) {
    std::vector<double> numbers = rest;
    numbers[7] = bad;
    solve(Queries({ContactKind::edge_edge, 1, false}, numbers), one);
    EXPECT_EQ(one[0].verdict, Verdict::error);
  }
  for (const double bad : {0.0, -1.0, infinite, std::nan("")}) {
    std::vector<double> numbers(4 * 2 * moving_points, 1.0);
    numbers[0] = 5.0;
    numbers[11] = bad;
    solve(Queries({ContactKind::edge_edge, 1, true}, numbers), one);
    EXPECT_EQ(one[0].verdict, Verdict::error) << bad;
  }
}

/// With factors of their own the corners of two edges are no parallelogram.
TEST(CurvedSolver, LeavesFewEdgesOfUnequalEndsToTheExactStage) {
  Random random(96);
  for (const std::array<double, 4>& weights :
       {std::array{1.0, 3.0, 1.0, 3.0}, {10.0, 1.0, 1.0, 10.0}, {1.0, 1.0, 0.125, 2.0}}) {
    Numbers some =
        random_queries(random, {2, Weights::of_points, false}, ContactKind::edge_edge, 400);
    for (std::size_t i = 3; i < some.numbers.size(); i += 4) {
      some.numbers[i] = weights.at(i / 4 % moving_points);
    }
    some.queries.numbers = some.numbers;
    int exact = 0, collisions = 0;
    expect_agreement(some.queries, {.max_threads = 1}, exact, collisions);
    EXPECT_GT(collisions, 20);
    EXPECT_LT(exact, 4) << weights[0];
  }
}

/// (The oracle takes a second for each query of degree 2 and of four denominators.)
TEST(CurvedSolver, DecidesWeightsOfAnySize) {
  Random random(103);
  constexpr std::array weights{5e-324, 1e-300, 0x1p-30, 1.0, 0x1p31, 1e300, 1.7e308};
  int exact = 0, collisions = 0;
  for (const auto& [degree, sort, count] :
       {std::tuple(std::size_t{1}, Weights::of_points, std::size_t{20}),
        {std::size_t{2}, Weights::of_primitives, std::size_t{20}},
        {std::size_t{2}, Weights::of_points, std::size_t{1}}}) {
    for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
      const std::size_t second = kind == ContactKind::vertex_face ? 1 : 2;
      Numbers some = random_queries(random, {degree, sort, true}, kind, count);
      for (std::size_t i = 3; i < some.numbers.size(); i += 4) {
        const std::size_t point = i / 4 % moving_points;
        const bool is_same = sort == Weights::of_primitives && point != 0 && point != second;
        some.numbers[i] =
            is_same ? some.numbers[i - 4] : weights.at(random.bits() % weights.size());
      }
      some.queries.numbers = some.numbers;
      expect_agreement(some.queries, {}, exact, collisions);
    }
  }
  EXPECT_GT(collisions, 8);
  EXPECT_GT(exact, 20);
}

// ---- The parts against exact values -------------------------------------------------------------

/// One query in the one lane.
using Lanes = ScalarLanes;
using Value = Lanes::Value;
using Mask = Lanes::Mask;
constexpr ContactKind of_face = ContactKind::vertex_face;
using Polygons = curved::ControlPolygons<Lanes, of_face>;

/// One rational or polynomial query of degree 2, with weights in common to a primitive.
Numbers one_query(Random& random, bool is_rational, double size) {
  const Weights weights = is_rational ? Weights::of_primitives : Weights::none;
  return random_queries(random, {2, weights, false, size}, of_face, 1);
}

curved::Block block_of(const Queries& queries) {
  return {queries, {.distance = 0.25, .norm = Norm::linf}};
}

bool load(const curved::Block& block, Polygons& polygons) {
  const curved::Rows<Lanes> rows{block, {block.numbers.data()}};
  const auto form = block.is_rational ? curved::Denominators::two : curved::Denominators::one;
  return curved::Loading<Lanes, of_face>::run(rows, form, polygons).set;
}

/// The exact Bernstein coefficients at a place of a control point.
std::vector<mpq_class> exact_values(const curved::Block& block, std::size_t place) {
  const auto number = [&](std::size_t k, std::size_t point, std::size_t i) -> mpq_class {
    const std::size_t stride = block.numbers_of_point();
    if (i == 3 && !block.is_rational) return 1;
    return block.numbers[(k * moving_points + point) * stride + i];
  };
  const auto value = [&](std::size_t a, std::size_t b) -> mpq_class {
    if (place == 9) return block.separation.distance;
    const Corner& corner = vertex_face_corners.at(place % 3);
    return number(a, corner.plus, place / 3) - number(b, corner.minus, place / 3);
  };
  if (!block.is_rational) return {value(0, 0), value(1, 1), value(2, 2)};
  static constexpr std::array binomials{1, 2, 1};
  static constexpr std::array wide{1, 4, 6, 4, 1};
  std::vector<mpq_class> values(5);
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) {
      values[a + b] += mpq_class(binomials.at(a) * binomials.at(b)) / wide.at(a + b) *
                       number(a, 0, 3) * number(b, 1, 3) * value(a, b);
    }
  }
  return values;
}

TEST(ControlPolygon, HasItsErrorOnAnyPart) {
  Random random(94);
  for (int round = 0; round < 3000; ++round) {
    const double size = round % 3 == 0 ? 0x1p-1058 : 1.0;
    const Numbers query = one_query(random, round % 2 == 1, size);
    const curved::Block block = block_of(query.queries);
    Polygons whole, part;
    ASSERT_TRUE(load(block, whole));
    double begin = round % 5 == 0 ? 0.0 : random.uniform(0, 1);
    double end = round % 7 == 0 ? 1.0 : random.uniform(0, 1);
    if (begin > end) std::swap(begin, end);
    curved::restrict_to<true>(whole, Value(begin), Value(end), part);
    for (std::size_t place = 0; place < Polygons::size; ++place) {
      const std::vector<mpq_class> of_whole = exact_values(block, place);
      const auto of_part = tests::bernstein_on(of_whole, begin, end);
      ASSERT_EQ(part.degree + 1, of_part.size());
      for (std::size_t k = 0; k <= part.degree; ++k) {
        const mpq_class bound = part.error[0];
        ASSERT_LE(abs(of_whole[k] - mpq_class(whole.at(k, place).x)), bound);
        ASSERT_LE(abs(of_part[k] - mpq_class(part.at(k, place).x)), bound);
        ASSERT_LE(std::abs(part.at(k, place).x), part.magnitude[0]);
      }
    }
  }
}

TEST(ControlPolygon, IsNoneOfNumbersThatAreNotUsual) {
  for (const double bad : {0x1p102, std::numeric_limits<double>::infinity(), std::nan("")}) {
    for (std::size_t place = 0; place < 36; ++place) {
      std::vector<double> numbers(36, 1.0);
      numbers[place] = bad;
      Polygons polygons;
      EXPECT_FALSE(load(block_of({{.degree = 2}, numbers}), polygons));
    }
  }
}

/// The coefficients of det are those of the exact form, within the error that the proof allows.
TEST(ContactProof, HasTheCoefficientsOfTheDeterminant) {
  Random random(97);
  int proved = 0;
  for (int round = 0; round < 2000; ++round) {
    Numbers query = one_query(random, round % 2 == 1, 1.0);
    // A corner's normal along z, and a vertex that passes through the triangle.
    const std::size_t stride = query.queries.numbers_of_point();
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t point = 0; point < moving_points; ++point) {
        double* const x = query.numbers.data() + (k * moving_points + point) * stride;
        x[0] = 0.05 * x[0] + std::array{0.0, -1.0, 1.0, 0.0}.at(point);
        x[1] = 0.05 * x[1] + std::array{0.0, -1.0, -1.0, 1.0}.at(point);
        x[2] = 0.05 * x[2] + (point == 0 ? static_cast<double>(k) - 1.0 : 0.0);
      }
    }
    const curved::Block block = block_of(query.queries);
    Polygons polygons;
    ASSERT_TRUE(load(block, polygons));
    curved::DeterminantForms<Lanes> det;
    const curved::Crossing<Lanes, of_face> crossing(polygons, Mask::none(), Mask::all());
    if (!crossing.is_proved(det).set) continue;
    ++proved;
    const auto motion = exact::scale(of_face, to_curved(query.queries, 0), {});
    for (int i = 0; i <= 8; ++i) {
      const double t = 0.125 * i;
      mpq_class sum = 0, power = 1;
      for (std::size_t m = 0; m <= det.degree; ++m) {
        sum = sum * (1 - mpq_class(t)) + mpq_class(det.coefficient[m][0]) * power;
        power *= t;
      }
      // (That of 9 corners below 3 and weights below 4 is below 2^-30.)
      if (abs(sum) < 0x1p-30) continue;
      exact::AlgebraicNumber at{exact::Rational(t)};
      EXPECT_EQ(exact::sign_at(exact::determinant(motion), at), sgn(sum));
    }
    EXPECT_TRUE(exact::decide(query.queries, 0).collides());
  }
  EXPECT_GT(proved, 1000);
}

TEST(ContactProof, HasTheSignOfTheDeterminant) {
  Random random(95);
  for (int round = 0; round < 200; ++round) {
    const Numbers query = one_query(random, round % 2 == 1, 1.0);
    const curved::Block block = block_of(query.queries);
    const double time = random.uniform(0, 1);
    exact::AlgebraicNumber at{exact::Rational(time)};
    const auto motion = exact::scale(of_face, to_curved(query.queries, 0), {});
    const auto signs =
        curved::AtTime<Lanes, of_face>({block, {block.numbers.data()}}, Value(time)).determinant();
    const int sign = exact::sign_at(exact::determinant(motion), at);
    EXPECT_EQ(signs.is_positive.set, sign > 0);
    EXPECT_EQ(signs.is_negative.set, sign < 0);
  }
}

/// Times a number.
bool is_multiple(const exact_stage::Polynomial& a, const exact_stage::Polynomial& b) {
  const auto place = static_cast<std::size_t>(
      std::ranges::find_if(b, [](const auto& x) { return x.sign() != 0; }) - b.begin());
  return a.size() == b.size() && a * b[place] == b * a[place];
}

/// For every choice of equal and different weights of the points.
TEST(CurvedPolygon, HasFactorsThatDivideTheDeterminant) {
  Random random(101);
  for (const ContactKind any : {ContactKind::vertex_face, ContactKind::edge_edge}) {
    for (int choice = 0; choice < 625; ++choice) {
      CurvedQuery query;
      int rest = choice;
      for (Trajectory& curve : query) {
        for (int k = 0; k < 3; ++k) {
          curve.control.push_back({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform()});
        }
        const double weight = rest % 5;
        if (weight > 0) curve.weights = {1, weight + 1, std::ldexp(weight + 2, 300)};
        rest /= 5;
      }
      for (const auto& [motion, factors] : exact_stage::motions_of(any, query)) {
        exact_stage::Polynomial left = determinant(motion, normal(motion));
        for (const exact_stage::Polynomial& factor : factors) {
          const exact_stage::Polynomial quotient = exact_stage::scaled_quotient(left, factor);
          ASSERT_TRUE(is_multiple(quotient * factor, left)) << choice;
          left = quotient;
        }
        EXPECT_LE(exact_stage::inner_polynomial(left).size(), 4U * 2U + 1U) << choice;
      }
    }
  }
}

}  // namespace
}  // namespace touchstone::fast::curved_test
