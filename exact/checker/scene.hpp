#pragma once

/// \file
/// A scene as certificates of steps and of meshes write it, and its primitives.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "exact/checker/certificate.hpp"
#include "exact/checker/places.hpp"

namespace touchstone::checker {

using Face = std::array<std::int32_t, 3>;
using Tetrahedron = std::array<std::int32_t, 4>;
/// The numbers of two vertices, two groups or two primitives.
using Two = std::array<std::int32_t, 2>;

/// Two groups and the thickness of their pairs.
struct GroupSeparation {
  Two groups{};
  double distance = 0.0;

  friend bool operator==(const GroupSeparation&, const GroupSeparation&) = default;
};

/// The scene as it is written.
struct Scene {
  std::vector<Motion> vertices;
  std::vector<Face> faces;
  std::vector<Two> edges;
  std::vector<std::int32_t> points;
  std::vector<std::int32_t> groups;
  std::vector<Two> apart;
  std::vector<double> radii;                 ///< of a step only
  std::vector<GroupSeparation> separations;  ///< of a step only
  std::vector<Tetrahedron> tetrahedra;       ///< of a step only
  std::vector<Face> plane_triangles;         ///< of a step only

  friend bool operator==(const Scene&, const Scene&) = default;
};

/// The places of a vertex as they are written: X Y Z X Y Z, at t=0 and at t=1, or X Y Z, which are
/// both.
enum class Time : std::uint8_t { step, rest };

// These throw Rejection, and std::runtime_error as Reader::advance.

/// Takes a word that is a decimal integer from `least` to below `limit`, in its only form.
[[nodiscard]] std::int32_t take_integer(Reader& reader, std::int32_t least, std::size_t limit);
/// Takes any integer that is not below 0.
[[nodiscard]] std::int32_t take_count(Reader& reader);
/// \throws Rejection unless the number is a double.
[[nodiscard]] double to_double(const mpq_class& number);
/// Reads the lines from `vertices` to `separations`, and the elements if there are any, or to
/// `apart` of a mesh at rest.
[[nodiscard]] Scene read_scene(Reader& reader, const Options& options, Time time);

/// The primitives that take part.
struct Elements {
  Primitives vertices;
  Primitives edges;
  Primitives faces;
  /// The vertices without an edge.
  Primitives points;
  /// The edges of no face.
  Primitives bare_edges;
};

[[nodiscard]] Elements find_elements(const Scene& scene);

/// The number and the word for so many.
[[nodiscard]] std::string counted(std::size_t count, const char* one, const char* several);

/// "6 vertices", or "6 of 7 vertices" if not all take part.
[[nodiscard]] std::string vertices_text(const Scene& scene, std::size_t taking_part);

/// The rules, which weaken the claim: "2 pairs of groups held apart, 1 group held apart from
/// itself, 3 vertices left out", or those of the three that there are. \param apart groups that are
/// held apart \param left_out the number of vertices that take no part
[[nodiscard]] std::string rules_text(std::vector<Two> apart, std::size_t left_out);

/// The groups of vertices, and which of them are held apart. Without groups all vertices are in
/// group 0.
class Groups {
 public:
  Groups() = default;
  explicit Groups(const Scene& scene);

  /// True if the groups of some vertex of the one and some vertex of the other are not held apart.
  [[nodiscard]] bool meet(const Primitive& a, const Primitive& b) const;
  [[nodiscard]] std::int32_t of(std::int32_t vertex) const {
    return of_vertices_.empty() ? 0 : of_vertices_[static_cast<std::size_t>(vertex)];
  }

 private:
  std::vector<std::int32_t> of_vertices_;
  /// Those that are held apart, each two in both orders; sorted.
  std::vector<Two> apart_;
};

}  // namespace touchstone::checker
