#include "verify/jobs/certify.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "verify/jobs/stream.hpp"
#include "verify/jobs/truth_and_answers.hpp"

namespace touchstone::verify::jobs {
namespace {

/// The parallel stage: the truth about the queries of one block, and the judgement on labels and
/// answers.
class BlockJudgement {
 public:
  BlockJudgement(const QueryBlock& block, const CertifyOptions& options,
                 const judge::LabelComparison& comparison)
      : block_(block), options_(options), passes_(block.size(), options.stop) {
    if (options.decides) {
      truth_.emplace(block,
                     BlockTruthOptions{.separation = options.separation,
                                       .comparison = comparison,
                                       .times = options.on_truth || !options.solvers.empty(),
                                       .certificates = options.on_certificates != nullptr,
                                       .proof = options.proof},
                     passes_);
    }
    answers_.reserve(options.solvers.size());
    for (const solvers::Solver* solver : options.solvers) {
      answers_.emplace_back(block, *solver, options.separation, passes_);
    }
    complete_ = passes_.complete();
    for (const BlockAnswers& answers : answers_) {
      judgements_.push_back(answers.judge(complete_, truths()));
    }
  }

  [[nodiscard]] bool complete() const { return complete_ == block_.size(); }

  /// The serial stage.
  void add_to(CertifyResult& result) const {
    if (truth_) truth_->add_to(result, complete_);
    if (options_.on_truth) std::ranges::for_each(truths(), options_.on_truth);
    if (options_.on_certificates) {
      for (const DecidedPart& part : parts()) options_.on_certificates(part.certificates);
    }
    if (options_.on_answer) tell_answers();
    if (options_.on_wrong) tell_wrong_queries();
    for (std::size_t i = 0; i < judgements_.size(); ++i) {
      result.methods[i].judgement += judgements_[i];
    }
  }

 private:
  /// The truth about the complete queries; empty if none are decided.
  [[nodiscard]] std::span<const judge::GroundTruth> truths() const {
    if (!truth_) return {};
    return truth_->truths().first(complete_);
  }
  [[nodiscard]] std::span<const DecidedPart> parts() const {
    if (!truth_) return {};
    return truth_->parts(complete_);
  }

  void tell_answers() const {
    for (const BlockAnswers& answers : answers_) {
      for (std::size_t i = 0; i < complete_; ++i) {
        if (answers.why_unasked(i)) continue;
        options_.on_answer(block_.indices[i], answers.answers()[i], answers.failure(i));
      }
    }
  }

  /// The texts of all faults, by the indices of the queries.
  [[nodiscard]] std::map<std::uint64_t, std::vector<std::string>> faults() const {
    std::map<std::uint64_t, std::vector<std::string>> result;
    for (const DecidedPart& part : parts()) {
      for (const judge::Mismatch& mismatch : part.mismatches) {
        result[mismatch.index].push_back(judge::to_text(mismatch));
      }
    }
    for (std::size_t i = 0; i < judgements_.size(); ++i) {
      const solvers::Solver& solver = *options_.solvers[i];
      for (const judge::WrongAnswer& wrong : judgements_[i].wrong_answers) {
        if (!judge::breaks(wrong.fault, solver.promise())) continue;
        result[wrong.index].push_back(judge::to_text(solver.name(), wrong));
      }
    }
    return result;
  }

  void tell_wrong_queries() const {
    for (auto& [index, texts] : faults()) {
      const auto place = std::ranges::lower_bound(block_.indices, index) - block_.indices.begin();
      const auto i = static_cast<std::size_t>(place);
      judge::WrongQuery wrong{.source = *block_.source,
                              .index = index,
                              .query = {block_.queries(), i},
                              .separation = options_.separation,
                              .faults = texts};
      for (const BlockAnswers& answers : answers_) {
        if (auto given = answers.given(i)) wrong.answers.push_back(std::move(*given));
      }
      options_.on_wrong(std::move(wrong));
    }
  }

  const QueryBlock& block_;
  const CertifyOptions& options_;
  Passes passes_;
  std::optional<BlockTruth> truth_;
  std::vector<BlockAnswers> answers_;
  std::vector<judge::Judgement> judgements_;
  std::size_t complete_ = 0;
};

/// Queries of a block if time is short.
constexpr std::size_t short_block = 256;

void add_methods(std::vector<MethodResult>& sum, const std::vector<MethodResult>& methods) {
  for (std::size_t i = 0; i < methods.size(); ++i) {
    const MethodResult& method = methods[i];
    if (i == sum.size())
      sum.push_back({method.name, method.promise, method.terms, method.timed, {}});
    judge::Judgement counts = method.judgement;
    counts.wrong_answers.clear();
    counts.first_missing.reset();
    sum[i].judgement += counts;
  }
}

}  // namespace

MethodResult result_of(const solvers::Solver& solver) {
  return {.name = solver.name(),
          .promise = solver.promise(),
          .terms = solver.terms(),
          .timed = solver.is_timed(),
          .judgement = {}};
}

std::optional<double> MethodResult::nanoseconds_per_query() const {
  if (!timed || judgement.queries == 0) return std::nullopt;
  return judgement.nanoseconds_per_query();
}

std::optional<double> MethodResult::checks_per_query() const {
  if (judgement.queries == 0 || judgement.checks == 0) return std::nullopt;
  return static_cast<double>(judgement.checks) / static_cast<double>(judgement.queries);
}

exact::Rational CertifyOptions::default_toi_tolerance() {
  return exact::rational_from_decimal("1e-40");
}

double CertifyResult::microseconds_per_query() const {
  return queries == 0 ? 0.0 : microseconds / static_cast<double>(queries);
}

void CertifyResult::fail(const std::string& message) {
  error = message;
  errors = 1;
}

CertifyResult& CertifyResult::operator+=(const CertifyResult& other) {
  queries += other.queries;
  collisions += other.collisions;
  labels += other.labels;
  label_mismatches += other.label_mismatches;
  tois += other.tois;
  toi_mismatches += other.toi_mismatches;
  skipped += other.skipped;
  rounded += other.rounded;
  errors += other.errors;
  microseconds += other.microseconds;
  proofs += other.proofs;
  interrupted = interrupted || other.interrupted;
  add_methods(methods, other.methods);
  return *this;
}

bool has_wrong_answers(const CertifyResult& result) {
  const auto is_wrong = [](const MethodResult& method) {
    return !judge::keeps(method.judgement, method.promise);
  };
  return result.label_mismatches + result.toi_mismatches != 0 ||
         std::ranges::any_of(result.methods, is_wrong);
}

CertifyResult certify(data::QuerySource& source, const CertifyOptions& options) {
  const judge::LabelComparison comparison{
      .inference = options.compares_labels
                       ? judge::infer(source.recorded_separation(), options.separation)
                       : judge::Inference::nothing,
      .tolerance = options.toi_tolerance};
  CertifyResult result;
  result.separation = options.separation;
  result.compared = comparison.inference;
  result.name = source.name();
  result.shape = source.shape();
  for (const solvers::Solver* solver : options.solvers) {
    result.methods.push_back(result_of(*solver));
  }
  const StreamResult ended = stream(
      source, [&](const QueryBlock& block) { return BlockJudgement(block, options, comparison); },
      [&](const BlockJudgement& judgement) { judgement.add_to(result); },
      {.threads = options.threads,
       .on_progress = options.on_progress,
       .stop = options.stop,
       .deadline = options.deadline,
       .block = options.is_short_of_time ? short_block : QueryBlock::most_queries});
  result.skipped = ended.skipped;
  result.rounded = ended.rounded;
  result.interrupted = ended.interrupted;
  if (ended.error) result.fail(*ended.error);
  return result;
}

CertifyResult total(const std::vector<CertifyResult>& results) {
  CertifyResult sum;
  sum.name = "total";
  for (const CertifyResult& result : results) sum += result;
  return sum;
}

}  // namespace touchstone::verify::jobs
