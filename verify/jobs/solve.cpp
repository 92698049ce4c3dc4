#include "verify/jobs/solve.hpp"

#include <span>
#include <vector>

#include "verify/jobs/stream.hpp"

namespace touchstone::verify::jobs {
namespace {

/// The parallel stage: the answers to one block.
class BlockAnswers {
 public:
  BlockAnswers(const Block& block, const solvers::Solver& solver, const SolveOptions& options)
      : block_(block),
        answers_(block.queries.size()),
        replies_(block.queries.size() / Passes::unit + 1) {
    Passes passes(block.queries.size(), options.stop);
    passes.run(solver.good_span(), [&](std::size_t first, std::size_t count) {
      solvers::SolveReply& reply = replies_[first / Passes::unit];
      reply = solver.solve_timed(block.request(first, count, options.separation),
                                 std::span(answers_).subspan(first, count));
      return !reply.stopped;
    });
    complete_ = passes.complete();
    for (std::size_t unit = 0; unit < replies_.size(); ++unit) {
      for (const judge::QueryFailure& found : replies_[unit].failures) {
        failures_.push_back(
            {.position = unit * Passes::unit + found.position, .failure = found.failure});
      }
    }
  }

  [[nodiscard]] bool complete() const { return complete_ == answers_.size(); }

  /// The serial stage.
  void add_to(SolveResult& result, const SolveOptions& options) const {
    auto failure = failures_.begin();
    for (std::size_t i = 0; i < complete_; ++i) {
      const bool has_failed = failure != failures_.end() && failure->position == i;
      add(answers_[i], has_failed ? &failure->failure : nullptr, result);
      if (options.on_answer) {
        options.on_answer(block_.indices[i], answers_[i], has_failed ? &failure->failure : nullptr);
      }
      if (has_failed) ++failure;
    }
    for (std::size_t part = 0; part * Passes::unit < complete_; ++part) {
      result.nanoseconds +=
          replies_[part].time.value_or(solvers::SolverTime{}).processor_nanoseconds;
      result.unplaced_crashes += replies_[part].unplaced_crashes;
    }
  }

 private:
  static void add(const fast::Answer& answer, const judge::Failure* failure,
                  SolveResult& result) {
    using fast::Verdict;
    Verdict verdict = answer.verdict;
    if (const auto why =
            failure != nullptr ? std::optional(*failure) : judge::failure_of(answer)) {
      ++result.failures[static_cast<std::size_t>(why->kind)];
      verdict = judge::verdict_of(why->kind);
    }
    ++result.queries;
    result.yes += verdict == Verdict::yes ? 1U : 0U;
    result.no += verdict == Verdict::no ? 1U : 0U;
    result.undecided += verdict == Verdict::undecided ? 1U : 0U;
    result.errors += verdict == Verdict::error ? 1U : 0U;
  }

  const Block& block_;
  std::vector<fast::Answer> answers_;
  std::vector<solvers::SolveReply> replies_;     // of the part that begins with a unit
  std::vector<judge::QueryFailure> failures_;  // by position in the block
  std::size_t complete_ = 0;
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
      source, [&](const Block& block) { return BlockAnswers(block, solver, options); },
      [&](const BlockAnswers& answers) { answers.add_to(result, options); },
      {.threads = options.threads, .on_progress = options.on_progress, .stop = options.stop});
  result.skipped = ended.skipped;
  result.rounded = ended.rounded;
  result.reading_error = ended.error;
  result.interrupted = ended.interrupted;
  return result;
}

}  // namespace touchstone::verify::jobs
