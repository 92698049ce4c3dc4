#include "verify/solvers/registry.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/built_files.hpp"

namespace touchstone::verify::solvers::registry_test {
namespace {

TEST(Registry, NamesAreUniqueAndFound) {
  std::set<std::string_view> names;
  for (const auto& method : methods()) {
    EXPECT_TRUE(names.insert(method->name()).second) << method->name();
    EXPECT_EQ(method->name().find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_"),
              std::string_view::npos)
        << method->name();
    EXPECT_NE(method->name(), "none") << "what the command line calls no method";
    EXPECT_EQ(&find_method(method->name()), method.get());
    EXPECT_EQ(find_info(method->name()), &method->info());
  }
  EXPECT_TRUE(names.contains("tight_inclusion"));
}

TEST(Registry, BaselinesStandBehindOurOwn) {
  std::vector<std::string_view> ours;
  std::vector<std::string_view> baselines;
  for (const auto& method : methods()) {
    const bool is_baseline = method->info().is_baseline;
    (is_baseline ? baselines : ours).push_back(method->name());
    EXPECT_EQ(is_baseline, !baselines.empty()) << method->name();
  }
  EXPECT_EQ(ours, (std::vector<std::string_view>{"certified", "tight_inclusion"}));
  EXPECT_EQ(baselines,
            (std::vector<std::string_view>{
                "accd", "accd_limited", "cubic", "inversion_cubic", "inversion_additive",
                "subdivision", "subdivision_largest_deviation", "sampling", "advancement"}));
}

TEST(Registry, DescriptionsHold) {
  std::ifstream file(std::filesystem::path(tests::source_folder()) / "docs" / "references.bib");
  const std::string keys{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  for (const auto& method : methods()) {
    const fast::MethodInfo& info = method->info();
    const std::string name(info.name);
    // Those for curves are in use, and in no publication.
    EXPECT_TRUE(!info.is_baseline || !info.reference.empty() || !info.terms.straight) << name;
    if (!info.reference.empty()) {
      EXPECT_NE(keys.find("{" + std::string(info.reference) + ","), std::string::npos) << name;
    }
    if (!info.variant_of.empty()) {
      EXPECT_EQ(find_method(info.variant_of).info().variant_of, "") << name;
    }
    EXPECT_GT(info.usual_max_checks, 0) << name;
  }
}

}  // namespace
}  // namespace touchstone::verify::solvers::registry_test
