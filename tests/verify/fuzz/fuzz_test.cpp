#include "verify/fuzz/fuzz.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "fast/method.hpp"
#include "tests/support/methods.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/shared_counter.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/oracle.hpp"
#include "touchstone/tight_inclusion.hpp"
#include "verify/fuzz/plainness.hpp"
#include "verify/fuzz/recheck.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::verify::fuzz::fuzz_test {
namespace {

using fast::Answer;
using fast::Promise;
using fast::Verdict;
using tests::FunctionMethod;
using namespace std::chrono_literals;

/// The right answer, by the fast solver.
Answer honest(Kind kind, const Query& query) { return answer_of(fast::solve(kind, query)); }

constexpr std::uint64_t enough = 20'000;

FuzzResult search(const FunctionMethod::Function& function, const fast::MethodInfo& info,
                  FuzzOptions options = {}) {
  const FunctionMethod method(function, info);
  if (options.most_queries == 0) options.most_queries = enough;
  if (options.most_groups == 0) options.most_groups = 1;
  return fuzz(method, options);
}

FuzzResult search(const FunctionMethod::Function& function, Promise promise,
                  const FuzzOptions& options = {}) {
  return search(function, {.name = "function", .promise = promise}, options);
}

/// Expects an early finding of this fault, with true contents.
void expect_found(judge::Fault what, const FuzzResult& result) {
  ASSERT_FALSE(result.findings.empty()) << to_string(what);
  const Finding& finding = result.findings.front();
  EXPECT_EQ(to_string(finding.what), to_string(what)) << finding.original.detail;
  EXPECT_EQ(finding.method, "function");
  EXPECT_FALSE(finding.original.detail.empty());
  EXPECT_FALSE(finding.generator.empty());
  EXPECT_EQ(finding.original.collides,
            exact::decide(finding.original.query.queries(), 0, finding.separation).collides());
  // Simplification was not requested.
  EXPECT_EQ(finding.simplest.query, finding.original.query);
  EXPECT_EQ(finding.shrinking, Shrinking::not_tried);
  EXPECT_EQ(result.queries, finding.queries);
  EXPECT_GE(result.all_findings, 1U);
}

/// A method that is right but for this change, and the fault to be found.
struct Planted {
  const char* name;
  judge::Fault fault;
  Promise promise;
  std::function<void(const Query&, Answer&)> change;
};

/// What is done at some queries instead of an answer.
std::function<void(const Query&, Answer&)> at_some(const std::function<void()>& act) {
  return [act](const Query& query, Answer&) {
    if (query.at(0, 1, 1) == query.at(1, 1, 1) && query.at(0, 1, 1) != 0.0) act();
  };
}

TEST(Fuzz, FindsEveryPlantedFault) {
  using enum judge::Fault;
  const std::vector<Planted> all{
      {"always no", false_negative, Promise::none,
       [](const Query&, Answer& answer) { answer = {.verdict = Verdict::no}; }},
      {"a time that is late by the least", late_toi, Promise::conservative,
       [](const Query&, Answer& answer) {
         if (answer.verdict == Verdict::yes)
           answer.toi_lower = std::nextafter(answer.toi_upper, 2.0);
         answer.toi_upper = Answer::none;
       }},
      {"an upper bound that is early", early_toi_upper, Promise::conservative,
       [](const Query&, Answer& answer) {
         answer.toi_upper = answer.toi_lower;
         answer.toi_lower = Answer::none;
       }},
      {"an infinite time", not_finite, Promise::conservative,
       [](const Query& query, Answer& answer) {
         if (query.at(0, 0, 0) == query.at(1, 0, 0)) answer.toi_lower = -HUGE_VAL;
       }},
      {"a negative tolerance", not_finite, Promise::conservative,
       [](const Query&, Answer& answer) {
         if (answer.toi_lower > 0.5) answer.tolerance = -1.0;
       }},
      {"the bound of some collisions is missing", not_finite, Promise::conservative,
       [](const Query& query, Answer& answer) {
         if (query.at(0, 0, 0) == 1.0 && query.at(1, 0, 0) == 1.0) answer.toi_lower = Answer::none;
       }},
      {"an error", no_verdict, Promise::none,
       [](const Query&, Answer& answer) { answer = {.verdict = Verdict::error}; }},
      {"undecided", undecided, Promise::exact, [](const Query&, Answer& answer) { answer = {}; }},
      {"crash: SIGABRT", crash, Promise::none, at_some([] { std::abort(); })},
      {"exit: status 3", exit, Promise::none, at_some([] { std::_Exit(3); })},
      {"exception: thrown", exception, Promise::none,
       at_some([] { throw std::runtime_error("thrown"); })}};
  for (const Planted& planted : all) {
    SCOPED_TRACE(planted.name);
    const auto altered = [&](Kind kind, const Query& query) {
      Answer answer = honest(kind, query);
      planted.change(query, answer);
      return answer;
    };
    // Without the oracle's share: the judge must doubt the answer.
    const FuzzResult result = search(altered, planted.promise, {.oracle_share = 0.0});
    expect_found(planted.fault, result);
    EXPECT_TRUE(planted.fault != false_negative || result.queries < 2000U);
    if (planted.fault == crash || planted.fault == exit || planted.fault == exception) {
      EXPECT_EQ(result.findings.at(0).original.detail, planted.name);
    }
  }
}

TEST(Fuzz, FindsFalsePositivesOfExactSolvers) {
  const auto yes = [](Kind, const Query&) { return Answer{.verdict = Verdict::yes}; };
  expect_found(judge::Fault::false_positive, search(yes, Promise::exact));
  expect_found(judge::Fault::false_positive,
               search(yes, Promise::none, {.promise = Promise::exact}));
  const FuzzResult lenient =
      search(yes, Promise::conservative, {.most_queries = tests::trials(std::uint64_t{2400})});
  EXPECT_TRUE(lenient.findings.empty());
  EXPECT_EQ(lenient.all_findings, 0U);
}

/// A method that says yes to all queries, and so claims that their distance is within its
/// tolerance.
TEST(Fuzz, FindsAYesBeyondItsTolerance) {
  const auto yes = [](double tolerance) {
    return [tolerance](Kind, const Query&) {
      return Answer{.verdict = Verdict::yes, .toi_lower = 0.0, .tolerance = tolerance};
    };
  };
  expect_found(judge::Fault::beyond_tolerance, search(yes(1e-9),
                                                      {.name = "function",
                                                       .promise = Promise::conservative,
                                                       .filter = fast::ErrorModel::derived},
                                                      {.oracle_share = 0.0}));
  expect_found(judge::Fault::beyond_tolerance,
               search(yes(0.0), Promise::conservative, {.oracle_share = 0.0}));
  expect_found(judge::Fault::beyond_tolerance,
               search(yes(0.0), Promise::none,
                      {.separation = {.distance = 0.25, .norm = Norm::l2}, .oracle_share = 0.0}));
  const std::uint64_t some = tests::trials(std::uint64_t{2400});
  EXPECT_EQ(search(yes(HUGE_VAL), Promise::conservative, {.most_queries = some}).all_findings, 0U);
}

/// A method that is wrong only if the first point is on the left: the image of a query on the
/// right.
TEST(Fuzz, FindsWhatIsWrongInAMirror) {
  const auto one_sided = [](Kind kind, const Query& query) {
    Answer answer = honest(kind, query);
    if (query.at(0, 0, 0) < 0.0 && query.at(0, 1, 0) >= 0.0) answer.verdict = Verdict::no;
    return answer;
  };
  const FuzzOptions options{.most_queries = 2000, .most_groups = 1000};
  const FuzzResult result = search(one_sided, Promise::exact, options);
  EXPECT_GT(result.images, result.queries / 20);
  const auto is_asymmetry = [](const Finding& finding) {
    return finding.what == judge::Fault::asymmetry;
  };
  const auto found = std::ranges::find_if(result.findings, is_asymmetry);
  ASSERT_NE(found, result.findings.end());
  EXPECT_LT(found->original.query.straight().at(0, 0, 0), 0.0);
  EXPECT_NE(found->original.detail.find("exact image"), std::string::npos);
  // Without the promise exact only the wrong answer counts.
  const FuzzResult lenient = search(one_sided, Promise::conservative, options);
  EXPECT_TRUE(std::ranges::none_of(lenient.findings, is_asymmetry));
  EXPECT_FALSE(lenient.findings.empty());
}

TEST(Fuzz, TakesMethodsWithoutTimes) {
  const auto timeless = [](Kind kind, const Query& query) {
    return Answer{.verdict = honest(kind, query).verdict};
  };
  EXPECT_TRUE(search(timeless, Promise::exact, {.most_queries = tests::trials(std::uint64_t{2400})})
                  .findings.empty());
}

TEST(Fuzz, FindsNothingWhereNothingIsWrong) {
  // The oracle takes a hundred times as long with a distance.
  const std::vector<std::pair<Separation, std::uint64_t>> searches{
      {{}, 6000}, {{.distance = 1e-3, .norm = Norm::l2}, 160}};
  for (const auto& [separation, queries] : searches) {
    const FuzzOptions options{.most_queries = tests::trials(queries), .separation = separation};
    const FuzzResult certified = fuzz(solvers::find_method("certified"), options);
    EXPECT_EQ(certified.all_findings, 0U);
    EXPECT_EQ(certified.queries, options.most_queries);
    EXPECT_EQ(certified.judged_by_oracle, certified.queries);
    EXPECT_GT(certified.collisions, certified.queries / 20);
  }
}

TEST(Fuzz, FindsNothingInTightInclusion) {
  const FuzzOptions options{.most_queries = tests::trials(std::uint64_t{1200}),
                            .method = {.max_checks = 200},
                            .query_limit_seconds = 30.0};
  const FuzzResult result = fuzz(solvers::find_method("tight_inclusion"), options);
  EXPECT_EQ(result.all_findings, 0U);
  EXPECT_LT(result.judged_by_oracle, result.queries);
}

/// A method that ignores the separation misses collisions at it.
TEST(Fuzz, TellsTheMethodTheSeparation) {
  const auto contact_only = [](Kind kind, const Query& query) { return honest(kind, query); };
  for (const Norm norm : {Norm::linf, Norm::l2}) {
    const auto result = search(contact_only, Promise::conservative,
                               {.separation = {.distance = 0.25, .norm = norm}});
    ASSERT_FALSE(result.findings.empty());
    EXPECT_EQ(result.findings.front().separation.norm, norm);
  }
}

std::vector<base::AnyQuery> queries_of(const FuzzResult& result) {
  std::vector<base::AnyQuery> queries;
  for (const Finding& finding : result.findings) queries.push_back(finding.original.query);
  return queries;
}

Answer sometimes_wrong(Kind kind, const Query& query) {
  Answer answer = honest(kind, query);
  if (query.at(0, 0, 0) < query.at(1, 2, 1)) answer.verdict = Verdict::no;
  return answer;
}

TEST(Fuzz, IsTheSameForTheSameSeed) {
  const FuzzOptions options{
      .most_queries = tests::trials(std::uint64_t{2400}), .seed = 5, .most_groups = 1000};
  const FuzzResult a = search(sometimes_wrong, Promise::none, options);
  const FuzzResult b = search(sometimes_wrong, Promise::none, options);
  EXPECT_GT(a.findings.size(), tests::trials(8U));
  EXPECT_EQ(queries_of(a), queries_of(b));
  EXPECT_EQ(a.all_findings, b.all_findings);
  EXPECT_EQ(a.judged_by_oracle, b.judged_by_oracle);
  FuzzOptions other = options;
  other.seed = 6;
  EXPECT_NE(queries_of(a), queries_of(search(sometimes_wrong, Promise::none, other)));
}

/// A bound that is too small for small coordinates is one cause, for any generator, kind and stage.
TEST(Fuzz, PutsFindingsOfOneCauseInOneGroup) {
  const auto blind = [](Kind kind, const Query& query) {
    if (size_exponent({kind, query}) < -3) return Answer{.verdict = Verdict::no};
    return honest(kind, query);
  };
  const FuzzResult result = search(
      blind, Promise::none, {.most_queries = 2400, .most_groups = 1000, .shrink_seconds = 60.0});
  EXPECT_GT(result.findings.size(), 10U);
  ASSERT_EQ(result.groups.size(), 1U);
  EXPECT_EQ(result.groups.front().count, result.all_findings);
  const Finding& best = result.findings.at(result.groups.front().best);
  EXPECT_EQ(best.scales.end_above, -3);
  EXPECT_FALSE(best.scales.end_below);
  for (const Finding& finding : result.findings) {
    EXPECT_EQ(finding.group, 0U);
    const base::AnyQuery& original = finding.original.query;
    EXPECT_FALSE(plainness(finding.simplest.query, original)
                     .is_worse_somewhere(plainness(original, original)));
  }
}

/// Contacts missed at t=0 and hangs have two causes.
TEST(Fuzz, PutsFindingsOfTwoCausesInTwoGroups) {
  const auto ill = [](Kind kind, const Query& query) {
    const Answer answer = honest(kind, query);
    if (answer.verdict == Verdict::yes && answer.toi_upper == 0.0) {
      return Answer{.verdict = Verdict::no};
    }
    if (answer.verdict == Verdict::yes && query.at(0, 0, 0) == query.at(1, 2, 1)) std::abort();
    return answer;
  };
  const FuzzResult result = search(
      ill, Promise::none, {.most_queries = 2400, .most_groups = 1000, .shrink_seconds = 60.0});
  std::uint64_t count = 0;
  std::set<judge::Fault> kinds;
  for (const FindingGroup& group : result.groups) {
    count += group.count;
    kinds.insert(result.findings.at(group.best).what);
  }
  EXPECT_EQ(count, result.all_findings);
  EXPECT_EQ(kinds, (std::set{judge::Fault::false_negative, judge::Fault::crash}));
}

/// The method is wrong at one coordinate that only the corpus contains.
TEST(Fuzz, MutatesTheCorpus) {
  static constexpr double rare = 0x1.23456789abcdep+5;
  const auto wrong = [](Kind kind, const Query& query) {
    Answer answer = honest(kind, query);
    const auto& x = query.coordinates;
    if (std::ranges::find(x, rare) != x.end()) answer.verdict = Verdict::no;
    return answer;
  };
  FuzzOptions options{.most_queries = enough};
  EXPECT_TRUE(search(wrong, Promise::none, {.most_queries = 2000}).findings.empty());
  Query query = tests::over_triangle(1, 1, 1, -1).query;
  query.at(0, 0, 2) = rare;
  options.corpus = {{Kind::vertex_face, query}};
  expect_found(judge::Fault::false_negative, search(wrong, Promise::none, options));
}

// ---- Elements -----------------------------------------------------------------------------------

const std::vector<QueryShape> elements{{Kind::tetrahedron}, {Kind::plane_triangle}};

TEST(FuzzOfElements, FindsTheMissesOfFormulasAndNoneOfTheCertifiedSolver) {
  const FuzzResult certified =
      fuzz(solvers::find_method("certified"),
           {.most_queries = tests::trials(std::uint64_t{6000}), .shapes = elements});
  EXPECT_EQ(certified.all_findings, 0U);
  EXPECT_GT(certified.collisions, certified.queries / 4);
  EXPECT_LT(certified.collisions, certified.queries / 10 * 9);
  for (const char* const name : {"inversion_cubic", "inversion_additive"}) {
    for (const QueryShape& shape : elements) {
      SCOPED_TRACE(name);
      const FuzzResult result =
          fuzz(solvers::find_method(name), {.most_queries = enough,
                                            .method = {.max_checks = 200},
                                            .promise = Promise::conservative,
                                            .most_groups = 1,
                                            .shrink_seconds = 60.0,
                                            .only = {judge::Fault::false_negative},
                                            .shapes = {shape}});
      ASSERT_FALSE(result.findings.empty());
      const FailingCase& plain = result.findings.front().simplest;
      EXPECT_TRUE(exact::decide(plain.query.queries(), 0).collides());
      EXPECT_EQ(plain.answer.verdict, Verdict::no);
      EXPECT_EQ(plain.query.shape(), shape);
      EXPECT_NE(plain.certificate.find("query tetrahedron\n"), std::string::npos);
    }
  }
}

/// Right but where a volume only touches 0, where points rest, or at an orientation.
TEST(FuzzOfElements, FindsEveryPlantedFault) {
  using Fault = bool (*)(const Query&, const Answer&);
  const auto touches = [](const Query& query, const Answer&) {
    Query end = query;
    for (std::size_t i = 0; i < 12; ++i) end.coordinates.at(i) = end.coordinates.at(i + 12);
    return !exact::decide(Kind::tetrahedron, end).collides();
  };
  const auto at_end = [](const Query&, const Answer& answer) { return answer.toi_upper == 1.0; };
  const auto turned = [](const Query& query, const Answer&) {
    return query.at(0, 1, 0) < query.at(0, 0, 0) && query.at(0, 2, 0) > query.at(0, 0, 0);
  };
  for (const Fault is_missed : std::initializer_list<Fault>{touches, at_end, turned}) {
    const auto altered = [&](Kind kind, const Query& query) {
      Answer answer = honest(kind, query);
      if (answer.verdict == Verdict::yes && is_missed(query, answer))
        answer = {.verdict = Verdict::no};
      return answer;
    };
    expect_found(judge::Fault::false_negative,
                 search(altered,
                        {.name = "function",
                         .promise = Promise::conservative,
                         .terms = {.kinds = {false, false, true}}},
                        {.shapes = {{Kind::tetrahedron}}, .oracle_share = 0.0}));
  }
}

TEST(FuzzOfElements, HaveNoSeparation) {
  EXPECT_THROW(static_cast<void>(
                   fuzz(solvers::find_method("certified"),
                        {.most_queries = 1, .separation = {.distance = 1.0}, .shapes = elements})),
               std::invalid_argument);
}

// ---- Curves -------------------------------------------------------------------------------------

std::vector<QueryShape> shapes(std::size_t degree, bool is_rational = false) {
  return {{Kind::vertex_face, degree, is_rational}, {Kind::edge_edge, degree, is_rational}};
}

/// The certified solver's answers, changed.
FunctionMethod on_curves(const std::function<void(const Queries&, Answer&)>& change,
                         Promise promise = Promise::exact) {
  return {[change](const Queries& one) {
            fast::CertifiedResult result;
            fast::solve(one, {&result, 1}, {.max_threads = 1});
            Answer answer = answer_of(result);
            change(one, answer);
            return answer;
          },
          {.name = "function",
           .promise = promise,
           .terms = {.least_degree = 1, .most_degree = greatest_degree, .rational = true}}};
}

/// Each fault is found and made simple; those that lines show end in lines.
TEST(Fuzz, FindsEveryPlantedFaultOnCurvesAndMakesItsQuerySimple) {
  using enum judge::Fault;
  struct Row {
    judge::Fault fault;
    QueryShape simplest;
    std::function<void(const Queries&, Answer&)> change;
  };
  const std::vector<Row> rows{
      {false_negative,
       {},
       [](const Queries&, Answer& answer) { answer = {.verdict = Verdict::no}; }},
      {false_positive,
       {},
       [](const Queries&, Answer& answer) { answer = {.verdict = Verdict::yes}; }},
      {no_verdict,
       {},
       [](const Queries&, Answer& answer) { answer = {.verdict = Verdict::error}; }},
      {late_toi,
       {.degree = 2},
       [](const Queries& one, Answer& answer) {
         if (one.degree > 1) answer.toi_lower = answer.toi_upper + 1e-12;
       }},
      {early_toi_upper, {.degree = 1, .is_rational = true}, [](const Queries& one, Answer& answer) {
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

TEST(Fuzz, FindsNothingOnCurvesWhereNothingIsWrong) {
  for (const Separation& separation :
       {Separation{}, Separation{0.25, Norm::linf}, Separation{0.25, Norm::l2}}) {
    for (const auto& [degree, is_rational] : {std::pair(2U, false), {3U, false}, {2U, true}}) {
      const FuzzOptions options{.most_queries = 300,  // a block and some images
                                .separation = separation,
                                .shapes = shapes(degree, is_rational)};
      const FuzzResult certified = fuzz(solvers::find_method("certified"), options);
      EXPECT_EQ(certified.all_findings, 0U);
      EXPECT_EQ(certified.judged_by_oracle, certified.queries);
      EXPECT_GT(certified.collisions, certified.queries / 10);
      EXPECT_GT(certified.images, 0U);
    }
  }
  const FuzzOptions options{.most_queries = tests::trials(std::uint64_t{400}),
                            .method = {.max_checks = 2000},
                            .query_limit_seconds = 30.0,
                            .shapes = shapes(2)};
  EXPECT_EQ(fuzz(solvers::find_method("tight_inclusion"), options).all_findings, 0U);
}

/// Wrong in a mirror, as on straight lines; and the same queries for the same seed.
TEST(Fuzz, AsksImagesOfQueriesOnCurvesAndTheSameForTheSameSeed) {
  const FunctionMethod one_sided = on_curves([](const Queries& one, Answer& answer) {
    if (one.numbers[0] < 0.0 && one.numbers[3] >= 0.0) answer.verdict = Verdict::no;
  });
  const FuzzOptions options{.most_queries = 2000, .most_groups = 1000, .shapes = shapes(2)};
  const FuzzResult result = fuzz(one_sided, options);
  EXPECT_TRUE(std::ranges::any_of(result.findings, [](const Finding& finding) {
    return finding.what == judge::Fault::asymmetry;
  }));
  EXPECT_EQ(queries_of(result), queries_of(fuzz(one_sided, options)));
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
    const FunctionMethod method([&answered](Kind kind, const Query& query) {
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
      [&hung](Kind kind, const Query& query) {
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

TEST(Fuzz, RefusesOptionsThatMakeNoSense) {
  const fast::Method& method = solvers::find_method("certified");
  const auto refused = [&method](const FuzzOptions& options) {
    EXPECT_THROW((void)fuzz(method, options), std::invalid_argument);
  };
  refused({});
  refused({.seconds = -1.0});
  refused({.seconds = std::nan("")});
  refused({.most_queries = 1, .separation = {.distance = -1.0}});
  refused({.most_queries = 1, .query_limit_seconds = -1.0});
  refused({.most_queries = 1, .shrink_seconds = -1.0});
  refused({.most_queries = 1, .shapes = {}});
  refused({.most_queries = 1, .shapes = {{.degree = 0}}});
  refused({.most_queries = 1, .shapes = {{.degree = 9}}});
  refused({.most_queries = 1, .oracle_share = 1.5});
}

}  // namespace
}  // namespace touchstone::verify::fuzz::fuzz_test
