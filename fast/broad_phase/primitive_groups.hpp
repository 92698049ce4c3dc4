#pragma once

/// \file
/// Primitives in groups of sixteen that are near each other, for the trees of the broad phase.
///
/// They are split at the median of their boxes' centres, along the axis where these spread most, until
/// sixteen are left. Splitting by rank and not by place makes every branch equally deep, and memory
/// proportional to the primitives, however large, small or clustered they are.
///
/// All splits are at multiples of sixteen, then of 16², and so on. So groups 16 i to 16 i + 15 are what one
/// node covers, nodes 16 i to 16 i + 15 what the next one covers: a tree of sixteen children a
/// node that needs no pointers.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "fast/broad_phase/float_bounds.hpp"
#include "fast/mesh.hpp"

namespace touchstone::fast {

struct SearchKernel;

/// Primitives of a group, children of a node.
inline constexpr std::size_t group_size = 16;

/// The vertices of a primitive; the last one is repeated where there are fewer than three.
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
  IndexLanes numbers;  ///< of a vertex its own number, of others their place in the list
  std::array<IndexLanes, 3> vertices;  ///< the first of each primitive, the second, the third
};

class PrimitiveGroups {
 public:
  /// `Element` is std::int32_t (a vertex), Edge or Face. The groups depend on nothing but the arguments. Uses
  /// the threads of the task arena that it is called in.
  /// \param kernel For tests: instead of the best one for this processor. All make the same groups.
  /// \pre there are at most 2^31−1 elements, and their indices are in range.
  template <class Element>
  PrimitiveGroups(const FloatBounds& bounds, std::span<const Element> elements,
                  const SearchKernel* kernel = nullptr);

  /// How many primitives there are.
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::span<const GroupMembers> members() const { return {members_.get(), groups_}; }

 private:
  std::size_t size_;
  std::size_t groups_;
  // NOLINTNEXTLINE(modernize-avoid-c-arrays): an array of its own that nothing fills with zeros
  std::unique_ptr<GroupMembers[]> members_;
};

extern template PrimitiveGroups::PrimitiveGroups(const FloatBounds&, std::span<const std::int32_t>,
                                                 const SearchKernel*);
extern template PrimitiveGroups::PrimitiveGroups(const FloatBounds&, std::span<const Edge>,
                                                 const SearchKernel*);
extern template PrimitiveGroups::PrimitiveGroups(const FloatBounds&, std::span<const Face>,
                                                 const SearchKernel*);

}  // namespace touchstone::fast
