#include "touchstone/curved.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "fast/certified/block.hpp"
#include "fast/certified/exact/curved_polygon.hpp"
#include "fast/curved/curved_block.hpp"
#include "fast/kernels.hpp"
#include "fast/platform/floating_point_state.hpp"
#include "fast/platform/threads.hpp"

namespace touchstone::fast {
namespace {

/// Small enough that the queries stay in the cache between stages.
constexpr std::size_t queries_of_block = 1024;
static_assert(queries_of_block <= kernel_block);

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

// ---- Weights ------------------------------------------------------------------------------------

/// The weights of a query.
class Weights {
 public:
  Weights(Kind kind, const CurvedQueries& queries, std::size_t i)
      : queries_(queries), row_(queries.row(i)), second_(kind == Kind::vertex_face ? 1 : 2) {}

  /// True if all points have the same weights, or none.
  [[nodiscard]] bool are_alike() const { return are_equal(0, second_); }

  /// True if the points of each primitive have weights in common, which are not so small or large
  /// that products of them underflow or overflow.
  [[nodiscard]] bool are_rigid() const {
    constexpr double least = 0x1p-30, most = 0x1p30;
    if (!queries_.is_rational) return true;
    for (const std::size_t point : {std::size_t{0}, second_}) {
      for (std::size_t k = 0; k <= queries_.degree; ++k) {
        if (!(at(k, point) >= least && at(k, point) <= most)) return false;
      }
    }
    for (std::size_t point = 1; point < moving_points; ++point) {
      if (point != second_ && !are_equal(point, point < second_ ? 0 : second_)) return false;
    }
    return true;
  }

 private:
  [[nodiscard]] double at(std::size_t k, std::size_t point) const {
    return row_[(k * moving_points + point) * 4 + 3];
  }
  [[nodiscard]] bool are_equal(std::size_t a, std::size_t b) const {
    if (!queries_.is_rational) return true;
    for (std::size_t k = 0; k <= queries_.degree; ++k) {
      if (at(k, a) != at(k, b)) return false;
    }
    return true;
  }

  const CurvedQueries& queries_;
  std::span<const double> row_;
  std::size_t second_;
};

// ---- Blocks -------------------------------------------------------------------------------------

using Indices = KernelOutput::List<std::uint32_t>;

void append(Indices& list, std::uint32_t index) { list.items[list.count++] = index; }

/// Queries by the form of their control polygons; those without one are undecided.
void sort(Kind kind, const CurvedQueries& queries, const Indices& open,
          std::array<Indices, 2>& by_denominators, Indices& undecided) {
  for (Indices& list : by_denominators) list.count = 0;
  for (std::size_t i = 0; i < open.count; ++i) {
    const Weights weights(kind, queries, open.items[i]);
    const bool is_small = 2 * queries.degree <= curved::greatest_corner_degree;
    if (!weights.are_rigid() || (!weights.are_alike() && !is_small)) {
      append(undecided, open.items[i]);
    } else {
      const auto form = weights.are_alike() ? curved::Denominators::one : curved::Denominators::two;
      append(by_denominators[static_cast<std::size_t>(form)], open.items[i]);
    }
  }
}

/// Decides a block. \pre strict floating point
void decide(Kind kind, const CurvedQueries& queries, const CertifiedKernel& kernel,
            const CertifiedOptions& options, std::span<CertifiedResult> results) {
  thread_local Indices open;
  thread_local std::array<Indices, 2> sorted;
  thread_local KernelOutput output;
  const curved::Block block{
      .kind = kind,
      .degree = queries.degree,
      .is_rational = queries.is_rational,
      .numbers = queries.numbers.data(),
      .count = queries.size(),
      .separation = options.separation,
      .toi_tolerance = std::max(options.toi_tolerance, least_kernel_tolerance),
      .t_limit = options.t_max};
  std::ranges::fill(results, CertifiedResult{.verdict = Verdict::no, .stage = Stage::axis});
  kernel.curved_axis(block, open);
  output.separated_in_direction.count = output.rejected.count = 0;
  output.impacts.count = output.undecided.count = 0;
  sort(kind, queries, open, sorted, output.undecided);
  for (const auto form : {curved::Denominators::one, curved::Denominators::two}) {
    kernel.curved_search(block, sorted[static_cast<std::size_t>(form)], form, output);
  }
  const auto mark = [&](const Indices& list, Stage stage) {
    for (std::size_t i = 0; i < list.count; ++i) results[list.items[i]].stage = stage;
  };
  mark(output.separated_in_direction, Stage::direction);
  mark(output.rejected, Stage::bisection);
  for (std::size_t i = 0; i < output.impacts.count; ++i) {
    const KernelImpact& impact = output.impacts.items[i];
    if (const auto result = result_of(impact, options)) {
      results[impact.index] = *result;
    } else {
      append(output.undecided, impact.index);
    }
  }
  for (std::size_t i = 0; i < output.undecided.count; ++i) {
    const std::uint32_t index = output.undecided.items[i];
    results[index] = decided_exactly(kind, queries.query(index), options);
  }
}

}  // namespace

void solve(Kind kind, const CurvedQueries& queries, std::span<CertifiedResult> results,
           const CertifiedOptions& options) {
  require_valid(options);
  require_valid(queries);
  if (results.size() != queries.size()) {
    throw std::invalid_argument("curved: as many results as queries are needed");
  }
  const CertifiedKernel& kernel = certified_kernel(chosen_kernels());
  const auto decide_blocks = [&](std::size_t begin, std::size_t end) {
    const StrictFloatingPoint strict;
    const std::size_t size = queries.numbers_of_query();
    for (std::size_t first = begin; first < end; first += queries_of_block) {
      const std::size_t count = std::min(queries_of_block, end - first);
      const CurvedQueries some{queries.degree, queries.is_rational,
                               queries.numbers.subspan(first * size, count * size)};
      decide(kind, some, kernel, options, results.subspan(first, count));
    }
  };
  if (options.max_threads == 1 || results.size() <= 1) {
    decide_blocks(0, results.size());
    return;
  }
  with_threads(options.max_threads, [&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, results.size(), queries_of_block),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        decide_blocks(range.begin(), range.end());
                      });
  });
}

}  // namespace touchstone::fast
