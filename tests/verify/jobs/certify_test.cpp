#include "verify/jobs/certify.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "tests/support/certificates.hpp"
#include "tests/support/memory_source.hpp"
#include "tests/support/methods.hpp"
#include "tests/support/public_data.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/certificate_text.hpp"
#include "verify/data/dataset.hpp"
#include "verify/generate/families.hpp"
#include "verify/io/terminal.hpp"

namespace touchstone::verify::jobs::certify_test {
namespace {

using exact::Rational;
using tests::MemorySource;

/// A vertex falls from height `above` to height −`below` through the middle of a resting triangle:
/// they collide iff below ≥ 0, at above/(above + below).
base::AnyQuery falling_vertex(double above, double below) {
  return {ContactKind::vertex_face, tests::over_triangle(1, 1, above, -below).query};
}

CertifyResult certify_records(std::vector<data::RecordedQuery> records,
                              const CertifyOptions& options = {}) {
  MemorySource source(ContactKind::vertex_face, std::move(records));
  return certify(source, options);
}

/// Until they differ, and at least 45 digits of a true time, however small.
TEST(Certify, PrintsTimesOfImpactUntilTheyDiffer) {
  CertifyOptions options;
  options.toi_tolerance = 0;
  const std::string threes(45, '3');
  // The last vertex rises from 2^-1000 below the sinking face: toi = 2^-1000 / (2^-1000 + 3), not
  // dyadic, about 3.1108…e-302.
  const CertifyResult result =
      certify_records({{.query = falling_vertex(1, 2),
                        .index = 0,
                        .collides = true,
                        .toi = exact::rational_from_decimal("0." + threes)},
                       {.query = falling_vertex(1, 3),
                        .index = 1,
                        .collides = true,
                        .toi = Rational(1, 4) + exact::power_of_two(-2000)},
                       {.query = falling_vertex(0x1p-1000, 3),
                        .index = 2,
                        .collides = true,
                        .toi = Rational(1, 4)}},
                      options);
  ASSERT_EQ(result.toi_mismatches, 3U);
  EXPECT_EQ(result.mismatches[0].recorded, "3." + threes.substr(1) + "E-1");
  EXPECT_EQ(result.mismatches[0].truth, "3." + threes.substr(1) + threes + "E-1");
  EXPECT_TRUE(result.mismatches[1].recorded.starts_with("2.5000"));
  EXPECT_EQ(result.mismatches[1].truth, "2.5E-1");
  const std::string& small = result.mismatches[2].truth;
  EXPECT_TRUE(small.starts_with("3.1108")) << small;
  EXPECT_LE(small.find("E-302"), 46U) << small;
}

// ---- Proofs -------------------------------------------------------------------------------------

// Errors and interrupts leave whole certificates: tests/transcripts/prove.md.

/// Queries of which every third collides, at 0, at 1/3 or at 3/4.
std::vector<data::RecordedQuery> proved_records(std::uint64_t count) {
  std::vector<data::RecordedQuery> records;
  for (std::uint64_t i = 0; i < count; ++i) {
    const double end = i % 9 == 0 ? -2 : i % 9 == 3 ? -1.0 / 3 : 0.5;
    const double start = i % 9 == 6 ? 0 : 1;
    const auto posed = tests::over_triangle(1, 1, start, end);
    records.push_back(
        {.query = {posed.kind, posed.query}, .index = i + 10, .collides = {}, .toi = {}});
  }
  return records;
}

TEST(Prove, WritesEveryCertificateInOrderWhateverTheThreads) {
  std::string first;
  for (const unsigned threads : {1U, 3U}) {
    MemorySource source(ContactKind::vertex_face, proved_records(9000));
    std::string text(exact::certificates_header());
    const CertifyResult result = certify(
        source,
        {.threads = threads, .on_certificates = [&](std::string_view part) { text += part; }});
    const ProofCounts& counts = result.proofs;
    EXPECT_EQ(counts.certificates(), 9000U);
    EXPECT_EQ(counts.no_collision, 6000U);
    EXPECT_EQ(counts.time_of_impact, 3000U);
    EXPECT_EQ(counts.collision, 0U);
    EXPECT_EQ(counts.subintervals, (std::map<std::size_t, std::uint64_t>{{0, 1000}, {1, 8000}}));
    EXPECT_EQ(counts.bytes + exact::certificates_header().size(), text.size());
    EXPECT_GT(counts.nanoseconds, 0.0);
    EXPECT_GT(result.microseconds, 0.0);
    EXPECT_TRUE(counts.beyond_limits.empty());
    EXPECT_EQ(result.skipped, 3U);
    EXPECT_EQ(result.rounded, 5U);
    if (first.empty()) first = text;
    EXPECT_EQ(text, first);
  }
  std::size_t at = 0;
  for (std::uint64_t i = 0; i < 9000; ++i) {
    at = first.find("\nlabel memory:" + std::to_string(i + 10) + "\n", at);
    ASSERT_NE(at, std::string::npos) << i;
  }
  const checker::Report report = tests::check_text(first + exact::certificates_closing_line(9000));
  EXPECT_TRUE(report.all_accepted());
  EXPECT_EQ(report.no_collision, 6000U);
  EXPECT_EQ(report.time_of_impact, 3000U);
}

// ---- Solvers ------------------------------------------------------------------------------------

using fast::Answer;
using fast::Promise;
using tests::FunctionMethod;
using tests::true_answer;

/// Falling vertices that collide at times which are not doubles, but every third query does not.
/// The height of the vertex is the query's number.
std::vector<data::RecordedQuery> numbered_records(std::uint64_t count) {
  std::vector<data::RecordedQuery> records;
  for (std::uint64_t i = 0; i < count; ++i) {
    const double height = 1.0 + static_cast<double>(i);
    records.push_back(
        {.query = i % 3 != 0 ? falling_vertex(height, 2 * height) : falling_vertex(height, -0.5),
         .index = i,
         .collides = {},
         .toi = {}});
  }
  return records;
}

std::uint64_t number_of(const Query& query) {
  return static_cast<std::uint64_t>(query.at(0, 0, 2)) - 1;
}

std::uint64_t all_faults(const judge::Judgement& judgement) {
  return judgement.wrong_answers.size();
}

TEST(Budget, SharesWhatIsLeftOverSourcesAndSolvers) {
  const FunctionMethod method(true_answer);
  const auto first = solvers::solver_in_process(method, {}),
             second = solvers::solver_in_process(method, {});
  double now = 0.0;
  Budget budget(100.0, {first.get(), second.get()}, 1, [&] { return now; });
  EXPECT_EQ(budget.begin_source(4).seconds_left(), 25.0);
  EXPECT_DOUBLE_EQ(first->allowance(), 10.0);
  EXPECT_DOUBLE_EQ(second->allowance(), 10.0);
  // What a solver took too much is missing for all.
  first->allow(-10.0);
  now = 40.0;
  EXPECT_EQ(budget.begin_source(3).seconds_left(), 20.0);
  EXPECT_DOUBLE_EQ(first->allowance(), 8.0);
  EXPECT_DOUBLE_EQ(second->allowance(), 8.0);
  now = 100.0;
  EXPECT_TRUE(budget.is_over());
  EXPECT_TRUE(budget.begin_source(1).is_over());
  EXPECT_EQ(first->allowance(), 0.0);
  // Without time queries are left out.
  const std::vector<Query> queries(3);
  std::vector<Answer> answers(3);
  const auto reply = first->solve({.queries = {ContactKind::vertex_face, queries}}, answers);
  ASSERT_EQ(reply.unasked.size(), 3U);
  EXPECT_EQ(reply.unasked.front().why, judge::Unasked::left_out);
  EXPECT_FALSE(reply.stopped);
}

TEST(CertifyMethods, FaultsAreFoundWhereverTheyAreInALongSource) {
  for (const unsigned threads : {1U, 3U}) {
    const FunctionMethod method([](AnyKind kind, const Query& query) {
      const std::uint64_t number = number_of(query);
      return number % 1000 == 1 ? Answer{.verdict = fast::Verdict::no} : true_answer(kind, query);
    });
    const auto solver = solvers::solver_in_process(method, {});
    CertifyOptions options;
    options.threads = threads;
    options.solvers = {solver.get()};
    const CertifyResult result = certify_records(numbered_records(9000), options);
    const judge::Judgement& judgement = result.methods.at(0).judgement;
    // Queries whose numbers are divisible by 3 do not collide, so that no is right.
    std::vector<std::uint64_t> expected, found;
    for (std::uint64_t i = 1; i < 9000; i += 1000) {
      if (i % 3 != 0) expected.push_back(i);
    }
    for (const judge::WrongAnswer& wrong : judgement.wrong_answers) found.push_back(wrong.index);
    EXPECT_EQ(found, expected);
    EXPECT_EQ(all_faults(judgement), expected.size());
  }
}

TEST(CertifyMethods, AStopInSlowAnswersIsObeyedSoonAndLeavesAPrefix) {
  std::atomic<bool> stop = false;
  std::atomic<int> asked = 0;
  const FunctionMethod slow([&](AnyKind kind, const Query& query) {
    if (++asked == 300) stop = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return true_answer(kind, query);
  });
  const auto solver = solvers::solver_in_process(slow, {});
  std::vector<std::uint64_t> truths;
  CertifyOptions options;
  options.threads = 2;
  options.stop = &stop;
  options.solvers = {solver.get()};
  options.on_truth = [&](const judge::GroundTruth& truth) { truths.push_back(truth.index); };
  const CertifyResult result = certify_records(numbered_records(2000), options);
  EXPECT_TRUE(result.interrupted);
  EXPECT_LT(asked, 600);
  EXPECT_GE(result.queries, 100U);
  EXPECT_LT(result.queries, 600U);
  EXPECT_EQ(result.methods.at(0).judgement.queries, result.queries);
  EXPECT_EQ(truths.size(), result.queries);
  EXPECT_EQ(truths.back() + 1, result.queries);
}

TEST(Certify, AnErrorOfTheSourceLosesNothingBeforeIt) {
  MemorySource source(ContactKind::vertex_face, numbered_records(3000));
  source.fail_at(2005, "row is broken");
  const CertifyResult result = certify(source);
  EXPECT_EQ(result.queries, 2005U);
  EXPECT_EQ(result.error, "row is broken");
  EXPECT_FALSE(result.interrupted);
}

/// A source in which an interrupt ends the wait for query number 5.
class InterruptedSource final : public data::QuerySource {
 public:
  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] AnyShape shape() const override { return {.kind = ContactKind::vertex_face}; }
  [[nodiscard]] std::optional<data::RecordedQuery> next() override {
    if (position_ == 5) throw io::Interrupted();
    return data::RecordedQuery{
        .query = falling_vertex(1, 2), .index = position_++, .collides = {}, .toi = {}};
  }
  [[nodiscard]] double progress() const override { return 0.0; }

 private:
  std::string name_ = "interrupted";
  std::uint64_t position_ = 0;
};

TEST(Certify, AnInterruptOfTheSourceIsNoErrorAndLosesNothingBeforeIt) {
  InterruptedSource source;
  const CertifyResult result = certify(source);
  EXPECT_TRUE(result.interrupted);
  EXPECT_FALSE(result.error);
  EXPECT_EQ(result.queries, 5U);
}

TEST(Certify, AnExceptionOfASinkEndsItAndIsReported) {
  std::uint64_t told = 0;
  CertifyOptions options;
  options.on_truth = [&](const judge::GroundTruth&) {
    if (++told == 1000) throw std::runtime_error("no memory left");
  };
  const CertifyResult result = certify_records(numbered_records(9000), options);
  EXPECT_EQ(result.error, "no memory left");
  EXPECT_EQ(told, 1000U);
}

/// The truth of every family is known without the oracle; here the two are compared. Times of
/// impact must be equal, not near.
class BuiltInSet : public ::testing::TestWithParam<generate::Family> {};

TEST_P(BuiltInSet, AgreesWithTheOracle) {
  const std::uint64_t count = tests::soak_trials(1000U, 120U);
  CertifyOptions options;
  options.toi_tolerance = 0;
  for (const AnyKind kind : all_kinds) {
    if (!generate::supports(GetParam(), kind)) continue;
    const auto source = generate::open_family(GetParam(), kind, 1, count);
    const CertifyResult result = certify(*source, options);
    EXPECT_EQ(result.queries, count);
    EXPECT_EQ(result.labels, count);
    EXPECT_EQ(result.label_mismatches, 0U);
    EXPECT_EQ(result.toi_mismatches, 0U);
    for (const judge::Mismatch& mismatch : result.mismatches) {
      ADD_FAILURE() << to_string(kind) << " query " << mismatch.index << ": recorded "
                    << mismatch.recorded << ", truth " << mismatch.truth;
    }
  }
}

std::string family_name(const ::testing::TestParamInfo<generate::Family>& info) {
  std::string name(info.param.name);
  std::erase(name, '-');
  return name;
}

std::vector<generate::Family> all_families() {
  std::vector<generate::Family> all;
  for (const auto list :
       {generate::families(), generate::curved_families(), generate::cell_families()}) {
    all.insert(all.end(), list.begin(), list.end());
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Families, BuiltInSet, ::testing::ValuesIn(all_families()), family_name);

/// Answers alone: nothing is decided, and all are handed out in order.
TEST(CertifyMethods, AnswersWithoutATruth) {
  const FunctionMethod method([](AnyKind, const Query& query) {
    return Answer{.verdict = fast::Verdict::yes,
                  .toi_lower = static_cast<double>(number_of(query))};
  });
  const auto solver = solvers::solver_in_process(method, {});
  for (const unsigned threads : {1U, 3U}) {
    std::uint64_t next = 0;
    CertifyOptions options;
    options.decides = false;
    options.threads = threads;
    options.solvers = {solver.get()};
    options.on_answer = [&](const solvers::Solver& asked, std::uint64_t index, const Answer& answer,
                            const judge::Failure* failure) {
      ASSERT_EQ(&asked, solver.get());
      ASSERT_EQ(failure, nullptr);
      ASSERT_EQ(index, next);
      ASSERT_EQ(answer.toi_lower, static_cast<double>(next++));
    };
    const CertifyResult result = certify_records(numbered_records(9000), options);
    EXPECT_EQ(next, 9000U);
    EXPECT_EQ(result.queries, 9000U);
    EXPECT_EQ(result.methods.at(0).judgement.collisions, 9000U);
    EXPECT_EQ(all_faults(result.methods.at(0).judgement), 0U);
    EXPECT_GT(result.methods.at(0).judgement.nanoseconds, 0.0);
  }
}

/// The public data; empty if it is missing.
std::vector<CertifyResult> certify_public(const std::string& folder) {
  const std::filesystem::path root = tests::public_data_folder();
  if (root.empty()) return {};
  std::vector<CertifyResult> results;
  const std::vector<std::filesystem::path> paths{root / folder};
  for (const auto& file : data::find_datasets(paths))
    results.push_back(certify(*data::open_dataset(file)));
  return results;
}

TEST(PublicData, QueriesAndTimesOfImpactAgree) {
  for (const auto& [folder, queries, collisions] :
       {std::tuple("handcrafted", 4884U, 0U),
        {"simulation", 4652U + 92U + 263U, 4650U + 27U + 107U}}) {
    const auto results = certify_public(folder);
    if (results.empty()) GTEST_SKIP() << "public data missing";
    const CertifyResult sum = total(results);
    EXPECT_EQ(sum.queries, queries);
    EXPECT_EQ(sum.labels, queries);
    EXPECT_EQ(sum.label_mismatches + sum.toi_mismatches + sum.skipped, 0U);
    // Those of simulations have times.
    if (collisions == 0) continue;
    EXPECT_EQ(sum.collisions, collisions);
    EXPECT_EQ(sum.tois, collisions);
  }
}

}  // namespace
}  // namespace touchstone::verify::jobs::certify_test
