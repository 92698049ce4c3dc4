#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "exact/checker/checker.hpp"
#include "exact/checker/resting_mesh.hpp"
#include "exact/contact/triangle_intersection.hpp"
#include "exact/scene/directions.hpp"
#include "exact/scene/scene_text.hpp"
#include "touchstone/broad_phase.hpp"
#include "touchstone/certificate_text.hpp"
#include "touchstone/number.hpp"
#include "touchstone/scene_certificate.hpp"

namespace touchstone::exact {
namespace {

// ---- Vectors ------------------------------------------------------------------------------------

/// x y z.
template <class Number>
using Triple = std::array<Number, 3>;

template <class Number>
Triple<Number> difference(const Triple<Number>& a, const Triple<Number>& b) {
  return {Number(a[0] - b[0]), Number(a[1] - b[1]), Number(a[2] - b[2])};
}

template <class Number>
Number dot(const Triple<Number>& a, const Triple<Number>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class Number>
Triple<Number> cross(const Triple<Number>& a, const Triple<Number>& b) {
  return {Number(a[1] * b[2] - a[2] * b[1]), Number(a[2] * b[0] - a[0] * b[2]),
          Number(a[0] * b[1] - a[1] * b[0])};
}

template <class Number>
Triple<Number> negated(const Triple<Number>& a) {
  return difference({}, a);
}

template <class Number>
bool is_zero(const Triple<Number>& a) {
  return a[0] == 0 && a[1] == 0 && a[2] == 0;
}

/// A vector of about the same length as any other, in the same direction.
Triple<double> normalized(const Triple<double>& a) {
  const double length = std::hypot(a[0], a[1], a[2]);
  return {a[0] / length, a[1] / length, a[2] / length};
}

const Triple<Rational>& normalized(const Triple<Rational>& a) { return a; }

/// The integers without a common factor in the direction of a vector.
Triple<Integer> primitive_integers(const Triple<Rational>& a) {
  Integer denominator = 1, divisor = 0;
  for (const Rational& x : a) denominator = lcm(denominator, x.get_den());
  Triple<Integer> result;
  for (std::size_t k = 0; k < 3; ++k) {
    result[k] = denominator / a[k].get_den() * a[k].get_num();
    divisor = gcd(divisor, result[k]);
  }
  if (divisor != 0) {
    for (Integer& x : result) x /= divisor;
  }
  return result;
}

/// A direction d with d·g > 0 for all of these vectors, if there is one: the sum of the extreme
/// rays of all d with d·g ≥ 0, which are products of two of them or, if all are in a plane, are in
/// it.
/// \param tolerance of zero, relative to the lengths
template <class Number>
Triple<Number> central_direction(const std::vector<Triple<Number>>& all, const Number& tolerance) {
  Triple<Number> sum = all.empty() ? Triple<Number>{} : normalized(all.front());
  if (all.size() < 2) return sum;
  const auto is_feasible = [&](const Triple<Number>& d) {
    return std::ranges::all_of(all, [&](const auto& g) { return dot(d, g) >= -tolerance; });
  };
  if (!is_feasible(sum)) sum = {};
  const auto add = [&](const Triple<Number>& ray) {
    if (is_zero(ray)) return;
    for (const Triple<Number>& d : {normalized(ray), normalized(negated(ray))}) {
      if (!is_feasible(d)) continue;
      for (std::size_t k = 0; k < 3; ++k) sum[k] += d[k];
    }
  };
  bool is_flat = false;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < i && !is_flat; ++j) {
      const Triple<Number> product = cross(all[i], all[j]);
      if (dot(product, product) <= tolerance) continue;
      const Triple<Number> normal = normalized(product);
      is_flat = is_feasible(normal) && is_feasible(negated(normal));
      if (!is_flat) {
        add(normal);
        continue;
      }
      for (const Triple<Number>& g : all) add(cross(normal, g));
    }
  }
  return sum;
}

// ---- A pair -------------------------------------------------------------------------------------

/// The places of two elements, and of what they share.
struct PairPlaces {
  PairPlaces(const checker::Scene& scene, const checker::Primitive& a,
             const checker::Primitive& b) {
    const auto has = [](const checker::Primitive& element, std::int32_t v) {
      return std::ranges::find(element.vertices, v) != element.vertices.end();
    };
    const auto place = [&](std::int32_t v) {
      return scene.vertices[static_cast<std::size_t>(v)].start;
    };
    for (const std::int32_t v : a.vertices) (has(b, v) ? common : first).push_back(place(v));
    for (const std::int32_t v : b.vertices) {
      if (!has(a, v)) second.push_back(place(v));
    }
  }

  using Places = std::vector<Triple<double>>;

  Places first;   ///< of the first alone
  Places second;  ///< of the second alone
  Places common;
};

/// What a normal must have on one side: the differences that are not 0 of what the elements do not
/// share, or of each of it and what they share.
template <class Number>
std::vector<Triple<Number>> differences(const PairPlaces& places) {
  const auto exactly = [](const Triple<double>& x) {
    return Triple<Number>{Number(x[0]), Number(x[1]), Number(x[2])};
  };
  std::vector<Triple<Number>> result;
  const auto add = [&](const Triple<double>& upper, const Triple<double>& lower) {
    if (upper != lower) result.push_back(difference(exactly(upper), exactly(lower)));
  };
  for (const auto& a : places.first) {
    if (!places.common.empty()) add(a, places.common.front());
  }
  for (const auto& b : places.second) {
    if (!places.common.empty()) add(places.common.front(), b);
    if (!places.common.empty()) continue;
    for (const auto& a : places.first) add(a, b);
  }
  return result;
}

/// A direction of a line in the plane that is sought: through what the elements share, or along one
/// whose vertices are on a line. 0 if there is none.
Triple<Rational> line_in_plane(const PairPlaces& places) {
  const auto exactly = [](const Triple<double>& x) {
    return Triple<Rational>{Rational(x[0]), Rational(x[1]), Rational(x[2])};
  };
  if (places.common.empty()) return {};
  const Triple<Rational> c = exactly(places.common.front());
  for (const auto& other : places.common) {
    if (other != places.common.front()) return difference(exactly(other), c);
  }
  for (const auto* own : {&places.first, &places.second}) {
    for (const auto& x : *own) {
      for (const auto& y : *own) {
        Triple<Rational> to_x = difference(exactly(x), c);
        const Triple<Rational> to_y = difference(exactly(y), c);
        if (is_zero(cross(to_x, to_y)) && dot(to_x, to_y) < 0) return to_x;
      }
    }
  }
  return {};
}

/// Normals of a plane between two elements, one of which is accepted if there is one plane.
std::vector<Triple<Rational>> exact_normals(const PairPlaces& places) {
  const auto all = differences<Rational>(places);
  const Triple<Rational> line = line_in_plane(places);
  if (is_zero(line)) return {central_direction<Rational>(all, 0)};
  std::vector<Triple<Rational>> across, result;
  for (const Triple<Rational>& g : all) {
    if (const auto h = cross(g, line); !is_zero(h)) across.push_back(h);
  }
  for (const Triple<Rational>& h : across) result.push_back(cross(line, h));
  result.push_back(cross(line, central_direction<Rational>(across, 0)));
  return result;
}

/// The weights of the corners with which a point of their hull is their mean, as integers.
std::vector<Integer> weights_of(const RationalPoint& x, const RationalTriangle& corners) {
  std::array<Rational, 3> weights;
  const auto& [p, q, r] = corners;
  const RationalPoint normal = cross(difference(q, p), difference(r, p));
  if (!is_zero(normal)) {
    for (std::size_t i = 0; i < 3; ++i) {
      weights[i] = dot(
          normal, cross(difference(corners[(i + 1) % 3], x), difference(corners[(i + 2) % 3], x)));
    }
  } else {
    // Of corners at one place the first, because an edge repeats one and a point is repeated twice.
    const auto at = [&](auto corner) { return static_cast<std::size_t>(corner - corners.begin()); };
    const std::size_t least = at(std::ranges::min_element(corners)),
                      greatest = at(std::ranges::max_element(corners));
    const RationalPoint along = difference(corners[greatest], corners[least]);
    weights[greatest] = dot(along, difference(x, corners[least]));
    weights[least] = is_zero(along) ? Rational(1) : dot(along, difference(corners[greatest], x));
  }
  const Triple<Integer> integers = primitive_integers(weights);
  return {integers.begin(), integers.end()};
}

RationalTriangle triangle_of(const checker::Scene& scene, const checker::Primitive& element) {
  RationalTriangle result;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& start = scene.vertices[static_cast<std::size_t>(element.vertices[i])].start;
    for (std::size_t k = 0; k < 3; ++k) result[i][k] = start[k];
  }
  return result;
}

// ---- The certificate ----------------------------------------------------------------------------

/// The order of edges: by their larger vertex, then by the smaller.
bool is_before(const fast::Edge& a, const fast::Edge& b) {
  return std::tie(a[1], a[0]) < std::tie(b[1], b[0]);
}

checker::Scene scene_of(const fast::Motion& vertices, const ListedScene& listed) {
  checker::Scene scene;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const auto& [x, y, z, zero] = vertices[i].start;
    scene.vertices.push_back({{x, y, z}, {x, y, z}});
  }
  scene.faces = listed.mesh.faces;
  scene.edges = listed.bare_edges;
  scene.points = listed.mesh.points;
  scene.groups = listed.rules.of_vertices;
  scene.apart = listed.rules.apart;
  return scene;
}

/// Lists just the edges and points that are elements (touchstone/intersections.hpp).
void list_elements(const fast::Motion& vertices, bool is_welded, ListedScene& listed) {
  std::vector<std::int32_t> first(vertices.size());
  std::iota(first.begin(), first.end(), 0);
  if (is_welded) {
    const checker::Scene scene = scene_of(vertices, listed);
    first = checker::first_at_places(scene.vertices, checker::Groups(scene));
  }
  const auto place = [&](std::int32_t v) { return first[static_cast<std::size_t>(v)]; };
  std::vector<bool> is_taken(vertices.size());
  std::vector<fast::Face> faces = listed.mesh.faces;
  for (fast::Face& face : faces) {
    for (std::int32_t& v : face) is_taken[static_cast<std::size_t>(v = place(v))] = true;
  }
  const std::vector<fast::Edge> sides = fast::edges_of(faces);
  std::set<fast::Edge> known;
  std::vector<std::int32_t>& points = listed.mesh.points;
  listed.bare_edges.clear();
  for (const auto& [a, b] : listed.mesh.edges) {
    const fast::Edge edge{std::min(place(a), place(b)), std::max(place(a), place(b))};
    if (edge[0] == edge[1]) {
      points.push_back(std::min(a, b));
    } else if (!std::ranges::binary_search(sides, edge, is_before) && known.insert(edge).second) {
      listed.bare_edges.push_back({a, b});
      for (const std::int32_t v : edge) is_taken[static_cast<std::size_t>(v)] = true;
    }
  }
  std::ranges::sort(points);
  std::erase_if(points, [&](std::int32_t v) {
    const auto vertex = static_cast<std::size_t>(place(v));
    const bool was_taken = is_taken[vertex];
    is_taken[vertex] = true;
    return was_taken;
  });
}

class MeshProver : private ProofWriter {
 public:
  MeshProver(const fast::Motion& vertices, const ListedScene& listed, bool is_welded,
             const SceneProofOptions& options)
      : ProofWriter(options),
        listed_(listed),
        is_welded_(is_welded),
        scene_(scene_of(vertices, listed)),
        elements_(scene_, is_welded) {}

  SceneProof run(std::span<const fast::Intersection> found) {
    try {
      for (const fast::Intersection& one : found) intersecting_.push_back(pair_of(one));
      std::ranges::sort(intersecting_);
      proof().claim = words(is_welded_ ? "welded_intersections" : "intersections", found.size());
      proof().rules = checker::rules_text(
          scene_.apart, scene_.vertices.size() - elements_.vertices_of_elements());
      proof().contact = "intersect";
      const std::vector<fast::IndexPair> apart = pairs_to_argue();
      expect_arguments(intersecting_.size() + apart.size(), 0);
      write_scene();
      write_arguments(intersecting_.size(), [&](std::size_t i, Arguments& arguments) {
        add(intersecting_[i], common_point(intersecting_[i]), arguments);
      });
      put("separations\n");
      write_arguments(apart.size(), [&](std::size_t i, Arguments& arguments) {
        add(apart[i], argument(apart[i]), arguments);
        ++arguments.directions;
      });
      require_few_comparisons();
    } catch (const CertificateLimitError& error) {
      proof().failure = error.what();
    }
    return finish(mesh_certificates_header(), mesh_certificates_closing_line(1));
  }

 private:
  void write_scene() {
    std::string text;
    write_line(text, "mesh", label_text(options().label));
    write_line(text, "vertices", scene_.vertices.size());
    for (const checker::Motion& vertex : scene_.vertices) write_doubles(text, vertex.start);
    listed_.write(text);
    write_line(text, "claim", proof().claim);
    put(text);
  }

  /// The numbers of the elements in the certificate, the smaller one first.
  [[nodiscard]] fast::IndexPair pair_of(const fast::Intersection& found) const {
    fast::IndexPair result{};
    for (std::size_t i = 0; i < 2; ++i) result[i] = number_of(found.elements[i], found.numbers[i]);
    return {std::min(result[0], result[1]), std::max(result[0], result[1])};
  }

  [[nodiscard]] std::int32_t number_of(fast::PrimitiveKind kind, std::int32_t number) const {
    if (kind == fast::PrimitiveKind::face) return number;
    std::size_t place = elements_.faces();
    const auto place_in = [](const auto& list, auto found) {
      return static_cast<std::size_t>(found - list.begin());
    };
    if (kind == fast::PrimitiveKind::edge) {
      const fast::Edge& edge = listed_.mesh.edges[static_cast<std::size_t>(number)];
      place += place_in(scene_.edges, std::ranges::lower_bound(scene_.edges, edge, is_before));
    } else {
      place += elements_.edges() +
               place_in(scene_.points, std::ranges::lower_bound(scene_.points, number));
    }
    return static_cast<std::int32_t>(place);
  }

  /// Those that the checker asks for; more than the limit if there are more.
  [[nodiscard]] std::vector<fast::IndexPair> pairs_to_argue() {
    std::vector<fast::IndexPair> pairs;
    static constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
    std::int64_t comparisons_left = most;
    const auto take = [&](const checker::Primitive& a, const checker::Primitive& b) {
      const fast::IndexPair pair{a.number, b.number};
      if (pairs.size() > scene_argument_limit) return;
      if (!std::ranges::binary_search(intersecting_, pair)) pairs.push_back(pair);
    };
    elements_.find_pairs(comparisons_left, take);
    comparisons_ = most - comparisons_left;
    std::ranges::sort(pairs);
    return pairs;
  }

  /// Adds the line of a pair; an empty one is a failure.
  static void add(const fast::IndexPair& pair, const std::string& line, Arguments& arguments) {
    arguments.text += line;
    if (!line.empty()) return;
    arguments.failure = "no argument for the elements " + words(pair[0], "and", pair[1]);
  }

  /// \throws CertificateLimitError if the checker would compare too many boxes for this text.
  void require_few_comparisons() const {
    const auto most = checker::Options{}.max_comparisons_per_byte;
    if (comparisons_ / most <= static_cast<std::int64_t>(proof().bytes)) return;
    throw CertificateLimitError("the checker compares at most " + words(most, "boxes") +
                                " for each byte, and would compare " + words(comparisons_));
  }

  /// The weights of a point that both have beyond what they share.
  [[nodiscard]] std::string common_point(const fast::IndexPair& numbers) const {
    const auto& [a, b] = numbers;
    const checker::RestingPair pair = elements_.pair(a, b);
    if (pair.are_duplicates()) return words(a, b) + '\n';
    const RationalTriangle first = triangle_of(scene_, elements_[a]);
    const RationalTriangle second = triangle_of(scene_, elements_[b]);
    for (const RationalPoint& x : intersection_of(first, second)) {
      std::vector<Integer> of_a = weights_of(x, first), of_b = weights_of(x, second);
      of_a.resize(elements_.corners(a));
      of_b.resize(elements_.corners(b));
      if (!pair.is_common_point(of_a, of_b)) continue;
      std::string text = words(a, b);
      for (const auto* weights : {&of_a, &of_b}) {
        for (const Integer& weight : *weights) text += ' ' + weight.get_str();
      }
      return text + '\n';
    }
    return "";
  }

  /// The line of an argument.
  [[nodiscard]] std::string argument(const fast::IndexPair& numbers) const {
    const auto& [a, b] = numbers;
    const PairPlaces places(scene_, elements_[a], elements_[b]);
    const bool is_edge_shared = places.common.size() > 1;
    if (!is_edge_shared) {
      if (const auto d = small_normal(numbers, places)) {
        return words(a, b, (*d)[0], (*d)[1], (*d)[2]) + '\n';
      }
    }
    const checker::RestingPair pair = elements_.pair(a, b);
    if (pair.is_separated_by_first_plane()) return words(a, b, "plane\n");
    if (elements_.pair(b, a).is_separated_by_first_plane()) {
      return words(b, a, "plane\n");
    }
    for (const Triple<Rational>& normal : exact_normals(places)) {
      const Triple<Integer> d = primitive_integers(normal);
      if (!pair.is_separated_by(d)) continue;
      return words(a, b, d[0].get_str(), d[1].get_str(), d[2].get_str()) + '\n';
    }
    return pair.are_separated_on_lines() ? words(a, b, "line\n") : "";
  }

  /// A normal of small integers.
  [[nodiscard]] std::optional<checker::Direction> small_normal(const fast::IndexPair& numbers,
                                                               const PairPlaces& places) const {
    static constexpr double tolerance = 1e-12;
    std::vector<Triple<double>> all = differences<double>(places);
    for (Triple<double>& g : all) g = normalized(g);
    const Triple<double> d = central_direction(all, tolerance);
    return rounded_direction(d, [&](const checker::Direction& rounded) {
      checker::Vector normal;
      for (std::size_t k = 0; k < 3; ++k) normal[k] = static_cast<long>(rounded[k]);
      return elements_.is_separated_by(numbers[0], numbers[1], normal);
    });
  }

  const ListedScene& listed_;
  bool is_welded_;
  checker::Scene scene_;
  checker::RestingMesh elements_;
  std::vector<fast::IndexPair> intersecting_;  ///< in order
  std::int64_t comparisons_ = 0;               ///< of boxes, in the checker's search
};

}  // namespace

SceneProof prove_mesh(const fast::Motion& vertices, const fast::Mesh& mesh,
                      const fast::IntersectionOptions& search, const SceneProofOptions& options) {
  if (search.can_collide) {
    throw std::invalid_argument("prove: certificates know groups alone, not a rule can_collide");
  }
  ListedScene listed({.edges = mesh.edges, .faces = mesh.faces, .points = mesh.points},
                     {.of_vertices = search.groups.of_vertices, .apart = search.groups.apart},
                     search.weld);
  fast::IntersectionOptions all = search;
  all.pairs = fast::IntersectingPairs::all;
  all.most = (std::numeric_limits<std::size_t>::max)();
  all.places = false;
  const auto found = fast::intersections(vertices, listed.mesh, all);
  list_elements(vertices, search.weld, listed);
  try {
    listed.require_within_limit(vertices.size());
  } catch (const CertificateLimitError& error) {
    return {.failure = error.what()};
  }
  return MeshProver(vertices, listed, search.weld, options).run(found);
}

}  // namespace touchstone::exact
