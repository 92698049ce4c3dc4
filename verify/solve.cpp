#include "verify/solve.hpp"

#include <span>
#include <vector>

#include "verify/stream.hpp"

namespace touchstone::verify {
namespace {

/// The parallel stage: the answers to one block.
class BlockAnswers {
 public:
  BlockAnswers(const Block& block, const Respondent& respondent, const SolveOptions& options)
      : block_(block),
        answers_(block.queries.size()),
        responses_(block.queries.size() / Passes::unit + 1) {
    Passes passes(block.queries.size(), options.stop);
    passes.run(respondent.good_span(), [&](std::size_t first, std::size_t count) {
      const Questions questions{.source = *block.source,
                                .kind = block.kind,
                                .queries = std::span(block.queries).subspan(first, count),
                                .indices = std::span(block.indices).subspan(first, count),
                                .separation = options.separation};
      Response& response = responses_[first / Passes::unit];
      response = respondent.answer(questions, std::span(answers_).subspan(first, count));
      return !response.stopped;
    });
    complete_ = passes.complete();
  }

  [[nodiscard]] bool complete() const { return complete_ == answers_.size(); }

  /// The serial stage.
  void add_to(SolveResult& result, const SolveOptions& options) const {
    using fast::Verdict;
    for (std::size_t i = 0; i < complete_; ++i) {
      const fast::Answer& answer = answers_[i];
      ++result.queries;
      result.yes += answer.verdict == Verdict::yes ? 1U : 0U;
      result.no += answer.verdict == Verdict::no ? 1U : 0U;
      result.undecided += answer.verdict == Verdict::undecided ? 1U : 0U;
      result.errors += answer.verdict == Verdict::error ? 1U : 0U;
      if (options.on_answer) options.on_answer(block_.indices[i], answer);
    }
    for (std::size_t part = 0; part * Passes::unit < complete_; ++part) {
      result.nanoseconds += responses_[part].nanoseconds;
      result.unplaced_crashes += responses_[part].unplaced_crashes;
    }
  }

 private:
  const Block& block_;
  std::vector<fast::Answer> answers_;
  std::vector<Response> responses_;  // of the part that begins with a unit
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
  unplaced_crashes += other.unplaced_crashes;
  nanoseconds += other.nanoseconds;
  skipped += other.skipped;
  rounded += other.rounded;
  interrupted = interrupted || other.interrupted;
  return *this;
}

SolveResult solve(QuerySource& source, const Respondent& respondent, const SolveOptions& options) {
  SolveResult result;
  const StreamResult ended = stream(
      source, [&](const Block& block) { return BlockAnswers(block, respondent, options); },
      [&](const BlockAnswers& answers) { answers.add_to(result, options); },
      {.threads = options.threads, .on_progress = options.on_progress, .stop = options.stop});
  result.skipped = ended.skipped;
  result.rounded = ended.rounded;
  result.reading_error = ended.error;
  result.interrupted = ended.interrupted;
  return result;
}

}  // namespace touchstone::verify
