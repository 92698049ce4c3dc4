#include "verify/jobs/solve.hpp"

#include "verify/jobs/block_answers.hpp"
#include "verify/jobs/stream.hpp"

namespace touchstone::verify::jobs {
namespace {

void add(const fast::Answer& answer, const judge::Failure* failure, SolveResult& result) {
  using fast::Verdict;
  Verdict verdict = answer.verdict;
  if (const auto why = failure != nullptr ? std::optional(*failure) : judge::failure_of(answer)) {
    ++result.failures[static_cast<std::size_t>(why->kind)];
    verdict = judge::verdict_of(why->kind);
  }
  ++result.queries;
  result.yes += verdict == Verdict::yes ? 1U : 0U;
  result.no += verdict == Verdict::no ? 1U : 0U;
  result.undecided += verdict == Verdict::undecided ? 1U : 0U;
  result.errors += verdict == Verdict::error ? 1U : 0U;
}

/// The parallel stage.
class SolvedBlock {
 public:
  SolvedBlock(const Block& block, const solvers::Solver& solver, const SolveOptions& options)
      : block_(block),
        passes_(block.queries.size(), options.stop),
        answers_(block, solver, options.separation, passes_) {}

  [[nodiscard]] bool complete() const { return passes_.complete() == block_.queries.size(); }

  /// The serial stage.
  void add_to(SolveResult& result, const SolveOptions& options) const {
    const std::size_t complete = passes_.complete();
    for (std::size_t i = 0; i < complete; ++i) {
      if (answers_.why_unasked(i)) {
        ++result.unasked;
        continue;
      }
      const fast::Answer& answer = answers_.answers()[i];
      add(answer, answers_.failure(i), result);
      if (options.on_answer) options.on_answer(block_.indices[i], answer, answers_.failure(i));
    }
    result.nanoseconds += answers_.nanoseconds(complete);
    result.unplaced_crashes += answers_.unplaced_crashes(complete);
  }

 private:
  const Block& block_;
  Passes passes_;
  BlockAnswers answers_;
};

}  // namespace

double SolveResult::nanoseconds_per_query() const {
  return queries == 0 ? 0.0 : nanoseconds / static_cast<double>(queries);
}

SolveResult& SolveResult::operator+=(const SolveResult& other) {
  queries += other.queries;
  yes += other.yes;
  no += other.no;
  undecided += other.undecided;
  errors += other.errors;
  unasked += other.unasked;
  for (std::size_t i = 0; i < failures.size(); ++i) failures[i] += other.failures[i];
  unplaced_crashes += other.unplaced_crashes;
  nanoseconds += other.nanoseconds;
  skipped += other.skipped;
  rounded += other.rounded;
  interrupted = interrupted || other.interrupted;
  return *this;
}

SolveResult solve(data::QuerySource& source, const solvers::Solver& solver,
                  const SolveOptions& options) {
  SolveResult result;
  const StreamResult ended = stream(
      source, [&](const Block& block) { return SolvedBlock(block, solver, options); },
      [&](const SolvedBlock& solved) { solved.add_to(result, options); },
      {.threads = options.threads, .on_progress = options.on_progress, .stop = options.stop});
  result.skipped = ended.skipped;
  result.rounded = ended.rounded;
  result.reading_error = ended.error;
  result.interrupted = ended.interrupted;
  return result;
}

}  // namespace touchstone::verify::jobs
