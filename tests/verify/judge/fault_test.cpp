#include "verify/judge/fault.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <limits>
#include <set>
#include <string>
#include <vector>

namespace touchstone::verify::solvers::failure_test {
namespace {

using fast::Answer;
using fast::Verdict;

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(FailureKind, HasANameOfItsOwn) {
  std::set<std::string_view> names;
  for (const FailureKind kind : all_failure_kinds) {
    names.insert(to_string(kind));
    EXPECT_EQ(failure_kind_from_string(to_string(kind)), kind);
  }
  EXPECT_EQ(names.size(), failure_kinds);
  EXPECT_EQ(failure_kind_from_string("crashes"), std::nullopt);
}

TEST(Failure, IsALineOfTextAndBack) {
  const std::vector<std::pair<Failure, std::string>> texts{
      {{.kind = FailureKind::crash, .number = SIGSEGV}, "crash: SIGSEGV"},
      {{.kind = FailureKind::crash, .number = SIGXFSZ}, "crash: SIGXFSZ"},
      {{.kind = FailureKind::crash}, "crash: signal 0"},
      {{.kind = FailureKind::exit, .number = 3}, "exit: status 3"},
      {{.kind = FailureKind::exception, .what = "a: b"}, "exception: a: b"},
      {{.kind = FailureKind::no_verdict}, "no_verdict"},
      {{.kind = FailureKind::not_finite, .what = "toi_lower inf"}, "not_finite: toi_lower inf"},
      {{.kind = FailureKind::hang}, "hang"},
      {{.kind = FailureKind::undecided}, "undecided"}};
  for (const auto& [failure, text] : texts) {
    EXPECT_EQ(to_text(failure), text);
    EXPECT_EQ(failure_from_text(text), failure) << text;
  }
  EXPECT_EQ(failure_from_text(""), std::nullopt);
  EXPECT_EQ(failure_from_text("nonsense: crash"), std::nullopt);
  EXPECT_EQ(failure_from_text("crash: bang"), Failure{.kind = FailureKind::crash});
  EXPECT_EQ(to_text({.kind = FailureKind::exception, .what = "two\nlines\x1b"}),
            "exception: two\\x0alines\\x1b");
}

TEST(FailureOf, AnAnswerShowsItself) {
  EXPECT_EQ(failure_of({.verdict = Verdict::no}), std::nullopt);
  EXPECT_EQ(failure_of({.verdict = Verdict::yes, .toi_lower = 0.5}), std::nullopt);
  EXPECT_EQ(failure_of({.verdict = Verdict::no, .toi_lower = infinity}), std::nullopt);
  EXPECT_EQ(failure_of({.verdict = Verdict::error})->kind, FailureKind::no_verdict);
  EXPECT_EQ(failure_of({.verdict = Verdict::undecided})->kind, FailureKind::undecided);
  EXPECT_EQ(to_text(failure_of({.verdict = Verdict::yes, .toi_lower = infinity}).value()),
            "not_finite: toi_lower inf");
  EXPECT_EQ(to_text(failure_of({.verdict = Verdict::yes, .toi_upper = -infinity}).value()),
            "not_finite: toi_upper -inf");
}

TEST(VerdictOf, OnlyIndecisionIsConservative) {
  for (const FailureKind kind : all_failure_kinds) {
    const bool is_undecided = kind == FailureKind::undecided || kind == FailureKind::hang;
    EXPECT_EQ(verdict_of(kind), is_undecided ? Verdict::undecided : Verdict::error);
  }
}

}  // namespace
}  // namespace touchstone::verify::solvers::failure_test
