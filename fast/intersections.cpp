#include "touchstone/intersections.hpp"

#include <algorithm>
#include <limits>
#include <mutex>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "fast/broad_phase/body_tree.hpp"
#include "fast/broad_phase/box_tree.hpp"
#include "fast/broad_phase/float_bounds.hpp"
#include "fast/broad_phase/primitive_groups.hpp"
#include "fast/broad_phase/search.hpp"
#include "fast/candidates.hpp"
#include "fast/intersections/filter_kernel.hpp"
#include "fast/intersections/orientation.hpp"
#include "fast/intersections/pair_filter.hpp"
#include "fast/intersections/triangle_contacts.hpp"
#include "fast/platform/floating_point_state.hpp"
#include "fast/platform/threads.hpp"
#include "fast/step/codimensional.hpp"
#include "fast/step/thickness.hpp"
#include "touchstone/broad_phase.hpp"

namespace touchstone::fast {
namespace {

using meeting::Positions;

// ---- Vertices at one place ----------------------------------------------------------------------

/// The first vertex at the place of each vertex, of the same group if there are groups.
std::vector<std::int32_t> first_at_place(const Positions& at,
                                         std::span<const std::int32_t> groups) {
  std::vector<std::int32_t> order(at.size()), result(at.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](std::int32_t vertex) {
    const auto& [x, y, z, unused] = at[vertex];
    return std::tuple(x, y, z, groups.empty() ? 0 : groups[static_cast<std::size_t>(vertex)]);
  };
  std::ranges::sort(order, [&](std::int32_t a, std::int32_t b) {
    const auto key_a = key(a), key_b = key(b);
    return key_a == key_b ? a < b : key_a < key_b;
  });
  std::int32_t first = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || key(order[i]) != key(first)) first = order[i];
    result[static_cast<std::size_t>(order[i])] = first;
  }
  return result;
}

// ---- Elements -----------------------------------------------------------------------------------

/// Of edges in the order of their numbers, each once, and none from a vertex to itself.
std::vector<std::int32_t> different_edges(std::span<const Edge> edges,
                                          std::vector<std::int32_t> numbers) {
  const auto key = [&](std::int32_t number) {
    const auto [a, b] = edges[static_cast<std::size_t>(number)];
    return std::pair(std::max(a, b), std::min(a, b));
  };
  std::erase_if(numbers, [&](std::int32_t number) {
    const auto [larger, smaller] = key(number);
    return larger == smaller;
  });
  // The order of edges_of.
  if (std::ranges::adjacent_find(numbers, std::ranges::greater_equal{}, key) == numbers.end()) {
    return numbers;
  }
  std::ranges::stable_sort(numbers, {}, key);
  const auto is_equal = [&](std::int32_t a, std::int32_t b) { return key(a) == key(b); };
  numbers.erase(std::unique(numbers.begin(), numbers.end(), is_equal), numbers.end());
  std::ranges::sort(numbers);
  return numbers;
}

/// The elements of a mesh: all faces, then the edges of no face, then the points of neither.
class Elements {
 public:
  Elements(const Positions& at, const Mesh& given, const IntersectionOptions& options)
      : faces_(given.faces.size()) {
    const bool has_all_edges = options.pairs == IntersectingPairs::edges_with_faces;
    Mesh changed;
    const bool lacks_edges = given.edges.empty() && has_all_edges;
    if (lacks_edges || options.weld) {
      changed = {.edges = lacks_edges ? edges_of(given.faces) : given.edges, .faces = given.faces};
    }
    const Mesh& all = lacks_edges || options.weld ? changed : given;
    std::vector<std::int32_t> first;
    if (options.weld) {
      first = first_at_place(at, options.groups.of_vertices);
      renumber(changed.edges, first);
      renumber(changed.faces, first);
    }
    if (has_all_edges) {
      edges_.resize(all.edges.size());
      std::iota(edges_.begin(), edges_.end(), 0);
    } else {
      if (!all.edges.empty()) edges_ = edges_without_face(all);
      points_ = points_of(at.size(), given, all, first);
    }
    edges_ = different_edges(all.edges, std::move(edges_));
    require_few(faces_ + edges_.size() + points_.size());
    vertices_.reserve(faces_ + edges_.size() + points_.size());
    for (const Face& face : all.faces) add(primitive_of(face));
    for (const std::int32_t edge : edges_) {
      add(primitive_of(all.edges[static_cast<std::size_t>(edge)]));
    }
    for (const std::int32_t point : points_) {
      add(primitive_of(first.empty() ? point : first[static_cast<std::size_t>(point)]));
    }
    rows_.reserve(vertices_.size());
    for (const auto& [a, b, c] : vertices_) rows_.push_back({a, b, c, 0});
  }

  [[nodiscard]] std::size_t faces() const { return faces_; }
  /// The vertices of each element.
  [[nodiscard]] std::span<const Primitive> vertices() const { return vertices_; }
  [[nodiscard]] std::span<const ElementRow> rows() const { return rows_; }
  /// The kind of an element, and its number in the interface.
  [[nodiscard]] std::pair<PrimitiveKind, std::int32_t> reported(std::int32_t number) const {
    const auto i = static_cast<std::size_t>(number);
    if (i < faces_) return {PrimitiveKind::face, number};
    const std::size_t edge = i - faces_;
    if (edge < edges_.size()) return {PrimitiveKind::edge, edges_[edge]};
    return {PrimitiveKind::point, points_[edge - edges_.size()]};
  }

 private:
  static void require_few(std::size_t count) {
    if (count > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
      throw std::length_error("intersections: there are more than 2^31-1 elements");
    }
  }

  template <class Item>
  static void renumber(std::vector<Item>& items, std::span<const std::int32_t> numbers) {
    for (Item& item : items) {
      for (std::int32_t& vertex : item) vertex = numbers[static_cast<std::size_t>(vertex)];
    }
  }

  /// The points, and the edges of no face from a vertex to itself, whose vertex has no face and no
  /// other edge; of those that are one vertex the first. \param first Of the place of each vertex;
  /// empty: itself
  static std::vector<std::int32_t> points_of(std::size_t vertices, const Mesh& given,
                                             const Mesh& all, std::span<const std::int32_t> first) {
    std::vector<std::int32_t> points(given.points.begin(), given.points.end());
    for (std::size_t i = 0; i < all.edges.size(); ++i) {
      if (all.edges[i][0] == all.edges[i][1]) points.push_back(std::ranges::min(given.edges[i]));
    }
    if (points.empty()) return points;
    std::ranges::sort(points);
    std::vector<bool> is_taken(vertices);
    for (const Face& face : all.faces) {
      for (const std::int32_t vertex : face) is_taken[static_cast<std::size_t>(vertex)] = true;
    }
    for (const auto& [a, b] : all.edges) {
      if (a == b) continue;
      is_taken[static_cast<std::size_t>(a)] = is_taken[static_cast<std::size_t>(b)] = true;
    }
    std::erase_if(points, [&](std::int32_t point) {
      const auto vertex = static_cast<std::size_t>(point);
      const auto place = first.empty() ? vertex : static_cast<std::size_t>(first[vertex]);
      const bool was_taken = is_taken[place];
      is_taken[place] = true;
      return was_taken;
    });
    return points;
  }

  void add(const Primitive& vertices) { vertices_.push_back(meeting::in_normal_form(vertices)); }

  std::size_t faces_;
  std::vector<std::int32_t> edges_;   ///< of no face, or all
  std::vector<std::int32_t> points_;  ///< of no face and no edge
  std::vector<Primitive> vertices_;
  std::vector<ElementRow> rows_;
};

// ---- The search ---------------------------------------------------------------------------------

/// Groups per task, and pairs.
constexpr std::size_t groups_of_part = 32, found_of_task = 256;

std::uint64_t key_of(const IndexPair& pair) {
  return static_cast<std::uint64_t>(pair[0]) << 32U | static_cast<std::uint32_t>(pair[1]);
}

struct Found {
  IndexPair pair;
  meeting::Meeting meeting;

  /// In the order of pairs: the elements are numbered in the order of their kinds and numbers.
  [[nodiscard]] std::uint64_t key() const { return key_of(pair); }
};

/// The first so many of what several threads find, in twice their memory.
class FirstFound {
 public:
  explicit FirstFound(std::size_t most) : most_(most) {}

  /// True if so many are known to come before it.
  [[nodiscard]] bool is_beyond(const IndexPair& pair) const { return key_of(pair) >= end_; }
  /// Takes all out of the list.
  void take(std::vector<Found>& some) {
    const std::scoped_lock lock(mutex_);
    found_.insert(found_.end(), some.begin(), some.end());
    some.clear();
    if (found_.size() / 2 > most_) leave_out_rest();
  }
  [[nodiscard]] std::vector<Found> in_order() && {
    leave_out_rest();
    std::ranges::sort(found_, {}, &Found::key);
    return std::move(found_);
  }

 private:
  void leave_out_rest() {
    if (found_.size() <= most_) return;
    const auto rest = found_.begin() + static_cast<std::ptrdiff_t>(most_);
    std::ranges::nth_element(found_, rest, {}, &Found::key);
    end_ = rest->key();
    found_.erase(rest, found_.end());
  }

  std::size_t most_;
  std::mutex mutex_;
  std::vector<Found> found_;
  /// Of the first one that is left out.
  std::atomic<std::uint64_t> end_ = std::numeric_limits<std::uint64_t>::max();
};

class Search final : private PairQuestions {
 public:
  /// Uses the threads of the caller's task arena. \pre the vertices are finite and at rest, indices
  /// in range; strict floating point
  Search(Motion vertices, const Mesh& mesh, const IntersectionOptions& options)
      : bodies_(vertices.size(), options.groups, options.can_collide),
        bounds_(vertices),
        // The vertices take more memory than their places, and are not needed from here on.
        at_(Motion(std::move(vertices))),
        elements_(at_, mesh, options),
        groups_of_boxes_(bounds_, elements_.vertices()),
        tree_(groups_of_boxes_),
        options_(options) {
    tree_.fit(bounds_);
    if (!bodies_.all_meet()) {
      tree_of_bodies_.emplace(groups_of_boxes_, bodies_.of_vertices(),
                              bodies_.has_rule_for_vertices());
    }
  }

  [[nodiscard]] std::vector<Intersection> all() {
    FirstFound first(options_.most);
    for_each_part([&](std::size_t part) {
      std::vector<Found> some;
      find(part, options_.places, first, [&](const Found& found) {
        some.push_back(found);
        if (some.size() == found_of_task) first.take(some);
      });
      first.take(some);
    });
    const std::vector<Found> found = std::move(first).in_order();
    std::vector<Intersection> result(found.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, found.size(), found_of_task),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        const StrictFloatingPoint strict;
                        for (std::size_t i = range.begin(); i < range.end(); ++i) {
                          result[i] = intersection_of(found[i]);
                        }
                      });
    return result;
  }

  [[nodiscard]] bool is_any() {
    std::atomic<bool> is_found = false;
    for_each_part([&](std::size_t part) {
      if (is_found) return;
      find(part, false, FirstFound(1), [&](const Found& /*found*/) { is_found = true; });
    });
    return is_found;
  }

 private:
  [[nodiscard]] std::size_t parts() const {
    return (tree_.members().size() + groups_of_part - 1) / groups_of_part;
  }

  template <class Work>
  void for_each_part(const Work& work) const {
    tbb::parallel_for(std::size_t{0}, parts(), work);
  }

  /// Calls take(found) for the pairs of a part that intersect, if they are not beyond the first.
  /// \param with_contacts False if the contacts need not be known.
  template <class Take>
  void find(std::size_t part, bool with_contacts, const FirstFound& first_found,
            const Take& take) const {
    const StrictFloatingPoint strict;
    meeting::PairFilter& filter = filters_.local();
    const TriangleKernel& kernel = *triangle_kernels().back();
    const auto examine = [&](const IndexPair& pair) {
      if (first_found.is_beyond(pair)) return;
      const auto meeting = meeting::meeting_of(at_, element(pair[0]), element(pair[1]));
      if (meeting) take({pair, *meeting});
    };
    PairSink buffer(
        [&](std::span<const IndexPair> pairs) {
          const FilteredPairs& filtered =
              options_.pairs == IntersectingPairs::edges_with_faces
                  ? filter.filtered_edges_with_faces(at_, elements_.rows(), elements_.faces(),
                                                     pairs, kernel)
                  : filter.filtered(at_, elements_.rows(), pairs, kernel);
          for (const IndexPair& pair : std::span(filtered.open).first(filtered.open_count)) {
            examine(pair);
          }
          for (const IndexPair& pair :
               std::span(filtered.crossing).first(filtered.crossing_count)) {
            if (with_contacts) {
              examine(pair);
            } else {
              take({pair, {IntersectionKind::edge_through_face, {}}});
            }
          }
        },
        options_.stop);
    const PairRules rules{.keeps_neighbours = true,
                          .questions = this,
                          .some_bodies = tree_of_bodies_ ? &*tree_of_bodies_ : nullptr,
                          .all_bodies = tree_of_bodies_ ? &*tree_of_bodies_ : nullptr};
    const std::size_t first = part * groups_of_part;
    search_kernels().back()->find(SearchInput<1>{&tree_, &tree_, rules}, first,
                                  std::min(first + groups_of_part, tree_.members().size()), buffer);
    buffer.flush();
  }

  [[nodiscard]] meeting::Element element(std::int32_t number) const {
    return meeting::element_of(at_, elements_.vertices()[static_cast<std::size_t>(number)]);
  }

  [[nodiscard]] Intersection intersection_of(const Found& found) const {
    const auto& [pair, meeting] = found;
    const auto [kind_a, a] = elements_.reported(pair[0]);
    const auto [kind_b, b] = elements_.reported(pair[1]);
    Intersection result{
        .elements = {kind_a, kind_b}, .numbers = {a, b}, .kind = meeting.kind, .place = {}};
    if (options_.places) {
      result.place = meeting::place_of(at_, element(pair[0]), element(pair[1]), meeting.contacts);
    }
    return result;
  }

  [[nodiscard]] bool confirms(const Primitive& /*a*/, const Primitive& /*b*/) const override {
    return true;
  }
  [[nodiscard]] bool bodies_meet(std::int32_t a, std::int32_t b) const override {
    return bodies_.meet(a, b);
  }
  [[nodiscard]] bool primitives_meet(const Primitive& a, const Primitive& b) const override {
    return bodies_.meet(a, b);
  }

  Bodies bodies_;
  FloatBounds bounds_;
  Positions at_;
  Elements elements_;
  PrimitiveGroups groups_of_boxes_;
  BoxTree<1> tree_;
  std::optional<BodyTree> tree_of_bodies_;
  mutable tbb::enumerable_thread_specific<meeting::PairFilter> filters_;
  const IntersectionOptions& options_;
};

void require_valid(const Motion& vertices, const Mesh& mesh) {
  require_straight(vertices, "intersections");
  require_finite(vertices);
  require_in_range(vertices, mesh.faces);
  require_in_range(vertices, mesh.edges);
  require_in_range(vertices, mesh.points);
}

/// Calls answer(search) in the threads that the options allow.
template <class Answer>
auto searched(Motion vertices, const Mesh& mesh, const IntersectionOptions& options,
              const Answer& answer) {
  if (options.max_threads < 0) {
    throw std::invalid_argument("intersections: max_threads must not be negative");
  }
  require_valid(vertices, mesh);
  return with_threads(options.max_threads, [&] {
    const StrictFloatingPoint strict;
    Search search(std::move(vertices), mesh, options);
    return answer(search);
  });
}

template <class Item, std::size_t count>
std::string_view name_in(const std::array<std::string_view, count>& names, Item item) {
  return names.at(static_cast<std::size_t>(item));
}

}  // namespace

// ---- Interface ----------------------------------------------------------------------------------

std::string_view to_string(PrimitiveKind kind) {
  return name_in(std::array<std::string_view, 3>{"face", "edge", "point"}, kind);
}

std::string_view to_string(IntersectionKind kind) {
  static constexpr std::array<std::string_view, intersection_kinds> names{
      "duplicates",    "folded faces", "coplanar overlap", "edge through face", "vertex in face",
      "edges overlap", "edges cross",  "vertex on edge",   "vertices coincide"};
  return name_in(names, kind);
}

std::vector<Intersection> intersections(Motion vertices, const Mesh& mesh,
                                        const IntersectionOptions& options) {
  return searched(std::move(vertices), mesh, options, [](Search& search) { return search.all(); });
}

bool has_intersections(Motion vertices, const Mesh& mesh, const IntersectionOptions& options) {
  return searched(std::move(vertices), mesh, options,
                  [](Search& search) { return search.is_any(); });
}

MeshDefects mesh_defects(const Motion& vertices, const Mesh& mesh) {
  require_valid(vertices, mesh);
  const StrictFloatingPoint strict;
  MeshDefects result;
  const Positions at(vertices);
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const Primitive face = meeting::in_normal_form(mesh.faces[i]);
    if (meeting::dimension(meeting::element_of(at, face).simplex) != 2) {
      result.degenerate_faces.push_back(static_cast<std::int32_t>(i));
    }
  }
  const std::vector<std::int32_t> first = first_at_place(at, {});
  for (std::int32_t i = 0; std::cmp_less(i, first.size()); ++i) {
    const std::int32_t other = first[static_cast<std::size_t>(i)];
    if (other != i) result.duplicated_vertices.push_back({i, other});
  }
  const std::vector<Edge> of_faces =
      mesh.edges.empty() ? edges_of(mesh.faces) : std::vector<Edge>();
  const std::vector<Edge>& edges = mesh.edges.empty() ? of_faces : mesh.edges;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto [a, b] = edges[i];
    if (first[static_cast<std::size_t>(a)] == first[static_cast<std::size_t>(b)]) {
      result.degenerate_edges.push_back(static_cast<std::int32_t>(i));
    }
  }
  std::vector<std::int32_t> named = vertices_of(vertices.size(), mesh);
  const auto add = [&named](const auto& element) {
    named.insert(named.end(), element.begin(), element.end());
  };
  for (const CellKind kind : cell_kinds) add(mesh.corners_of(kind));
  std::ranges::sort(named);
  named.erase(std::unique(named.begin(), named.end()), named.end());
  for (std::int32_t i = 0, next = 0; std::cmp_less(i, vertices.size()); ++i) {
    if (std::cmp_less(next, named.size()) && named[static_cast<std::size_t>(next)] == i) {
      ++next;
    } else {
      result.unreferenced_vertices.push_back(i);
    }
  }
  return result;
}

}  // namespace touchstone::fast
