#include "fast/certified/rescaling.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fast/certified/block.hpp"
#include "tests/faults/planted_faults.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"

namespace touchstone::fast::rescaling_test {
namespace {

using tests::Random;

/// Queries of one kind and separation, all undecided by the kernel.
struct Block {
  Kind kind;
  Separation separation;
  std::vector<Query> queries;
};

/// The outcome for a block.
struct Outcome {
  std::string fault;  ///< the first answer that is not that of the exact stage
  std::size_t decided = 0;
};

Outcome outcome(tests::DecideRescaled& decide, const Block& block) {
  const auto output = std::make_unique<KernelOutput>();
  std::vector<std::optional<KernelImpact>> impacts(block.queries.size());
  std::vector<bool> is_open(block.queries.size());
  for (std::size_t i = 0; i < block.queries.size(); ++i) {
    output->undecided.items[i] = static_cast<std::uint32_t>(i);
  }
  output->undecided.count = block.queries.size();
  decide({.kind = block.kind, .count = block.queries.size(), .separation = block.separation},
         *certified_kernels().back(), block.queries, *output);
  for (std::size_t i = 0; i < output->impacts.count; ++i) {
    impacts[output->impacts.items[i].index] = output->impacts.items[i];
  }
  for (std::size_t i = 0; i < output->undecided.count; ++i) {
    is_open[output->undecided.items[i]] = true;
  }
  Outcome result;
  for (std::size_t i = 0; i < block.queries.size(); ++i) {
    if (is_open[i]) continue;
    ++result.decided;
    const CertifiedResult truth =
        decided_exactly(block.kind, block.queries[i], {.separation = block.separation});
    const bool collides = truth.verdict == Verdict::yes;
    const bool is_right = impacts[i].has_value() == collides &&
                          (!collides || (impacts[i]->toi_lower <= truth.toi_upper &&
                                         truth.toi_lower <= impacts[i]->toi_upper));
    if (!is_right && result.fault.empty()) result.fault = "query " + std::to_string(i);
  }
  return result;
}

/// Queries near a contact that floating point decides at their usual size, with the axes multiplied
/// by powers of two.
Block block_of(Random& random, Kind kind, const std::array<int, 3>& exponents, double distance) {
  Block block{kind, {.distance = std::ldexp(distance, exponents[0]), .norm = Norm::l2}, {}};
  while (block.queries.size() < 60) {
    Query query = tests::near_contact_query(random, kind);
    const Separation usual{.distance = distance, .norm = Norm::l2};
    if (solve(kind, query, {.separation = usual}).stage == Stage::exact) continue;
    for (std::size_t k = 0; k < query.coordinates.size(); ++k) {
      query.coordinates[k] = std::ldexp(query.coordinates[k], exponents[k % 3]);
    }
    block.queries.push_back(query);
  }
  return block;
}

using Exponents = std::array<int, 3>;
const std::vector<Exponents> equal_ones{
    {110, 110, 110}, {400, 400, 400}, {1000, 1000, 1000}, {-200, -200, -200}, {-900, -900, -900}};
const std::vector<Exponents> others{{0, 40, 0}, {900, 0, -800}, {-900, 300, 1000}};

/// The first wrong answer, or nothing; counts the queries that floating point decides.
std::string first_fault(tests::DecideRescaled& decide, std::size_t& asked, std::size_t& decided) {
  Random random(31);
  const auto try_block = [&](const Block& block, const Exponents& exponents) {
    const Outcome result = outcome(decide, block);
    asked += block.queries.size();
    decided += result.decided;
    return result.fault.empty() ? "" : result.fault + " at 2^" + std::to_string(exponents[0]);
  };
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    for (const std::vector<Exponents>* const some : {&equal_ones, &others}) {
      for (const Exponents& exponents : *some) {
        for (const double distance : {0.0, 0.01, 1.0}) {
          if (distance > 0.0 && some == &others) continue;
          const std::string fault =
              try_block(block_of(random, kind, exponents, distance), exponents);
          if (!fault.empty()) return fault;
        }
      }
    }
  }
  return "";
}

/// The first wrong answer to queries that cannot be scaled without rounding, or nothing.
std::string fault_of_rounding(tests::DecideRescaled& decide) {
  Random random(32);
  Block block{Kind::vertex_face, {}, {}};
  for (int i = 0; i < 200; ++i) {
    Query query = tests::near_contact_query(random, Kind::vertex_face);
    for (double& x : query.coordinates) x = std::ldexp(x, -1020);
    // A vertex far away, and a triangle at rest in it but for one corner that comes near.
    for (const std::size_t end : {0U, 1U}) query.at(end, 3, 0) = 0x1p1000;
    block.queries.push_back(query);
  }
  return outcome(decide, block).fault;
}

TEST(Rescaling, DecidesQueriesOfAllSizesInFloatingPoint) {
  std::size_t asked = 0, decided = 0;
  EXPECT_EQ(first_fault(decide_rescaled, asked, decided), "");
  EXPECT_GT(decided, asked - asked / 10);
  EXPECT_EQ(fault_of_rounding(decide_rescaled), "");
}

TEST(Rescaling, LeavesQueriesOfUsualSizeAlone) {
  Random random(33);
  for (const double distance : {0.0, 0.1}) {
    const Block block = block_of(random, Kind::edge_edge, {0, 0, 0}, distance);
    EXPECT_EQ(outcome(decide_rescaled, block).decided, 0U);
  }
}

TEST(Rescaling, PlantedFaultsAreFound) {
  for (const auto& fault : tests::planted_faults().rescaling) {
    std::size_t asked = 0, decided = 0;
    EXPECT_NE(first_fault(*fault.part, asked, decided) + fault_of_rounding(*fault.part), "")
        << fault.name;
  }
}

}  // namespace
}  // namespace touchstone::fast::rescaling_test
