#pragma once

/// \file
/// The first step after the search for pairs of elements whose boxes overlap: it leaves out pairs
/// that are not asked for, and those that certainly do not intersect by rounded numbers, and tells
/// those that certainly cross (filter_on_lanes.hpp).

#include <cstddef>
#include <span>

#include "fast/intersections/filter_kernel.hpp"
#include "fast/intersections/orientation.hpp"
#include "touchstone/mesh.hpp"

namespace touchstone::fast::meeting {

/// The buffers of one thread.
class PairFilter {
 public:
  /// What is known of pairs of elements, all faces first; valid until the next call.
  /// \pre there are at most FilteredPairs::capacity pairs; strict floating point.
  [[nodiscard]] const FilteredPairs& filtered(const Positions& at,
                                              std::span<const ElementRow> elements,
                                              std::span<const IndexPair> pairs,
                                              const TriangleKernel& kernel);

  /// The same of pairs of an edge and a face without a common vertex; the others are left out.
  [[nodiscard]] const FilteredPairs& filtered_edges_with_faces(const Positions& at,
                                                               std::span<const ElementRow> elements,
                                                               std::size_t faces,
                                                               std::span<const IndexPair> pairs,
                                                               const TriangleKernel& kernel);

 private:
  /// \param lists The number of lists of sorted pairs that are asked for.
  [[nodiscard]] const FilteredPairs& filter(const Positions& at,
                                            std::span<const ElementRow> elements,
                                            std::span<const IndexPair> pairs,
                                            const TriangleKernel& kernel, std::size_t lists);

  SortedPairs sorted_;
  FilteredPairs result_;
};

}  // namespace touchstone::fast::meeting
