#include "verify/jobs/truth_and_answers.hpp"

#include <algorithm>
#include <utility>

#include "verify/base/thread_clock.hpp"
#include "verify/jobs/certify.hpp"

namespace touchstone::verify::jobs {

// ---- Truth --------------------------------------------------------------------------------------

BlockTruth::BlockTruth(const QueryBlock& block, BlockTruthOptions options, Passes& passes)
    : block_(block),
      options_(std::move(options)),
      truths_(block.size()),
      parts_(Passes::units(block.size())) {
  passes.run(Passes::unit, [this](std::size_t first, std::size_t count) {
    decide(first, count, parts_[first / Passes::unit]);
    return true;
  });
}

std::span<const DecidedPart> BlockTruth::parts(std::size_t count) const {
  return std::span(parts_).first(Passes::units(count));
}

void BlockTruth::decide(std::size_t first, std::size_t count, DecidedPart& part) {
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

void BlockTruth::prove(std::size_t first, const std::vector<exact::Decision>& verdicts,
                       DecidedPart& part) const {
  const double start = base::thread_nanoseconds();
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    append_certificate(block_.queries(), first + i, verdicts[i],
                       certificate_label(*block_.source, block_.indices[first + i]), options_.proof,
                       part.certificates, part.proofs);
  }
  part.proofs.nanoseconds = base::thread_nanoseconds() - start;
}

void BlockTruth::add_to(CertifyResult& result, std::size_t count) const {
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

// ---- Answers ------------------------------------------------------------------------------------

BlockAnswers::BlockAnswers(const QueryBlock& block, const solvers::Solver& solver,
                           const Separation& separation, Passes& passes)
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

const judge::Failure* BlockAnswers::failure(std::size_t i) const {
  const std::size_t first = begins_[i / Passes::unit];
  return judge::failure_at(calls_[first / Passes::unit].reply.failures, i - first);
}

std::optional<judge::Unasked> BlockAnswers::why_unasked(std::size_t i) const {
  const std::size_t first = begins_[i / Passes::unit];
  return calls_[first / Passes::unit].reply.why_unasked(i - first);
}

std::optional<judge::GivenAnswer> BlockAnswers::given(std::size_t i) const {
  if (why_unasked(i)) return std::nullopt;
  judge::GivenAnswer given{
      .solver = solver_.name(), .answer = answers_[i], .standard = solver_.standard()};
  if (const judge::Failure* const failed = failure(i)) given.failure = *failed;
  return given;
}

judge::Judgement BlockAnswers::judge(std::size_t count,
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
  judgement.unplaced_crashes = unplaced_crashes(count);
  judgement.nanoseconds = nanoseconds(count);
  return judgement;
}

double BlockAnswers::nanoseconds(std::size_t count) const {
  double sum = 0.0;
  for (std::size_t first = 0; first < count; first += calls_[first / Passes::unit].count) {
    const Call& call = calls_[first / Passes::unit];
    const std::size_t counted = std::min(call.count, count - first);
    sum += call.reply.time.value().processor_nanoseconds * static_cast<double>(counted) /
           static_cast<double>(call.count);
  }
  return sum;
}

std::uint64_t BlockAnswers::unplaced_crashes(std::size_t count) const {
  std::uint64_t sum = 0;
  for (const Call& call : std::span(calls_).first(Passes::units(count))) {
    sum += call.reply.unplaced_crashes;
  }
  return sum;
}

}  // namespace touchstone::verify::jobs
