#include "verify/jobs/block_answers.hpp"

#include <algorithm>

namespace touchstone::verify::jobs {

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
