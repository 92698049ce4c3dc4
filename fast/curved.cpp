#include "touchstone/curved.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <stdexcept>

#include "fast/certified/block.hpp"
#include "fast/certified/exact/curved_polygon.hpp"
#include "fast/curved/curved_block.hpp"
#include "fast/kernels.hpp"

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

// ---- Weights ------------------------------------------------------------------------------------

/// The weights of a query.
class Weights {
 public:
  Weights(Kind kind, const CurvedQueries& queries, std::size_t i)
      : queries_(queries), row_(queries.row(i)), second_(kind == Kind::vertex_face ? 1 : 2) {}

  /// True if both primitives have the same weights, or none. \pre are_alike_in_primitives()
  [[nodiscard]] bool are_alike() const { return are_equal(0, second_); }

  /// True if the points of each primitive have the same weights, or none.
  [[nodiscard]] bool are_alike_in_primitives() const {
    for (std::size_t point = 1; point < moving_points; ++point) {
      if (point != second_ && !are_equal(point, point < second_ ? 0 : second_)) return false;
    }
    return true;
  }

  /// True if no product of two underflows or overflows.
  [[nodiscard]] bool are_usual() const {
    constexpr double least = 0x1p-30, most = 0x1p30;
    if (!queries_.is_rational) return true;
    for (std::size_t i = 3; i < row_.size(); i += 4) {
      if (!(row_[i] >= least && row_[i] <= most)) return false;
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

/// The form of a query's control polygon, if it has one.
std::optional<curved::Denominators> form_of(const Weights& weights, std::size_t degree,
                                            double distance) {
  using curved::Denominators;
  if (!weights.are_usual()) return std::nullopt;
  const bool is_rigid = weights.are_alike_in_primitives();
  if (is_rigid && weights.are_alike()) return Denominators::one;
  if (2 * degree > curved::greatest_corner_degree) return std::nullopt;
  if (is_rigid) return Denominators::two;
  if (distance == 0.0) return Denominators::four;
  return std::nullopt;
}

using ByDenominators = std::array<Indices, curved::denominators_count>;

/// Queries by the form of their control polygons; those without one are undecided.
void sort(Kind kind, const CurvedQueries& queries, double distance, const Indices& open,
          ByDenominators& by_denominators, Indices& undecided) {
  for (Indices& list : by_denominators) list.count = 0;
  for (std::size_t i = 0; i < open.count; ++i) {
    const std::uint32_t index = open.items[i];
    const auto form = form_of(Weights(kind, queries, index), queries.degree, distance);
    append(form ? by_denominators[static_cast<std::size_t>(*form)] : undecided, index);
  }
}

/// Decides a block. \pre strict floating point
void decide(Kind kind, const CurvedQueries& queries, const CertifiedKernel& kernel,
            const CertifiedOptions& options, std::span<CertifiedResult> results) {
  thread_local Indices open;
  thread_local ByDenominators sorted;
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
  output.separated_in_direction.count = output.one_sided.count = output.rejected.count = 0;
  output.impacts.count = output.undecided.count = 0;
  sort(kind, queries, options.separation.distance, open, sorted, output.undecided);
  for (std::size_t form = 0; form < sorted.size(); ++form) {
    kernel.curved_search(block, sorted[form], static_cast<curved::Denominators>(form), output);
  }
  mark_stages(output, [&](std::size_t index, Stage stage) { results[index].stage = stage; });
  report_contacts(
      output, options,
      [&](std::size_t index) { return decided_exactly(kind, queries.query(index), options); },
      [&](std::size_t index, const CertifiedResult& result) { results[index] = result; });
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
  const std::size_t size = queries.numbers_of_query();
  for_each_kernel_block(results.size(), options.max_threads, 1, [&](std::size_t first) {
    const std::size_t count = std::min(kernel_block, results.size() - first);
    const CurvedQueries some{queries.degree, queries.is_rational,
                             queries.numbers.subspan(first * size, count * size)};
    decide(kind, some, kernel, options, results.subspan(first, count));
  });
}

}  // namespace touchstone::fast
