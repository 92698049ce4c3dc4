/// \file
/// The regression corpus, tests/corpus/: queries that a wrong solver once answered wrongly, each as
/// simple as it gets, with the truth as label. No solver of ours answers one wrongly.
///
/// They come from the fuzzer, which found and shrank them against solvers with planted faults
/// (tests/faults/), and from findings kept by hand (`touchstone fuzz … --out`). `contact/` is about
/// contact itself, `linf/` and `l2/` about the separation in their separation.json.

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <vector>

#include "tests/support/built_files.hpp"
#include "verify/data/dataset.hpp"
#include "verify/data/ground_truth_files.hpp"
#include "verify/jobs/certify.hpp"
#include "verify/solvers/registry.hpp"
#include "verify/solvers/solver.hpp"

namespace touchstone::verify::corpus_test {
namespace {

std::vector<std::filesystem::path> corpus() {
  return data::find_datasets(
      {{std::filesystem::path(tests::source_folder()) / "tests" / "corpus"}});
}

std::vector<std::unique_ptr<solvers::Solver>> solvers() {
  std::vector<std::unique_ptr<solvers::Solver>> result;
  for (const std::string& name : solvers::default_methods()) {
    result.push_back(
        solvers::solver_in_process(solvers::find_method(name), {.max_checks = 20'000}));
  }
  return result;
}

TEST(Corpus, IsAnsweredRightlyByTheOracleAndByEverySolver) {
  const auto asked = solvers();
  ASSERT_GE(asked.size(), 2U);
  std::uint64_t queries = 0;
  for (const std::filesystem::path& path : corpus()) {
    const auto source = data::open_dataset(path);
    jobs::CertifyOptions options{.separation = data::recorded_separation(path), .threads = 1};
    for (const auto& solver : asked) options.solvers.push_back(solver.get());
    const jobs::CertifyResult result = jobs::certify(*source, options);
    EXPECT_FALSE(result.error) << *result.error;
    EXPECT_EQ(result.labels, result.queries) << path;
    EXPECT_EQ(result.label_mismatches, 0U) << path;
    for (const jobs::MethodResult& method : result.methods) {
      EXPECT_TRUE(judge::keeps(method.judgement, method.promise)) << path << ' ' << method.name;
      EXPECT_EQ(method.judgement.queries, result.queries);
    }
    queries += result.queries;
  }
  EXPECT_GE(queries, 20U);
}

TEST(Corpus, HasBothKindsAndASeparation) {
  bool has_faces = false, has_edges = false, is_separated = false;
  for (const std::filesystem::path& path : corpus()) {
    const AnyKind kind = data::open_dataset(path)->kind();
    has_faces = has_faces || kind == ContactKind::vertex_face;
    has_edges = has_edges || kind == ContactKind::edge_edge;
    is_separated = is_separated || data::recorded_separation(path).distance > 0.0;
  }
  EXPECT_TRUE(has_faces && has_edges && is_separated);
}

}  // namespace
}  // namespace touchstone::verify::corpus_test
