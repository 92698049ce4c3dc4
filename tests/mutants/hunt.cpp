#include "tests/mutants/hunt.hpp"

#include <memory>

#include "verify/fuzz/shrink.hpp"
#include "verify/methods/registry.hpp"

namespace touchstone::tests {
namespace {

/// So many boxes a query are enough to go wrong in.
constexpr std::int64_t most_checks = 5000;

verify::FuzzOptions fuzz_options(const Mutant& mutant) {
  verify::FuzzOptions options;
  options.separation = mutant.separation;
  options.method.max_checks = most_checks;
  options.reach = verify::reach_of(mutant.of);
  options.most_findings = 1;
  return options;
}

}  // namespace

Hunt hunt(const Mutant& mutant, const HuntOptions& options) {
  const std::unique_ptr<fast::Method> method = mutant.make();
  verify::FuzzOptions fuzzing = fuzz_options(mutant);
  fuzzing.seconds = options.seconds;
  fuzzing.most_queries = options.queries;
  fuzzing.seed = options.seed;
  verify::FuzzResult result = verify::fuzz(*method, fuzzing);
  Hunt hunt{.finding = {}, .seconds = result.seconds, .queries = result.queries};
  if (!result.findings.empty()) {
    hunt.finding = result.findings.front();
    hunt.queries = hunt.finding->queries;
  }
  return hunt;
}

Query simplest(const Mutant& mutant, const verify::Finding& finding) {
  const std::unique_ptr<fast::Method> method = mutant.make();
  return verify::shrink(finding.kind, finding.query,
                        verify::still_fails(*method, finding, fuzz_options(mutant)));
}

}  // namespace touchstone::tests
