#include "touchstone/curved.hpp"

#include <algorithm>
#include <stdexcept>

#include "fast/certified/block.hpp"
#include "fast/certified/exact/curved_polygon.hpp"
#include "fast/curved/curved_search.hpp"
#include "fast/platform/floating_point_state.hpp"
#include "fast/platform/threads.hpp"

namespace touchstone::fast {
namespace {

void require_valid(const CurvedQueries& queries) {
  if (queries.degree > greatest_degree) {
    throw std::invalid_argument("curved: a degree above 8");
  }
  if (queries.numbers.size() % queries.numbers_of_query() != 0) {
    throw std::invalid_argument("curved: the numbers are no whole queries");
  }
}

CertifiedResult decided_exactly(Kind kind, const CurvedQuery& query,
                                const CertifiedOptions& options) {
  if (!exact_stage::is_valid(query)) return {.verdict = Verdict::error, .stage = Stage::exact};
  return result_of(
      decide_exactly(kind, query, options.separation, options.toi_tolerance, options.t_max));
}

template <Kind kind, Norm norm>
CertifiedResult decide(const CurvedQueries& queries, std::size_t i,
                       const CertifiedOptions& options) {
  const curved::ControlPoints points(kind, queries, i);
  const CertifiedResult result = curved::Search<kind, norm>(points, options).run();
  if (result.verdict != Verdict::undecided) return result;
  return decided_exactly(kind, queries.query(i), options);
}

}  // namespace

void solve(Kind kind, const CurvedQueries& queries, std::span<CertifiedResult> results,
           const CertifiedOptions& options) {
  require_valid(options);
  require_valid(queries);
  if (results.size() != queries.size()) {
    throw std::invalid_argument("curved: as many results as queries are needed");
  }
  // At distance 0 the best direction is that of l2.
  const Norm norm = options.separation.distance == 0.0 ? Norm::l2 : options.separation.norm;
  const auto one = [&](std::size_t i) {
    if (kind == Kind::vertex_face) {
      return norm == Norm::l2 ? decide<Kind::vertex_face, Norm::l2>(queries, i, options)
                              : decide<Kind::vertex_face, Norm::linf>(queries, i, options);
    }
    return norm == Norm::l2 ? decide<Kind::edge_edge, Norm::l2>(queries, i, options)
                            : decide<Kind::edge_edge, Norm::linf>(queries, i, options);
  };
  const auto run = [&](std::size_t begin, std::size_t end) {
    const StrictFloatingPoint strict;
    for (std::size_t i = begin; i < end; ++i) results[i] = one(i);
  };
  if (options.max_threads == 1 || results.size() <= 1) {
    run(0, results.size());
    return;
  }
  constexpr std::size_t queries_of_task = 256;
  with_threads(options.max_threads, [&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, results.size(), queries_of_task),
        [&](const tbb::blocked_range<std::size_t>& range) { run(range.begin(), range.end()); });
  });
}

}  // namespace touchstone::fast
