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
  ContactKind kind;
  Separation separation;
  std::vector<Query> queries;
  bool can_be_scaled = true;  ///< without rounding
};

/// The outcome for blocks.
struct Outcome {
  std::string fault;  ///< the first answer that is not that of the exact stage
  std::size_t asked = 0, decided = 0;
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
         *certified_kernels().back()->decide, block.queries, *output);
  for (std::size_t i = 0; i < output->impacts.count; ++i) {
    impacts[output->impacts.items[i].index] = output->impacts.items[i];
  }
  for (std::size_t i = 0; i < output->undecided.count; ++i) {
    is_open[output->undecided.items[i]] = true;
  }
  Outcome result;
  result.asked = block.queries.size();
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
Block block_of(Random& random, ContactKind kind, const std::array<int, 3>& exponents,
               double distance) {
  Block block{kind, {.distance = std::ldexp(distance, exponents[0]), .norm = Norm::l2}, {}};
  while (block.queries.size() < 60) {
    Query query = tests::near_contact_query(random, kind);
    const Separation usual{.distance = distance, .norm = Norm::l2};
    if (solve(kind, query, {.separation = usual}).is_exact) continue;
    for (std::size_t k = 0; k < query.coordinates.size(); ++k) {
      query.coordinates[k] = std::ldexp(query.coordinates[k], exponents[k % 3]);
    }
    block.queries.push_back(query);
  }
  return block;
}

/// Blocks of all sizes, with separations where the axes are of one size; the last one cannot be
/// scaled without rounding.
std::vector<Block> blocks() {
  Random random(31);
  std::vector<Block> result;
  for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
    for (const std::array<int, 3>& exponents : {std::array{110, 110, 110},
                                                {400, 400, 400},
                                                {1000, 1000, 1000},
                                                {-200, -200, -200},
                                                {-900, -900, -900},
                                                {0, 40, 0},
                                                {900, 0, -800},
                                                {-900, 300, 1000}}) {
      result.push_back(block_of(random, kind, exponents, 0.0));
      if (exponents[0] != exponents[1]) continue;
      for (const double distance : {0.01, 1.0}) {
        result.push_back(block_of(random, kind, exponents, distance));
      }
    }
  }
  Block& rounded = result.emplace_back(Block{ContactKind::vertex_face, {}, {}, false});
  for (int i = 0; i < 200; ++i) {
    Query query = tests::near_contact_query(random, ContactKind::vertex_face);
    for (double& x : query.coordinates) x = std::ldexp(x, -1020);
    // A vertex far away, and a triangle at rest in it but for one corner that comes near.
    for (const std::size_t end : {0U, 1U}) query.at(end, 3, 0) = 0x1p1000;
    rounded.queries.push_back(query);
  }
  return result;
}

/// The outcome for all blocks up to the first fault. Counts those that can be scaled.
Outcome outcome_of_all(tests::DecideRescaled& decide) {
  Outcome all;
  for (const Block& block : blocks()) {
    const Outcome one = outcome(decide, block);
    if (!one.fault.empty()) {
      all.fault = one.fault + " of " + std::to_string(block.queries[0].coordinates[0]);
      break;
    }
    if (!block.can_be_scaled) continue;
    all.asked += one.asked;
    all.decided += one.decided;
  }
  return all;
}

TEST(Rescaling, DecidesQueriesOfAllSizesInFloatingPoint) {
  const Outcome all = outcome_of_all(decide_rescaled);
  EXPECT_EQ(all.fault, "");
  EXPECT_GT(all.decided, all.asked - all.asked / 10);
}

TEST(Rescaling, LeavesQueriesOfUsualSizeAlone) {
  Random random(33);
  for (const double distance : {0.0, 0.1}) {
    const Block block = block_of(random, ContactKind::edge_edge, {0, 0, 0}, distance);
    EXPECT_EQ(outcome(decide_rescaled, block).decided, 0U);
  }
}

TEST(Rescaling, PlantedFaultsAreFound) {
  for (const auto& fault : tests::planted_faults().rescaling) {
    EXPECT_NE(outcome_of_all(*fault.part).fault, "") << fault.name;
  }
}

}  // namespace
}  // namespace touchstone::fast::rescaling_test
