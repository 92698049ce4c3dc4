#include "verify/certify.hpp"

#include <fmt/format.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <ctime>
#include <exception>
#include <memory>
#include <utility>

#include "exact/oracle.hpp"
#include "verify/dataset/toi_writer.hpp"

namespace touchstone::verify {
namespace {

constexpr std::size_t block_size = 64;
constexpr unsigned most_threads = 1024;

/// Some consecutive queries on their way through the pipeline.
struct Block {
  std::vector<RecordedQuery> queries;
  std::vector<Truth> truths;
  std::vector<Mismatch> mismatches;
  double microseconds = 0.0;
  double progress = 0.0;
};

double thread_microseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e6 + static_cast<double>(now.tv_nsec) * 1e-3;
}

std::string verdict_text(bool collides) { return collides ? "collision" : "no collision"; }

/// The first 45 significant digits, as published times of impact have them.
std::string decimal_text(const exact::AlgebraicNumber& number) {
  static constexpr unsigned digits = 45;
  static const exact::Rational relative_width = exact::power_of_two(-160);
  exact::AlgebraicNumber refined = number;
  // Zero would be known as rational, so the lower end leaves zero sooner or later.
  for (unsigned long level = 1; !refined.rational(); level *= 2) {
    refined.refine_to_level(level);
    const auto [lower, upper] = refined.interval();
    if (upper - lower <= relative_width * lower) break;
  }
  return to_decimal(refined.interval().lower, digits);
}

bool within(const exact::AlgebraicNumber& toi, const exact::Rational& recorded,
            const exact::Rational& tolerance) {
  const exact::Rational lower = recorded - tolerance, upper = recorded + tolerance;
  return toi >= lower && toi <= upper;
}

void compare(const RecordedQuery& query, const exact::Verdict& verdict,
             const exact::Rational& tolerance, std::vector<Mismatch>& mismatches) {
  if (query.collides && *query.collides != verdict.collides()) {
    mismatches.push_back({Mismatch::Of::label, query.index, verdict_text(*query.collides),
                          verdict_text(verdict.collides())});
  }
  if (!query.toi) return;
  if (verdict.collides() && within(verdict.impact->toi, *query.toi, tolerance)) return;
  mismatches.push_back(
      {Mismatch::Of::toi, query.index, to_decimal(*query.toi),
       verdict.collides() ? decimal_text(verdict.impact->toi) : verdict_text(false)});
}

/// The parallel stage: needs nothing but the block.
void judge(Block& block, Kind kind, const exact::Rational& tolerance, bool wants_toi) {
  std::vector<exact::Verdict> verdicts;
  verdicts.reserve(block.queries.size());
  const double start = thread_microseconds();
  for (const RecordedQuery& query : block.queries) {
    verdicts.push_back(exact::decide(kind, query.query));
  }
  block.microseconds = thread_microseconds() - start;
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    const RecordedQuery& query = block.queries[i];
    const exact::Verdict& verdict = verdicts[i];
    compare(query, verdict, tolerance, block.mismatches);
    Truth truth{.index = query.index, .collides = verdict.collides(), .toi = std::nullopt};
    if (wants_toi && truth.collides) truth.toi = verdict.impact->toi.enclosure();
    block.truths.push_back(truth);
  }
}

/// The serial stages around it: reading from the source and adding up.
class Judgement {
 public:
  Judgement(QuerySource& source, const CertifyOptions& options)
      : source_(source), options_(options) {
    result_.name = source.name();
    result_.kind = source.kind();
  }

  /// The next block; null at the end. Errors of the source are kept, and end the stream.
  std::shared_ptr<Block> read() {
    auto block = std::make_shared<Block>();
    while (!ended_ && block->queries.size() < block_size) read_query(*block);
    block->progress = source_.progress();
    return block->queries.empty() ? nullptr : block;
  }

  void add(const Block& block) {
    for (std::size_t i = 0; i < block.queries.size(); ++i) {
      ++result_.queries;
      result_.collisions += block.truths[i].collides ? 1U : 0U;
      result_.labels += block.queries[i].collides ? 1U : 0U;
      result_.tois += block.queries[i].toi ? 1U : 0U;
      if (options_.on_truth) options_.on_truth(block.truths[i]);
    }
    for (const Mismatch& mismatch : block.mismatches) {
      ++(mismatch.of == Mismatch::Of::label ? result_.label_mismatches : result_.toi_mismatches);
      result_.mismatches.push_back(mismatch);
    }
    result_.microseconds += block.microseconds;
    if (options_.on_progress) options_.on_progress(block.progress);
  }

  CertifyResult finish() {
    result_.skipped = source_.skipped();
    result_.rounded = source_.rounded();
    return std::move(result_);
  }

 private:
  void read_query(Block& block) {
    if (options_.stop != nullptr && options_.stop->load()) {
      ended_ = result_.interrupted = true;
      return;
    }
    try {
      auto query = source_.next();
      ended_ = !query;
      if (query) block.queries.push_back(std::move(*query));
    } catch (const std::exception& error) {
      result_.fail(error.what());
      ended_ = true;
    }
  }

  QuerySource& source_;
  const CertifyOptions& options_;
  CertifyResult result_;
  bool ended_ = false;
};

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

CertifyResult certify(QuerySource& source, const CertifyOptions& options) {
  namespace tbb = oneapi::tbb;
  using BlockPointer = std::shared_ptr<Block>;
  const int available = tbb::info::default_concurrency();
  const int threads =
      options.threads == 0 ? available : static_cast<int>(std::min(options.threads, most_threads));
  const std::size_t blocks_in_flight = 4 * static_cast<std::size_t>(threads);
  Judgement judgement(source, options);
  const bool wants_toi = options.on_truth != nullptr;

  const auto read = [&](tbb::flow_control& flow) {
    BlockPointer block = judgement.read();
    if (!block) flow.stop();
    return block;
  };
  const auto decide = [&](BlockPointer block) {
    judge(*block, source.kind(), options.toi_tolerance, wants_toi);
    return block;
  };
  const auto add = [&](const BlockPointer& block) { judgement.add(*block); };

  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_pipeline(
        blocks_in_flight,
        tbb::make_filter<void, BlockPointer>(tbb::filter_mode::serial_in_order, read) &
            tbb::make_filter<BlockPointer, BlockPointer>(tbb::filter_mode::parallel, decide) &
            tbb::make_filter<BlockPointer, void>(tbb::filter_mode::serial_in_order, add));
  });
  return judgement.finish();
}

CertifyResult total(const std::vector<CertifyResult>& results) {
  CertifyResult sum;
  sum.name = "total";
  for (const CertifyResult& result : results) {
    sum.queries += result.queries;
    sum.collisions += result.collisions;
    sum.labels += result.labels;
    sum.label_mismatches += result.label_mismatches;
    sum.tois += result.tois;
    sum.toi_mismatches += result.toi_mismatches;
    sum.skipped += result.skipped;
    sum.rounded += result.rounded;
    sum.errors += result.errors;
    sum.microseconds += result.microseconds;
    sum.interrupted = sum.interrupted || result.interrupted;
  }
  return sum;
}

}  // namespace touchstone::verify
