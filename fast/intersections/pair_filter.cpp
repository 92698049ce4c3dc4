#include "fast/intersections/pair_filter.hpp"

#include <bit>

namespace touchstone::fast::meeting {
namespace {

using Row = std::int32_t __attribute__((vector_size(16)));

/// Bit 3 k + i: vertex i of one is vertex k of the other.
unsigned equal_vertices(const Primitive& a, const Primitive& b) {
  const Row of_a{a[0], a[1], a[2], 0};
  const Row bits = ((of_a == b[0]) & Row{1, 2, 4, 0}) | ((of_a == b[1]) & Row{8, 16, 32, 0}) |
                   ((of_a == b[2]) & Row{64, 128, 256, 0});
  return static_cast<unsigned>(bits[0] | bits[1] | bits[2]);
}

/// The places of the vertices of two triangles in a TrianglePair: the first three are of the first
/// triangle, the others of the second.
struct Order {
  std::size_t common = 3;
  std::array<std::uint8_t, 6> of{};
};

/// Of triangles with these equal vertices.
constexpr Order order_of(unsigned equal) {
  const auto order = [](std::size_t common, const std::array<unsigned, 6>& of) {
    Order result{.common = common};
    for (std::size_t n = 0; n < 6; ++n) result.of[n] = static_cast<std::uint8_t>(of[n]);
    return result;
  };
  const auto first = static_cast<unsigned>(std::countr_zero(equal)), i = first % 3, k = first / 3;
  const auto last = static_cast<unsigned>(std::bit_width(equal)) - 1, j = last % 3, l = last / 3;
  if (equal == 0) return order(0, {0, 1, 2, 0, 1, 2});
  if (i == j && k == l) {
    return order(1, {i, (i + 1) % 3, (i + 2) % 3, (k + 1) % 3, (k + 2) % 3, 0});
  }
  if (std::popcount(equal) == 2 && i != j && k != l) {
    return order(2, {i, j, 3 - i - j, 3 - k - l, 0, 0});
  }
  return {};
}

constexpr std::array<Order, 512> make_orders() {
  std::array<Order, 512> result;
  for (unsigned equal = 0; equal < result.size(); ++equal) result[equal] = order_of(equal);
  return result;
}
constexpr std::array<Order, 512> orders = make_orders();

}  // namespace

void PairFilter::sort(const ElementLists& elements, const IndexPair& pair) {
  const auto i = static_cast<std::size_t>(pair[0]), k = static_cast<std::size_t>(pair[1]);
  const unsigned equal = equal_vertices(elements.vertices[i], elements.vertices[k]);
  if (elements.asked == IntersectingPairs::edges_with_faces) {
    if (equal != 0 || (i < elements.faces) == (k < elements.faces)) return;
  }
  const Simplex &a = elements.simplices[i], &b = elements.simplices[k];
  const Order& order = orders[equal];
  // Of strangers the kernel takes segments and points, too: as triangles without an area.
  const bool is_for_kernel = equal == 0 || (dimension(a) == 2 && dimension(b) == 2);
  const std::size_t list = is_for_kernel ? order.common : 3;
  const auto& of = order.of;
  sorted_[list][count_[list]++] = {{a[of[0]], a[of[1]], a[of[2]], b[of[3]], b[of[4]], b[of[5]]},
                                   pair};
}

const FilteredPairs& PairFilter::filtered(const Positions& at, const ElementLists& elements,
                                          std::span<const IndexPair> pairs,
                                          const TriangleKernel& kernel) {
  count_.fill(0);
  result_.open_count = result_.crossing_count = 0;
  for (const IndexPair& pair : pairs) sort(elements, pair);
  for (std::size_t common = 0; common < sorted_.size(); ++common) {
    const auto some = std::span(sorted_[common]).first(count_[common]);
    if (common < 3 && at.has_filter()) {
      kernel.filter(at.vertices().data(), common, some, result_);
    } else {
      for (const TrianglePair& one : some) result_.open[result_.open_count++] = one.pair;
    }
  }
  return result_;
}

}  // namespace touchstone::fast::meeting
