#pragma once

/// \file
/// Other filters of Tight-Inclusion than fast::error_filter(), with its arguments and result
/// (docs/methods.md, section 2).

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "touchstone/filters/error_bounds.hpp"
#include "touchstone/query.hpp"
#include "touchstone/tight_inclusion.hpp"

namespace touchstone::verify::published {

/// The constants of [wang2021], section 4.2 and appendix (docs/theory.md, section 4.10), times γ³,
/// γ = gamma(x_max) on each axis; infinite where ours is.
template <class Gamma>
[[nodiscard]] std::array<double, 3> filter_of_cubes(ContactKind kind,
                                                    const std::array<double, 3>& x_max,
                                                    double distance, const Gamma& gamma) {
  const double constant = kind == ContactKind::edge_edge
                              ? (distance > 0.0 ? 7.105427357601002e-15 : 6.217248937900877e-15)
                              : (distance > 0.0 ? 7.549516567451064e-15 : 6.661338147750939e-15);
  std::array<double, 3> result = fast::error_filter(kind, x_max, distance);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (result[axis] == std::numeric_limits<double>::infinity()) continue;
    const double factor = gamma(x_max[axis]);
    result[axis] = constant * factor * factor * factor;
  }
  return result;
}

/// [wang2021]: γ = max(x_max, 1), x_max with the distance.
[[nodiscard]] inline std::array<double, 3> published_filter(ContactKind kind,
                                                            const std::array<double, 3>& x_max,
                                                            double distance) {
  return filter_of_cubes(kind, x_max, distance, [&](double greatest) {
    return std::max({greatest, distance, 1.0});
  });
}

/// The public Tight-Inclusion since 2022: γ = min(x_max, 1). It is not a bound: F is linear in the
/// coordinates, so it is too small for x_max below about 0.9 and above about 1.2.
[[nodiscard]] inline std::array<double, 3> released_filter(ContactKind kind,
                                                           const std::array<double, 3>& x_max,
                                                           double distance) {
  return filter_of_cubes(kind, x_max, distance,
                         [](double greatest) { return std::min(greatest, 1.0); });
}

/// The derived bounds for F computed in float. \pre the arguments are floats.
[[nodiscard]] inline std::array<double, 3> float_filter(ContactKind kind,
                                                        const std::array<double, 3>& x_max,
                                                        double distance) {
  const bool is_edges = kind == ContactKind::edge_edge, separated = distance > 0.0;
  const filters::ErrorBound<float, 1>& bound =
      separated
          ? (is_edges ? filters::edge_edge_separated_float : filters::vertex_face_separated_float)
          : (is_edges ? filters::edge_edge_float : filters::vertex_face_float);
  std::array<double, 3> result{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto x = static_cast<float>(std::max(x_max[axis], distance));
    result[axis] = x > bound.greatest_x ? std::numeric_limits<double>::infinity()
                                        : static_cast<double>(bound(x));
  }
  return result;
}

}  // namespace touchstone::verify::published
