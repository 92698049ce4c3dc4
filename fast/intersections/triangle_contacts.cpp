#include "fast/intersections/triangle_contacts.hpp"

#include <algorithm>

namespace touchstone::fast::meeting {
namespace {

constexpr Feature nowhere = features;

std::int32_t side_start(const Simplex& simplex, std::size_t side) { return simplex[side]; }
std::int32_t side_end(const Simplex& simplex, std::size_t side) { return simplex[(side + 1) % 3]; }

/// The number of edges.
std::size_t sides_of(const Simplex& simplex) {
  static constexpr std::array<std::size_t, 3> of_dimension{0, 1, 3};
  return of_dimension[dimension(simplex)];
}

bool has(const Primitive& vertices, std::int32_t vertex) {
  return std::ranges::find(vertices, vertex) != vertices.end();
}

/// The feature of a triangle that contains a point of its plane, from the signs that tell on which
/// sides of its edges the point is: positive on one side of all edges inside.
Feature feature_of(const std::array<int, 3>& signs) {
  const auto [least, greatest] = std::ranges::minmax(signs);
  if (least < 0 && greatest > 0) return nowhere;
  const auto zeros = std::ranges::count(signs, 0);
  if (zeros == 0) return face_feature;
  const auto place = [&](bool is_zero) {
    return static_cast<std::size_t>(
        std::ranges::find_if(signs, [&](int sign) { return (sign == 0) == is_zero; }) -
        signs.begin());
  };
  if (zeros == 1) return first_edge + place(true);
  // A point on two edges is the vertex opposite to the third.
  return (place(false) + 2) % 3;
}

/// A projection in which a triangle keeps its area.
struct Projection {
  Projection(const Positions& at, const Simplex& triangle) {
    axis = Normal(at.difference(triangle[0], triangle[1]), at.difference(triangle[0], triangle[2]))
               .greatest_axis();
    for (std::size_t i = 0; i < 3; ++i, axis = (axis + 1) % 3) {
      turn = planar_orientation(at, axis, triangle[0], triangle[1], triangle[2]);
      if (turn != 0) return;
    }
  }

  std::size_t axis;
  int turn = 0;  ///< the orientation of the triangle in it
};

/// A simplex, and the sides of another one's vertices.
class Side {
 public:
  Side(const Positions& at, const Simplex& simplex, const Simplex& other)
      : at_(at), simplex_(simplex), dimension_(dimension(simplex)) {
    if (dimension_ != 2) return;
    for (std::size_t i = 0; i < 3; ++i) {
      if (i > 0 && other[i] == other[i - 1]) {
        signs_[i] = signs_[i - 1];
      } else if (!has(simplex, other[i])) {
        signs_[i] = orientation(at, simplex[0], other[i], simplex[1], simplex[2]);
      }
    }
  }

  /// True if the plane of the triangle is strictly on one side of the other simplex.
  [[nodiscard]] bool separates() const {
    const auto [least, greatest] = std::ranges::minmax(signs_);
    return dimension_ == 2 && (least > 0 || greatest < 0);
  }
  /// True if the other simplex is in the plane of the triangle.
  [[nodiscard]] bool is_coplanar() const {
    return dimension_ == 2 && signs_ == std::array<int, 3>{};
  }
  /// True if the plane of the triangle strictly separates the ends of the other simplex's edge.
  [[nodiscard]] bool is_crossed_by(std::size_t edge) const {
    return signs_[edge] * signs_[(edge + 1) % 3] < 0;
  }

  /// The feature that contains a vertex of the other simplex; nowhere if none does.
  [[nodiscard]] Feature feature_with(const Simplex& other, std::size_t corner) {
    const std::int32_t vertex = other[corner];
    for (std::size_t i = 0; i <= dimension_; ++i) {
      if (at_.are_equal(simplex_[i], vertex)) return i;
    }
    if (dimension_ == 0) return nowhere;
    if (dimension_ == 1) return on_segment(vertex) ? first_edge : nowhere;
    return signs_[corner] == 0 ? in_plane(vertex) : nowhere;
  }

  /// The feature through which an edge that crosses the plane of the triangle passes.
  [[nodiscard]] Feature feature_crossed_by(std::int32_t start, std::int32_t end) const {
    std::array<int, 3> signs{};
    for (std::size_t i = 0; i < 3; ++i) {
      signs[i] = orientation(at_, start, end, side_start(simplex_, i), side_end(simplex_, i));
    }
    return feature_of(signs);
  }

  /// A projection of the triangle.
  [[nodiscard]] const Projection& projection() {
    if (!projection_) projection_.emplace(at_, simplex_);
    return *projection_;
  }

 private:
  [[nodiscard]] bool on_segment(std::int32_t vertex) const {
    if (!are_collinear(at_, simplex_[0], simplex_[1], vertex)) return false;
    // The vertices in the order of places by x, y, z.
    const auto &start = at_[simplex_[0]], &end = at_[simplex_[1]], &point = at_[vertex];
    return (start < point && point < end) || (end < point && point < start);
  }

  [[nodiscard]] Feature in_plane(std::int32_t vertex) {
    const auto& [axis, turn] = projection();
    std::array<int, 3> signs{};
    for (std::size_t i = 0; i < 3; ++i) {
      signs[i] = turn * planar_orientation(at_, axis, side_start(simplex_, i),
                                           side_end(simplex_, i), vertex);
      if (signs[i] < 0) return nowhere;
    }
    return feature_of(signs);
  }

  const Positions& at_;
  const Simplex& simplex_;
  std::size_t dimension_;
  std::array<int, 3> signs_{};
  std::optional<Projection> projection_;
};

/// True if two segments in one plane, without their ends, have exactly one common point. \param
/// axes Projections: one that keeps an area in the plane, or all.
bool cross_in_plane(const Positions& at, std::span<const std::size_t> axes, const Edge& a,
                    const Edge& b) {
  const std::int32_t a0 = a[0], a1 = a[1], b0 = b[0], b1 = b[1];
  if (a0 == b0 || a0 == b1 || a1 == b0 || a1 == b1) return false;
  return std::ranges::any_of(axes, [&](std::size_t axis) {
    return planar_orientation(at, axis, a0, a1, b0) * planar_orientation(at, axis, a0, a1, b1) <
               0 &&
           planar_orientation(at, axis, b0, b1, a0) * planar_orientation(at, axis, b0, b1, a1) < 0;
  });
}

/// The contacts of edges of simplices in one plane.
void add_crossings(const Positions& at, std::span<const std::size_t> axes, const Simplex& a,
                   const Simplex& b, Contacts& contacts) {
  for (std::size_t i = 0; i < sides_of(a); ++i) {
    for (std::size_t k = 0; k < sides_of(b); ++k) {
      if (cross_in_plane(at, axes, {side_start(a, i), side_end(a, i)},
                         {side_start(b, k), side_end(b, k)})) {
        contacts.add(first_edge + i, first_edge + k);
      }
    }
  }
}

// ---- Common vertices ----------------------------------------------------------------------------

/// The different vertices of an element.
std::span<const std::int32_t> different(const Primitive& vertices) {
  return std::span(vertices).first(dimension(vertices) + 1);
}

std::size_t common_vertices(const Primitive& a, const Primitive& b) {
  return static_cast<std::size_t>(
      std::ranges::count_if(different(a), [&](std::int32_t vertex) { return has(b, vertex); }));
}

/// True if a feature or its boundary contains a vertex.
bool reaches(const Positions& at, const Simplex& simplex, Feature feature, std::int32_t vertex) {
  std::array<std::int32_t, 2> edge{};
  const auto corners = vertices_of(simplex, feature, edge);
  const Simplex of_feature{corners.front(), corners[corners.size() > 1 ? 1 : 0], corners.back()};
  const Simplex point{vertex, vertex, vertex};
  return Side(at, of_feature, point).feature_with(point, 0) != nowhere;
}

/// True if the point of a contact is at a common vertex.
bool is_common(const Positions& at, const Element& a, const Element& b, const Contact& contact) {
  if (contact.a < first_edge && contact.b < first_edge &&
      a.simplex[contact.a] == b.simplex[contact.b]) {
    return true;
  }
  if (a.vertices == a.simplex && b.vertices == b.simplex) return false;
  return std::ranges::any_of(different(a.vertices), [&](std::int32_t vertex) {
    return has(b.vertices, vertex) && reaches(at, a.simplex, contact.a, vertex) &&
           reaches(at, b.simplex, contact.b, vertex);
  });
}

bool is_outside_common(const Positions& at, const Element& a, const Element& b, Contacts contacts) {
  for (; contacts.count() > 0; contacts.remove(contacts.first())) {
    if (!is_common(at, a, b, contacts.first())) return true;
  }
  return false;
}

// ---- Kinds --------------------------------------------------------------------------------------

std::size_t dimension_of(Feature feature) {
  if (feature < first_edge) return 0;
  return feature < face_feature ? 1 : 2;
}

/// The dimension of the feature between the points of two features of a simplex.
std::size_t dimension_between(const Simplex& simplex, Feature one, Feature other) {
  if (dimension(simplex) == 1) return 1;
  unsigned corners = 0;
  for (const Feature feature : {one, other}) {
    if (feature < first_edge) {
      corners |= 1U << feature;
    } else if (feature < face_feature) {
      corners |= 1U << (feature - first_edge) | 1U << ((feature - first_edge + 1) % 3);
    } else {
      return 2;
    }
  }
  return std::popcount(corners) <= 2 ? 1 : 2;
}

IntersectionKind kind_of_point(const Contact& contact) {
  const std::size_t sum = dimension_of(contact.a) + dimension_of(contact.b);
  const bool is_vertex = dimension_of(contact.a) == 0 || dimension_of(contact.b) == 0;
  switch (sum) {
    case 0:
      return IntersectionKind::vertices_coincide;
    case 1:
      return IntersectionKind::vertex_on_edge;
    case 2:
      return is_vertex ? IntersectionKind::vertex_in_face : IntersectionKind::edges_cross;
    default:
      return IntersectionKind::edge_through_face;
  }
}

IntersectionKind kind_of_segment(const Simplex& a, const Simplex& b, Contacts contacts) {
  const Contact one = contacts.first();
  contacts.remove(one);
  const Contact other = contacts.first();
  const bool of_edges =
      dimension_between(a, one.a, other.a) == 1 && dimension_between(b, one.b, other.b) == 1;
  return of_edges ? IntersectionKind::edges_overlap : IntersectionKind::edge_through_face;
}

/// The simplex that is the hull of an element's vertices.
Simplex simplex_of(const Positions& at, const Primitive& element) {
  const auto [a, b, c] = element;
  const std::size_t order = dimension(element);
  if (order == 0 || (order == 1 && !at.are_equal(a, b)) ||
      (order == 2 && !are_collinear(at, a, b, c))) {
    return element;
  }
  const auto [least, greatest] =
      std::ranges::minmax(element, {}, [&](std::int32_t vertex) { return at[vertex]; });
  if (at.are_equal(least, greatest)) return primitive_of(least);
  return {least, greatest, greatest};
}

}  // namespace

// ---- Interface ----------------------------------------------------------------------------------

Primitive in_normal_form(const Primitive& vertices) {
  const auto [a, b, c] = vertices;
  if (a == b) return {a, c, c};
  return {a, b, a == c ? b : c};
}

Element element_of(const Positions& at, const Primitive& vertices) {
  return {vertices, simplex_of(at, vertices)};
}

std::span<const std::int32_t> vertices_of(const Simplex& simplex, Feature feature,
                                          std::array<std::int32_t, 2>& edge) {
  if (feature < first_edge) return std::span(simplex).subspan(feature, 1);
  if (feature == face_feature) return simplex;
  edge = {side_start(simplex, feature - first_edge), side_end(simplex, feature - first_edge)};
  return edge;
}

Contacts contacts_of(const Positions& at, const Simplex& a, const Simplex& b) {
  Contacts contacts;
  Side of_a(at, a, b);
  if (of_a.separates()) return contacts;
  Side of_b(at, b, a);
  if (of_b.separates()) return contacts;
  for (std::size_t i = 0; i <= dimension(a); ++i) {
    const Feature feature = of_b.feature_with(a, i);
    if (feature != nowhere) contacts.add(i, feature);
  }
  for (std::size_t i = 0; i <= dimension(b); ++i) {
    const Feature feature = of_a.feature_with(b, i);
    if (feature != nowhere) contacts.add(feature, i);
  }
  for (std::size_t i = 0; i < sides_of(a); ++i) {
    if (!of_b.is_crossed_by(i)) continue;
    const Feature feature = of_b.feature_crossed_by(side_start(a, i), side_end(a, i));
    if (feature != nowhere) contacts.add(first_edge + i, feature);
  }
  for (std::size_t i = 0; i < sides_of(b); ++i) {
    if (!of_a.is_crossed_by(i)) continue;
    const Feature feature = of_a.feature_crossed_by(side_start(b, i), side_end(b, i));
    if (feature != nowhere) contacts.add(feature, first_edge + i);
  }
  if (of_a.is_coplanar() || of_b.is_coplanar()) {
    Side& triangle = of_a.is_coplanar() ? of_a : of_b;
    add_crossings(at, std::array{triangle.projection().axis}, a, b, contacts);
  } else if (dimension(a) == 1 && dimension(b) == 1 &&
             orientation(at, a[0], a[1], b[0], b[1]) == 0) {
    add_crossings(at, std::array<std::size_t, 3>{0, 1, 2}, a, b, contacts);
  }
  return contacts;
}

std::optional<Meeting> meeting_of(const Positions& at, const Element& a, const Element& b) {
  const std::size_t common = common_vertices(a.vertices, b.vertices);
  const bool are_duplicates =
      common == different(a.vertices).size() &&
      common_vertices(b.vertices, a.vertices) == different(b.vertices).size();
  const Contacts contacts = contacts_of(at, a.simplex, b.simplex);
  if (are_duplicates) return Meeting{IntersectionKind::duplicates, contacts};
  if (common == 0 ? contacts.count() == 0 : !is_outside_common(at, a, b, contacts)) {
    return std::nullopt;
  }
  if (contacts.count() == 1) return Meeting{kind_of_point(contacts.first()), contacts};
  if (contacts.count() == 2) {
    return Meeting{kind_of_segment(a.simplex, b.simplex, contacts), contacts};
  }
  return Meeting{common == 2 ? IntersectionKind::folded_faces : IntersectionKind::coplanar_overlap,
                 contacts};
}

}  // namespace touchstone::fast::meeting
