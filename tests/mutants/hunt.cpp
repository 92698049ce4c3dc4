#include "tests/mutants/hunt.hpp"

#include <memory>
#include <span>
#include <string_view>

#include "verify/fuzz/recheck.hpp"

namespace touchstone::tests {
namespace {

/// So many boxes a query are enough to go wrong in.
constexpr std::int64_t most_checks = 1000;

/// A mutant under its own name: what calls itself certified is not judged by the certified solver.
class Named final : public fast::Method {
 public:
  explicit Named(const Mutant& mutant) : method_(mutant.make()), info_(method_->info()) {
    info_.name = mutant.name;
  }

  [[nodiscard]] const fast::MethodInfo& info() const override { return info_; }
  void solve(Kind kind, std::span<const Query> queries, std::span<fast::Answer> answers,
             const fast::MethodOptions& options) const override {
    method_->solve(kind, queries, answers, options);
  }

 private:
  std::unique_ptr<fast::Method> method_;
  fast::MethodInfo info_;
};

verify::fuzz::FuzzOptions fuzz_options(const Mutant& mutant) {
  verify::fuzz::FuzzOptions options;
  options.separation = mutant.separation;
  options.method.max_checks = most_checks;
  options.most_groups = 1;
  return options;
}

}  // namespace

Hunt hunt(const Mutant& mutant, const HuntOptions& options) {
  const Named method(mutant);
  verify::fuzz::FuzzOptions fuzzing = fuzz_options(mutant);
  fuzzing.seconds = options.seconds;
  fuzzing.most_queries = options.queries;
  fuzzing.seed = options.seed;
  verify::fuzz::FuzzResult result = verify::fuzz::fuzz(method, fuzzing);
  Hunt hunt{.finding = {}, .seconds = result.seconds, .queries = result.queries};
  if (!result.findings.empty()) {
    hunt.finding = result.findings.front();
    hunt.queries = hunt.finding->queries;
  }
  return hunt;
}

Query simplest(const Mutant& mutant, const verify::fuzz::Finding& finding) {
  const Named method(mutant);
  verify::fuzz::Finding simpler = finding;
  verify::fuzz::simplify(method, fuzz_options(mutant), {}, simpler);
  return simpler.simplest.query;
}

}  // namespace touchstone::tests
