#include "exact/checker/resting_mesh.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <tuple>

namespace touchstone::checker {
namespace {

/// The vertices of an element that another one does not have; the last is repeated. None if it has
/// all.
std::optional<Primitive> without_vertices_of(const Primitive& other, const Primitive& element) {
  std::optional<Primitive> result;
  std::size_t count = 0;
  for (const std::int32_t v : element.vertices) {
    if (std::ranges::count(other.vertices, v) > 0) continue;
    if (!result) result = Primitive{element.number, {v, v, v}};
    for (std::size_t i = count; i < 3; ++i) result->vertices[i] = v;
    ++count;
  }
  return result;
}

/// The only vertex of an element that another one has, too.
std::optional<Primitive> only_common_vertex(const Primitive& a, const Primitive& b) {
  std::optional<Primitive> result;
  for (const std::int32_t v : a.vertices) {
    if (std::ranges::count(b.vertices, v) == 0) continue;
    if (result && result->vertices[0] != v) return std::nullopt;
    result = Primitive{v, {v, v, v}};
  }
  return result;
}

/// True if the vertices of one are some of the other's, but not all: what they have in common is
/// the hull of common vertices.
bool is_one_in_other(const Primitive& a, const Primitive& b) {
  return without_vertices_of(b, a).has_value() != without_vertices_of(a, b).has_value();
}

/// True if integers of 64 bits are enough to see that the direction keeps a above b, or all that
/// they do not share above and below their only common vertex.
bool is_seen_apart(const Places& places, const Primitive& a, const Primitive& b, const Vector& d) {
  const auto is_small = [](const mpz_class& x) { return abs(x) < max_direction; };
  const auto upper = without_vertices_of(b, a), lower = without_vertices_of(a, b);
  if (!std::ranges::all_of(d, is_small) || !upper || !lower) return false;
  const Direction direction{d[0].get_si(), d[1].get_si(), d[2].get_si()};
  const auto common = only_common_vertex(a, b);
  if (common) {
    return places.is_above(*upper, *common, direction, 0) &&
           places.is_above(*common, *lower, direction, 0);
  }
  return upper->vertices == a.vertices && places.is_above(a, b, direction, 0);
}

}  // namespace

std::vector<std::int32_t> first_at_places(const std::vector<Motion>& vertices,
                                          const Groups& groups) {
  std::vector<std::int32_t> order(vertices.size()), first(vertices.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](std::int32_t v) {
    return std::tuple(vertices[static_cast<std::size_t>(v)].start, groups.of(v));
  };
  std::ranges::stable_sort(order, {}, key);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool is_first = i == 0 || key(order[i]) != key(order[i - 1]);
    const auto v = static_cast<std::size_t>(order[i]);
    first[v] = is_first ? order[i] : first[static_cast<std::size_t>(order[i - 1])];
  }
  return first;
}

RestingMesh::RestingMesh(const Scene& scene, bool is_welded)
    : vertices_(scene.vertices), groups_(scene), places_(scene.vertices, 0.0, 0) {
  std::vector<bool> is_listed(scene.vertices.size());
  for (const std::int32_t v : scene.points) is_listed[static_cast<std::size_t>(v)] = true;
  const Elements found = find_elements(scene);
  const auto add = [&](const Primitive& element) {
    elements_.push_back({static_cast<std::int32_t>(elements_.size()), element.vertices});
  };
  for (const Primitive& face : found.faces) add(face);
  for (const Primitive& edge : found.bare_edges) add(edge);
  for (const Primitive& point : found.points) {
    if (is_listed[static_cast<std::size_t>(point.number)]) add(point);
  }
  faces_ = found.faces.size();
  edges_ = found.bare_edges.size();
  std::vector<bool> takes_part(scene.vertices.size());
  for (const Primitive& element : elements_) {
    for (const std::int32_t v : element.vertices) takes_part[static_cast<std::size_t>(v)] = true;
  }
  vertices_of_elements_ = static_cast<std::size_t>(std::ranges::count(takes_part, true));
  if (is_welded) weld();
}

void RestingMesh::weld() {
  const std::vector<std::int32_t> first = first_at_places(vertices_, groups_);
  for (Primitive& element : elements_) {
    for (std::int32_t& v : element.vertices) v = first[static_cast<std::size_t>(v)];
  }
}

std::size_t RestingMesh::corners(std::int32_t number) const {
  const auto i = static_cast<std::size_t>(number);
  if (i < faces_) return 3;
  return i < faces_ + edges_ ? 2 : 1;
}

bool RestingMesh::can_meet(std::int32_t a, std::int32_t b) const {
  return groups_.meet((*this)[a], (*this)[b]);
}

RestingPair RestingMesh::pair(std::int32_t a, std::int32_t b) const {
  return {vertices_, (*this)[a], (*this)[b]};
}

bool RestingMesh::is_separated_by(std::int32_t a, std::int32_t b, const Vector& d) const {
  return is_seen_apart(places_, (*this)[a], (*this)[b], d) || pair(a, b).is_separated_by(d);
}

void RestingMesh::find_pairs(std::int64_t& comparisons_left, const TakePair& take) const {
  places_.find_near(elements_, elements_, comparisons_left,
                    [&](const Primitive& a, const Primitive& b) {
                      if (groups_.meet(a, b) && !is_one_in_other(a, b)) take(a, b);
                    });
}

}  // namespace touchstone::checker
