#pragma once

/// \file
/// The positions of a step's vertices in integers, as in the checker of certificates, and
/// directions of small integers that separate two primitives (exact/CERTIFICATES.md, "Steps").
///
/// A direction is searched in doubles, from the corners w = a − b of two primitives a and b at the
/// start and at the end: the vector from the origin to the hull's nearest point, by Gilbert's
/// method, and the normals of the triangle or parallelogram of the corners. It is then rounded to
/// the smallest integers that separate them, which is decided in integers. The search is not
/// complete.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "touchstone/mesh.hpp"
#include "touchstone/number.hpp"

namespace touchstone::exact {

class StepPlaces {
 public:
  using Direction = std::array<std::int64_t, 3>;
  using Vertices = std::span<const std::int32_t>;

  /// A direction's components are at most this.
  static constexpr std::int64_t greatest_component = 1023;

  /// The motion from t=0 to t=end. Refers to the vertices.
  /// \param greatest the greatest distance of a pair
  StepPlaces(const fast::Motion& vertices, double greatest, const Rational& end);

  /// An upper bound, in the step's coordinates, of the reduction of distances by the integers.
  [[nodiscard]] double uncertainty() const { return uncertainty_; }

  /// True if for the checker the direction keeps the primitive of vertices a above that of b, by
  /// that distance.
  [[nodiscard]] bool is_above(Vertices a, Vertices b, const Direction& d, double distance) const {
    return is_above(a, b, d, enlarged_distance(distance));
  }
  /// True if for the checker a coordinate axis separates them.
  [[nodiscard]] bool is_axis_between(Vertices a, Vertices b, double distance) const;
  /// A direction that keeps a above b.
  [[nodiscard]] std::optional<Direction> direction(Vertices a, Vertices b, double distance) const;

 private:
  using Integers = std::array<std::int64_t, 3>;

  /// A vertex at the start and at the end.
  struct Bounds {
    std::array<Integers, 2> lower;
    std::array<Integers, 2> upper;
  };

  [[nodiscard]] const Bounds& at(std::int32_t vertex) const {
    return bounds_[static_cast<std::size_t>(vertex)];
  }

  /// A distance in integers, rounded up.
  [[nodiscard]] std::int64_t enlarged_distance(double distance) const;
  [[nodiscard]] bool is_above(Vertices a, Vertices b, const Direction& d,
                              std::int64_t distance) const;

  std::vector<Bounds> bounds_;
  int shift_ = 0;
  double uncertainty_ = 0.0;
};

}  // namespace touchstone::exact
