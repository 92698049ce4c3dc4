#include "fast/intersections/pair_filter.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace touchstone::fast::meeting {

const FilteredPairs& PairFilter::filtered(const Positions& at, std::span<const ElementRow> elements,
                                          std::span<const IndexPair> pairs,
                                          const TriangleKernel& kernel) {
  return filter(at, elements, pairs, kernel, sorted_.lists.size());
}

const FilteredPairs& PairFilter::filtered_edges_with_faces(const Positions& at,
                                                           std::span<const ElementRow> elements,
                                                           std::size_t faces,
                                                           std::span<const IndexPair> pairs,
                                                           const TriangleKernel& kernel) {
  std::array<IndexPair, FilteredPairs::capacity> asked;
  const auto is_asked = [faces](const IndexPair& pair) {
    return std::cmp_less(pair[0], faces) != std::cmp_less(pair[1], faces);
  };
  const auto count = std::ranges::copy_if(pairs, asked.begin(), is_asked).out - asked.begin();
  return filter(at, elements, std::span(asked).first(static_cast<std::size_t>(count)), kernel, 1);
}

const FilteredPairs& PairFilter::filter(const Positions& at, std::span<const ElementRow> elements,
                                        std::span<const IndexPair> pairs,
                                        const TriangleKernel& kernel, std::size_t lists) {
  result_.open_count = result_.crossing_count = 0;
  while (!pairs.empty()) {
    const auto some = pairs.first(std::min(pairs.size(), SortedPairs::capacity));
    pairs = pairs.subspan(some.size());
    kernel.sort(elements.data(), some, sorted_);
    for (std::size_t list = 0; list < lists; ++list) {
      const auto sorted = std::span(sorted_.lists[list]).first(sorted_.count[list]);
      if (list < 3 && at.has_filter()) {
        kernel.filter(at.data(), list, sorted, result_);
      } else {
        for (const ElementPair& one : sorted) result_.open[result_.open_count++] = one.pair;
      }
    }
  }
  return result_;
}

}  // namespace touchstone::fast::meeting
