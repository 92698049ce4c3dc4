#include "verify/judge/fault.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <limits>
#include <set>
#include <string>
#include <vector>

namespace touchstone::verify::judge::fault_test {
namespace {

using fast::Verdict;

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Fault, HasANameOfItsOwnAndATextAndALetter) {
  std::set<std::string_view> names, texts;
  for (const Fault fault : all_faults) {
    names.insert(to_string(fault));
    texts.insert(to_text(fault));
    EXPECT_EQ(fault_from_name(to_string(fault)), fault);
    // Tables and maps count all errors as one.
    const std::optional<Fault> found = fault_from_text(to_text(fault));
    EXPECT_EQ(found, is_error(fault) ? Fault::crash : fault);
    EXPECT_EQ(letter_of(fault), letter_of(*found));
  }
  EXPECT_EQ(names.size(), fault_count);
  EXPECT_EQ(texts.size(), fault_count - 4);
  EXPECT_EQ(fault_from_name("crashes"), std::nullopt);
  EXPECT_EQ(fault_from_text("crash"), std::nullopt);
}

TEST(Failure, IsALineOfTextAndBack) {
  const std::vector<std::pair<Failure, std::string>> texts{
      {{.kind = Fault::crash, .number = SIGSEGV}, "crash: SIGSEGV"},
      {{.kind = Fault::crash, .number = SIGXFSZ}, "crash: SIGXFSZ"},
      {{.kind = Fault::crash}, "crash: signal 0"},
      {{.kind = Fault::exit, .number = 3}, "exit: status 3"},
      {{.kind = Fault::exception, .what = "a: b"}, "exception: a: b"},
      {{.kind = Fault::no_verdict}, "no_verdict"},
      {{.kind = Fault::not_finite, .what = "toi_lower inf"}, "not_finite: toi_lower inf"},
      {{.kind = Fault::hang}, "hang"},
      {{.kind = Fault::undecided}, "undecided"}};
  for (const auto& [failure, text] : texts) {
    EXPECT_EQ(to_text(failure), text);
    EXPECT_EQ(failure_from_text(text), failure) << text;
  }
  EXPECT_EQ(failure_from_text(""), std::nullopt);
  EXPECT_EQ(failure_from_text("nonsense: crash"), std::nullopt);
  EXPECT_EQ(failure_from_text("false_negative"), std::nullopt) << "no failure";
  EXPECT_EQ(failure_from_text("crash: bang"), Failure{.kind = Fault::crash});
  EXPECT_EQ(to_text({.kind = Fault::exception, .what = "two\nlines\x1b"}),
            "exception: two\\x0alines\\x1b");
}

TEST(FailureOf, AnAnswerShowsItself) {
  EXPECT_EQ(failure_of({.verdict = Verdict::no}), std::nullopt);
  EXPECT_EQ(failure_of({.verdict = Verdict::yes, .toi_lower = 0.5}), std::nullopt);
  EXPECT_EQ(failure_of({.verdict = Verdict::no, .toi_lower = infinity}), std::nullopt);
  EXPECT_EQ(failure_of({.verdict = Verdict::error})->kind, Fault::no_verdict);
  EXPECT_EQ(failure_of({.verdict = Verdict::undecided})->kind, Fault::undecided);
  EXPECT_EQ(to_text(failure_of({.verdict = Verdict::yes, .toi_lower = infinity}).value()),
            "not_finite: toi_lower inf");
  EXPECT_EQ(to_text(failure_of({.verdict = Verdict::yes, .toi_upper = -infinity}).value()),
            "not_finite: toi_upper -inf");
  EXPECT_EQ(to_text(failure_of({.verdict = Verdict::yes, .tolerance = -1.0}).value()),
            "not_finite: tolerance -1");
}

}  // namespace
}  // namespace touchstone::verify::judge::fault_test
