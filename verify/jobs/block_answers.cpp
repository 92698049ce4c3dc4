#include "verify/jobs/block_answers.hpp"

#include <algorithm>

namespace touchstone::verify::jobs {

BlockAnswers::BlockAnswers(const Block& block, const solvers::Solver& solver,
                           const Separation& separation, Passes& passes)
    : block_(block),
      solver_(solver),
      separation_(separation),
      answers_(block.queries.size()),
      parts_(Passes::units(block.queries.size())) {
  passes.run(solver.good_span(), [this](std::size_t first, std::size_t count) {
    Part& part = parts_[first / Passes::unit];
    part = {.count = count,
            .reply = solver_.solve_timed(block_.request(first, count, separation_),
                                         std::span(answers_).subspan(first, count))};
    return !part.reply.stopped;
  });
}

judge::Judgement BlockAnswers::judge(std::span<const judge::GroundTruth> truths) const {
  judge::Judgement judgement;
  for (std::size_t first = 0; first < truths.size();) {
    const auto& [count, reply] = parts_[first / Passes::unit];
    const std::size_t last = std::min(first + count, truths.size());
    for (std::size_t i = first; i < last; ++i) {
      if (std::ranges::binary_search(reply.missing, i - first)) {
        judgement.add_missing(block_.indices[i]);
        continue;
      }
      judgement.add({block_.kind, block_.queries[i], separation_}, truths[i], answers_[i],
                    solver_.standard(), judge::failure_at(reply.failures, i - first));
    }
    judgement.unplaced_crashes += reply.unplaced_crashes;
    judgement.nanoseconds += reply.time.value().processor_nanoseconds *
                             static_cast<double>(last - first) / static_cast<double>(count);
    first += count;
  }
  return judgement;
}

std::optional<judge::GivenAnswer> BlockAnswers::given(std::size_t i) const {
  std::size_t unit = i / Passes::unit;
  while (parts_[unit].count == 0) --unit;
  const solvers::SolveReply& reply = parts_[unit].reply;
  const std::size_t position = i - unit * Passes::unit;
  if (std::ranges::binary_search(reply.missing, position)) return std::nullopt;
  const judge::Failure* const failure = judge::failure_at(reply.failures, position);
  return judge::GivenAnswer{.solver = solver_.name(),
                            .answer = answers_[i],
                            .failure = failure ? std::optional(*failure) : std::nullopt,
                            .standard = solver_.standard()};
}

}  // namespace touchstone::verify::jobs
