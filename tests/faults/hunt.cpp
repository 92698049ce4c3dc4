#include "tests/faults/hunt.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>

#include "verify/fuzz/recheck.hpp"

namespace touchstone::tests {
namespace {

/// Enough boxes in each query to go wrong.
constexpr std::int64_t most_checks = 1000;

/// The certified solver with another exact stage, for straight lines alone.
class WithExactStage final : public fast::Method {
 public:
  explicit WithExactStage(DecideExactly* decide) : decide_(decide), info_(fast::certified_info()) {
    info_.terms = {};
  }

  [[nodiscard]] const fast::MethodInfo& info() const override { return info_; }
  void solve(const AnyQueries& queries, std::span<fast::Answer> answers,
             const fast::MethodOptions& options) const override {
    const fast::CertifiedOptions all{
        .t_max = options.t_max, .separation = options.separation, .max_threads = 1};
    const ContactKind kind = queries.kind.contact();
    for (std::size_t i = 0; i < answers.size(); ++i) {
      const Query& query = queries.straight()[i];
      fast::CertifiedResult result = fast::solve(kind, query, all);
      if (result.is_exact && result.verdict != fast::Verdict::error) {
        const auto impact = decide_(kind, query, all.separation, all.toi_tolerance, all.t_max);
        result = {.verdict = impact ? fast::Verdict::yes : fast::Verdict::no};
        if (impact) result.toi_lower = impact->toi_lower, result.toi_upper = impact->toi_upper;
      }
      answers[i] = verify::fuzz::answer_of(result);
    }
  }

 private:
  DecideExactly* decide_;
  fast::MethodInfo info_;
};

std::vector<FaultySolver> all_faulty_solvers() {
  constexpr std::string_view tight_inclusion = "tight_inclusion", certified = "certified";
  const PlantedFaults& planted = planted_faults();
  std::vector<FaultySolver> all;
  for (const auto& fault : planted.box_kernel) {
    all.push_back({fault, tight_inclusion,
                   [part = fault.part] { return fast::tight_inclusion_method({.kernel = part}); }});
  }
  for (const auto& fault : planted.tight_inclusion) {
    all.push_back({fault, tight_inclusion, [part = fault.part] { return part({}); }});
  }
  for (const auto& fault : planted.certified_kernel) {
    all.push_back({fault, certified, [part = fault.part] {
                     return fast::certified_method({.kernels = {.certified = part}});
                   }});
  }
  for (const auto& fault : planted.curved_kernel) {
    all.push_back(
        {fault, certified,
         [part = fault.part] { return fast::certified_method({.kernels = {.certified = part}}); },
         true});
  }
  for (const auto& fault : planted.exact_stage) {
    all.push_back(
        {fault, certified, [part = fault.part] { return std::make_unique<WithExactStage>(part); }});
  }
  for (const auto& fault : planted.certified) {
    all.push_back({fault, certified, [part = fault.part] { return part({}); }});
  }
  return all;
}

/// A faulty solver under the name of its fault: the certified solver does not judge a method that
/// is named as itself.
class Named final : public fast::Method {
 public:
  explicit Named(const FaultySolver& solver) : method_(solver.make()), info_(method_->info()) {
    info_.name = solver.fault.name;
  }

  [[nodiscard]] const fast::MethodInfo& info() const override { return info_; }
  void solve(const AnyQueries& queries, std::span<fast::Answer> answers,
             const fast::MethodOptions& options) const override {
    method_->solve(queries, answers, options);
  }

 private:
  std::unique_ptr<fast::Method> method_;
  fast::MethodInfo info_;
};

verify::fuzz::FuzzOptions fuzz_options(const FaultySolver& solver) {
  verify::fuzz::FuzzOptions options;
  if (solver.fault.separation.distance > 0.0) options.separation = solver.fault.separation;
  options.method.max_checks = most_checks;
  options.most_groups = 1;
  if (!solver.is_on_curves) return options;
  options.shapes.clear();
  for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
    options.shapes.push_back({kind, 2});
    options.shapes.push_back({kind, 3});
    options.shapes.push_back({kind, 2, true});
  }
  return options;
}

}  // namespace

const std::vector<FaultySolver>& faulty_solvers() {
  static const std::vector<FaultySolver> all = all_faulty_solvers();
  return all;
}

const FaultySolver& find_faulty_solver(std::string_view fault) {
  const auto found = std::ranges::find(
      faulty_solvers(), fault, [](const FaultySolver& solver) { return solver.fault.name; });
  if (found == faulty_solvers().end()) {
    throw std::invalid_argument("no solver with a fault called " + std::string(fault));
  }
  return *found;
}

Hunt hunt(const FaultySolver& solver, const HuntOptions& options) {
  const Named method(solver);
  verify::fuzz::FuzzOptions fuzzing = fuzz_options(solver);
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

verify::base::AnyQuery simplest(const FaultySolver& solver, const verify::fuzz::Finding& finding) {
  const Named method(solver);
  verify::fuzz::Finding simpler = finding;
  verify::fuzz::simplify(method, fuzz_options(solver), {}, simpler);
  return simpler.simplest.query;
}

}  // namespace touchstone::tests
