#pragma once

/// \file
/// The elements of a mesh at rest, and the pairs of them that need an argument (mesh.hpp).

#include <cstddef>
#include <cstdint>
#include <vector>

#include "exact/checker/places.hpp"
#include "exact/checker/resting_pair.hpp"
#include "exact/checker/scene.hpp"

namespace touchstone::checker {

/// The first vertex at the place of each one, of the same group.
[[nodiscard]] std::vector<std::int32_t> first_at_places(const std::vector<Motion>& vertices,
                                                        const Groups& groups);

/// The elements are numbered: the faces as they are listed, then the listed edges of no face by
/// their larger vertex, then by the smaller, then the listed points without an edge by their
/// vertex.
class RestingMesh {
 public:
  /// \param scene at rest \param is_welded vertices of one group at one place are one vertex
  RestingMesh(const Scene& scene, bool is_welded);

  [[nodiscard]] const Primitives& elements() const { return elements_; }
  [[nodiscard]] const Primitive& operator[](std::int32_t number) const {
    return elements_[static_cast<std::size_t>(number)];
  }
  [[nodiscard]] std::size_t faces() const { return faces_; }
  [[nodiscard]] std::size_t edges() const { return edges_; }
  [[nodiscard]] std::size_t points() const { return elements_.size() - faces_ - edges_; }
  [[nodiscard]] std::size_t vertices_of_elements() const { return vertices_of_elements_; }
  /// The number of vertices that an element is listed with.
  [[nodiscard]] std::size_t corners(std::int32_t number) const;

  /// True unless their groups are held apart.
  [[nodiscard]] bool can_meet(std::int32_t a, std::int32_t b) const;
  [[nodiscard]] RestingPair pair(std::int32_t a, std::int32_t b) const;
  /// True if theorem 1 of resting_pair.hpp shows with this direction that they do not intersect.
  [[nodiscard]] bool is_separated_by(std::int32_t a, std::int32_t b, const Vector& d) const;

  /// Calls take(a, b), the smaller number first, for every two that can meet, that no coordinate
  /// axis keeps apart, and neither of which has only vertices of the other, and not all.
  /// \param comparisons_left how often boxes may still be compared
  /// \throws Rejection if that is not often enough.
  void find_pairs(std::int64_t& comparisons_left, const TakePair& take) const;

 private:
  void weld();

  std::vector<Motion> vertices_;
  Groups groups_;
  Places places_;
  Primitives elements_;
  std::size_t faces_ = 0;
  std::size_t edges_ = 0;
  /// Before they are welded.
  std::size_t vertices_of_elements_ = 0;
};

}  // namespace touchstone::checker
