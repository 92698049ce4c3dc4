#include "verify/fuzz/fuzz.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "fast/method.hpp"
#include "tests/support/certificates.hpp"
#include "tests/support/methods.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/shared_counter.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/oracle.hpp"
#include "verify/base/any_decision.hpp"
#include "verify/fuzz/plainness.hpp"
#include "verify/fuzz/recheck.hpp"
#include "verify/judge/ground_truth.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::verify::fuzz::fuzz_test {
namespace {

using fast::Answer;
using fast::Promise;
using fast::Verdict;
using tests::FunctionMethod;
using namespace std::chrono_literals;

/// The right answer, by the fast solver.
Answer honest(AnyKind kind, const Query& query) {
  fast::CertifiedResult result;
  base::solve({kind, {&query, 1}}, {&result, 1}, {.max_threads = 1});
  return answer_of(result);
}

fast::MethodInfo promising(Promise promise) { return {.name = "function", .promise = promise}; }

constexpr std::uint64_t enough = 20'000;

FuzzResult search(const FunctionMethod::Function& function, const fast::MethodInfo& info,
                  FuzzOptions options = {}) {
  const FunctionMethod method(function, info);
  if (options.most_queries == 0) options.most_queries = enough;
  if (options.most_groups == 0) options.most_groups = 1;
  return fuzz(method, options);
}

const std::vector<AnyShape> cells{{CellKind::tetrahedron}, {CellKind::plane_triangle}};

std::vector<AnyShape> shapes(std::size_t degree, bool is_rational = false) {
  return {{ContactKind::vertex_face, degree, is_rational},
          {ContactKind::edge_edge, degree, is_rational}};
}

/// The certified solver's answers to queries on curves, changed.
FunctionMethod on_curves(const std::function<void(const AnyQueries&, Answer&)>& change,
                         Promise promise = Promise::exact) {
  return {[change](const AnyQueries& one) {
            fast::CertifiedResult result;
            base::solve(one, {&result, 1}, {.max_threads = 1});
            Answer answer = answer_of(result);
            change(one, answer);
            return answer;
          },
          {.name = "function",
           .promise = promise,
           .terms = {.least_degree = 1, .most_degree = greatest_degree, .rational = true}}};
}

// ---- Faults -------------------------------------------------------------------------------------

using Change = std::function<void(const Query&, Answer&)>;

/// A method that is right but for this change, and the fault to be found.
struct Planted {
  const char* name;
  judge::Fault fault;
  fast::MethodInfo info;
  Change change;
  /// Without the oracle's share: the judge must doubt the answer.
  FuzzOptions options = {.oracle_share = 0.0};
};

/// What is done at some queries instead of an answer.
Change at_some(const std::function<void()>& act) {
  return [act](const Query& query, Answer&) {
    if (query.at(0, 1, 1) == query.at(1, 1, 1) && query.at(0, 1, 1) != 0.0) act();
  };
}

/// Yes to all queries, and so a claim that their distance is within the tolerance.
Change yes_within(double tolerance) {
  return [tolerance](const Query&, Answer& answer) {
    answer = {.verdict = Verdict::yes, .toi_lower = 0.0, .tolerance = tolerance};
  };
}

/// No to inversions of cells of which this is true.
Planted missed_cell(const char* name, bool (*is_missed)(const Query&, const Answer&)) {
  return {name,
          judge::Fault::false_negative,
          {.name = "function",
           .promise = Promise::conservative,
           .terms = {.contacts = {false, false}, .cells = {true, false}}},
          [is_missed](const Query& query, Answer& answer) {
            if (answer.verdict == Verdict::yes && is_missed(query, answer)) {
              answer = {.verdict = Verdict::no};
            }
          },
          {.shapes = {{CellKind::tetrahedron}}, .oracle_share = 0.0}};
}

TEST(Fuzz, FindsEveryPlantedFault) {
  using enum judge::Fault;
  const fast::MethodInfo nothing = promising(Promise::none), exactly = promising(Promise::exact),
                         conservatively = promising(Promise::conservative);
  fast::MethodInfo filtered = conservatively;
  filtered.filter = fast::error_filter;
  const auto right = [](const Query&, Answer&) {};
  const Separation linf{.distance = 0.25, .norm = Norm::linf}, l2{0.25, Norm::l2};
  const std::vector<Planted> all{
      {"always no", false_negative, nothing,
       [](const Query&, Answer& answer) { answer = {.verdict = Verdict::no}; }},
      {"a time that is late by the least", late_toi, conservatively,
       [](const Query&, Answer& answer) {
         if (answer.verdict == Verdict::yes)
           answer.toi_lower = std::nextafter(answer.toi_upper, 2.0);
         answer.toi_upper = Answer::none;
       }},
      {"an upper bound that is early", early_toi_upper, conservatively,
       [](const Query&, Answer& answer) {
         answer.toi_upper = answer.toi_lower;
         answer.toi_lower = Answer::none;
       }},
      {"an infinite time", not_finite, conservatively,
       [](const Query& query, Answer& answer) {
         if (query.at(0, 0, 0) == query.at(1, 0, 0)) answer.toi_lower = -HUGE_VAL;
       }},
      {"a negative tolerance", not_finite, conservatively,
       [](const Query&, Answer& answer) {
         if (answer.toi_lower > 0.5) answer.tolerance = -1.0;
       }},
      {"the bound of some collisions is missing", not_finite, conservatively,
       [](const Query& query, Answer& answer) {
         if (query.at(0, 0, 0) == 1.0 && query.at(1, 0, 0) == 1.0) answer.toi_lower = Answer::none;
       }},
      {"an error", no_verdict, nothing,
       [](const Query&, Answer& answer) { answer = {.verdict = Verdict::error}; }},
      {"undecided", undecided, exactly, [](const Query&, Answer& answer) { answer = {}; }},
      {"crash: SIGABRT", crash, nothing, at_some([] { std::abort(); })},
      {"exit: status 3", exit, nothing, at_some([] { std::_Exit(3); })},
      {"exception: thrown", exception, nothing,
       at_some([] { throw std::runtime_error("thrown"); })},
      {"always yes", false_positive, exactly, yes_within(Answer::none)},
      {"always yes, asked for exactness",
       false_positive,
       nothing,
       yes_within(Answer::none),
       {.promise = Promise::exact}},
      {"beyond tolerance and filter", beyond_tolerance, filtered, yes_within(1e-9)},
      {"beyond contact", beyond_tolerance, conservatively, yes_within(0.0)},
      {"beyond a separation",
       beyond_tolerance,
       nothing,
       yes_within(0.0),
       {.separation = l2, .oracle_share = 0.0}},
      {"ignores the separation",
       false_negative,
       conservatively,
       right,
       {.separation = linf, .only = {false_negative}}},
      {"ignores the separation in L2",
       false_negative,
       conservatively,
       right,
       {.separation = l2, .only = {false_negative}}},
      missed_cell("where a volume only touches 0",
                  [](const Query& query, const Answer&) {
                    Query end = query;
                    std::copy_n(query.coordinates.begin() + 12, 12, end.coordinates.begin());
                    return !exact::first_inversion(CellKind::tetrahedron, end);
                  }),
      missed_cell("at the end",
                  [](const Query&, const Answer& answer) { return answer.toi_upper == 1.0; }),
      missed_cell("of an orientation", [](const Query& query, const Answer&) {
        return query.at(0, 1, 0) < query.at(0, 0, 0) && query.at(0, 2, 0) > query.at(0, 0, 0);
      })};
  for (const Planted& planted : all) {
    SCOPED_TRACE(planted.name);
    const auto altered = [&](AnyKind kind, const Query& query) {
      Answer answer = honest(kind, query);
      planted.change(query, answer);
      return answer;
    };
    const FuzzResult result = search(altered, planted.info, planted.options);
    ASSERT_FALSE(result.findings.empty());
    const Finding& finding = result.findings.front();
    EXPECT_EQ(to_string(finding.what), to_string(planted.fault)) << finding.original.detail;
    EXPECT_EQ(finding.method, "function");
    EXPECT_EQ(finding.separation, planted.options.separation);
    EXPECT_FALSE(finding.original.detail.empty());
    EXPECT_FALSE(finding.generator.empty());
    EXPECT_EQ(finding.original.collides,
              base::decide(finding.original.query.queries(), 0, finding.separation).collides());
    // Simplification was not requested.
    EXPECT_EQ(finding.simplest.query, finding.original.query);
    EXPECT_EQ(finding.shrinking, Shrinking::not_tried);
    EXPECT_EQ(result.queries, finding.queries);
    EXPECT_GE(result.all_findings, 1U);
    EXPECT_TRUE(std::string_view(planted.name) != "always no" || result.queries < 2000U);
    if (planted.fault == crash || planted.fault == exit || planted.fault == exception) {
      EXPECT_EQ(finding.original.detail, planted.name);
    }
  }
}

/// Of lines, curves and cells, with a separation and without.
TEST(Fuzz, FindsNothingWhereNothingIsWrong) {
  struct Sound {
    const fast::Method& method;
    std::uint64_t queries;
    FuzzOptions options = {};
  };
  const auto yes = [](double tolerance) {
    return FunctionMethod(
        [tolerance](AnyKind, const Query& query) {
          Answer answer;
          yes_within(tolerance)(query, answer);
          return answer;
        },
        promising(Promise::conservative));
  };
  const FunctionMethod always_yes = yes(Answer::none), always_near = yes(HUGE_VAL);
  const FunctionMethod timeless(
      [](AnyKind kind, const Query& query) -> Answer {
        return {.verdict = honest(kind, query).verdict};
      },
      promising(Promise::exact));
  const fast::Method &certified = solvers::find_method("certified"),
                     &tight = solvers::find_method("tight_inclusion");
  const std::uint64_t some = tests::trials(std::uint64_t{2400});
  std::vector<Sound> all{
      {certified, tests::trials(std::uint64_t{6000})},
      // The oracle takes a hundred times as long with a distance.
      {certified, tests::trials(std::uint64_t{160}), {.separation = {1e-3, Norm::l2}}},
      {certified, tests::trials(std::uint64_t{6000}), {.shapes = cells}},
      {tight, some / 2, {.method = {.max_checks = 200}, .query_limit_seconds = 30.0}},
      {tight,
       some / 6,
       {.method = {.max_checks = 2000}, .query_limit_seconds = 30.0, .shapes = shapes(2)}},
      {always_yes, some},
      {always_near, some},
      {timeless, some}};
  for (const Separation& separation :
       {Separation{}, Separation{0.25, Norm::linf}, Separation{0.25, Norm::l2}}) {
    for (const auto& [degree, is_rational] : {std::pair(2U, false), {3U, false}, {2U, true}}) {
      // A block and some images.
      all.push_back(
          {certified, 300, {.separation = separation, .shapes = shapes(degree, is_rational)}});
    }
  }
  for (auto& [method, queries, options] : all) {
    options.most_queries = queries;
    const FuzzResult result = fuzz(method, options);
    SCOPED_TRACE(std::string(method.name()) + " " + std::to_string(queries));
    EXPECT_EQ(result.all_findings, 0U);
    EXPECT_TRUE(result.findings.empty());
    EXPECT_EQ(result.queries, queries);
    EXPECT_TRUE(result.images > 0 || queries < 256) << "within a block there are none";
    if (&method == &certified) {
      EXPECT_EQ(result.judged_by_oracle, result.queries);
      EXPECT_GT(result.collisions, result.queries / 20);
      EXPECT_TRUE(result.collisions < result.queries || queries < 256);
    }
    EXPECT_TRUE(&method != &tight || result.judged_by_oracle < result.queries);
  }
}

/// A method that is wrong only if the first point is on the left: the image of a query on the
/// right.
TEST(Fuzz, FindsWhatIsWrongInAMirror) {
  const FunctionMethod one_sided = on_curves([](const AnyQueries& one, Answer& answer) {
    if (one.numbers[0] < 0.0 && one.numbers[3] >= 0.0) answer.verdict = Verdict::no;
  });
  for (const std::size_t degree : {1U, 2U}) {
    FuzzOptions options{.most_queries = 2000, .most_groups = 1000, .shapes = shapes(degree)};
    const FuzzResult result = fuzz(one_sided, options);
    EXPECT_GT(result.images, result.queries / 20);
    const auto found = std::ranges::find(result.findings, judge::Fault::asymmetry, &Finding::what);
    ASSERT_NE(found, result.findings.end());
    EXPECT_LT(found->original.query.numbers()[0], 0.0);
    EXPECT_NE(found->original.detail.find("exact image"), std::string::npos);
    // Without the promise exact only the wrong answer counts.
    options.promise = Promise::conservative;
    const auto is_asymmetry = [](const Finding& finding) {
      return finding.what == judge::Fault::asymmetry;
    };
    EXPECT_TRUE(std::ranges::none_of(fuzz(one_sided, options).findings, is_asymmetry));
  }
}

Answer sometimes_wrong(AnyKind kind, const Query& query) {
  Answer answer = honest(kind, query);
  if (query.at(0, 0, 0) < query.at(1, 2, 1)) answer.verdict = Verdict::no;
  return answer;
}

/// Contacts missed at t=0 and crashes, of both kinds: each group has one fault, kind and shape.
TEST(Fuzz, PutsFindingsInGroupsByFaultKindAndShape) {
  const auto ill = [](AnyKind kind, const Query& query) {
    const Answer answer = honest(kind, query);
    if (answer.verdict == Verdict::yes && answer.toi_upper == 0.0) {
      return Answer{.verdict = Verdict::no};
    }
    if (answer.verdict == Verdict::yes && query.at(0, 0, 0) == query.at(1, 2, 1)) std::abort();
    return answer;
  };
  const FuzzResult result =
      search(ill, promising(Promise::none),
             {.most_queries = 2400, .most_groups = 1000, .shrink_seconds = 60.0});
  std::uint64_t count = 0;
  std::set<judge::Fault> faults;
  std::set<Signature> signatures;
  for (const FindingGroup& group : result.groups) {
    const Finding& best = result.findings.at(group.best);
    count += group.count;
    faults.insert(best.what);
    EXPECT_TRUE(signatures.insert(signature_of(best)).second);
  }
  EXPECT_EQ(count, result.all_findings);
  EXPECT_EQ(faults, (std::set{judge::Fault::false_negative, judge::Fault::crash}));
  EXPECT_GT(result.findings.size(), result.groups.size());
  for (const Finding& finding : result.findings) {
    const Finding& best = result.findings.at(result.groups.at(finding.group).best);
    EXPECT_EQ(signature_of(finding), signature_of(best));
    EXPECT_LE(plainness(best.simplest.query), plainness(finding.simplest.query));
    EXPECT_LE(plainness(finding.simplest.query), plainness(finding.original.query));
  }
}

/// The method is wrong at one coordinate that only the corpus contains.
TEST(Fuzz, MutatesTheCorpus) {
  static constexpr double rare = 0x1.23456789abcdep+5;
  const auto wrong = [](AnyKind kind, const Query& query) {
    Answer answer = honest(kind, query);
    const auto& x = query.coordinates;
    if (std::ranges::find(x, rare) != x.end()) answer.verdict = Verdict::no;
    return answer;
  };
  EXPECT_TRUE(search(wrong, promising(Promise::none), {.most_queries = 2000}).findings.empty());
  Query query = tests::over_triangle(1, 1, 1, -1).query;
  query.at(0, 0, 2) = rare;
  const FuzzResult result =
      search(wrong, promising(Promise::none), {.corpus = {{ContactKind::vertex_face, query}}});
  ASSERT_FALSE(result.findings.empty());
  EXPECT_EQ(result.findings.front().what, judge::Fault::false_negative);
}

/// Each fault is found and made simple; those that lines show end in lines.
TEST(Fuzz, FindsEveryPlantedFaultOnCurvesAndMakesItsQuerySimple) {
  using enum judge::Fault;
  struct Row {
    judge::Fault fault;
    AnyShape simplest;
    std::function<void(const AnyQueries&, Answer&)> change;
  };
  const std::vector<Row> rows{
      {false_negative,
       {},
       [](const AnyQueries&, Answer& answer) { answer = {.verdict = Verdict::no}; }},
      {false_positive,
       {},
       [](const AnyQueries&, Answer& answer) { answer = {.verdict = Verdict::yes}; }},
      {no_verdict,
       {},
       [](const AnyQueries&, Answer& answer) { answer = {.verdict = Verdict::error}; }},
      {late_toi,
       {.degree = 2},
       [](const AnyQueries& one, Answer& answer) {
         if (one.degree > 1) answer.toi_lower = answer.toi_upper + 1e-12;
       }},
      {early_toi_upper,
       {.degree = 1, .is_rational = true},
       [](const AnyQueries& one, Answer& answer) {
         if (one.is_rational) answer.toi_upper = answer.toi_lower - 1e-12;
       }}};
  for (const Row& row : rows) {
    SCOPED_TRACE(to_string(row.fault));
    const std::size_t degree = row.simplest.is_rational ? 2 : 3;
    const FuzzResult result =
        fuzz(on_curves(row.change), {.most_queries = 3000,
                                     .most_groups = 1,
                                     .shrink_seconds = 60.0,
                                     .shapes = shapes(degree, row.simplest.is_rational)});
    ASSERT_FALSE(result.findings.empty());
    const Finding& finding = result.findings.front();
    EXPECT_EQ(to_string(finding.what), to_string(row.fault)) << finding.original.detail;
    EXPECT_EQ(finding.original.query.shape().degree, degree);
    EXPECT_EQ(finding.shrinking, Shrinking::complete);
    EXPECT_EQ(finding.simplest.query.shape().degree, row.simplest.degree);
    EXPECT_EQ(finding.simplest.query.shape().is_rational, row.simplest.is_rational);
    EXPECT_LE(magnitudes(finding.simplest.query).size(), 3U);
    EXPECT_FALSE(finding.simplest.certificate.empty());
  }
}

// ---- The time -----------------------------------------------------------------------------------

/// Answers are judged, or counted as not judged, whenever the time is over.
TEST(Fuzz, JudgesWhatIsAnsweredWhenTheTimeIsOver) {
  bool judged_some = false, left_some = false;
  for (std::uint64_t last_look = 1; last_look < 1200; last_look += 1 + last_look / 4) {
    tests::SharedCounter answered;
    std::uint64_t looks = 0;
    FuzzOptions options{.seconds = 10.0};
    // The time is over from the given reading of the clock on.
    options.clock = [&] { return ++looks > last_look ? 1000.0 + static_cast<double>(looks) : 0.0; };
    const FunctionMethod method([&answered](AnyKind kind, const Query& query) {
      answered.add();
      return honest(kind, query);
    });
    const FuzzResult result = fuzz(method, options);
    EXPECT_EQ(result.ended_by, FuzzEnd::time);
    // Other answers may still be on their way from the solver's process.
    const std::uint64_t received = result.queries + result.unjudged;
    EXPECT_LE(received, answered.value()) << last_look;
    EXPECT_GE(received + result.unanswered, answered.value()) << last_look;
    EXPECT_EQ(result.queries == 0, received == 0) << last_look;
    judged_some = judged_some || result.queries != 0;
    left_some = left_some || result.unjudged != 0;
  }
  EXPECT_TRUE(judged_some);
  EXPECT_TRUE(left_some);
}

/// A solver that hangs uses the whole time: its earlier answers are judged, and the hang is found.
TEST(Fuzz, ReportsAHangThatTakesTheRestOfTheTime) {
  tests::SharedCounter hung;
  const FunctionMethod method(
      [&hung](AnyKind kind, const Query& query) {
        if (query.at(0, 1, 1) == query.at(1, 1, 1)) {
          hung.add();
          std::this_thread::sleep_for(1h);
        }
        return honest(kind, query);
      },
      Promise::none);
  FuzzOptions options{.seconds = 600.0, .query_limit_seconds = 0.05};
  options.clock = [&hung] { return hung.value() == 0 ? 0.0 : 1000.0; };
  const FuzzResult result = fuzz(method, options);
  EXPECT_EQ(result.ended_by, FuzzEnd::time);
  EXPECT_GT(result.queries, 0U);
  EXPECT_EQ(result.unjudged, 0U);
  ASSERT_FALSE(result.findings.empty());
  EXPECT_EQ(to_string(result.findings.front().what), "hang");
}

TEST(Fuzz, CountsTheTimeOfFindingsAsTheRuns) {
  // A clock that advances by a hundredth of a second at each reading.
  double now = 0.0;
  FuzzOptions options{.seconds = 10.0, .shrink_seconds = 5.0};
  options.clock = [&now] { return now += 0.01; };
  std::vector<double> ends;
  options.on_finding = [&](const Finding&) { ends.push_back(now); };
  const FuzzResult result = fuzz(FunctionMethod(sometimes_wrong, Promise::none), options);
  EXPECT_EQ(result.ended_by, FuzzEnd::time);
  EXPECT_LT(now, 10.0 + 1.5);
  ASSERT_GT(result.findings.size(), 3U);
  EXPECT_GT(result.shrink_seconds, 1.0);
  EXPECT_LT(result.shrink_seconds, result.seconds);
  EXPECT_NEAR(result.method_seconds + result.shrink_seconds + result.other_seconds, result.seconds,
              1e-9);
  // No finding uses up the time of the others.
  EXPECT_LT(ends.at(0), 2.0);
  EXPECT_LT(ends.at(3), 9.0);
}

// ---- One finding: asking again ------------------------------------------------------------------

/// An answer that is late by a tenth of the remaining time.
Answer late(AnyKind kind, const Query& query) {
  Answer answer = honest(kind, query);
  answer.toi_lower += 0.1 * (1.0 - answer.toi_lower);
  answer.toi_upper = Answer::none;
  return answer;
}

/// The first finding of this fault in a run without simplification.
Finding find(const FunctionMethod& method, const FuzzOptions& options = {}) {
  FuzzOptions search = options;
  search.most_queries = 20'000;
  search.most_groups = 1;
  const FuzzResult result = fuzz(method, search);
  EXPECT_FALSE(result.findings.empty());
  return result.findings.empty() ? Finding{} : result.findings.front();
}

TEST(Recheck, AsksAgainAboutAnyQuery) {
  const FunctionMethod method(sometimes_wrong, Promise::none);
  const Finding finding = find(method);
  Recheck recheck(method, finding, {});
  EXPECT_TRUE(recheck.ask(finding.original.query));
  // The first point is raised first, and so never below the point that the method compares it with.
  EXPECT_FALSE(recheck.ask({ContactKind::vertex_face, tests::over_triangle(8, 8, 1, -1).query}));
  AnyQuery infinite = finding.original.query;
  infinite.numbers().front() = HUGE_VAL;
  EXPECT_FALSE(recheck.ask(infinite));
  EXPECT_FALSE(recheck.ask(finding.original.query, base::Deadline(0.0)));
}

TEST(Recheck, KnowsCrashesHangsAndMissingBounds) {
  const auto ill = [](AnyKind kind, const Query& query) {
    const double word = query.at(0, 0, 0);
    if (word == 1.0) std::abort();
    if (word == 2.0) std::this_thread::sleep_for(1h);
    Answer answer = honest(kind, query);
    if (word == 0.5) answer.toi_lower = Answer::none;
    return answer;
  };
  const FunctionMethod method(ill, Promise::none);
  const FuzzOptions options{.query_limit_seconds = 0.5};
  const auto query_at = [](double x) {
    return AnyQuery(ContactKind::vertex_face, tests::over_triangle(x, 0.25, 1, -1).query);
  };
  Finding finding;
  finding.method = "function";
  finding.original.query = query_at(1.0);
  finding.original.answer = {.verdict = Verdict::yes, .toi_lower = Answer::none, .toi_upper = 0.5};
  finding.missing.lower = true;
  const std::array<judge::Fault, 3> kinds{judge::Fault::crash, judge::Fault::hang,
                                          judge::Fault::not_finite};
  const std::array<double, 3> words{1.0, 2.0, 0.5};
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    finding.what = kinds.at(i);
    Recheck recheck(method, finding, options);
    for (std::size_t j = 0; j < words.size(); ++j) {
      EXPECT_EQ(recheck.ask(query_at(words.at(j))).has_value(), i == j);
    }
  }
}

// ---- Making simpler -----------------------------------------------------------------------------

/// Expects that all parts of the case agree with its query, by the method and the oracle.
void expect_consistent(const Finding& finding, const FailingCase& failing,
                       const FunctionMethod::Function& function) {
  const Answer answer = function(finding.kind(), failing.query.straight());
  EXPECT_EQ(failing.answer.verdict, answer.verdict);
  EXPECT_EQ(failing.answer.toi_lower, answer.toi_lower);
  const exact::Decision truth = base::decide(failing.query.queries(), 0, finding.separation);
  EXPECT_EQ(failing.collides, truth.collides());
  EXPECT_EQ(failing.truth, judge::to_text(judge::truth_of(0, truth)));
  EXPECT_NE(failing.detail.find(fmt::format("{}", answer.toi_lower)), std::string::npos)
      << failing.detail;
  EXPECT_EQ(tests::check_text(failing.certificate).accepted(), 1U) << failing.certificate;
  const std::optional<tests::ReadClaim> claim = tests::read_claim(failing.certificate);
  ASSERT_TRUE(claim);
  EXPECT_EQ(AnyQuery(claim->kind, claim->query), failing.query);
  EXPECT_TRUE(tests::is_true(*claim));
}

TEST(Simplify, KeepsAnswerTruthAndCertificateWithTheirQuery) {
  const FunctionMethod method(late, Promise::conservative);
  Finding finding = find(method);
  EXPECT_EQ(finding.what, judge::Fault::late_toi);
  const FailingCase original = finding.original;
  simplify(method, {}, {}, finding);
  EXPECT_EQ(finding.shrinking, Shrinking::complete);
  EXPECT_NE(finding.simplest.query, original.query);
  EXPECT_EQ(finding.original.query, original.query);
  EXPECT_EQ(finding.original.detail, original.detail);
  expect_consistent(finding, finding.simplest, late);
  expect_consistent(finding, finding.original, late);
  EXPECT_NE(finding.simplest.certificate, finding.original.certificate);
}

TEST(Simplify, SaysIfTheTimeWasTooShort) {
  const FunctionMethod method(late, Promise::conservative);
  const Finding found = find(method);
  // A clock that advances at each reading.
  for (const double step : {1.0, 0.2, 0.05}) {
    double now = 0.0;
    const base::Deadline deadline(1.0, [&now, step] { return now += step; });
    Finding finding = found;
    simplify(method, {}, deadline, finding);
    EXPECT_EQ(finding.shrinking, Shrinking::cut_short);
    expect_consistent(finding, finding.simplest, late);
    EXPECT_LE(now, 1.0 + 5.0 * step);
  }
}

TEST(Simplify, SaysIfTheMethodIsNotWrongAlone) {
  const FunctionMethod wrong(late, Promise::conservative), right(honest, Promise::conservative);
  Finding finding = find(wrong);
  simplify(right, {}, {}, finding);
  EXPECT_EQ(finding.shrinking, Shrinking::not_reproduced);
  EXPECT_EQ(finding.simplest.query, finding.original.query);
}

/// The method was asked twice before the finding, and a repetition may cost as much as a hang.
TEST(Simplify, DoesNotRepeatACrashOrAHangLongerThanTheTime) {
  tests::SharedCounter asked;
  Query crashing = tests::over_triangle(1, 1, 1, -1).query;
  const FunctionMethod method([&](AnyKind kind, const Query& query) {
    if (query == crashing) asked.add();
    return honest(kind, query);
  });
  Finding finding;
  finding.what = judge::Fault::crash;
  finding.method = "function";
  finding.original.query = {ContactKind::vertex_face, crashing};
  finding.simplest = finding.original;
  simplify(method, {}, {}, finding);
  EXPECT_EQ(asked.value(), 0U);
  EXPECT_EQ(finding.shrinking, Shrinking::complete);
  EXPECT_EQ(finding.simplest.query, finding.original.query);

  const FunctionMethod aborts([](AnyKind, const Query&) -> Answer { std::abort(); });
  finding.what = judge::Fault::hang;
  finding.shrinking = Shrinking::not_tried;
  simplify(aborts, {.query_limit_seconds = 10.0}, base::Deadline(5.0, [] { return 0.0; }), finding);
  EXPECT_EQ(finding.shrinking, Shrinking::not_tried);
}

}  // namespace
}  // namespace touchstone::verify::fuzz::fuzz_test
