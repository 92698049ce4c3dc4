#include "exact/checker/scene.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <string>
#include <tuple>

namespace touchstone::checker {
namespace {

/// Reads a line of a keyword and a number, which goes to count_items(), and as many lines: take()
/// makes an item of each.
template <class Item, class Count, class Take>
std::vector<Item> read_list(Reader& reader, std::string_view keyword, const Count& count_items,
                            const Take& take) {
  reader.begin(keyword);
  const auto count = static_cast<std::size_t>(take_count(reader));
  count_items(count);
  reader.end();
  std::vector<Item> list;
  for (std::size_t n = 0; n < count; ++n) {
    reader.begin();
    list.push_back(take());
    reader.end();
  }
  return list;
}

/// Takes a double that is not below 0.
double take_length(Reader& reader) {
  const double length = to_double(take_number(reader));
  if (length < 0.0) reject("a distance below 0");
  return length;
}

/// The next number of a list.
std::int32_t next_number(const Primitives& primitives) {
  return static_cast<std::int32_t>(primitives.size());
}

/// An edge by its vertices. Edges are numbered in the order of these.
struct Edge {
  std::int32_t larger;
  std::int32_t smaller;
  /// True for an edge of no face.
  bool is_bare;
};

/// All edges of the scene, each once, in the order of their numbers.
std::vector<Edge> find_edges(const Scene& scene) {
  std::vector<Edge> edges;
  const auto add = [&](std::int32_t a, std::int32_t b, bool is_bare) {
    edges.push_back({std::max(a, b), std::min(a, b), is_bare});
  };
  for (const auto& [a, b, c] : scene.faces) {
    add(a, b, false);
    add(b, c, false);
    add(c, a, false);
  }
  for (const auto& [a, b] : scene.edges) add(a, b, true);
  // The first of several with the same vertices is that of a face, if there is one.
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.larger, a.smaller, a.is_bare) < std::tie(b.larger, b.smaller, b.is_bare);
  });
  const auto repeated = std::unique(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return a.larger == b.larger && a.smaller == b.smaller;
  });
  edges.erase(repeated, edges.end());
  return edges;
}

}  // namespace

std::int32_t take_integer(Reader& reader, std::int32_t least, std::size_t limit) {
  const std::string_view word = reader.word();
  std::int32_t x = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), x);
  const bool is_integer = error == std::errc() && std::to_string(x) == word;
  const bool is_in_range = x >= least && x < static_cast<std::int64_t>(limit);
  if (!is_integer || !is_in_range) reject("not an integer, or out of range: " + quoted(word));
  return x;
}

std::int32_t take_count(Reader& reader) {
  return take_integer(reader, 0, std::numeric_limits<std::int32_t>::max());
}

double to_double(const mpq_class& number) {
  const bool is_in_range = abs(number) <= std::numeric_limits<double>::max();
  if (!is_in_range || number != number.get_d()) reject("a number that is not a double");
  return number.get_d();
}

Scene read_scene(Reader& reader, const Options& options, Time time) {
  std::size_t items = 0;
  const auto count_items = [&](std::size_t more) {
    items += more;
    require_at_most(options.max_items, items, "items in the lists of a scene");
  };
  Scene scene;
  scene.vertices = read_list<Motion>(reader, "vertices", count_items, [&] {
    Motion motion;
    for (double& x : motion.start) x = to_double(take_number(reader));
    motion.end = motion.start;
    if (time == Time::rest) return motion;
    for (double& x : motion.end) x = to_double(take_number(reader));
    return motion;
  });
  const std::size_t count = scene.vertices.size();
  const auto vertex = [&] { return take_integer(reader, 0, count); };
  const auto group = [&] { return take_count(reader); };
  // The numbers in braces are taken from the left to the right.
  const auto three_vertices = [&] { return Face{vertex(), vertex(), vertex()}; };
  const auto two_vertices = [&] { return Two{vertex(), vertex()}; };
  const auto two_groups = [&] { return Two{group(), group()}; };
  scene.faces = read_list<Face>(reader, "faces", count_items, three_vertices);
  scene.edges = read_list<Two>(reader, "edges", count_items, two_vertices);
  scene.points = read_list<std::int32_t>(reader, "points", count_items, vertex);
  scene.groups = read_list<std::int32_t>(reader, "groups", count_items, group);
  if (!scene.groups.empty() && scene.groups.size() != count) reject("not a group for each vertex");
  scene.apart = read_list<Two>(reader, "apart", count_items, two_groups);
  if (time == Time::rest) return scene;
  scene.radii =
      read_list<double>(reader, "radii", count_items, [&] { return take_length(reader); });
  const auto separation = [&] { return GroupSeparation{two_groups(), take_length(reader)}; };
  scene.separations = read_list<GroupSeparation>(reader, "separations", count_items, separation);
  if (reader.first_word() == "tetrahedra") {
    scene.tetrahedra = read_list<Tetrahedron>(reader, "tetrahedra", count_items, [&] {
      return Tetrahedron{vertex(), vertex(), vertex(), vertex()};
    });
  }
  if (reader.first_word() == "plane_triangles") {
    scene.plane_triangles = read_list<Face>(reader, "plane_triangles", count_items, three_vertices);
  }
  return scene;
}

Elements find_elements(const Scene& scene) {
  Elements elements;
  for (const Face& face : scene.faces) {
    elements.faces.push_back({next_number(elements.faces), face});
  }
  std::vector<bool> takes_part(scene.vertices.size());
  std::vector<bool> has_edge(scene.vertices.size());
  for (const auto& [larger, smaller, is_bare] : find_edges(scene)) {
    takes_part[static_cast<std::size_t>(larger)] = true;
    takes_part[static_cast<std::size_t>(smaller)] = true;
    // No edge goes from a vertex to itself.
    if (larger == smaller) continue;
    has_edge[static_cast<std::size_t>(larger)] = true;
    has_edge[static_cast<std::size_t>(smaller)] = true;
    const Primitive edge{next_number(elements.edges), {smaller, larger, smaller}};
    elements.edges.push_back(edge);
    if (is_bare) elements.bare_edges.push_back(edge);
  }
  for (const std::int32_t vertex : scene.points) {
    takes_part[static_cast<std::size_t>(vertex)] = true;
  }
  for (std::size_t n = 0; n < scene.vertices.size(); ++n) {
    const auto number = static_cast<std::int32_t>(n);
    const Primitive vertex{number, {number, number, number}};
    if (takes_part[n]) elements.vertices.push_back(vertex);
    if (takes_part[n] && !has_edge[n]) elements.points.push_back(vertex);
  }
  return elements;
}

std::string counted(std::size_t count, const char* one, const char* several) {
  return std::to_string(count) + ' ' + (count == 1 ? one : several);
}

std::string vertices_text(const Scene& scene, std::size_t taking_part) {
  const bool are_all = taking_part == scene.vertices.size();
  return std::to_string(taking_part) +
         (are_all ? "" : " of " + std::to_string(scene.vertices.size())) + " vertices";
}

std::string rules_text(std::vector<Two> apart, std::size_t left_out) {
  for (auto& [one, other] : apart) std::tie(one, other) = std::minmax({one, other});
  std::ranges::sort(apart);
  apart.erase(std::unique(apart.begin(), apart.end()), apart.end());
  const auto selves = static_cast<std::size_t>(
      std::ranges::count_if(apart, [](const Two& two) { return two[0] == two[1]; }));
  const std::size_t pairs = apart.size() - selves;
  std::string text;
  const auto add = [&](std::size_t count, const std::string& rule) {
    if (count > 0) text += (text.empty() ? "" : ", ") + rule;
  };
  add(pairs, counted(pairs, "pair", "pairs") + " of groups held apart");
  add(selves, counted(selves, "group held apart from itself", "groups held apart from themselves"));
  add(left_out, counted(left_out, "vertex", "vertices") + " left out");
  return text;
}

Groups::Groups(const Scene& scene) : of_vertices_(scene.groups) {
  for (const auto& [one, other] : scene.apart) {
    apart_.push_back({one, other});
    apart_.push_back({other, one});
  }
  std::ranges::sort(apart_);
}

bool Groups::meet(const Primitive& a, const Primitive& b) const {
  return std::ranges::any_of(a.vertices, [&](std::int32_t v) {
    return std::ranges::any_of(b.vertices, [&](std::int32_t w) {
      return !std::ranges::binary_search(apart_, Two{of(v), of(w)});
    });
  });
}

}  // namespace touchstone::checker
