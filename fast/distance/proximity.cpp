#include "fast/distance/proximity.hpp"

#include <algorithm>

namespace touchstone::fast {

std::vector<std::uint32_t> perhaps_within(Kind kind, std::span<Query> queries,
                                          const Separation& separation,
                                          const CertifiedKernel& kernel) {
  thread_local KernelOutput output;
  for (Query& query : queries) {
    const auto start = std::span(query.coordinates).first<3 * moving_points>();
    std::ranges::copy(start, query.coordinates.begin() + start.size());
  }
  KernelInput block{.kind = kind, .count = queries.size(), .queries = queries.data()};
  block.separation = separation;
  block.t_limit = 0.0;
  kernel.decide(block, output);
  std::vector<std::uint32_t> result;
  result.reserve(output.impacts.count + output.undecided.count);
  for (std::size_t i = 0; i < output.impacts.count; ++i)
    result.push_back(output.impacts.items[i].index);
  for (std::size_t i = 0; i < output.undecided.count; ++i) {
    result.push_back(output.undecided.items[i]);
  }
  return result;
}

std::vector<std::uint32_t> perhaps_within(const Step& step, const StepCandidates& candidates,
                                          const Separation& separation) {
  std::vector<Query> queries;
  queries.reserve(candidates.pairs.size());
  for (const IndexPair& pair : candidates.pairs) {
    queries.push_back(step.query_of(candidates.kind, pair));
  }
  return perhaps_within(Step::kind_of(candidates.kind), queries, separation);
}

}  // namespace touchstone::fast
