#pragma once

/// \file
/// Queries on their way from a source through work on all cores, and out in order.
///
/// They travel in blocks. Blocks are worked on in parallel, and so are the parts of a block: a
/// source of a thousand queries keeps all cores busy too. After a stop everything from the first
/// unfinished query on is dropped: the results are always those of the first queries.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "touchstone/query.hpp"
#include "verify/base/deadline.hpp"
#include "verify/data/query_source.hpp"
#include "verify/judge/label.hpp"
#include "verify/solvers/solver.hpp"

namespace touchstone::verify::jobs {

/// Some consecutive queries of a source.
struct QueryBlock {
  /// The number of queries of every block but the last: enough to hide the cost of a clock call
  /// behind a solver that takes 10 ns a query.
  static constexpr std::size_t most_queries = 2048;

  const std::string* source;
  QueryShape shape;
  std::vector<double> numbers;
  std::vector<std::uint64_t> indices;
  std::vector<judge::Label> labels;

  [[nodiscard]] std::size_t size() const { return indices.size(); }
  [[nodiscard]] Queries queries() const { return {shape, numbers}; }

  /// Asks for the answers to `count` of them from number `first` on.
  [[nodiscard]] solvers::SolveRequest request(std::size_t first, std::size_t count,
                                              const Separation& separation) const {
    return {.queries = queries().part(first, count),
            .separation = separation,
            .source = *source,
            .indices = std::span(indices).subspan(first, count)};
  }
};

/// Passes over the queries of a block, each on all cores.
class Passes {
 public:
  /// Parts of a pass begin at multiples of this.
  static constexpr std::size_t unit = 16;

  /// The number of units that queries fill, the last one maybe in part.
  [[nodiscard]] static constexpr std::size_t units(std::size_t queries) {
    return (queries + unit - 1) / unit;
  }

  /// \param stop May be null. Once true, no further part of a pass is begun.
  Passes(std::size_t queries, const std::atomic<bool>* stop);

  /// Calls work(first, count) for parts of about `span` queries, at least a unit, which together
  /// are the block; from several threads. The work returns false if a stop has cut the part short.
  /// Returns when all calls have returned.
  void run(std::size_t span, const std::function<bool(std::size_t, std::size_t)>& work);

  /// The number of queries, from the first on, that all passes so far have completed.
  [[nodiscard]] std::size_t complete() const;

 private:
  std::size_t queries_;
  const std::atomic<bool>* stop_;
  std::size_t passes_ = 0;
  std::vector<std::size_t> done_;  // passes that are done with each unit
};

/// The part of the work on a block that is done in the order of the queries.
struct BlockResult {
  /// Called once, never from two threads at once.
  std::function<void()> in_order;
  /// If false, the stream ends after this block.
  bool complete = true;
};

/// The work on a block; called from several threads. The block lives until in_order has returned.
using BlockWork = std::function<BlockResult(const QueryBlock&)>;

struct StreamOptions {
  /// Cores to use; 0: all of them.
  unsigned threads = 0;
  /// Called now and then with the fraction of the source that is done; never from two threads at
  /// once.
  std::function<void(double)> on_progress = nullptr;
  /// Once true, no further queries are read.
  const std::atomic<bool>* stop = nullptr;
  /// No further block is begun after it.
  base::Deadline deadline = {};
  /// Queries of a block, at most QueryBlock::most_queries; fewer end sooner.
  std::size_t block = QueryBlock::most_queries;
};

/// Outcome of a stream.
struct StreamResult {
  std::uint64_t skipped = 0;  ///< in error, left out
  std::uint64_t rounded = 0;  ///< coordinates rounded to double
  /// The error that ended the stream before the source's end.
  std::optional<std::string> error;
  bool interrupted = false;  ///< by the stop, or by the deadline
};

/// Sends all queries of the source through the work. Errors of the source, and exceptions of the
/// work, end the stream and are in the result; the work done in order until then stands.
StreamResult stream(data::QuerySource& source, const BlockWork& work, const StreamOptions& options);

/// The same with work in two steps: what make(block) returns says by its complete() whether the
/// stream goes on, and add takes it in the order of the queries.
template <class Make, class Add>
StreamResult stream(data::QuerySource& source, const Make& make, const Add& add,
                    const StreamOptions& options) {
  const auto work = [&](const QueryBlock& block) -> BlockResult {
    const auto made =
        std::make_shared<const std::invoke_result_t<Make, const QueryBlock&>>(make(block));
    return {.in_order = [made, &add] { add(*made); }, .complete = made->complete()};
  };
  return stream(source, BlockWork(work), options);
}

}  // namespace touchstone::verify::jobs
