#pragma once

/// \file
/// Ground truth of the queries of a group, decided once by the oracle for all users in a run.

#include <atomic>
#include <cstddef>
#include <functional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "touchstone/query.hpp"
#include "verify/data/query_group.hpp"
#include "verify/judge/judgement.hpp"

namespace touchstone::verify::judge {

/// A memory of verdicts: of one group, at any number of separations. For one thread at a time; the
/// oracle works on all cores.
class GroundTruthCache {
 public:
  /// The group must live as long as this. \param threads cores to use; 0: all of them
  explicit GroundTruthCache(const data::QueryGroup& group, unsigned threads = 0);

  /// The truth of the queries at these positions, in their order; `index` is the position. Those
  /// that are not known yet are decided. Once *stop is true (it may be null), no more are decided,
  /// and only the truths before the first unknown one are returned.
  /// \param on_progress called now and then with the fraction that is done, from this thread; may be null
  /// \throws std::domain_error if a coordinate is not finite; std::invalid_argument if the
  /// separation is not valid; std::out_of_range for a position beyond the group.
  [[nodiscard]] std::vector<GroundTruth> of(
      const Separation& separation, std::span<const std::size_t> positions,
      const std::atomic<bool>* stop = nullptr,
      const std::function<void(double)>& on_progress = nullptr);

 private:
  using Known = std::unordered_map<std::size_t, GroundTruth>;

  [[nodiscard]] Known& known_at(const Separation& separation);
  /// \pre the positions ascend
  void decide(const Separation& separation, std::span<const std::size_t> positions, Known& known,
              const std::atomic<bool>* stop, const std::function<void(double)>& on_progress);

  const data::QueryGroup& group_;
  int threads_;
  std::vector<std::pair<Separation, Known>> known_;
};

}  // namespace touchstone::verify::judge
