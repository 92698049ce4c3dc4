#include "fast/broad_phase.hpp"

#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>

#include "fast/broad_phase/box_tree.hpp"
#include "fast/platform/floating_point_state.hpp"

namespace touchstone::fast {
namespace {

namespace tbb = oneapi::tbb;

/// So many groups are held against a tree by one task.
constexpr std::size_t groups_of_chunk = 16;

Primitive primitive_of(std::int32_t vertex) { return {vertex, vertex, vertex}; }
Primitive primitive_of(const Edge& edge) { return {edge[0], edge[1], edge[1]}; }
Primitive primitive_of(const Face& face) { return face; }

void require_valid(const BroadPhaseOptions& options) {
  if (!std::isfinite(options.min_separation) || options.min_separation < 0.0) {
    throw std::invalid_argument("min_separation must be finite and not negative");
  }
  if (options.max_threads < 0) throw std::invalid_argument("max_threads must not be negative");
}

void require_countable(std::size_t count, std::string_view name) {
  if (count <= static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) return;
  throw std::length_error(std::string(name) + ": more than 2^31-1 of them");
}

void require_finite(const MovingVertices& vertices) {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (!is_finite(vertices[i].start) || !is_finite(vertices[i].end)) {
      throw std::domain_error("vertex " + std::to_string(i) + ": a coordinate is not finite");
    }
  }
}

/// Edges or faces as primitives of a tree.
template <class Element>
std::vector<Primitive> primitives_of(const MovingVertices& vertices,
                                     std::span<const Element> elements, std::string_view name) {
  require_countable(elements.size(), name);
  std::vector<Primitive> result(elements.size());
  for (std::size_t i = 0; i < elements.size(); ++i) {
    for (const std::int32_t vertex : elements[i]) {
      if (vertex >= 0 && static_cast<std::size_t>(vertex) < vertices.size()) continue;
      throw std::out_of_range(std::string(name) + " " + std::to_string(i) + ": vertex " +
                              std::to_string(vertex) + ", but there are " +
                              std::to_string(vertices.size()));
    }
    result[i] = primitive_of(elements[i]);
  }
  return result;
}

std::vector<Primitive> all_vertices(const MovingVertices& vertices) {
  require_countable(vertices.size(), "vertices");
  std::vector<Primitive> result(vertices.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = primitive_of(static_cast<std::int32_t>(i));
  }
  return result;
}

/// Holds the groups of one tree against those of another, or against those of the same that come
/// later and against themselves.
class Search {
 public:
  /// \param all The same tree as `some` for pairs of one kind: each is then found once.
  Search(const BoxTree& some, const BoxTree& all, double separation)
      : some_(some), all_(all), within_(&some == &all), separation_(separation) {}

  /// \throws TooManyCandidates if there are more than `most`.
  [[nodiscard]] std::vector<IndexPair> run(std::uint64_t most) const {
    const std::size_t count = (some_.groups().size() + groups_of_chunk - 1) / groups_of_chunk;
    std::vector<std::vector<IndexPair>> chunks(count);
    std::atomic<std::uint64_t> found = 0;
    std::atomic<bool> all_fit = true;
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      const std::uint64_t before = found;
      if (all_fit && before <= most && collect(i, most - before, chunks[i])) {
        found += chunks[i].size();
        return;
      }
      all_fit = false;
      chunks[i] = {};
      found += count_pairs(i);
    });
    if (!all_fit || found > most) throw TooManyCandidates(found);
    return joined(chunks, found);
  }

 private:
  /// Calls use(group) with the number of each group of a chunk while it returns true.
  template <class Use>
  void for_each_group(std::size_t chunk, const Use& use) const {
    const std::size_t first = chunk * groups_of_chunk;
    const std::size_t end = std::min(first + groups_of_chunk, some_.groups().size());
    for (std::size_t i = first; i < end && use(i); ++i) continue;
  }

  /// Appends the pairs of a chunk. False if they are more than there is room for, or do not fit into
  /// memory.
  [[nodiscard]] bool collect(std::size_t chunk, std::uint64_t room,
                             std::vector<IndexPair>& pairs) const {
    const StrictFloatingPoint strict;
    try {
      for_each_group(chunk, [&](std::size_t group) {
        search(group, [&pairs](const IndexPair& pair) { pairs.push_back(pair); });
        return pairs.size() <= room;
      });
    } catch (const std::bad_alloc&) {
      return false;
    }
    return pairs.size() <= room;
  }

  [[nodiscard]] std::uint64_t count_pairs(std::size_t chunk) const {
    const StrictFloatingPoint strict;
    std::uint64_t count = 0;
    for_each_group(chunk, [&](std::size_t group) {
      search(group, [&count](const IndexPair&) { ++count; });
      return true;
    });
    return count;
  }

  /// The chunks, of so many pairs together, one after the other; they are empty afterwards.
  [[nodiscard]] static std::vector<IndexPair> joined(std::vector<std::vector<IndexPair>>& chunks,
                                                     std::uint64_t count) {
    std::vector<std::size_t> offsets(chunks.size() + 1, 0);
    for (std::size_t i = 0; i < chunks.size(); ++i) offsets[i + 1] = offsets[i] + chunks[i].size();
    std::vector<IndexPair> result;
    try {
      result.resize(offsets.back());
    } catch (const std::bad_alloc&) {
      throw TooManyCandidates(count);
    }
    tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t i) {
      std::ranges::copy(chunks[i], result.begin() + static_cast<std::ptrdiff_t>(offsets[i]));
      chunks[i] = {};
    });
    return result;
  }

  /// Calls use(pair) for each pair of a group.
  template <class Use>
  void search(std::size_t number, const Use& use) const {
    const Group& group = some_.groups()[number];
    std::array<Box, Group::capacity> boxes;
    for (std::size_t lane = 0; lane < group.size; ++lane) {
      boxes[lane] = widened(group.box(lane), separation_);
    }
    const Box around = widened(some_.nodes()[some_.leaf(number)].box, separation_);
    const std::uint32_t start = within_ ? all_.leaf(number) : 0;
    for_each_overlapping(all_, start, around, [&](const BoxTree::Node& node, const Group& others) {
      for (std::size_t lane = 0; lane < group.size; ++lane) {
        if (!boxes[lane].overlaps(node.box)) continue;
        unsigned hits = others.overlapping(boxes[lane]);
        if (&others == &group) hits &= ~0U << (lane + 1);
        for_each_hit(group, lane, others, hits, use);
      }
    });
  }

  /// Calls use(pair) for a primitive with each of the other group's that are hits.
  template <class Use>
  void for_each_hit(const Group& group, std::size_t lane, const Group& others, unsigned hits,
                    const Use& use) const {
    for (; hits != 0; hits &= hits - 1) {
      const auto hit = static_cast<std::size_t>(std::countr_zero(hits));
      if (share_vertex(group.primitives[lane], others.primitives[hit])) continue;
      const std::int32_t a = group.indices[lane], b = others.indices[hit];
      use(within_ && b < a ? IndexPair{b, a} : IndexPair{a, b});
    }
  }

  const BoxTree& some_;
  const BoxTree& all_;
  bool within_;
  double separation_;
};

/// Calls work() in an arena of so many threads, strictly: it may be in another thread.
template <class Work>
std::vector<IndexPair> with_threads(int max_threads, const Work& work) {
  // More threads than cores would not even be made.
  const int cores = tbb::info::default_concurrency();
  tbb::task_arena arena(max_threads == 0 ? cores : std::min(max_threads, cores));
  return arena.execute([&work] {
    const StrictFloatingPoint strict;
    return work();
  });
}

}  // namespace

TooManyCandidates::TooManyCandidates(std::uint64_t count)
    : std::runtime_error(std::to_string(count) + " candidates are too many for the memory"),
      count_(count) {}

std::vector<IndexPair> vertex_face_candidates(const MovingVertices& vertices,
                                              std::span<const Face> faces,
                                              const BroadPhaseOptions& options) {
  require_valid(options);
  require_finite(vertices);
  const std::vector<Primitive> corners = all_vertices(vertices);
  const std::vector<Primitive> triangles = primitives_of(vertices, faces, "face");
  return with_threads(options.max_threads, [&] {
    const BoxTree vertex_tree(vertices, corners), face_tree(vertices, triangles);
    return Search(vertex_tree, face_tree, options.min_separation).run(options.max_candidates);
  });
}

std::vector<IndexPair> edge_edge_candidates(const MovingVertices& vertices,
                                            std::span<const Edge> edges,
                                            const BroadPhaseOptions& options) {
  require_valid(options);
  require_finite(vertices);
  const std::vector<Primitive> segments = primitives_of(vertices, edges, "edge");
  return with_threads(options.max_threads, [&] {
    const BoxTree tree(vertices, segments);
    return Search(tree, tree, options.min_separation).run(options.max_candidates);
  });
}

std::vector<Edge> edges_of(std::span<const Face> faces) {
  std::vector<Edge> edges;
  edges.reserve(3 * faces.size());
  for (const Face& face : faces) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [lesser, greater] = std::minmax(face[i], face[(i + 1) % 3]);
      if (lesser != greater) edges.push_back({lesser, greater});
    }
  }
  std::ranges::sort(edges, [](const Edge& a, const Edge& b) {
    return std::tie(a[1], a[0]) < std::tie(b[1], b[0]);
  });
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

}  // namespace touchstone::fast
