#include "verify/jobs/prove.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/certificates.hpp"
#include "tests/support/memory_source.hpp"
#include "tests/support/queries.hpp"
#include "touchstone/certificate_text.hpp"
#include "verify/jobs/certify.hpp"

namespace touchstone::verify::jobs::prove_test {
namespace {

using tests::MemorySource;

/// Queries of which every third collides, at 0, at 1/3 or at 3/4.
std::vector<data::RecordedQuery> falling_vertices(std::uint64_t count) {
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

struct ProofRun {
  CertifyResult proof;
  std::string text{exact::certificates_header()};

  /// The text with the closing line for its counts.
  [[nodiscard]] std::string stream() const {
    return text + exact::certificates_closing_line(proof.proofs.certificates());
  }
};

ProofRun run(data::QuerySource& source, CertifyOptions options = {}) {
  ProofRun result;
  options.on_certificates = [&](std::string_view text) { result.text += text; };
  result.proof = certify(source, options);
  return result;
}

TEST(Prove, WritesEveryCertificateInOrderWhateverTheThreads) {
  std::string first;
  for (const unsigned threads : {1U, 3U}) {
    MemorySource source(Kind::vertex_face, falling_vertices(9000));
    const ProofRun result = run(source, {.threads = threads});
    const ProofCounts& counts = result.proof.proofs;
    EXPECT_EQ(counts.certificates(), 9000U);
    EXPECT_EQ(counts.no_collision, 6000U);
    EXPECT_EQ(counts.time_of_impact, 3000U);
    EXPECT_EQ(counts.collision, 0U);
    EXPECT_EQ(counts.subintervals, (std::map<std::size_t, std::uint64_t>{{0, 1000}, {1, 8000}}));
    EXPECT_EQ(counts.bytes + exact::certificates_header().size(), result.text.size());
    EXPECT_GT(counts.nanoseconds, 0.0);
    EXPECT_GT(result.proof.microseconds, 0.0);
    EXPECT_TRUE(counts.beyond_limits.empty());
    EXPECT_EQ(result.proof.skipped, 3U);
    EXPECT_EQ(result.proof.rounded, 5U);
    if (first.empty()) first = result.text;
    EXPECT_EQ(result.text, first);
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

TEST(Prove, AnErrorOrAStopLeavesWholeCertificates) {
  MemorySource broken(Kind::vertex_face, falling_vertices(3000));
  broken.fail_at(2500, "row is broken");
  const ProofRun to_error = run(broken);
  EXPECT_EQ(to_error.proof.error, "row is broken");
  EXPECT_EQ(tests::check_text(to_error.stream()).accepted(), 2500U);

  std::atomic<bool> stop = false;
  MemorySource source(Kind::vertex_face, falling_vertices(200000));
  std::string text(exact::certificates_header());
  const CertifyResult stopped = certify(source, {.on_certificates =
                                                     [&](std::string_view certificates) {
                                                       text += certificates;
                                                       stop = true;
                                                     },
                                                 .stop = &stop});
  EXPECT_TRUE(stopped.interrupted);
  const checker::Report report =
      tests::check_text(text + exact::certificates_closing_line(stopped.proofs.certificates()));
  EXPECT_TRUE(report.all_accepted());
  EXPECT_EQ(report.accepted(), stopped.proofs.certificates());
  EXPECT_GT(report.accepted(), 0U);
  EXPECT_LT(report.accepted(), 100000U);
}

}  // namespace
}  // namespace touchstone::verify::jobs::prove_test
