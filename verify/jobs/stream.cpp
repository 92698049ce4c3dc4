#include "verify/jobs/stream.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "verify/base/cores.hpp"
#include "verify/io/terminal.hpp"

namespace touchstone::verify::jobs {
namespace {

namespace tbb = oneapi::tbb;

/// A block with its result.
struct Token {
  QueryBlock block;
  BlockResult result;
  double progress = 0.0;
};

/// The serial ends of the pipeline: reading, and the work that is done in order.
class Stream {
 public:
  Stream(data::QuerySource& source, const StreamOptions& options, std::size_t blocks_in_flight)
      : source_(source), options_(options), in_flight_(blocks_in_flight) {}

  /// The next block, in the place of one that is finished; null at the end. Errors of the source
  /// are kept, and end the stream.
  Token* read() {
    Token& token = in_flight_[read_++ % in_flight_.size()];
    token = {};
    token.block.source = &source_.name();
    token.block.shape = source_.shape();
    while (!ended_ && token.block.size() < options_.block) read_query(token.block);
    token.progress = source_.progress();
    return token.block.size() == 0 ? nullptr : &token;
  }

  void finish(const Token& token) {
    if (cut_) return;
    token.result.in_order();
    if (options_.on_progress) options_.on_progress(token.progress);
    cut_ = !token.result.complete;
  }

  void fail(const std::string& message) { result_.error = message; }

  StreamResult result() {
    result_.interrupted = result_.interrupted || cut_;
    result_.skipped = source_.skipped();
    result_.rounded = source_.rounded();
    return std::move(result_);
  }

 private:
  void read_query(QueryBlock& block) {
    const bool is_late = block.size() == 0 && options_.deadline.is_over();
    if (base::is_stopped(options_.stop) || is_late) {
      ended_ = result_.interrupted = true;
      return;
    }
    try {
      auto query = source_.next();
      ended_ = !query;
      if (!query) return;
      const std::span<const double> numbers = query->query.numbers();
      block.numbers.insert(block.numbers.end(), numbers.begin(), numbers.end());
      block.indices.push_back(query->index);
      block.labels.push_back({query->collides, std::move(query->toi)});
    } catch (const io::Interrupted&) {
      ended_ = result_.interrupted = true;
    } catch (const std::exception& error) {
      result_.error = error.what();
      ended_ = true;
    }
  }

  data::QuerySource& source_;
  const StreamOptions& options_;
  /// The pipeline has only pointers: oneTBB may lose objects that it owns if work throws. Blocks
  /// begin and end in order; the size of this vector ensures that the first block is finished
  /// before its place is needed again.
  std::vector<Token> in_flight_;
  std::size_t read_ = 0;
  StreamResult result_;
  bool ended_ = false;
  bool cut_ = false;
};

}  // namespace

Passes::Passes(std::size_t queries, const std::atomic<bool>* stop)
    : queries_(queries), stop_(stop), done_(units(queries)) {}

void Passes::run(std::size_t span, const std::function<bool(std::size_t, std::size_t)>& work) {
  const std::size_t step =
      std::clamp<std::size_t>(span / unit, 1, std::max<std::size_t>(done_.size(), 1));
  const std::size_t steps = (done_.size() + step - 1) / step;
  const auto part = [&](std::size_t i) {
    if (base::is_stopped(stop_)) return;
    const std::size_t first = i * step, last = std::min(first + step, done_.size());
    if (!work(first * unit, std::min(last * unit, queries_) - first * unit)) return;
    for (std::size_t u = first; u < last; ++u) ++done_[u];
  };
  // Isolated, so that a thread that waits here does not begin another block meanwhile.
  tbb::this_task_arena::isolate(
      [&] { tbb::parallel_for(std::size_t{0}, steps, part, tbb::simple_partitioner()); });
  ++passes_;
}

std::size_t Passes::complete() const {
  const auto first_undone =
      std::ranges::find_if(done_, [this](std::size_t passes) { return passes != passes_; });
  return std::min(static_cast<std::size_t>(first_undone - done_.begin()) * unit, queries_);
}

StreamResult stream(data::QuerySource& source, const BlockWork& work,
                    const StreamOptions& options) {
  const int threads = base::cores_for(options.threads);
  const std::size_t blocks_in_flight = 2 * static_cast<std::size_t>(threads);
  Stream ends(source, options, blocks_in_flight);
  const auto read = [&](tbb::flow_control& flow) {
    Token* const token = ends.read();
    if (token == nullptr) flow.stop();
    return token;
  };
  const auto work_on = [&](Token* token) {
    token->result = work(token->block);
    return token;
  };
  const auto finish = [&](const Token* token) { ends.finish(*token); };
  const auto run = [&] {
    tbb::parallel_pipeline(
        blocks_in_flight,
        tbb::make_filter<void, Token*>(tbb::filter_mode::serial_in_order, read) &
            tbb::make_filter<Token*, Token*>(tbb::filter_mode::parallel, work_on) &
            tbb::make_filter<Token*, void>(tbb::filter_mode::serial_in_order, finish));
  };
  tbb::task_arena arena(threads);
  try {
    arena.execute(run);
  } catch (const std::exception& error) {
    ends.fail(error.what());
  }
  return ends.result();
}

}  // namespace touchstone::verify::jobs
