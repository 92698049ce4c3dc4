#include "verify/fuzz/generators.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <string_view>
#include <vector>

#include "tests/support/trials.hpp"
#include "touchstone/certified.hpp"
#include "verify/fuzz/plainness.hpp"
#include "verify/generate/random_stream.hpp"

namespace touchstone::verify::fuzz::generators_test {
namespace {

using generate::Random;

constexpr std::array<ContactKind, 2> both_kinds{ContactKind::vertex_face, ContactKind::edge_edge};
constexpr std::array<AnyShape, 5> some_shapes{{{ContactKind::vertex_face},
                                               {ContactKind::edge_edge},
                                               {ContactKind::vertex_face, 2, true},
                                               {ContactKind::edge_edge, 3},
                                               {ContactKind::edge_edge, 1, true}}};
const std::array<Separation, 3> separations{
    {{}, {.distance = 1e-8, .norm = Norm::l2}, {.distance = 1e250, .norm = Norm::linf}}};

std::vector<AnyQuery> make_queries(const Generator& generator, const AnyShape& shape,
                                   const Separation& separation, int count) {
  GeneratorContext context(separation);
  Random random(7);
  std::vector<AnyQuery> queries;
  for (int i = 0; i < count; ++i) {
    // A query to mutate, from each generator without inputs in turn.
    const Generator& other = generators()[1 + static_cast<std::size_t>(i % 7)];
    context.pool(shape).add(other.make(shape, context, random));
    queries.push_back(generator.make(shape, context, random));
  }
  return queries;
}

TEST(Generators, MakeFiniteQueriesTheSameEveryTime) {
  for (const Separation& separation : separations) {
    for (const Generator& generator : generators(separation, true)) {
      for (const AnyShape& shape : some_shapes) {
        const auto queries = make_queries(generator, shape, separation, tests::trials(160));
        EXPECT_TRUE(std::ranges::all_of(queries, is_valid)) << generator.name;
        EXPECT_TRUE(std::ranges::all_of(
            queries, [&](const AnyQuery& query) { return query.shape() == shape; }));
        EXPECT_EQ(queries, make_queries(generator, shape, separation, tests::trials(160)))
            << generator.name;
      }
    }
  }
}

/// The queries are useful: both verdicts, and some that are decided late.
TEST(Generators, MakeCollisionsAndMissesThatAreHard) {
  constexpr int count = 160;
  for (const Separation& separation : separations) {
    for (const Generator& generator : generators(separation, false)) {
      for (const ContactKind kind : both_kinds) {
        std::vector<double> numbers;
        for (const AnyQuery& query : make_queries(generator, {kind}, separation, count)) {
          numbers.insert(numbers.end(), query.numbers().begin(), query.numbers().end());
        }
        std::vector<fast::CertifiedResult> results(count);
        fast::solve(Queries({kind}, numbers), results,
                    {.separation = separation, .max_threads = 1});
        const auto collisions =
            std::ranges::count(results, fast::Verdict::yes, &fast::CertifiedResult::verdict);
        const auto late = std::ranges::count_if(results, [](const auto& result) {
          return result.is_exact || result.verdict == fast::Verdict::yes;
        });
        const std::string_view name = generator.name;
        EXPECT_GT(collisions, 0) << name << ' ' << to_string(kind);
        EXPECT_GT(late, 3) << name << ' ' << to_string(kind);
        // With a distance most queries collide.
        EXPECT_TRUE(separation.distance > 0.0 || collisions < count)
            << name << ' ' << to_string(kind);
      }
    }
  }
}

TEST(Mutated, StaysFiniteWhereverItStarts) {
  Random random(2);
  constexpr double greatest = std::numeric_limits<double>::max();
  for (const double start : {0.0, std::numeric_limits<double>::denorm_min(), -1.5, greatest}) {
    for (const AnyShape& shape : {AnyShape{}, {.degree = 3}, {.is_rational = true}}) {
      AnyQuery query(shape, std::vector<double>(shape.numbers_of_query(), start));
      for (std::size_t i = 3; shape.is_rational && i < query.numbers().size(); i += 4) {
        query.numbers()[i] = 0x1p39;  // a weight
      }
      for (int i = 0; i < 5000; ++i) {
        query = mutated(query, true, random);
        ASSERT_TRUE(is_valid(query));
      }
    }
  }
}

TEST(QueryPool, ForgetsTheOldestButNotWhatItKeeps) {
  const auto numbered = [](double number) { return AnyQuery({}, std::vector<double>(24, number)); };
  QueryPool pool;
  EXPECT_TRUE(pool.empty());
  pool.keep(numbered(-1.0));
  for (int i = 0; i < 5000; ++i) pool.add(numbered(i));
  Random random(1);
  int kept = 0;
  double oldest = 5000.0;
  for (int i = 0; i < 4000; ++i) {
    const double number = pool.draw(random).numbers().front();
    kept += number < 0.0 ? 1 : 0;
    if (number >= 0.0) oldest = std::min(oldest, number);
  }
  EXPECT_NEAR(kept, 2000, 200);
  EXPECT_GE(oldest, 5000.0 - 1024.0);
  EXPECT_LT(oldest, 5000.0 - 900.0);
}

}  // namespace
}  // namespace touchstone::verify::fuzz::generators_test
