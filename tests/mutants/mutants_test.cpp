#include "tests/mutants/mutants.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>

#include "tests/mutants/hunt.hpp"
#include "verify/fuzz/fuzz.hpp"
#include "verify/methods/plugin.hpp"
#include "verify/methods/registry.hpp"

namespace touchstone::tests {
namespace {

TEST(Mutants, are_many_and_each_is_of_a_method) {
  std::set<std::string_view> names;
  std::size_t faulty = 0;
  for (const Mutant& mutant : mutants()) {
    EXPECT_TRUE(names.insert(mutant.name).second) << mutant.name;
    EXPECT_EQ(mutant.make()->promise(), verify::find_method(mutant.of).promise()) << mutant.name;
    EXPECT_EQ(&find_mutant(mutant.name), &mutant);
    faulty += mutant.harmless.empty();
  }
  EXPECT_GE(faulty, 20U);
  EXPECT_THROW((void)find_mutant("none"), std::invalid_argument);
}

/// Some of each sort that are found within a second or so; `./run soak` hunts all.
constexpr auto quick = std::to_array<std::string_view>({
    "filter_none",
    "box_of_wrong_sign",
});

TEST(Mutants, are_found) {
  for (const std::string_view name : quick) {
    const Hunt found = hunt(find_mutant(name), {.seconds = 0.0, .queries = 100'000});
    ASSERT_TRUE(found.finding) << name;
    EXPECT_EQ(found.finding->method, name);
  }
}

TEST(Mutants, that_are_harmless_are_not_found) {
  for (const Mutant& mutant : mutants()) {
    if (mutant.harmless.empty()) continue;
    const Hunt found = hunt(mutant, {.seconds = 0.0, .queries = 10'000});
    EXPECT_FALSE(found.finding) << mutant.name;
    EXPECT_EQ(found.queries, 10'000U);
  }
}

TEST(Mutants, become_simple_queries) {
  const Mutant& mutant = find_mutant("root_at_start_missing");
  const Hunt found = hunt(mutant, {.seconds = 0.0, .queries = 100'000});
  ASSERT_TRUE(found.finding);
  EXPECT_EQ(simplest(mutant, *found.finding), Query{});
}

TEST(Plugin, with_min_for_max_in_its_filter_is_found) {
  const auto plugin = verify::load_plugin(TOUCHSTONE_MIN_FOR_MAX);
  const verify::FuzzResult result =
      verify::fuzz(*plugin, {.seconds = 10.0, .seed = 1, .most_findings = 1});
  ASSERT_FALSE(result.findings.empty());
  EXPECT_EQ(result.findings.front().what, verify::FindingKind::false_negative);
}

}  // namespace
}  // namespace touchstone::tests
