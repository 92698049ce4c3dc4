#include "verify/jobs/certify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <span>
#include <utility>

#include "verify/data/toi_writer.hpp"
#include "verify/jobs/stream.hpp"
#include "verify/jobs/thread_clock.hpp"
#include "verify/judge/claimed_distance.hpp"

namespace touchstone::verify::jobs {
namespace {

std::string verdict_text(bool collides) { return collides ? "collision" : "no collision"; }

/// The first significant digits, by which the relative error is far below a unit in the last one.
std::string decimal_text(const exact::AlgebraicNumber& number, unsigned digits) {
  const exact::Rational relative_width =
      exact::power_of_two(-16 - 10 * static_cast<long>(digits) / 3);
  exact::AlgebraicNumber refined = number;
  // Zero would be known as rational, so the lower end leaves zero sooner or later.
  for (unsigned long level = 1; !refined.rational(); level *= 2) {
    refined.refine_to_level(level);
    const auto [lower, upper] = refined.interval();
    if (upper - lower <= relative_width * lower) break;
  }
  return data::to_decimal(refined.interval().lower, digits);
}

/// A recorded time of impact and the true one, which it is not: so many digits that the texts differ, from
/// 45 on, as published times have them.
Mismatch toi_mismatch(std::uint64_t index, const exact::Rational& recorded,
                      const exact::AlgebraicNumber& toi) {
  Mismatch mismatch{Mismatch::Of::toi, index, {}, {}};
  for (unsigned digits = 45; mismatch.recorded == mismatch.truth; digits *= 2) {
    mismatch.recorded = data::to_decimal(recorded, digits);
    mismatch.truth = decimal_text(toi, digits);
  }
  return mismatch;
}

std::string to_text(const Mismatch& mismatch) {
  return fmt::format("recorded {}: {}, the truth is {}",
                     mismatch.of == Mismatch::Of::label ? "label" : "time of impact",
                     mismatch.recorded, mismatch.truth);
}

bool within(const exact::AlgebraicNumber& toi, const exact::Rational& recorded,
            const exact::Rational& tolerance) {
  const exact::Rational lower = recorded - tolerance, upper = recorded + tolerance;
  return toi >= lower && toi <= upper;
}

/// The comparison of recorded claims with the ground truth.
struct Comparison {
  judge::Inference inference;
  exact::Rational tolerance;

  [[nodiscard]] bool uses_label(const Block::Claim& claim) const {
    if (inference == judge::Inference::collisions) return claim.collides.value_or(false);
    return inference == judge::Inference::all && claim.collides;
  }

  [[nodiscard]] bool uses_toi(const Block::Claim& claim) const {
    return inference != judge::Inference::nothing && claim.toi;
  }

  [[nodiscard]] bool accepts(const exact::Rational& recorded,
                             const exact::AlgebraicNumber& toi) const {
    if (inference == judge::Inference::all) return within(toi, recorded, tolerance);
    return toi <= exact::Rational(recorded + tolerance);
  }
};

void compare(std::uint64_t index, const Block::Claim& claim, const exact::Verdict& truth,
             const Comparison& comparison, std::vector<Mismatch>& mismatches) {
  if (comparison.uses_label(claim) && *claim.collides != truth.collides()) {
    mismatches.push_back({Mismatch::Of::label, index, verdict_text(*claim.collides),
                          verdict_text(truth.collides())});
  }
  if (!comparison.uses_toi(claim)) return;
  if (truth.collides() && comparison.accepts(*claim.toi, *truth.toi)) return;
  mismatches.push_back(
      truth.collides()
          ? toi_mismatch(index, *claim.toi, *truth.toi)
          : Mismatch{Mismatch::Of::toi, index, data::to_decimal(*claim.toi), verdict_text(false)});
}

/// The oracle's results for a part of a block.
struct DecidedPart {
  std::vector<Mismatch> mismatches;
  double nanoseconds = 0.0;
  std::string certificates;
  ProofCounts proofs;
};

/// A solver's answers to a part of a block.
struct AnsweredPart {
  std::size_t count = 0;
  solvers::SolveReply reply;
};

/// The parallel stage: all that is true and all that is said of the queries of one block.
class BlockJudgement {
 public:
  BlockJudgement(const Block& block, const CertifyOptions& options, const Comparison& comparison)
      : block_(block),
        options_(options),
        comparison_(comparison),
        passes_(block.queries.size(), options.stop),
        truths_(block.queries.size()),
        decided_(parts()) {
    decide();
    answers_.reserve(options.solvers.size());
    for (const solvers::Solver* solver : options.solvers) ask(*solver);
    complete_ = passes_.complete();
    judge();
  }

  [[nodiscard]] bool complete() const { return complete_ == block_.queries.size(); }

  /// The serial stage.
  void add_to(CertifyResult& result) const {
    for (std::size_t i = 0; i < complete_; ++i) {
      const Block::Claim& claim = block_.claims[i];
      ++result.queries;
      result.collisions += truths_[i].collides ? 1U : 0U;
      result.labels += comparison_.uses_label(claim) ? 1U : 0U;
      result.tois += comparison_.uses_toi(claim) ? 1U : 0U;
      if (options_.on_truth) options_.on_truth(truths_[i]);
    }
    for (std::size_t part = 0; part * Passes::unit < complete_; ++part) {
      for (const Mismatch& mismatch : decided_[part].mismatches) {
        ++(mismatch.of == Mismatch::Of::label ? result.label_mismatches : result.toi_mismatches);
        result.mismatches.push_back(mismatch);
      }
      result.microseconds += 1e-3 * decided_[part].nanoseconds;
      if (options_.on_certificates) options_.on_certificates(decided_[part].certificates);
      result.proofs += decided_[part].proofs;
    }
    if (options_.on_wrong) tell_wrong_queries();
    for (std::size_t i = 0; i < judgements_.size(); ++i) {
      result.methods[i].judgement += judgements_[i];
    }
  }

 private:
  /// The answers of one solver; a part is known by the query it begins with.
  struct Answers {
    std::vector<fast::Answer> answers;
    std::vector<AnsweredPart> parts;
  };

  [[nodiscard]] std::size_t parts() const {
    return (block_.queries.size() + Passes::unit - 1) / Passes::unit;
  }

  void decide() {
    passes_.run(Passes::unit, [this](std::size_t first, std::size_t count) {
      decide_part(first, count, decided_[first / Passes::unit]);
      return true;
    });
  }

  void decide_part(std::size_t first, std::size_t count, DecidedPart& part) {
    std::vector<exact::Verdict> verdicts;
    verdicts.reserve(count);
    const double start = thread_nanoseconds();
    for (std::size_t i = 0; i < count; ++i) {
      verdicts.push_back(
          exact::decide(block_.kind, block_.queries[first + i], options_.separation));
    }
    part.nanoseconds = thread_nanoseconds() - start;
    const bool wants_toi = options_.on_truth || !options_.solvers.empty();
    for (std::size_t i = 0; i < count; ++i) {
      const exact::Verdict& verdict = verdicts[i];
      const std::uint64_t index = block_.indices[first + i];
      compare(index, block_.claims[first + i], verdict, comparison_, part.mismatches);
      truths_[first + i] =
          wants_toi ? judge::truth_of(index, verdict)
                    : judge::GroundTruth{
                          .index = index, .collides = verdict.collides(), .toi = std::nullopt};
    }
    if (options_.on_certificates) prove_part(first, verdicts, part);
  }

  void prove_part(std::size_t first, const std::vector<exact::Verdict>& verdicts,
                  DecidedPart& part) const {
    const double start = thread_nanoseconds();
    for (std::size_t i = 0; i < verdicts.size(); ++i) {
      append_certificate(block_.kind, block_.queries[first + i], verdicts[i],
                         certificate_label(*block_.source, block_.indices[first + i]), {},
                         part.certificates, part.proofs);
    }
    part.proofs.nanoseconds = thread_nanoseconds() - start;
  }

  void ask(const solvers::Solver& solver) {
    Answers& said = answers_.emplace_back();
    said.answers.resize(block_.queries.size());
    said.parts.resize(parts());
    passes_.run(solver.good_span(), [&](std::size_t first, std::size_t count) {
      solvers::SolveReply reply =
          solver.solve_timed(block_.request(first, count, options_.separation),
                             std::span(said.answers).subspan(first, count));
      const bool done = !reply.stopped;
      said.parts[first / Passes::unit] = {.count = count, .reply = std::move(reply)};
      return done;
    });
  }

  void judge() {
    judgements_.resize(answers_.size());
    for (std::size_t solver = 0; solver < answers_.size(); ++solver) {
      const Answers& said = answers_[solver];
      for (std::size_t first = 0; first < complete_;) {
        const AnsweredPart& part = said.parts[first / Passes::unit];
        judge_part(first, part, said.answers, solver);
        first += part.count;
      }
    }
  }

  /// A part may reach beyond the queries that are complete; it then counts as far as they go.
  void judge_part(std::size_t first, const AnsweredPart& part,
                  const std::vector<fast::Answer>& answers, std::size_t solver) {
    judge::Judgement& judgement = judgements_[solver];
    const std::size_t last = std::min(first + part.count, complete_);
    auto missing = part.reply.missing.begin();
    auto failure = part.reply.failures.begin();
    for (std::size_t i = first; i < last; ++i) {
      if (missing != part.reply.missing.end() && first + *missing == i) {
        judgement.add_missing(block_.indices[i]);
        ++missing;
      } else {
        const bool has_failed =
            failure != part.reply.failures.end() && first + failure->position == i;
        judgement.add(truths_[i], answers[i], has_failed ? &failure->failure : nullptr);
        if (has_failed) ++failure;
        if (claims_too_much(*options_.solvers[solver], i, answers[i])) {
          judgement.add_beyond_tolerance(truths_[i], answers[i]);
        }
      }
    }
    judgement.add_unplaced_crashes(part.reply.unplaced_crashes);
    judgement.nanoseconds += part.reply.time.value().processor_nanoseconds *
                             static_cast<double>(last - first) / static_cast<double>(part.count);
  }

  // ---- What is wrong ----

  /// What is wrong with the queries, by their indices.
  [[nodiscard]] std::map<std::uint64_t, std::vector<std::string>> faults() const {
    std::map<std::uint64_t, std::vector<std::string>> result;
    for (std::size_t part = 0; part * Passes::unit < complete_; ++part) {
      for (const Mismatch& mismatch : decided_[part].mismatches) {
        result[mismatch.index].push_back(to_text(mismatch));
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
      options_.on_wrong({.source = *block_.source,
                         .index = index,
                         .kind = block_.kind,
                         .query = block_.queries[i],
                         .separation = options_.separation,
                         .faults = texts,
                         .answers = answers_to(i)});
    }
  }

  /// What the solvers said to a query, but for those that have no answer to it.
  [[nodiscard]] std::vector<judge::GivenAnswer> answers_to(std::size_t i) const {
    std::vector<judge::GivenAnswer> given;
    for (std::size_t solver = 0; solver < answers_.size(); ++solver) {
      const Answers& said = answers_[solver];
      std::size_t first = 0;
      while (first + said.parts[first / Passes::unit].count <= i) {
        first += said.parts[first / Passes::unit].count;
      }
      const solvers::SolveReply& reply = said.parts[first / Passes::unit].reply;
      if (std::ranges::count(reply.missing, i - first) != 0) continue;
      const auto failure =
          std::ranges::find(reply.failures, i - first, &solvers::QueryFailure::position);
      given.push_back({.solver = options_.solvers[solver]->name(),
                       .answer = said.answers[i],
                       .failure = failure == reply.failures.end() ? std::nullopt
                                                                  : std::optional(failure->failure),
                       .promise = options_.solvers[solver]->promise()});
    }
    return given;
  }

  /// A yes to what never comes as near as that claims. What collides is near enough for any claim.
  [[nodiscard]] bool claims_too_much(const solvers::Solver& solver, std::size_t i,
                                     const fast::Answer& answer) const {
    if (truths_[i].collides || answer.verdict != fast::Verdict::yes ||
        solvers::failure_of(answer)) {
      return false;
    }
    const Query& query = block_.queries[i];
    const Separation claimed = judge::claimed_distance(solver.info().filter, block_.kind, query,
                                                       answer, options_.separation);
    return is_valid(claimed) && !exact::decide(block_.kind, query, claimed).collides();
  }

  const Block& block_;
  const CertifyOptions& options_;
  const Comparison& comparison_;
  Passes passes_;
  std::vector<judge::GroundTruth> truths_;
  std::vector<DecidedPart> decided_;
  std::vector<Answers> answers_;
  std::vector<judge::Judgement> judgements_;
  std::size_t complete_ = 0;
};

void add_methods(std::vector<MethodResult>& sum, const std::vector<MethodResult>& methods) {
  for (std::size_t i = 0; i < methods.size(); ++i) {
    const MethodResult& method = methods[i];
    if (i == sum.size()) sum.push_back({method.name, method.promise, method.timed, {}});
    judge::Judgement counts = method.judgement;
    counts.wrong_answers.clear();
    counts.first_missing.reset();
    sum[i].judgement += counts;
  }
}

}  // namespace

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

CertifyResult certify(data::QuerySource& source, const CertifyOptions& options) {
  const Comparison comparison{
      .inference = judge::infer(source.recorded_separation(), options.separation),
      .tolerance = options.toi_tolerance};
  CertifyResult result;
  result.separation = options.separation;
  result.compared = comparison.inference;
  result.name = source.name();
  result.kind = source.kind();
  for (const solvers::Solver* solver : options.solvers) {
    result.methods.push_back(
        {solver->name(), solver->promise(), solver->is_timed(), judge::Judgement{}});
  }
  const StreamResult ended = stream(
      source, [&](const Block& block) { return BlockJudgement(block, options, comparison); },
      [&](const BlockJudgement& judgement) { judgement.add_to(result); },
      {.threads = options.threads, .on_progress = options.on_progress, .stop = options.stop});
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
