#include "verify/solvers/answers.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "tests/verify/data/dataset_fixture.hpp"
#include "verify/io/printable.hpp"

namespace touchstone::verify::solvers::answers_test {
namespace {

using data::test::TemporaryFolder;
using fast::Answer;
using fast::Verdict;

constexpr auto vf = ContactKind::vertex_face;
constexpr auto ee = ContactKind::edge_edge;
/// The header without the last column, which files may omit.
const std::string header = "file,index,kind,verdict,toi_lower,toi_upper,tolerance\n";
const std::string full_header = "file,index,kind,verdict,toi_lower,toi_upper,tolerance,failure\n";
constexpr double infinity = std::numeric_limits<double>::infinity();

/// The answers of a file with this text.
RecordedAnswers load(const std::string& text) {
  const TemporaryFolder folder;
  return load_answers(folder.file("answers.csv", text));
}

std::string error_in(const std::string& text) {
  const TemporaryFolder folder;
  const auto file = folder.file("answers.csv", text);
  return data::test::error_of(folder.path(), [&] { static_cast<void>(load_answers(file)); });
}

void expect_same_bits(double a, double b) {
  if (std::isnan(a) && std::isnan(b)) return;
  EXPECT_EQ(std::bit_cast<std::uint64_t>(a), std::bit_cast<std::uint64_t>(b)) << a << ' ' << b;
}

void expect_same(const std::optional<RecordedAnswer>& recorded, const Answer& b,
                 std::optional<judge::Fault> failure = std::nullopt) {
  ASSERT_TRUE(recorded.has_value());
  const Answer& a = recorded->answer;
  EXPECT_EQ(a.verdict, b.verdict);
  expect_same_bits(a.toi_lower, b.toi_lower);
  expect_same_bits(a.toi_upper, b.toi_upper);
  expect_same_bits(a.tolerance, b.tolerance);
  EXPECT_EQ(recorded->failure, failure);
}

// ---- Writing ------------------------------------------------------------------------------------

TEST(AnswerRow, IsWrittenAsDocumented) {
  EXPECT_EQ(answers_header(), full_header);
  const Answer no{.verdict = Verdict::no}, error{.verdict = Verdict::error},
      undecided{.verdict = Verdict::undecided};
  EXPECT_EQ(answer_row("a,\"b\".csv", 3, vf, {Verdict::yes, 0, 0.1, 0.25, 1e-6}),
            "\"a,\"\"b\"\".csv\",3,vertex-face,yes,0.1,0.25,1e-06,\n");
  struct Case {
    Answer answer;
    std::optional<judge::Failure> failure;
    std::string row;
  };
  const std::vector<Case> cases{
      {no, {}, "no,,,,"},
      {{.verdict = Verdict::undecided, .tolerance = 0.5}, {}, "undecided,,,0.5,"},
      {error, {}, "error,,,,no_verdict"},
      {{.verdict = Verdict::yes, .toi_upper = 1.0}, {}, "yes,,1,,"},
      {error, {{.kind = judge::Fault::crash, .number = 11}}, "error,,,,crash: SIGSEGV"},
      {undecided, {{.kind = judge::Fault::hang}}, "undecided,,,,hang"},
      {error, {{.kind = judge::Fault::exception, .what = "a,b"}}, "error,,,,\"exception: a,b\""},
      // Readers refuse an infinite time.
      {{.verdict = Verdict::yes, .toi_lower = infinity}, {}, "error,,,,not_finite: toi_lower inf"}};
  for (const auto& [answer, failure, row] : cases) {
    EXPECT_EQ(answer_row("a", 0, ee, answer, failure ? &*failure : nullptr),
              "a,0,edge-edge," + row + "\n");
  }
}

/// Names that CSV quotes, that are formulas in a spreadsheet, or that are not printed, too.
TEST(Answers, ReadAsTheyWereWritten) {
  std::mt19937_64 random(5);
  const auto finite = [&random] {
    double x = 0.0;
    do {
      x = std::bit_cast<double>(random());
    } while (!std::isfinite(x));
    return x;
  };
  std::vector<Answer> written{
      {Verdict::no},
      {Verdict::undecided},
      {Verdict::error},
      {Verdict::yes},
      {Verdict::yes, 0, -0.0, std::numeric_limits<double>::denorm_min(), 0.0},
      {Verdict::yes, 0, 0.25, 0.5, infinity}};
  for (int i = 0; i < 400; ++i) {
    written.push_back({Verdict::yes, 0, finite(), finite(), std::abs(finite())});
  }
  for (const std::string name :
       {"n,\n\"", "=1+1.csv", "'=1.csv", "-a.csv", "a\x1b[2J\n\u202e.csv", "caf\xe9.csv"}) {
    std::string text = answers_header();
    for (std::size_t i = 0; i < written.size(); ++i) {
      const std::string row = answer_row(name, i, ee, written[i]);
      text += row;
      EXPECT_EQ(std::string_view("=+-@").find(row.front()), std::string_view::npos) << row;
      EXPECT_TRUE(name.front() == 'n' || io::is_printable(row.substr(0, row.size() - 1))) << row;
    }
    const RecordedAnswers answers = load(text);
    ASSERT_EQ(answers.unasked(), written.size());
    for (std::size_t i = 0; i < written.size(); ++i) {
      expect_same(answers.answer_to(name, ee, i), written[i],
                  i == 2 ? std::optional(judge::Fault::no_verdict) : std::nullopt);
    }
  }
  // Rows as other programs may write them.
  EXPECT_TRUE(load(header + "=1+1.csv,0,vertex-face,no,,,\n").answer_to("=1+1.csv", vf, 0));
}

// ---- Reading ------------------------------------------------------------------------------------

TEST(LoadAnswers, ReadsEveryVerdict) {
  struct Case {
    std::string row;
    Answer answer;
    std::optional<judge::Fault> failure = {};
  };
  const Answer no{.verdict = Verdict::no}, error{.verdict = Verdict::error},
      undecided{.verdict = Verdict::undecided};
  const std::vector<Case> cases{
      {"no,,,,", no},
      {"yes,0.25,0.5,1e-3,", {Verdict::yes, 0, 0.25, 0.5, 1e-3}},
      {"undecided,,,,", undecided},
      {"error,,,,", error},
      {"yes,,,,", {.verdict = Verdict::yes}},
      // Why there is no answer.
      {"error,,,,crash: SIGSEGV", error, judge::Fault::crash},
      {"undecided,,,,hang", undecided, judge::Fault::hang},
      // Times without a yes may be any number, and are dropped.
      {"no,1,1,0.5,", {.verdict = Verdict::no, .tolerance = 0.5}},
      {"undecided,0,1,0.5,", {.verdict = Verdict::undecided, .tolerance = 0.5}},
      {"no,inf,inf,inf,", {.verdict = Verdict::no, .tolerance = infinity}},
      {"undecided,-inf,nan,,", undecided},
      {"error,nan,inf,0,", {.verdict = Verdict::error, .tolerance = 0.0}},
      // An infinite tolerance claims nothing.
      {"yes,0.25,0.5,inf,", {Verdict::yes, 0, 0.25, 0.5, infinity}},
      // The range of times is left to the judge.
      {"yes,-1e-17,1.5,,", {.verdict = Verdict::yes, .toi_lower = -1e-17, .toi_upper = 1.5}},
      // Spaces around all fields but the name.
      {" yes , 0.5 ,\t, ,", {.verdict = Verdict::yes, .toi_lower = 0.5}}};
  for (const auto& [row, answer, failure] : cases) {
    SCOPED_TRACE(row);
    expect_same(load(full_header + " a , 5 , edge-edge ," + row).answer_to(" a ", ee, 5), answer,
                failure);
  }
}

TEST(LoadAnswers, TakesAFileWithoutAnswers) { EXPECT_TRUE(load(header).groups().empty()); }

// ---- Requests -----------------------------------------------------------------------------------

TEST(RecordedAnswers, SayWhatWasNeverAskedFor) {
  const RecordedAnswers answers = load(header +
                                       "\"b,c\",1,edge-edge,no,,,\n"
                                       "a,2,vertex-face,no,,,\n"
                                       "a,0,vertex-face,yes,0.25,,\n"
                                       "a,1,vertex-face,error,,,\n"
                                       "a,1,edge-edge,no,,,\n");
  EXPECT_EQ(answers.unasked(), 5U);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(answers.answer_to("a", vf, 0)->answer.toi_lower, 0.25);
    EXPECT_FALSE(answers.answer_to("a", vf, 9).has_value());
    EXPECT_FALSE(answers.answer_to("a", ee, 0).has_value());
    EXPECT_FALSE(answers.answer_to("", vf, 0).has_value());
    EXPECT_EQ(answers.answer_to("b,c", ee, 1)->answer.verdict, Verdict::no);
  }
  EXPECT_EQ(answers.unasked(), 3U);

  const std::vector<RecordedAnswers::Group> groups = answers.groups();
  std::string text;
  for (const RecordedAnswers::Group& group : groups) {
    text +=
        fmt::format("{} {}: {} answers, {} unasked from line {}; ", group.file,
                    to_string(group.kind), group.answers, group.unasked, group.first_unasked_line);
  }
  EXPECT_EQ(text,
            "a vertex-face: 3 answers, 2 unasked from line 5; "
            "a edge-edge: 1 answers, 1 unasked from line 6; "
            "b,c edge-edge: 1 answers, 0 unasked from line 0; ");
}

TEST(RecordedAnswers, MayBeAskedFromSeveralThreads) {
  constexpr std::uint64_t count = 10'000;
  std::string text;
  for (std::uint64_t i = 0; i < count; ++i) {
    text += answer_row("a", i, vf, {.verdict = Verdict::yes, .toi_lower = static_cast<double>(i)});
  }
  const RecordedAnswers answers = load(answers_header() + text);
  std::vector<std::uint64_t> right(4);
  {
    std::vector<std::jthread> threads;
    for (std::uint64_t thread = 0; thread < 4; ++thread) {
      threads.emplace_back([&, thread] {
        for (std::uint64_t i = thread / 2; i < count; i += 2) {
          const auto answer = answers.answer_to("a", vf, i);
          right[thread] += answer && answer->answer.toi_lower == static_cast<double>(i) ? 1U : 0U;
        }
      });
    }
  }
  EXPECT_EQ(right, std::vector<std::uint64_t>(4, count / 2));
  EXPECT_EQ(answers.unasked(), 0U);
}

// ---- Errors -------------------------------------------------------------------------------------

TEST(LoadAnswers, NeedsAFileWithItsHeader) {
  const std::string reason =
      "first line must be file,index,kind,verdict,toi_lower,toi_upper,tolerance[,failure]";
  EXPECT_EQ(error_in(""), "answers.csv: " + reason);
  for (const std::string other :
       {"a,0,vertex-face,no,,,", "index,file,kind,verdict,toi_lower,toi_upper,tolerance",
        "file,index,kind,verdict,toi_lower,toi_upper",
        "file,index,kind,verdict,toi_lower,toi_upper,tolerance,x"}) {
    EXPECT_EQ(error_in(other + "\n"), "answers.csv:1: " + reason);
  }
}

TEST(LoadAnswers, NamesLineColumnAndReason) {
  const std::vector<std::pair<std::string, std::string>> rows{
      {"a,0,vertex-face,no,,", "6 columns, expected 7"},
      {"a,0,vertex-face,no,,,,", "8 columns, expected 7"},
      {"", "blank line before the end of the file"},
      {"\"a\"b,0,vertex-face,no,,,", "1: text after a quoted field"},
      {"\"a,1,vertex-face,no,,,", "1: quoted field does not end"},
      {",0,vertex-face,no,,,", "1: no file name"},
      {"a,-1,vertex-face,no,,,", "2: index must be a whole number from 0 on: \"-1\""},
      {"a,18446744073709551616,vertex-face,no,,,",
       "2: index must be a whole number from 0 on: \"18446744073709551616\""},
      {"a,0,vf,no,,,",
       "3: kind must be vertex-face, edge-edge, tetrahedron or plane-triangle: \"vf\""},
      {"a,0,vertex-face,1,,,", "4: verdict must be yes, no, undecided or error: \"1\""},
      {"a,0,vertex-face,yes,half,,", "5: must be a finite double or empty: \"half\""},
      {"a,0,vertex-face,yes,nan,,", "5: must be a finite double or empty: \"nan\""},
      {"a,0,vertex-face,no,soon,,", "5: must be a finite double or empty: \"soon\""},
      {"a,0,vertex-face,yes,,-inf,", "6: must be a finite double or empty: \"-inf\""},
      {"a,0,vertex-face,yes,,1e999,", "6: must be a finite double or empty: \"1e999\""},
      {"a,0,vertex-face,yes,,,1e-6 m", "7: must be a double or empty: \"1e-6 m\""},
      {"a,0,vertex-face,yes,,,nan", "7: must be a double or empty: \"nan\""},
      {"a,0,vertex-face,yes,,,-1", "7: tolerance must not be negative"},
  };
  for (const auto& [row, error] : rows) {
    std::string expected = "answers.csv:3:";
    if (error.substr(1, 1) != ":") expected += ' ';
    expected += error;
    EXPECT_EQ(error_in(header + "a,9,vertex-face,no,,,\n" + row + "\nb,0,vertex-face,no,,,\n"),
              expected)
        << row;
  }
  EXPECT_EQ(error_in(full_header + "a,0,edge-edge,error,,,,bang\n"),
            "answers.csv:2:8: must be a kind of failure or empty: \"bang\"");
  EXPECT_EQ(error_in(full_header + "a,0,edge-edge,no,,,,crash\n"),
            "answers.csv:2:8: the failure crash contradicts the verdict no");
  EXPECT_EQ(error_in(full_header + "a,0,edge-edge,no,,,\n"),
            "answers.csv:2: 7 columns, expected 8");
}

TEST(LoadAnswers, FindsQueriesAnsweredTwice) {
  EXPECT_EQ(
      error_in(header + "a,0,vertex-face,no,,,\na,1,vertex-face,no,,,\na,1,vertex-face,no,,,\n"),
      "answers.csv:4:2: vertex-face query 1 of \"a\" is answered in line 3 already");
  EXPECT_EQ(error_in(header + "a,5,edge-edge,no,,,\n"
                              "a,2,edge-edge,no,,,\n"
                              "b,2,edge-edge,no,,,\n"
                              "a,5,edge-edge,yes,,,\n"),
            "answers.csv:5:2: edge-edge query 5 of \"a\" is answered in line 2 already");
}

}  // namespace
}  // namespace touchstone::verify::solvers::answers_test
