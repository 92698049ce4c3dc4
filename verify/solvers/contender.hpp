#pragma once

/// \file
/// What a benchmark times: a solver together with the memory that its answers go to.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exact/query.hpp"
#include "fast/certified.hpp"
#include "fast/method.hpp"
#include "verify/solvers/solver_process.hpp"

namespace touchstone::verify {

/// So many queries were ended by a stage of that name.
struct StageCount {
  std::string_view stage;
  std::uint64_t queries = 0;

  friend bool operator==(const StageCount&, const StageCount&) = default;
};

/// How many of these results each stage ended, all stages in their order.
[[nodiscard]] std::vector<StageCount> count_stages(std::span<const fast::CertifiedResult> results);

/// A solver in a benchmark. For one thread at a time.
class Contender {
 public:
  Contender(std::string name, fast::Promise promise) : name_(std::move(name)), promise_(promise) {}
  Contender(const Contender&) = delete;
  Contender& operator=(const Contender&) = delete;
  Contender(Contender&&) = delete;
  Contender& operator=(Contender&&) = delete;
  virtual ~Contender() = default;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] fast::Promise promise() const { return promise_; }

  /// Does it take its queries from elsewhere, and so can be asked for all of them only?
  [[nodiscard]] virtual bool only_as_a_whole() const { return false; }

  /// Answers the queries, in this thread or in a child process that it waits for: the work that is
  /// timed. Memory of earlier calls is used again.
  virtual void solve(Kind kind, std::span<const Query> queries) = 0;

  /// Processor time of the latest call of solve() in nanoseconds, where that is not the time of this
  /// thread.
  [[nodiscard]] virtual std::optional<double> nanoseconds_elsewhere() const { return std::nullopt; }

  /// The answer to query i of the latest call of solve().
  [[nodiscard]] virtual fast::Answer answer(std::size_t i) const = 0;

  /// Why there is no answer to query i, where more is known than the answer shows; else null.
  [[nodiscard]] virtual const Failure* failure(std::size_t i) const;

  /// Times its process ended at no particular query: see solver_process.hpp.
  [[nodiscard]] virtual std::uint64_t unplaced_crashes() const { return 0; }

  /// What it printed since the last call of this, where that is caught.
  [[nodiscard]] virtual CapturedOutput take_output() { return {}; }

  /// Which stages end these queries, if it has stages; empty if not. Not timed.
  [[nodiscard]] virtual std::vector<StageCount> stages(Kind kind, std::span<const Query> queries);

 private:
  std::string name_;
  fast::Promise promise_;
};

/// A method under these options. The method must live as long as the contender.
[[nodiscard]] std::unique_ptr<Contender> contend(const fast::Method& method,
                                                 const fast::MethodOptions& options);

/// The certified solver as a method, which knows its stages.
[[nodiscard]] std::unique_ptr<Contender> contend_certified(
    const fast::MethodOptions& options, const fast::CertifiedOptions& certified = {});

/// The certified solver by its own interface, fast::collisions, as `certified_queries`: on the array
/// of queries, in one thread.
[[nodiscard]] std::unique_ptr<Contender> contend_with_queries(
    const fast::CertifiedOptions& certified);

/// The same from index pairs, as `certified_pairs`. The queries that it is asked must be those of
/// all the candidates; it does not look at them. The mesh must live as long as the contender.
[[nodiscard]] std::unique_ptr<Contender> contend_with_pairs(
    const fast::MovingVertices& vertices, const fast::Candidates& candidates,
    const fast::CertifiedOptions& certified);

}  // namespace touchstone::verify
