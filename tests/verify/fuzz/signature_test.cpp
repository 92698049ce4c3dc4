#include "verify/fuzz/signature.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "fast/certified.hpp"
#include "tests/support/methods.hpp"
#include "tests/support/queries.hpp"
#include "verify/fuzz/plainness.hpp"
#include "verify/fuzz/recheck.hpp"

namespace touchstone::verify::fuzz::signature_test {
namespace {

using fast::Answer;
using fast::Promise;
using fast::Verdict;
using tests::FunctionMethod;

Finding finding_of(Kind kind, const Query& query) {
  Finding finding;
  finding.kind = kind;
  finding.method = "function";
  const exact::Decision truth = exact::decide(kind, query);
  finding.simplest.query = query;
  finding.simplest.collides = truth.collides();
  if (truth.collides()) finding.simplest.toi = truth.toi->enclosure();
  finding.original = finding.simplest;
  finding.shrinking = Shrinking::complete;
  return finding;
}

const Query falling = tests::over_triangle(1, 1, 1, -2).query;  // its size is 2^2

/// The range of a method that misses all queries whose greatest coordinate is in a range of binary
/// exponents.
ScaleRange range_of_misses(int from, int to, const FuzzOptions& options = {}) {
  const FunctionMethod method(
      [from, to](Kind kind, const Query& query) {
        const int size = size_exponent(query);
        if (size >= from && size <= to) return Answer{.verdict = Verdict::no};
        return answer_of(fast::solve(kind, query));
      },
      Promise::none);
  return scale_range(method, options, {}, finding_of(Kind::vertex_face, falling));
}

TEST(ScaleRange, EndsWhereTheFaultDoes) {
  const ScaleRange small = range_of_misses(-1000, 5);
  EXPECT_FALSE(small.end_below);
  EXPECT_EQ(small.end_above, 6);
  const ScaleRange large = range_of_misses(-6, 1000);
  EXPECT_EQ(large.end_below, -7);
  EXPECT_FALSE(large.end_above);
  const ScaleRange both = range_of_misses(2, 2);
  EXPECT_EQ(both.end_below, 1);
  EXPECT_EQ(both.end_above, 3);
}

TEST(ScaleRange, DoesNotAskBelowTheTolerance) {
  EXPECT_EQ(least_scale(0x1p-20), -16);
  EXPECT_EQ(least_scale(0.0), -40);
  EXPECT_EQ(least_scale(std::nan("")), -40);
  EXPECT_EQ(least_scale(1e9), 0);
  FuzzOptions options;
  options.method.tolerance = 0x1p-20;
  EXPECT_FALSE(range_of_misses(-18, 1000, options).end_below);
  EXPECT_EQ(range_of_misses(-13, 1000, options).end_below, -14);
  options.method.tolerance = 0.0;
  EXPECT_EQ(range_of_misses(-18, 1000, options).end_below, -20);
}

TEST(ScaleRange, IsUnknownForHangsAndSeparations) {
  const FunctionMethod method([](Kind, const Query&) { return Answer{.verdict = Verdict::no}; });
  Finding finding = finding_of(Kind::vertex_face, falling);
  finding.separation = {.distance = 0.5, .norm = Norm::l2};
  EXPECT_FALSE(scale_range(method, {}, {}, finding).end_above);
  finding.separation = {};
  finding.what = judge::Fault::hang;
  EXPECT_FALSE(scale_range(method, {}, {}, finding).end_above);
}

TEST(ScaleRange, IsUnknownWhenTheTimeIsOver) {
  const FunctionMethod method(
      [](Kind kind, const Query& query) { return answer_of(fast::solve(kind, query)); });
  const ScaleRange range =
      scale_range(method, {}, base::Deadline(0.0), finding_of(Kind::vertex_face, falling));
  EXPECT_FALSE(range.end_below || range.end_above);
}

TEST(Signature, OfAFaultOfScaleIsItsEnds) {
  Finding finding = finding_of(Kind::vertex_face, falling);
  finding.scales = {.end_above = 1};
  const Signature small = signature_of(finding);
  EXPECT_EQ(to_text(small.ends), "ends near 1");
  EXPECT_FALSE(small.kind || small.shape || small.time);
  // The other side of the same end, of the other kind, at another time.
  Finding other = finding_of(Kind::edge_edge, tests::over_edge(1, 1, 0, -0.5).query);
  other.scales = {.end_below = -3};
  EXPECT_EQ(signature_of(other), small);
  other.scales = {.end_below = -20, .end_above = 20};
  EXPECT_EQ(to_text(signature_of(other).ends), "ends below 2^-10 and above 2^10");
  other.scales = {.end_above = 1};
  other.what = judge::Fault::late_toi;
  EXPECT_NE(signature_of(other), small);
}

TEST(Signature, OfAFaultOfLogicIsKindShapeAndTime) {
  const Signature between = signature_of(finding_of(Kind::vertex_face, falling));
  EXPECT_EQ(to_text(between.ends), "any scale");
  EXPECT_EQ(to_text(between.shape), "general");
  EXPECT_EQ(to_text(between.time), "between");
  const auto time_of = [](double start, double end) {
    return to_text(
        signature_of(finding_of(Kind::vertex_face, tests::over_triangle(1, 1, start, end).query))
            .time);
  };
  EXPECT_EQ(time_of(0, -2), "t=0");
  EXPECT_EQ(time_of(1, 0), "t=1");
  EXPECT_EQ(time_of(2, 1), "none");
  Query flat = tests::over_triangle(1, 1, 0, 0).query;
  EXPECT_EQ(to_text(signature_of(finding_of(Kind::vertex_face, flat)).shape), "coplanar");
  flat.point(0, 2) = flat.point(0, 3);
  EXPECT_EQ(to_text(signature_of(finding_of(Kind::vertex_face, flat)).shape), "collapsed");
}

TEST(Signature, TellsCrashesApartByTheirReason) {
  Finding finding = finding_of(Kind::vertex_face, falling);
  finding.what = judge::Fault::crash;
  finding.simplest.detail = "crash: SIGSEGV";
  Finding other = finding;
  EXPECT_EQ(signature_of(other), signature_of(finding));
  other.simplest.detail = "crash: SIGFPE";
  EXPECT_NE(signature_of(other), signature_of(finding));
}

}  // namespace
}  // namespace touchstone::verify::fuzz::signature_test
