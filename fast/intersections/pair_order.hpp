#pragma once

/// \file
/// The order of the vertices of two elements for the filter (filter_on_lanes.hpp): a table, by what
/// vertices they have in common. Only the kernels include this file.
///
/// `Lanes`, besides what the filter needs, has
/// - Both: the rows of two elements;
/// - both(a, b);
/// - equal_vertices(both): bit 3 k + i if vertex i of the first is vertex k of the second;
/// - write(to, both, order, pair): the pair, with the vertices in that order.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "fast/intersections/filter_kernel.hpp"

namespace touchstone::fast::pair_order {

/// Places among the rows of two elements, 0 to 2 in the first, 4 to 6 in the second, and the list.
struct alignas(8) Order {
  std::array<std::uint8_t, 6> places{};
  std::uint8_t list = 3;
};

constexpr Order order_of(unsigned equal) {
  const auto order = [](std::size_t list, const std::array<unsigned, 6>& places) {
    Order result;
    result.list = static_cast<std::uint8_t>(list);
    for (std::size_t n = 0; n < 6; ++n) result.places[n] = static_cast<std::uint8_t>(places[n]);
    return result;
  };
  if (equal == 0) return order(0, {0, 1, 2, 4, 5, 6});
  const auto first = static_cast<unsigned>(std::countr_zero(equal)), i = first % 3, k = first / 3;
  const auto last = static_cast<unsigned>(std::bit_width(equal)) - 1, j = last % 3, l = last / 3;
  if (std::popcount(equal) == 1) {
    return order(1, {i, (i + 1) % 3, (i + 2) % 3, 4 + (k + 1) % 3, 4 + (k + 2) % 3, 0});
  }
  if (std::popcount(equal) == 2 && i != j && k != l) {
    return order(2, {i, j, 3 - i - j, 4 + (3 - k - l), 0, 0});
  }
  return {};
}

constexpr auto orders = [] {
  std::array<Order, 512> result;
  for (unsigned equal = 0; equal < result.size(); ++equal) result[equal] = order_of(equal);
  return result;
}();

/// As TriangleKernel::sort.
template <class Lanes>
void sort(const ElementRow* elements, std::span<const IndexPair> pairs, SortedPairs& sorted) {
  std::array<ElementPair*, 4> ends;
  for (std::size_t i = 0; i < 4; ++i) ends[i] = sorted.lists[i].data();
  for (const IndexPair& pair : pairs) {
    const auto both = Lanes::both(elements[pair[0]], elements[pair[1]]);
    const Order& order = orders[Lanes::equal_vertices(both)];
    Lanes::write(ends[order.list]++, both, order, pair);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    sorted.count[i] = static_cast<std::size_t>(ends[i] - sorted.lists[i].data());
  }
}

/// In plain C++.
struct OneByOne {
  using Row = std::int32_t __attribute__((vector_size(16)));

  struct Both {
    const ElementRow *a, *b;
  };
  static Both both(const ElementRow& a, const ElementRow& b) { return {&a, &b}; }

  static unsigned equal_vertices(const Both& both) {
    const auto &a = *both.a, &b = *both.b;
    const Row of_a{a[0], a[1], a[2], 0};
    const Row bits = ((of_a == b[0]) & Row{1, 2, 4, 0}) | ((of_a == b[1]) & Row{8, 16, 32, 0}) |
                     ((of_a == b[2]) & Row{64, 128, 256, 0});
    return static_cast<unsigned>(bits[0] | bits[1] | bits[2]);
  }

  static void write(ElementPair* to, const Both& both, const Order& order, const IndexPair& pair) {
    const auto &a = *both.a, &b = *both.b;
    const auto& at = order.places;
    // The second three are of the second element, or unused.
    *to = {{a[at[0]], a[at[1]], a[at[2]], b[at[3] & 3U], b[at[4] & 3U], b[at[5] & 3U]}, pair};
  }
};

}  // namespace touchstone::fast::pair_order
