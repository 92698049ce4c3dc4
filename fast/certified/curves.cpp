#include "fast/certified/curves.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace touchstone::fast {
namespace {

// ---- Weights ------------------------------------------------------------------------------------

/// The weights of a query.
class Weights {
 public:
  Weights(const Queries& queries, std::size_t i)
      : queries_(queries),
        row_(queries.row(i)),
        second_(queries.kind == ContactKind::vertex_face ? 1 : 2) {}

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

  const Queries& queries_;
  std::span<const double> row_;
  std::size_t second_;
};

// ---- Blocks -------------------------------------------------------------------------------------

using Indices = KernelList<std::uint32_t>;

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
void sort(const Queries& queries, double distance, const Indices& open,
          ByDenominators& by_denominators, Indices& undecided) {
  for (Indices& list : by_denominators) list.count = 0;
  for (std::size_t i = 0; i < open.count; ++i) {
    const std::uint32_t index = open.items[i];
    const auto form = form_of(Weights(queries, index), queries.degree, distance);
    append(form ? by_denominators[static_cast<std::size_t>(*form)] : undecided, index);
  }
}

}  // namespace

const KernelOutput& search_curves(const Queries& queries, double t_limit,
                                  const CertifiedOptions& options, const CertifiedKernel& kernel) {
  thread_local Indices open;
  thread_local ByDenominators sorted;
  thread_local KernelOutput output;
  const curved::Block block{queries, options.separation,
                            std::max(options.toi_tolerance, least_kernel_tolerance), t_limit};
  kernel.curves->axis(block, open);
  output.separated_in_direction.count = output.one_sided.count = output.rejected.count = 0;
  output.impacts.count = output.undecided.count = 0;
  sort(queries, options.separation.distance, open, sorted, output.undecided);
  for (std::size_t form = 0; form < sorted.size(); ++form) {
    kernel.curves->search(block, sorted[form], static_cast<curved::Denominators>(form), output);
  }
  return output;
}

}  // namespace touchstone::fast
