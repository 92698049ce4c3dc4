#include "tests/mutants/mutants.hpp"
#include "tests/support/built_files.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>

#include "tests/mutants/hunt.hpp"
#include "verify/fuzz/fuzz.hpp"
#include "verify/fuzz/plainness.hpp"
#include "verify/generate/decimal.hpp"
#include "verify/solvers/plugin.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::tests::mutants_test {
namespace {

TEST(Mutants, are_many_and_each_is_of_a_method) {
  std::set<std::string_view> names;
  std::size_t faulty = 0;
  for (const Mutant& mutant : mutants()) {
    EXPECT_TRUE(names.insert(mutant.name).second) << mutant.name;
    EXPECT_EQ(mutant.make()->promise(), verify::solvers::find_method(mutant.of).promise())
        << mutant.name;
    EXPECT_EQ(&find_mutant(mutant.name), &mutant);
    if (mutant.harmless.empty()) ++faulty;
  }
  EXPECT_GE(faulty, 20U);
  EXPECT_THROW((void)find_mutant("none"), std::invalid_argument);
}

/// Some of each sort that are found within a second or so; `./run soak` hunts all.
constexpr auto quick = std::to_array<std::string_view>({
    // Of Tight-Inclusion: the filter, the box test, the search.
    "filter_none",
    "filter_1000",
    "filter_10",
    "filter_3",
    "filter_min_for_max",
    "box_of_wrong_sign",
    "box_in_float",
    "box_of_one_sided_distance",
    "box_of_swapped_corners",
    "search_in_part_of_triangle",
    "search_of_edges_as_triangle",
    "search_split_off_by_one",
    "search_gives_upper_time",
    "search_out_of_order",
    "search_claims_its_tolerance",
    "search_forgets_the_remembered",
    // Of the certified solver: bounds, stages, the last one.
    "gap_bound_none",
    "determinant_bound_1000",
    "orientation_bound_1000",
    "kernel_without_product_error",
    "axis_of_start",
    "determinant_of_ends",
    "rejection_by_one",
    "zero_without_orientation",
    "refinement_unproved",
    "bounds_not_widened",
    "exact_without_boundary",
    "exact_without_last_bound",
    "exact_without_parallel_case",
    "root_at_start_missing",
    "root_at_end_missing",
    "coordinates_as_floats",
    "upper_for_lower",
    "other_norm",
});

TEST(Mutants, are_found) {
  std::size_t hunted = 0;
  for (const std::string_view name : quick) {
    if (std::ranges::find(mutants(), name, &Mutant::name) == mutants().end()) continue;
    ++hunted;
    const Hunt found = hunt(find_mutant(name), {.seconds = 0.0, .queries = 20'000});
    ASSERT_TRUE(found.finding) << name;
    EXPECT_EQ(found.finding->method, name);
  }
  EXPECT_GE(hunted, 20U) << "of those that every build plants";
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
  const Query query = simplest(mutant, *found.finding);
  EXPECT_EQ(verify::fuzz::degeneracy(found.finding->kind, query), 0U);
  EXPECT_LE(verify::fuzz::magnitudes(query).size(), 2U);
  for (const double x : verify::fuzz::magnitudes(query)) {
    EXPECT_EQ(verify::generate::shortest_decimal(x).count, 1) << x;
  }
}

bool is_everyday(double x) { return x == 0.0 || (std::abs(x) >= 1e-4 && std::abs(x) <= 1e4); }

/// The public Tight-Inclusion's filter and order of operations: soon, by a query that its users could have
/// met, and what is shown of it is one of few short numbers.
TEST(Released, is_found_by_a_query_of_everyday_size) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    bool found = false;
    const auto look_at = [&found](const verify::fuzz::Finding& finding) {
      const Query& query = finding.original.query;
      if (!std::ranges::all_of(query.coordinates, is_everyday)) return;
      found = true;
      const auto all = verify::fuzz::magnitudes(finding.simplest.query);
      EXPECT_LE(all.size(), 4U);
      for (const double x : all) {
        EXPECT_TRUE(x >= 1e-3 && x <= 1e3) << x;
        EXPECT_LE(verify::generate::shortest_decimal(x).count, 4) << x;
      }
    };
    (void)verify::fuzz::fuzz(verify::solvers::find_method("tight_inclusion_released"),
                             {.most_queries = 3000,
                              .seed = seed,
                              .method = {.max_checks = 10'000},
                              .shrink_seconds = 60.0,
                              .only = {verify::judge::Fault::false_negative},
                              .on_finding = look_at});
    EXPECT_TRUE(found) << "seed " << seed;
  }
}

/// In seconds, by the command line as anyone runs it.
TEST(Plugin, with_min_for_max_in_its_filter_is_found) {
  const std::string command = std::string("\"") + tests::touchstone_program() +
                              "\" fuzz --plugin \"" + tests::plugin_library("min_for_max") +
                              "\" --seconds 10 --most-findings 1";
  const int status = std::system((command + " > /dev/null").c_str());  // NOLINT(cert-env33-c)
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 1);
  const auto plugin = verify::solvers::load_plugin(tests::plugin_library("min_for_max"));
  const verify::fuzz::FuzzResult result =
      verify::fuzz::fuzz(*plugin, {.most_queries = 20'000, .seed = 1, .most_groups = 1});
  ASSERT_FALSE(result.findings.empty());
  EXPECT_TRUE(result.findings.front().original.collides);
}

}  // namespace
}  // namespace touchstone::tests::mutants_test
