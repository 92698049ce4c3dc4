#pragma once

/// \file
/// Squared distances of a point and a triangle, and of two segments, by their closest
/// features, in the two ways that released methods compute them: from the closest points themselves
/// (MSRF; [ericson2005], 5.1.5 and 5.1.9), and by the formula of the pair of features, with less
/// cancellation near contact (ACCD; [li2020]).
///
/// The closest points of two convex sets are in the interior of one feature each, where the
/// difference is orthogonal to both features. In ordinary floating point; nothing bounds the error.

#include <Eigen/Core>

namespace touchstone::baselines {

struct Triangle {
  Eigen::Vector3d a, b, c;
};

struct Segment {
  Eigen::Vector3d a, b;
};

/// Segments whose squared length is at most this are points to closest_points_squared_distance().
inline constexpr double point_squared_length = 1e-8;

/// The squared distance of p and the nearest point of the triangle; NaN for some degenerate
/// triangles.
[[nodiscard]] double closest_point_squared_distance(const Eigen::Vector3d& p,
                                                    const Triangle& triangle);

/// The squared distance of the nearest points of two segments; segments of a squared length up to
/// point_squared_length are treated as points.
[[nodiscard]] double closest_points_squared_distance(const Segment& first, const Segment& second);

/// The squared distance of p and the triangle, by the formula of its nearest vertex, edge or face.
[[nodiscard]] double feature_squared_distance(const Eigen::Vector3d& p, const Triangle& triangle);

/// The squared distance of two segments, by the formula of their nearest features. Parallel ones,
/// with |u×v|² < 2.5e-16 |u|²|v|², have an end among these.
[[nodiscard]] double feature_squared_distance(const Segment& first, const Segment& second);

}  // namespace touchstone::baselines
