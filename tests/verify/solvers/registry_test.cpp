#include "verify/solvers/registry.hpp"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/queries.hpp"

namespace touchstone::verify::registry_test {
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
  }
  EXPECT_TRUE(names.contains("tight_inclusion"));
}

TEST(Registry, AnUnknownNameIsAnErrorThatListsTheKnownOnes) {
  try {
    static_cast<void>(find_method("nonsense"));
    FAIL();
  } catch (const std::invalid_argument& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("nonsense"), std::string::npos) << message;
    for (const auto& method : methods()) {
      EXPECT_NE(message.find(method->name()), std::string::npos) << message;
    }
  }
}

TEST(Registry, EveryMethodTellsAHitFromAWideMiss) {
  const tests::PosedQuery hit = tests::over_triangle(1, 1, 1, -3);
  const tests::PosedQuery miss = tests::over_triangle(1, 1, 3, 1);
  const std::vector<Query> queries{hit.query, miss.query};
  for (const auto& method : methods()) {
    std::vector<fast::Answer> answers(2);
    method->solve(Kind::vertex_face, queries, answers, {});
    EXPECT_EQ(answers[0].verdict, fast::Verdict::yes) << method->name();
    EXPECT_EQ(answers[1].verdict, fast::Verdict::no) << method->name();
  }
}

TEST(Registry, JudgesUnaskedWhatPromisesSomethingInItsDefaultSetting) {
  EXPECT_EQ(default_methods(), (std::vector<std::string_view>{"certified", "tight_inclusion"}));
}

TEST(Registry, BaselinesStandBehindOurOwn) {
  std::vector<std::string_view> ours;
  std::vector<std::string_view> baselines;
  for (const auto& method : methods()) {
    (is_baseline(method->name()) ? baselines : ours).push_back(method->name());
    EXPECT_EQ(is_baseline(method->name()), !baselines.empty()) << method->name();
  }
  EXPECT_EQ(ours, (std::vector<std::string_view>{"certified", "tight_inclusion",
                                                 "tight_inclusion_published"}));
  EXPECT_EQ(baselines,
            (std::vector<std::string_view>{"tight_inclusion_released", "irf", "uirf", "fprf",
                                           "tccd", "rp", "rrp", "bsc", "msrf", "accd"}));
  EXPECT_FALSE(is_baseline("nonsense"));
}

TEST(Registry, PromisesHaveNames) {
  EXPECT_EQ(to_string(fast::Promise::none), "none");
  EXPECT_EQ(to_string(fast::Promise::conservative), "conservative");
  EXPECT_EQ(to_string(fast::Promise::exact), "exact");
}

}  // namespace
}  // namespace touchstone::verify::registry_test
