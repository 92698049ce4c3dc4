#include "touchstone/broad_phase.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <new>
#include <numeric>
#include <string>
#include <utility>

#include "fast/broad_phase/box_tree.hpp"
#include "fast/broad_phase/float_bounds.hpp"
#include "fast/broad_phase/primitive_groups.hpp"
#include "fast/broad_phase/search.hpp"
#include "fast/broad_phase/swept_box.hpp"
#include "fast/candidates.hpp"
#include "fast/platform/floating_point_state.hpp"
#include "fast/platform/threads.hpp"

namespace touchstone::fast {
namespace {

/// Groups per task.
constexpr std::size_t groups_of_chunk = 16;

void require_valid(const BroadPhaseOptions& options) {
  if (!is_valid(options.separation)) {
    throw std::invalid_argument("the separation must be finite and not negative");
  }
  if (options.max_threads < 0) throw std::invalid_argument("max_threads must not be negative");
}

/// Decision in double whether swept boxes are within a distance.
class ExactTest final : public PairQuestions {
 public:
  ExactTest(const Motion& vertices, double distance) : vertices_(vertices), distance_(distance) {}

  [[nodiscard]] bool confirms(const Primitive& a, const Primitive& b) const override {
    return are_within_distance(vertices_, a, b, distance_);
  }

 private:
  const Motion& vertices_;
  double distance_;
};

/// Search for the pairs between two trees, or within one.
class Search {
 public:
  /// \param stop As in the options.
  Search(const SearchInput<1>& input, const std::atomic<bool>* stop) : input_(input), stop_(stop) {}

  /// Counts the pairs first, then writes them to their final places.
  /// \throws TooManyCandidates if there are more than `most`.
  [[nodiscard]] std::vector<IndexPair> run(std::uint64_t most) const {
    const std::size_t groups = input_.some->members().size();
    const std::size_t chunks = (groups + groups_of_chunk - 1) / groups_of_chunk;
    std::vector<std::uint64_t> begins(chunks + 1, 0);
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t i) {
      for_each_part(i, [&](std::span<const IndexPair> part) { begins[i + 1] += part.size(); });
    });
    std::partial_sum(begins.begin(), begins.end(), begins.begin());
    std::vector<IndexPair> pairs = room_for(begins.back(), most);
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t i) {
      auto to = pairs.begin() + static_cast<std::ptrdiff_t>(begins[i]);
      for_each_part(i, [&](std::span<const IndexPair> part) {
        to = std::copy(part.begin(), part.end(), to);
      });
    });
    return pairs;
  }

 private:
  /// Calls take(pairs) for the pairs of a chunk, some at a time.
  template <class Take>
  void for_each_part(std::size_t chunk, Take take) const {
    const StrictFloatingPoint strict;
    PairSink buffer(std::move(take), stop_);
    const std::size_t first = chunk * groups_of_chunk;
    const std::size_t end = std::min(first + groups_of_chunk, input_.some->members().size());
    search_kernels().back()->find(input_, first, end, buffer);
    buffer.flush();
  }

  static std::vector<IndexPair> room_for(std::uint64_t count, std::uint64_t most) {
    if (count > std::min<std::uint64_t>(most, std::numeric_limits<std::size_t>::max())) {
      throw TooManyCandidates(count);
    }
    try {
      return std::vector<IndexPair>(static_cast<std::size_t>(count));
    } catch (const std::bad_alloc&) {
      throw TooManyCandidates(count);
    } catch (const std::length_error&) {
      throw TooManyCandidates(count);
    }
  }

  const SearchInput<1>& input_;
  const std::atomic<bool>* stop_;
};

/// The rules for all pairs of a kind within a distance, with a reference to `test`.
PairRules rules_of(const FloatBounds& bounds, const ExactTest& test, bool are_edges) {
  return {.of_edges = are_edges,
          .certainty = bounds.are_exact() ? Certainty::all : Certainty::unless_close,
          .questions = &test};
}

// ---- Edges of faces -----------------------------------------------------------------------------

/// Sorts numbers by their digits, the lowest first. Takes time proportional to their count, and
/// nothing for a digit that all have.
void sort_by_digits(std::vector<std::uint64_t>& numbers) {
  static constexpr unsigned bits_of_digit = 11;
  static constexpr std::size_t digits = std::size_t{1} << bits_of_digit;
  std::vector<std::uint64_t> sorted(numbers.size());
  for (unsigned shift = 0; shift < 64; shift += bits_of_digit) {
    const auto digit_of = [shift](std::uint64_t number) {
      return static_cast<std::size_t>((number >> shift) % digits);
    };
    // The place of the next number with a digit.
    std::array<std::size_t, digits + 1> places{};
    for (const std::uint64_t number : numbers) ++places[digit_of(number) + 1];
    if (std::ranges::find(places, numbers.size()) != places.end()) continue;
    std::partial_sum(places.begin(), places.end(), places.begin());
    for (const std::uint64_t number : numbers) sorted[places[digit_of(number)]++] = number;
    numbers.swap(sorted);
  }
}

}  // namespace

TooManyCandidates::TooManyCandidates(std::uint64_t count)
    : std::runtime_error(std::to_string(count) + " candidates are too many for the memory"),
      count_(count) {}

std::vector<IndexPair> vertex_face_candidates(const Motion& vertices, std::span<const Face> faces,
                                              const BroadPhaseOptions& options) {
  require_valid(options);
  require_finite(vertices);
  require_in_range(vertices, faces);
  return with_threads(options.max_threads, [&] {
    std::vector<std::int32_t> points(vertices.size());
    std::iota(points.begin(), points.end(), 0);
    const FloatBounds bounds(vertices, 1.0, options.separation.distance);
    const PrimitiveGroups point_groups(bounds, std::span<const std::int32_t>(points));
    const PrimitiveGroups face_groups(bounds, faces);
    BoxTree<1> point_tree(point_groups), face_tree(face_groups);
    point_tree.fit(bounds);
    face_tree.fit(bounds);
    const ExactTest test(vertices, options.separation.distance);
    const SearchInput<1> input{&point_tree, &face_tree, rules_of(bounds, test, false)};
    return Search(input, options.stop).run(options.max_candidates);
  });
}

std::vector<IndexPair> edge_edge_candidates(const Motion& vertices, std::span<const Edge> edges,
                                            const BroadPhaseOptions& options) {
  require_valid(options);
  require_finite(vertices);
  require_in_range(vertices, edges);
  return with_threads(options.max_threads, [&] {
    const FloatBounds bounds(vertices, 1.0, options.separation.distance);
    const PrimitiveGroups groups(bounds, edges);
    BoxTree<1> tree(groups);
    tree.fit(bounds);
    const ExactTest test(vertices, options.separation.distance);
    const SearchInput<1> input{&tree, &tree, rules_of(bounds, test, true)};
    return Search(input, options.stop).run(options.max_candidates);
  });
}

std::vector<Edge> edges_of(std::span<const Face> faces) {
  // The larger vertex in the upper half, the smaller one in the lower.
  std::vector<std::uint64_t> sides;
  sides.reserve(3 * faces.size());
  for (const Face& face : faces) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [smaller, larger] = std::minmax(face[i], face[(i + 1) % 3]);
      if (smaller == larger) continue;
      sides.push_back(std::uint64_t{static_cast<std::uint32_t>(larger)} << 32U |
                      static_cast<std::uint32_t>(smaller));
    }
  }
  sort_by_digits(sides);
  sides.erase(std::unique(sides.begin(), sides.end()), sides.end());
  std::vector<Edge> edges;
  edges.reserve(sides.size());
  for (const std::uint64_t side : sides) {
    edges.push_back({static_cast<std::int32_t>(side), static_cast<std::int32_t>(side >> 32U)});
  }
  return edges;
}

}  // namespace touchstone::fast
