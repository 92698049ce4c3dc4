#pragma once

/// \file
/// Groups of sixteen primitives that are close to each other, for the trees of the broad
/// phase.
///
/// Primitives are split at the median of their boxes' centres, along the axis of greatest spread,
/// until sixteen are left. Splitting by rank rather than by place gives every branch the same
/// depth, and memory proportional to the number of primitives, for any sizes and clusters.
///
/// All splits are at multiples of sixteen, then of 16², and so on. So one node covers groups 16 i
/// to 16 i + 15, and a node of the next level nodes 16 i to 16 i + 15: a tree with sixteen children
/// per node and without pointers.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "fast/broad_phase/float_bounds.hpp"
#include "fast/platform/large_array.hpp"
#include "touchstone/mesh.hpp"

namespace touchstone::fast {

struct SearchKernel;

/// Number of primitives of a group, and of children of a node.
inline constexpr std::size_t group_size = 16;

/// The vertices of a primitive; the last one is repeated if there are fewer than three.
using Primitive = std::array<std::int32_t, 3>;

[[nodiscard]] inline Primitive primitive_of(std::int32_t vertex) {
  return {vertex, vertex, vertex};
}
[[nodiscard]] inline Primitive primitive_of(const Edge& edge) {
  return {edge[0], edge[1], edge[1]};
}
[[nodiscard]] inline Primitive primitive_of(const Face& face) { return face; }

/// A number for each primitive of a group.
using IndexLanes = std::array<std::int32_t, group_size>;

/// The primitives of a group. Lanes beyond the last primitive repeat it.
struct alignas(64) GroupMembers {
  IndexLanes numbers;  ///< for a vertex its own number, for others the index in the list
  std::array<IndexLanes, 3> vertices;  ///< first, second and third vertices of the primitives
};

class PrimitiveGroups {
 public:
  /// No primitives.
  PrimitiveGroups() = default;
  /// `Element` is std::int32_t (a vertex), Edge or Face. The groups depend only on the arguments.
  /// Uses the threads of the caller's task arena.
  /// \param kernel For tests: a replacement of the best one for this processor. All kernels give
  /// the same groups.
  /// \pre there are at most 2^31−1 elements, and their indices are in range.
  template <class Element>
  PrimitiveGroups(const FloatBounds& bounds, std::span<const Element> elements,
                  const SearchKernel* kernel = nullptr);

  /// The number of primitives.
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::span<const GroupMembers> members() const { return {members_.data(), groups_}; }

 private:
  std::size_t size_ = 0;
  std::size_t groups_ = 0;
  LargeArray<GroupMembers> members_;
};

extern template PrimitiveGroups::PrimitiveGroups(const FloatBounds&, std::span<const std::int32_t>,
                                                 const SearchKernel*);
extern template PrimitiveGroups::PrimitiveGroups(const FloatBounds&, std::span<const Edge>,
                                                 const SearchKernel*);
extern template PrimitiveGroups::PrimitiveGroups(const FloatBounds&, std::span<const Face>,
                                                 const SearchKernel*);

}  // namespace touchstone::fast
