#pragma once

/// \file
/// Directions of small integers that keep two primitives of a scene apart for the checker of
/// certificates (exact/checker/places.hpp).
///
/// A direction is searched in doubles, from the corners w = a − b of two primitives a and b at the
/// start and at the end: the vector from the origin to the hull's nearest point, by Gilbert's
/// method, and the normals of the triangle or parallelogram of the corners. It is then rounded to
/// the smallest integers that the checker accepts. The search is not complete.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "exact/checker/places.hpp"

namespace touchstone::exact {

/// The direction d in the smallest integers that are accepted, if any are.
template <class Accepts>
[[nodiscard]] std::optional<checker::Direction> rounded_direction(const std::array<double, 3>& d,
                                                                  const Accepts& accepts) {
  const double greatest = std::max({std::abs(d[0]), std::abs(d[1]), std::abs(d[2])});
  if (!(greatest > 0.0) || !std::isfinite(greatest)) return std::nullopt;
  for (const double size : {1., 2., 3., 5., 8., 13., 24., 44., 80., 150., 290., 550., 1023.}) {
    checker::Direction rounded{};
    for (std::size_t k = 0; k < 3; ++k) rounded[k] = std::llround(d[k] / greatest * size);
    if (accepts(rounded)) return rounded;
  }
  return std::nullopt;
}

/// The vertices of a vertex, an edge or a face, each once.
using PrimitiveVertices = std::span<const std::int32_t>;

/// The primitive as the checker has it.
[[nodiscard]] checker::Primitive primitive_of(PrimitiveVertices vertices);

/// A direction that keeps a above b by that distance.
[[nodiscard]] std::optional<checker::Direction> find_direction(const checker::Places& places,
                                                               PrimitiveVertices a,
                                                               PrimitiveVertices b,
                                                               double distance);

}  // namespace touchstone::exact
