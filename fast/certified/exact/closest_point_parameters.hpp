#pragma once

/// \file
/// Where on a polygon the point nearest to the origin is, in floating point: a guess.
///
/// The polygon is {r − u p − v q} over the triangle or the square of (u,v), as in contact_conditions.hpp,
/// and the norm is convex. Euclid's is least at the foot of the perpendicular on the plane, if that
/// is in the domain, else on a side, at the foot on its line or at an end. The greatest component's
/// is a linear program; its vertices are where three of the numbers ±F_k are equal, or two of them
/// (or one of them 0) on a side, or the corners. All these are tried.

#include <Eigen/Core>

#include <array>

#include "exact/query.hpp"

namespace touchstone::fast::exact_stage {

/// A point of F's domain, up to rounding.
struct Parameters {
  double u = 0.0, v = 0.0;
};

/// r, p and q.
struct AffineVectors {
  Eigen::Vector3d r, p, q;
};

/// Those of a query at t=0 and at t=1, in units of a power of two that no coordinate exceeds, so that nothing
/// overflows. The points are differences first: a common motion or position costs no accuracy.
[[nodiscard]] std::array<AffineVectors, 2> scaled_vectors(Kind kind, const Query& query);

/// The (u,v), up to rounding, at which ‖F(t,u,v)‖ is least. One of them if there are many.
/// \pre all coordinates are finite; 0 ≤ t ≤ 1.
[[nodiscard]] Parameters nearest_parameters(Kind kind, const Query& query, double t, Norm norm);

}  // namespace touchstone::fast::exact_stage
