#pragma once

/// \file
/// The first step after the search for pairs of elements whose boxes overlap: it leaves out pairs
/// that are not asked for, and those that certainly do not intersect by rounded numbers, and tells
/// those that certainly cross (filter_on_lanes.hpp). The pairs are sorted by the number of their
/// common vertices, and the vertices of each are brought into one order, so that the lanes of a
/// kernel do the same.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "fast/broad_phase/primitive_groups.hpp"
#include "fast/intersections/contacts.hpp"
#include "fast/intersections/filter_kernel.hpp"
#include "fast/intersections/orientation.hpp"
#include "touchstone/intersections.hpp"

namespace touchstone::fast::meeting {

/// The elements of a mesh: all faces first.
struct ElementLists {
  std::span<const Primitive> vertices;  ///< in normal form
  std::span<const Simplex> simplices;
  std::size_t faces = 0;
  IntersectingPairs asked = IntersectingPairs::all;

  [[nodiscard]] Element operator[](std::int32_t number) const {
    const auto i = static_cast<std::size_t>(number);
    return {vertices[i], simplices[i]};
  }
};

/// The buffers of one thread.
class PairFilter {
 public:
  /// What is known of pairs; valid until the next call.
  /// \pre there are at most FilteredPairs::capacity pairs; strict floating point.
  [[nodiscard]] const FilteredPairs& filtered(const Positions& at, const ElementLists& elements,
                                              std::span<const IndexPair> pairs,
                                              const TriangleKernel& kernel);

 private:
  void sort(const ElementLists& elements, const IndexPair& pair);

  /// By the number of common vertices. The last ones are not for the kernel.
  std::array<std::array<TrianglePair, FilteredPairs::capacity>, 4> sorted_;
  std::array<std::size_t, 4> count_{};
  FilteredPairs result_;
};

}  // namespace touchstone::fast::meeting
