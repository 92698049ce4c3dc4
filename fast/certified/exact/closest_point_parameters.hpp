#pragma once

/// \file
/// An approximation, in floating point, of the parameters of the point of a polygon that is
/// nearest to the origin.
///
/// The polygon is {r − u p − v q} over the triangle or the square of (u,v), as in
/// contact_conditions.hpp, and the norm is convex. The Euclidean norm is least at the foot of the
/// perpendicular on the plane, if that is in the domain, else on a side, at the foot on its line or
/// at an end. The maximum norm gives a linear program. Its vertices are the points at which three
/// of the numbers ±F_k are equal, the points on a side at which two of them are equal or one is 0,
/// and the corners. All these are tried.

#include <Eigen/Core>

#include <array>

#include "touchstone/query.hpp"

namespace touchstone::fast::exact_stage {

/// A point of F's domain, up to rounding.
struct Parameters {
  double u = 0.0, v = 0.0;
};

/// r, p and q.
struct AffineVectors {
  Eigen::Vector3d r, p, q;
};

/// The vectors of a query at t=0 and at t=1, in units of a power of two that no coordinate exceeds,
/// against overflow. Differences of points are taken first, so a common motion or position costs no
/// accuracy.
[[nodiscard]] std::array<AffineVectors, 2> scaled_vectors(ContactKind kind, const Query& query);

/// An approximation of the point of F's domain that is nearest to these parameters, exactly inside
/// it.
[[nodiscard]] Parameters inside_domain(ContactKind kind, Parameters x);

/// The (u,v), up to rounding, at which ‖F(t,u,v)‖ is least; one of them if there are several.
/// \pre all coordinates are finite; 0 ≤ t ≤ 1.
[[nodiscard]] Parameters nearest_parameters(ContactKind kind, const Query& query, double t,
                                            Norm norm);

}  // namespace touchstone::fast::exact_stage
