#pragma once

/// \file
/// Exact symmetries: maps of queries that change neither the verdict nor the time of impact.
///
/// - The points of a primitive may be renumbered, edges exchanged: the same sets of points.
/// - Axes may be permuted and mirrored: an isometry in both norms, without a rounding.
/// - A cell's points and axes may be, if its volume keeps its sign: an even number of exchanges
///   and mirrors; of a triangle in the plane its three points, and the first two axes.
/// - Each axis may be multiplied by a power of two without rounding: a linear map of full rank maps
///   roots of F to roots. It changes distances, so it needs separation 0.
/// - All points may be shifted by one vector if all sums are exact: F does not change.
/// - Time may be reversed: the set of positions is the same, so the verdict is the same, but the
///   time of impact is different.
///
/// All of them act on the control points of curves, which keep their weights.

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "touchstone/any_kind.hpp"
#include "verify/generate/random_stream.hpp"

namespace touchstone::verify::generate {

/// A map of queries: points renumbered, axes permuted, then each axis multiplied and shifted, then
/// time reversed.
struct Symmetry {
  std::array<std::size_t, moving_points> points{0, 1, 2, 3};  ///< image point i is point points[i]
  std::array<std::size_t, 3> axes{0, 1, 2};                   ///< image axis i is axis axes[i]
  std::array<double, 3> factors{1.0, 1.0, 1.0};  ///< of the image's axes: ± a power of two
  std::array<double, 3> shifts{};                ///< of the image's axes, after the factors
  bool reversed = false;                         ///< true if start and end are exchanged

  friend bool operator==(const Symmetry&, const Symmetry&) = default;
};

/// The image of a query; empty if some coordinate of it would not be exact.
[[nodiscard]] std::optional<Query> image(const Symmetry& symmetry, const Query& query);
/// The numbers of the image of one query of any shape; empty as above.
[[nodiscard]] std::optional<std::vector<double>> image(const Symmetry& symmetry,
                                                       const AnyQueries& query);

/// A random renumbering of the points, and permutation and mirroring of axes.
[[nodiscard]] Symmetry draw_isometry(AnyKind kind, Random& random);

/// A random symmetry with an exact image of this query, one of any shape. Without powers of two if
/// there is a separation.
[[nodiscard]] Symmetry draw_symmetry(const AnyQueries& query, const Separation& separation,
                                     Random& random);
[[nodiscard]] Symmetry draw_symmetry(AnyKind kind, const Query& query, const Separation& separation,
                                     Random& random);

}  // namespace touchstone::verify::generate
