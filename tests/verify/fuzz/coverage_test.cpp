#include "verify/fuzz/coverage.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <set>
#include <vector>

#include "tests/support/queries.hpp"

namespace touchstone::verify::fuzz::coverage_test {
namespace {

using fast::Answer;
using fast::CertifiedResult;
using fast::Verdict;

struct Case {
  Kind kind = Kind::vertex_face;
  Query query = tests::over_triangle(1, 1, 1, -1).query;
  CertifiedResult judged{.verdict = Verdict::yes,
                         .stage = fast::Stage::bisection,
                         .toi_lower = 0.4999,
                         .toi_upper = 0.5,
                         .u = 0.25,
                         .v = 0.25};
  Answer answer{.verdict = Verdict::yes, .toi_lower = 0.499, .tolerance = 1e-6};

  [[nodiscard]] std::uint64_t operator()() const {
    return coverage_key(kind, query, judged, answer);
  }
};

TEST(CoverageKey, TellsSortsApart) {
  const std::vector<std::function<void(Case&)>> changes{
      [](Case&) {},
      [](Case& c) { c.kind = Kind::edge_edge; },
      [](Case& c) { c.judged.stage = fast::Stage::exact; },
      [](Case& c) { c.judged.verdict = Verdict::no; },
      [](Case& c) { c.answer.verdict = Verdict::no; },
      [](Case& c) { c.answer.verdict = Verdict::undecided; },
      [](Case& c) { c.judged.toi_upper = 0.01; },
      [](Case& c) { c.judged.toi_upper = 1.0; },
      [](Case& c) { c.judged.u = 0.0; },
      [](Case& c) { c.judged.v = 0.75; },
      [](Case& c) { c.answer.toi_lower = 0.25; },
      [](Case& c) { c.answer.toi_lower = 0.4999999; },
      [](Case& c) { c.answer.tolerance = 1e-3; },
      [](Case& c) { c.query.coordinates.fill(1.0); },
      [](Case& c) { c.query.coordinates.front() = 1e100; }};
  std::set<std::uint64_t> seen;
  for (const auto& change : changes) {
    Case one;
    change(one);
    seen.insert(one());
  }
  EXPECT_EQ(seen.size(), changes.size());
}

TEST(CoverageKey, IsCoarse) {
  const Case one;
  Case other;
  other.query.coordinates.front() = 1.5;
  other.judged.toi_upper = 0.51;
  other.judged.u = 0.3;
  other.answer.toi_lower = 0.5085;
  other.answer.tolerance = 1.1e-6;
  EXPECT_EQ(one(), other());
}

}  // namespace
}  // namespace touchstone::verify::fuzz::coverage_test
