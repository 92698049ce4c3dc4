#pragma once

/// \file
/// The contacts of two simplices at rest, which determine their intersection.
///
/// A simplex is a triangle, a segment or a point. Its *features* are its vertices, its edges and
/// its face, without their boundaries, so that each of its points is in exactly one feature. A
/// *contact* of A and B is a pair of features, one of each, that have exactly one point in common.
///
/// **Theorem.** The points of the contacts are the extreme points of A ∩ B, each once. So A ∩ B is
/// their convex hull.
/// Proof. A ∩ B is convex and compact, so it is the hull of its extreme points. Let x be one, f and
/// g the features that contain it. f ∩ g is convex, relatively open and a part of A ∩ B; if it had
/// a second point, x would be between two of its points. So (f, g) is a contact. Conversely its
/// only point x is in A ∩ B. If it were between two points of A ∩ B, these would be in the smallest
/// vertex, edge or face of A with x, and of B, hence x not the only common point of the features.
/// So x is extreme. Since a point is in one feature of each simplex only, contacts with the same
/// point are equal. ∎
///
/// Two features have exactly one common point only as a vertex and any feature, two edges that are
/// not on one line, or an edge and a face that it crosses. So signs of orientations find all
/// contacts:
/// - a vertex is *located* in the other simplex: in its plane by one orientation in space, in a
///   feature by those of its projection along an axis on which the simplex keeps its area;
/// - an edge whose ends are strictly on different sides of a triangle's plane crosses this plane in
///   one point. The orientations of the edge with the three sides of the triangle tell in which
///   feature of the triangle this point is;
/// - two edges in one plane cross if the ends of each are strictly on different sides of the other
///   in a projection.
/// Edges that cross outside the plane of either triangle are found by the second test: one of them
/// crosses the plane of the other's triangle, or both triangles are in one plane.
///
/// **Common vertices.** Let S be the vertices that two elements of a mesh share, by their numbers.
/// They intersect iff a point of a contact is outside the hull of S. For triangles with an area:
/// - S = ∅: iff there is a contact.
/// - S = {v}: iff there is a contact besides (v, v). Then one edge opposite to v reaches the other
///   triangle, or an edge at v is on or inside it.
/// - S = {v, w}: iff both triangles are in one plane and on the same side of vw. For if the planes
///   differ, both triangles are on the sides of the line vw, which they meet in the edge. If the
///   triangles are on different sides of it in one plane, so too. On the same side, they overlap.
/// - three vertices: always. The triangles are the same.
/// For all others, a point of a contact is in the hull of S iff it is the place of a vertex of S.
/// Proof. If it is between two vertices of S, the edge between them is in A and in B. An end of a
/// segment cannot be there, so each feature of the contact is that edge, or on its line: then they
/// have more than one common point, or none. ∎
///
/// **Elements without an area.** A face whose vertices are on a line is the segment between its
/// extreme vertices, or a point; its third vertex is no feature, but can be in S.
///
/// **Kind.** With one contact, its features name the kind. With two, A ∩ B is a segment; it
/// is inside an edge of A if the features of A in the contacts are of one edge, otherwise inside
/// the face, and likewise of B. With three or more it is a polygon: the triangles are in one plane.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "fast/broad_phase/primitive_groups.hpp"
#include "fast/intersections/orientation.hpp"
#include "touchstone/intersections.hpp"

namespace touchstone::fast::meeting {

/// A simplex of different vertices at different places that are not on a line: a triangle; a
/// segment, whose last vertex is repeated; or a point, three times the same vertex.
using Simplex = Primitive;

[[nodiscard]] inline std::size_t dimension(const Simplex& simplex) {
  if (simplex[0] == simplex[1]) return 0;
  return simplex[1] == simplex[2] ? 1 : 2;
}

/// The vertices with repeated ones last, as in a simplex; their places may be on a line.
[[nodiscard]] Primitive in_normal_form(const Primitive& vertices);

/// Features by number: vertices 0, 1, 2, then edges, from vertex i to the next: 3 + i, then the
/// face. A segment has edge 3 only.
using Feature = std::size_t;
inline constexpr Feature first_edge = 3, face_feature = 6, features = 7;

/// The vertices of a feature, of which it is the hull.
[[nodiscard]] std::span<const std::int32_t> vertices_of(const Simplex& simplex, Feature feature,
                                                        std::array<std::int32_t, 2>& edge);

struct Contact {
  Feature a, b;
};

/// A set of contacts of two simplices.
class Contacts {
 public:
  void add(Feature a, Feature b) { bits_ |= std::uint64_t{1} << (a * features + b); }
  void remove(Contact contact) {
    bits_ &= ~(std::uint64_t{1} << (contact.a * features + contact.b));
  }
  [[nodiscard]] int count() const { return std::popcount(bits_); }
  [[nodiscard]] Contact first() const {
    const auto place = static_cast<std::size_t>(std::countr_zero(bits_));
    return {place / features, place % features};
  }

 private:
  std::uint64_t bits_ = 0;
};

[[nodiscard]] Contacts contacts_of(const Positions& at, const Simplex& a, const Simplex& b);

/// An element of a mesh.
struct Element {
  Primitive vertices;  ///< in normal form
  Simplex simplex;
};

/// \param vertices in normal form
[[nodiscard]] Element element_of(const Positions& at, const Primitive& vertices);

/// The kind of an intersection, with its contacts.
struct Meeting {
  IntersectionKind kind;
  Contacts contacts;
};

/// The meeting of two elements; nullopt if they do not intersect.
[[nodiscard]] std::optional<Meeting> meeting_of(const Positions& at, const Element& a,
                                                const Element& b);

/// The place of an intersection.
[[nodiscard]] std::array<PointEnclosure, 2> place_of(const Positions& at, const Element& a,
                                                     const Element& b, Contacts contacts);

}  // namespace touchstone::fast::meeting
