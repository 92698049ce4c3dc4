#include "verify/jobs/certify.hpp"

#include <algorithm>
#include <map>
#include <span>
#include <utility>

#include "touchstone/oracle.hpp"
#include "verify/base/cores.hpp"
#include "verify/base/thread_clock.hpp"
#include "verify/jobs/stream.hpp"
#include "verify/judge/ground_truth.hpp"

namespace touchstone::verify::jobs {
namespace {

// ---- Truth --------------------------------------------------------------------------------------

struct BlockTruthOptions {
  Separation separation = {};
  judge::LabelComparison comparison = {};
  bool times = false;         ///< true if times of impact are needed
  bool certificates = false;  ///< true if certificates are to be written
  exact::ProveOptions proof = {};
};

/// The results of the oracle for a part of a block.
struct DecidedPart {
  std::vector<judge::Mismatch> mismatches;
  double nanoseconds = 0.0;
  std::string certificates;
  ProofCounts proofs;
};

/// The truth about the queries of one block.
class BlockTruth {
 public:
  /// Decides all queries in one of the passes. The block must live as long as this.
  BlockTruth(const QueryBlock& block, BlockTruthOptions options, Passes& passes)
      : block_(block),
        options_(std::move(options)),
        truths_(block.size()),
        parts_(Passes::units(block.size())) {
    passes.run(Passes::unit, [this](std::size_t first, std::size_t count) {
      decide(first, count, parts_[first / Passes::unit]);
      return true;
    });
  }

  /// By query, without times where these are not needed.
  [[nodiscard]] std::span<const judge::GroundTruth> truths() const { return truths_; }

  /// The parts of the first `count` queries.
  [[nodiscard]] std::span<const DecidedPart> parts(std::size_t count) const {
    return std::span(parts_).first(Passes::units(count));
  }

  /// Adds counts and mismatches of the first `count` queries.
  void add_to(CertifyResult& result, std::size_t count) const {
    for (std::size_t i = 0; i < count; ++i) {
      ++result.queries;
      result.collisions += truths_[i].collides ? 1U : 0U;
      result.labels += options_.comparison.uses_verdict(block_.labels[i]) ? 1U : 0U;
      result.tois += options_.comparison.uses_toi(block_.labels[i]) ? 1U : 0U;
    }
    for (const DecidedPart& part : parts(count)) {
      for (const judge::Mismatch& mismatch : part.mismatches) {
        ++(mismatch.of == judge::Mismatch::Of::label ? result.label_mismatches
                                                     : result.toi_mismatches);
        result.mismatches.push_back(mismatch);
      }
      result.microseconds += 1e-3 * part.nanoseconds;
      result.proofs += part.proofs;
    }
  }

 private:
  void decide(std::size_t first, std::size_t count, DecidedPart& part) {
    const double start = base::thread_nanoseconds();
    const std::vector<exact::Decision> verdicts =
        exact::decide(block_.queries().part(first, count), options_.separation);
    part.nanoseconds = base::thread_nanoseconds() - start;
    for (std::size_t i = 0; i < count; ++i) {
      const exact::Decision& verdict = verdicts[i];
      const std::uint64_t index = block_.indices[first + i];
      for (judge::Mismatch& mismatch :
           judge::judge_label(index, block_.labels[first + i], verdict, options_.comparison)) {
        part.mismatches.push_back(std::move(mismatch));
      }
      truths_[first + i] =
          options_.times ? judge::truth_of(index, verdict)
                         : judge::GroundTruth{
                               .index = index, .collides = verdict.collides(), .toi = std::nullopt};
    }
    if (options_.certificates) prove(first, verdicts, part);
  }

  void prove(std::size_t first, const std::vector<exact::Decision>& verdicts,
             DecidedPart& part) const {
    const double start = base::thread_nanoseconds();
    for (std::size_t i = 0; i < verdicts.size(); ++i) {
      append_certificate(block_.queries(), first + i, verdicts[i],
                         certificate_label(*block_.source, block_.indices[first + i]),
                         options_.proof, part.certificates, part.proofs);
    }
    part.proofs.nanoseconds = base::thread_nanoseconds() - start;
  }

  const QueryBlock& block_;
  BlockTruthOptions options_;
  std::vector<judge::GroundTruth> truths_;
  std::vector<DecidedPart> parts_;
};

// ---- Answers ------------------------------------------------------------------------------------

/// The answers of a solver to the queries of one block. All below is about the first `count` of
/// them, no more than are complete (Passes::complete). A call may reach beyond these; it then
/// counts in part.
class BlockAnswers {
 public:
  /// Asks the solver in one of the passes. The block and the solver must live as long as this.
  BlockAnswers(const QueryBlock& block, const solvers::Solver& solver, const Separation& separation,
               Passes& passes)
      : block_(block),
        solver_(solver),
        separation_(separation),
        answers_(block.size()),
        calls_(Passes::units(block.size())) {
    passes.run(solver.good_span(), [this](std::size_t first, std::size_t count) {
      Call& call = calls_[first / Passes::unit];
      call = {.count = count,
              .reply = solver_.solve_timed(block_.request(first, count, separation_),
                                           std::span(answers_).subspan(first, count))};
      return !call.reply.stopped;
    });
    for (std::size_t unit = 0; unit < calls_.size(); ++unit) {
      const bool is_begin = unit == 0 || calls_[unit].count != 0;
      begins_.push_back(is_begin ? unit * Passes::unit : begins_.back());
    }
  }

  [[nodiscard]] const solvers::Solver& solver() const { return solver_; }

  /// By query.
  [[nodiscard]] std::span<const fast::Answer> answers() const { return answers_; }

  /// The failure at query i that the solver reports with the answers, or null.
  [[nodiscard]] const judge::Failure* failure(std::size_t i) const {
    const std::size_t first = begins_[i / Passes::unit];
    return judge::failure_at(calls_[first / Passes::unit].reply.failures, i - first);
  }

  /// The reason why query i was not asked; nothing if it was.
  [[nodiscard]] std::optional<judge::Unasked> why_unasked(std::size_t i) const {
    const std::size_t first = begins_[i / Passes::unit];
    return calls_[first / Passes::unit].reply.why_unasked(i - first);
  }

  /// The answer to query i as a person is shown it, unless the solver has none.
  [[nodiscard]] std::optional<judge::GivenAnswer> given(std::size_t i) const {
    if (why_unasked(i)) return std::nullopt;
    judge::GivenAnswer given{
        .solver = solver_.name(), .answer = answers_[i], .standard = solver_.standard()};
    if (const judge::Failure* const failed = failure(i)) given.failure = *failed;
    return given;
  }

  /// The judgement on the first `count` answers. \param truths empty: queries are only counted
  [[nodiscard]] judge::Judgement judge(std::size_t count,
                                       std::span<const judge::GroundTruth> truths) const {
    judge::Judgement judgement;
    const Queries queries = block_.queries();
    for (std::size_t i = 0; i < count; ++i) {
      if (const auto why = why_unasked(i)) {
        judgement.add_unasked(*why, block_.indices[i]);
      } else if (truths.empty()) {
        ++judgement.queries;
      } else {
        judgement.add({queries.part(i, 1), separation_}, truths[i], answers_[i], solver_.standard(),
                      failure(i));
      }
    }
    for (const Call& call : std::span(calls_).first(Passes::units(count))) {
      judgement.unplaced_crashes += call.reply.unplaced_crashes;
    }
    for (std::size_t first = 0; first < count; first += calls_[first / Passes::unit].count) {
      const Call& call = calls_[first / Passes::unit];
      const std::size_t counted = std::min(call.count, count - first);
      judgement.nanoseconds += call.reply.time.value().processor_nanoseconds *
                               static_cast<double>(counted) / static_cast<double>(call.count);
    }
    return judgement;
  }

 private:
  /// A call, which answers queries from a multiple of Passes::unit on.
  struct Call {
    std::size_t count = 0;  ///< of queries; 0: no call begins here
    solvers::SolveReply reply;
  };

  const QueryBlock& block_;
  const solvers::Solver& solver_;
  Separation separation_;
  std::vector<fast::Answer> answers_;
  std::vector<Call> calls_;               ///< by the unit of their first query
  std::vector<std::size_t> begins_ = {};  ///< by unit: the first query of its call
};

// ---- Both ---------------------------------------------------------------------------------------

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
        options_.on_answer(answers.solver(), block_.indices[i], answers.answers()[i],
                           answers.failure(i));
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

Budget::Budget(double seconds, std::vector<const solvers::Solver*> solvers, unsigned threads,
               const base::SecondsClock& clock)
    : end_(base::Deadline(seconds, clock)),
      solvers_(std::move(solvers)),
      threads_(base::cores_for(threads)) {}

base::Deadline Budget::begin_source(std::size_t sources_left) const {
  if (!end_) return {};
  // The rest is for the oracle, the reading and the writing.
  constexpr double solvers_part = 0.8;
  const double seconds =
      end_->seconds_left() / static_cast<double>(std::max<std::size_t>(sources_left, 1));
  for (const solvers::Solver* solver : solvers_) {
    solver->allow(solvers_part * seconds * threads_ / static_cast<double>(solvers_.size()));
  }
  return end_->at_most(seconds);
}

}  // namespace touchstone::verify::jobs
