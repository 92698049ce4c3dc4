#include "fast/broad_phase/body_tree.hpp"

#include <algorithm>

namespace touchstone::fast {
namespace {

/// The common body, or mixed.
template <std::size_t count>
std::int32_t common_body(const std::array<std::int32_t, count>& bodies) {
  const bool all_equal =
      std::ranges::all_of(bodies, [&](std::int32_t body) { return body == bodies.front(); });
  return all_equal ? bodies.front() : BodyTree::mixed;
}

IndexLanes bodies_of(const GroupMembers& members, std::span<const std::int32_t> of_vertices) {
  IndexLanes result;
  for (std::size_t lane = 0; lane < group_size; ++lane) {
    Primitive bodies;
    for (std::size_t corner = 0; corner < bodies.size(); ++corner) {
      bodies[corner] = of_vertices[static_cast<std::size_t>(members.vertices[corner][lane])];
    }
    result[lane] = common_body(bodies);
  }
  return result;
}

/// The bodies of the groups below, sixteen at a time. Lanes after the last repeat it.
std::vector<IndexLanes> level_above(const std::vector<IndexLanes>& below) {
  std::vector<IndexLanes> result((below.size() + group_size - 1) / group_size);
  for (std::size_t i = 0; i < result.size() * group_size; ++i) {
    result[i / group_size][i % group_size] = common_body(below[std::min(i, below.size() - 1)]);
  }
  return result;
}

}  // namespace

BodyTree::BodyTree(const PrimitiveGroups& primitives, std::span<const std::int32_t> of_vertices,
                   bool all_are_mixed) {
  if (primitives.members().empty()) return;
  levels_.emplace_back();
  for (const GroupMembers& members : primitives.members()) {
    levels_.back().push_back(bodies_of(members, of_vertices));
  }
  do {
    levels_.push_back(level_above(levels_.back()));
  } while (levels_.back().size() > 1);
  if (all_are_mixed) {
    for (IndexLanes& bodies : levels_.front()) bodies.fill(mixed);
  }
}

}  // namespace touchstone::fast
