#include "verify/jobs/certify.hpp"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <exception>
#include <iterator>
#include <map>
#include <utility>

#include "touchstone/certificate_text.hpp"
#include "touchstone/oracle.hpp"
#include "verify/base/any_decision.hpp"
#include "verify/base/cores.hpp"
#include "verify/base/thread_clock.hpp"
#include "verify/io/terminal.hpp"
#include "verify/judge/ground_truth.hpp"

namespace touchstone::verify::jobs {
namespace {

namespace tbb = oneapi::tbb;

/// Queries of a block: enough that the cost of a call hides behind them, and few enough that a stop
/// and a deadline are soon obeyed.
constexpr std::size_t least_queries = 16, most_queries = 256;

/// The number of queries of the next block after some: smaller at first on many cores, so that a
/// source of a thousand queries keeps all of them busy too.
std::size_t size_of_block(std::size_t queries_so_far, std::size_t threads) {
  return std::clamp(queries_so_far / (4 * threads), std::max(least_queries, most_queries / threads),
                    most_queries);
}

/// Some consecutive queries of a source: they are read, worked on and told.
class Block {
 public:
  /// All must live as long as the block.
  Block(const data::QuerySource& source, const CertifyOptions& options,
        const judge::LabelComparison& comparison)
      : source_(source.name()),
        shape_(source.shape()),
        options_(options),
        comparison_(comparison) {}

  // ---- The first stage, in order

  void add(data::RecordedQuery&& recorded) {
    std::ranges::copy(recorded.query.numbers(), std::back_inserter(numbers_));
    indices_.push_back(recorded.index);
    labels_.push_back({recorded.collides, std::move(recorded.toi)});
  }

  [[nodiscard]] std::size_t size() const { return indices_.size(); }

  // ---- The second stage, in parallel

  /// Decides the queries, and asks the solvers, until a stop.
  void work() {
    if (options_.decides && !is_stopped()) decide();
    answers_.reserve(options_.solvers.size());
    for (const solvers::Solver* solver : options_.solvers) {
      if (!is_stopped()) ask(*solver);
    }
  }

  // ---- The third stage, in order

  /// False if a stop has cut the second one short.
  [[nodiscard]] bool is_complete() const {
    const auto is_cut = [](const Answers& answers) { return answers.reply.stopped; };
    return truths_.size() == (options_.decides ? size() : 0) &&
           answers_.size() == options_.solvers.size() && std::ranges::none_of(answers_, is_cut);
  }

  void add_to(CertifyResult& result) const {
    result.queries += size();
    if (options_.decides) add_truth_to(result);
    if (options_.on_truth) std::ranges::for_each(truths_, options_.on_truth);
    if (options_.on_certificates) options_.on_certificates(certificates_);
    if (options_.on_answer) tell_answers();
    if (options_.on_wrong) tell_wrong_queries();
    for (std::size_t i = 0; i < answers_.size(); ++i) {
      result.methods[i].judgement += answers_[i].judgement;
    }
  }

 private:
  /// Those of a solver.
  struct Answers {
    const solvers::Solver& solver;
    std::vector<fast::Answer> all;
    solvers::SolveReply reply;
    judge::Judgement judgement = {};

    [[nodiscard]] const judge::Failure* failure(std::size_t i) const {
      return judge::failure_at(reply.failures, i);
    }
  };

  [[nodiscard]] AnyQueries queries() const { return {shape_, numbers_}; }
  [[nodiscard]] bool is_stopped() const { return base::is_stopped(options_.stop); }

  // ---- Truth

  void decide() {
    const double start = base::thread_nanoseconds();
    std::vector<exact::Decision> decisions;
    for (std::size_t i = 0; i < size(); ++i) {
      decisions.push_back(base::decide(queries(), i, options_.separation));
    }
    nanoseconds_ = base::thread_nanoseconds() - start;
    const bool has_times = options_.on_truth || !options_.solvers.empty();
    for (std::size_t i = 0; i < decisions.size(); ++i) {
      const exact::Decision& decision = decisions[i];
      const std::uint64_t index = indices_[i];
      std::ranges::move(judge::judge_label(index, labels_[i], decision, comparison_),
                        std::back_inserter(mismatches_));
      truths_.push_back(
          has_times
              ? judge::truth_of(index, decision)
              : judge::GroundTruth{.index = index, .collides = decision.collides(), .toi = {}});
    }
    if (options_.on_certificates) prove(decisions);
  }

  void prove(const std::vector<exact::Decision>& decisions) {
    const double start = base::thread_nanoseconds();
    for (std::size_t i = 0; i < size(); ++i) {
      const std::string label = certificate_label(source_, indices_[i]);
      try {
        const exact::Certificate certificate =
            base::prove(queries(), i, decisions[i], options_.proof);
        exact::write(certificates_, certificate, label);
        proofs_.add(certificate);
      } catch (const exact::CertificateLimitError& error) {
        proofs_.beyond_limits.push_back(fmt::format("{}: no certificate: {}", label, error.what()));
      }
    }
    proofs_.bytes = certificates_.size();
    proofs_.nanoseconds = base::thread_nanoseconds() - start;
  }

  void add_truth_to(CertifyResult& result) const {
    for (std::size_t i = 0; i < size(); ++i) {
      result.collisions += truths_[i].collides ? 1U : 0U;
      result.labels += comparison_.uses_verdict(labels_[i]) ? 1U : 0U;
      result.tois += comparison_.uses_toi(labels_[i]) ? 1U : 0U;
    }
    for (const judge::Mismatch& mismatch : mismatches_) {
      ++(mismatch.of == judge::Mismatch::Of::label ? result.label_mismatches
                                                   : result.toi_mismatches);
      result.mismatches.push_back(mismatch);
    }
    result.microseconds += 1e-3 * nanoseconds_;
    result.proofs += proofs_;
  }

  // ---- Answers

  void ask(const solvers::Solver& solver) {
    Answers& answers = answers_.emplace_back(
        Answers{.solver = solver, .all = std::vector<fast::Answer>(size()), .reply = {}});
    answers.reply = solver.solve_timed({.queries = queries(),
                                        .separation = options_.separation,
                                        .source = source_,
                                        .indices = indices_},
                                       answers.all);
    judge::Judgement& judgement = answers.judgement;
    for (std::size_t i = 0; i < size(); ++i) {
      if (const auto why = answers.reply.why_unasked(i)) {
        judgement.add_unasked(*why, indices_[i]);
      } else if (options_.decides) {
        judgement.add({queries().part(i, 1), options_.separation}, truths_[i], answers.all[i],
                      solver.standard(), answers.failure(i));
      } else {
        judgement.add(answers.all[i], answers.failure(i));
      }
    }
    judgement.unplaced_crashes = answers.reply.unplaced_crashes;
    judgement.nanoseconds = answers.reply.time.value().processor_nanoseconds;
  }

  void tell_answers() const {
    for (const Answers& answers : answers_) {
      for (std::size_t i = 0; i < size(); ++i) {
        if (answers.reply.why_unasked(i)) continue;
        options_.on_answer(answers.solver, indices_[i], answers.all[i], answers.failure(i));
      }
    }
  }

  // ---- Wrong queries

  void tell_wrong_queries() const {
    std::map<std::uint64_t, judge::WrongQuery> all;
    for (const judge::Mismatch& mismatch : mismatches_) {
      all[mismatch.index].faults.push_back(judge::to_text(mismatch));
    }
    for (const Answers& answers : answers_) {
      for (const judge::WrongAnswer& wrong : answers.judgement.wrong_answers) {
        if (!judge::breaks(wrong.fault, answers.solver.promise())) continue;
        all[wrong.index].faults.push_back(judge::to_text(answers.solver.name(), wrong));
      }
    }
    for (std::size_t i = 0; i < size(); ++i) {
      const auto wrong = all.find(indices_[i]);
      if (wrong != all.end()) tell_wrong_query(i, std::move(wrong->second));
    }
  }

  void tell_wrong_query(std::size_t i, judge::WrongQuery wrong) const {
    wrong.source = source_;
    wrong.index = indices_[i];
    wrong.query = {queries(), i};
    wrong.separation = options_.separation;
    for (const Answers& answers : answers_) {
      if (answers.reply.why_unasked(i)) continue;
      const judge::Failure* const failed = answers.failure(i);
      wrong.answers.push_back({.solver = answers.solver.name(),
                               .answer = answers.all[i],
                               .failure = failed == nullptr ? std::nullopt : std::optional(*failed),
                               .standard = answers.solver.standard()});
    }
    options_.on_wrong(std::move(wrong));
  }

  const std::string& source_;
  AnyShape shape_;
  const CertifyOptions& options_;
  const judge::LabelComparison& comparison_;
  std::vector<double> numbers_;
  std::vector<std::uint64_t> indices_;
  std::vector<judge::Label> labels_;
  std::vector<judge::GroundTruth> truths_;  // without times where these are not needed
  std::vector<judge::Mismatch> mismatches_;
  double nanoseconds_ = 0.0;  // of the oracle
  std::string certificates_;
  ProofCounts proofs_;
  std::vector<Answers> answers_;
};

/// The ends of the pipeline, each in order: reading and telling.
class Stream {
 public:
  /// \param blocks_in_flight two for each thread
  /// \param result with the solvers as its methods
  Stream(data::QuerySource& source, const CertifyOptions& options,
         const judge::LabelComparison& comparison, std::size_t blocks_in_flight,
         CertifyResult& result)
      : source_(source),
        options_(options),
        comparison_(comparison),
        in_flight_(blocks_in_flight),
        result_(result) {}

  /// The next block, in the place of one that is told; null at the end.
  Block* read() {
    Block& block =
        in_flight_[blocks_++ % in_flight_.size()].emplace(source_, options_, comparison_);
    const std::size_t size = size_of_block(queries_, in_flight_.size() / 2);
    while (!ended_ && block.size() < size) read_query(block);
    queries_ += block.size();
    if (options_.on_progress) options_.on_progress(source_.progress());
    return block.size() == 0 ? nullptr : &block;
  }

  /// A block is kept or dropped whole: after a stop, the result is that of the first queries.
  void tell(const Block& block) {
    cut_ = cut_ || !block.is_complete();
    if (!cut_) block.add_to(result_);
  }

  /// Closes the result after the last block.
  void close() {
    result_.interrupted = ended_early_ || cut_;
    result_.skipped = source_.skipped();
    result_.rounded = source_.rounded();
  }

 private:
  void read_query(Block& block) {
    const bool is_late = block.size() == 0 && options_.deadline.is_over();
    if (base::is_stopped(options_.stop) || is_late) {
      ended_ = ended_early_ = true;
      return;
    }
    try {
      auto query = source_.next();
      ended_ = !query;
      if (query) block.add(std::move(*query));
    } catch (const io::Interrupted&) {
      ended_ = ended_early_ = true;
    } catch (const std::exception& error) {
      result_.fail(error.what());
      ended_ = true;
    }
  }

  data::QuerySource& source_;
  const CertifyOptions& options_;
  const judge::LabelComparison& comparison_;
  /// The pipeline has only pointers: oneTBB may lose objects that it owns if work throws. Blocks
  /// begin and end in order; the size of this vector ensures that the first block is told before
  /// its place is needed again.
  std::vector<std::optional<Block>> in_flight_;
  std::size_t blocks_ = 0;   // read so far
  std::size_t queries_ = 0;  // in these
  CertifyResult& result_;
  bool ended_ = false;
  bool ended_early_ = false;
  bool cut_ = false;
};

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
      .inference = judge::infer(source.recorded_separation(), options.separation),
      .tolerance = options.toi_tolerance};
  CertifyResult result;
  result.separation = options.separation;
  result.compared = comparison.inference;
  result.name = source.name();
  result.shape = source.shape();
  for (const solvers::Solver* solver : options.solvers) {
    result.methods.push_back(result_of(*solver));
  }
  const int threads = base::cores_for(options.threads);
  const std::size_t blocks_in_flight = 2 * static_cast<std::size_t>(threads);
  Stream stream(source, options, comparison, blocks_in_flight, result);
  const auto read = [&](tbb::flow_control& flow) {
    Block* const block = stream.read();
    if (block == nullptr) flow.stop();
    return block;
  };
  const auto work = [](Block* block) {
    block->work();
    return block;
  };
  const auto tell = [&](const Block* block) { stream.tell(*block); };
  const auto run = [&] {
    tbb::parallel_pipeline(
        blocks_in_flight,
        tbb::make_filter<void, Block*>(tbb::filter_mode::serial_in_order, read) &
            tbb::make_filter<Block*, Block*>(tbb::filter_mode::parallel, work) &
            tbb::make_filter<Block*, void>(tbb::filter_mode::serial_in_order, tell));
  };
  try {
    tbb::task_arena(threads).execute(run);
  } catch (const std::exception& error) {
    result.fail(error.what());
  }
  stream.close();
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
    : end_(seconds, clock), solvers_(std::move(solvers)), threads_(base::cores_for(threads)) {}

base::Deadline Budget::begin_source(std::size_t sources_left) const {
  // The rest is for the oracle, the reading and the writing.
  constexpr double solvers_part = 0.8;
  const double seconds =
      end_.seconds_left() / static_cast<double>(std::max<std::size_t>(sources_left, 1));
  for (const solvers::Solver* solver : solvers_) {
    solver->allow(solvers_part * seconds * threads_ / static_cast<double>(solvers_.size()));
  }
  return end_.at_most(seconds);
}

}  // namespace touchstone::verify::jobs
