#pragma once

/// \file
/// The active set of a step: the pairs that a constrained solver has to keep apart, with the
/// time, the place and the direction of each contact ([wang2021], algorithm 3).
///
/// A constraint of such a solver is n·(x − y) ≥ η at the end of the step, where x and y are points
/// of the two primitives and n is the contact normal. It is active if the primitives come within η
/// at some time of the step. These pairs and their times are decided exactly (touchstone/step.hpp).
/// Points and normals are computed in doubles without a bound.
///
/// **The normal** is a unit vector that points from the second primitive to the first. Let F be the
/// difference x − y of the contact points, at the upper end of the time of impact, and F' its rate.
/// - It is parallel to the face's normal, or to the cross product of the edges. Of the two
///   directions it is the one with n·F > 0; if the points coincide, the one with n·F' < 0, from
///   which the first primitive comes; otherwise the direction of the product itself.
/// - *Degenerate pairs* have no such product: parallel edges, a face without an area, a vertex and
///   an edge, two vertices. Their normal is the direction of F; if the points coincide, the
///   direction of −F' without its component along the edge; otherwise any direction perpendicular
///   to the edge.
///
/// Edges are treated as parallel, and a face as one without an area, if the sine of the angle is
/// below 2^-20: about half of a normal's digits are right then. Points are treated as coincident if
/// F is below 2^-40 of the size of the pair, or below the motion of the pair within the enclosure
/// of the time of impact. The functions are thread-safe.

#include <Eigen/Core>

#include <vector>

#include "touchstone/mesh.hpp"
#include "touchstone/query.hpp"
#include "touchstone/step.hpp"

namespace touchstone::fast {

/// Two primitives that come within η, with the place of contact.
struct ActiveContact : StepCollision {
  /// The contact points at toi_upper: on the first primitive and on the second.
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Vector3d second = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
};

/// Every pair of the step that comes within η, the distance of `separation`, up to the step's
/// t_max, exactly these, in the order of toi_lower, toi_upper, kind and pair. The separation of the
/// step itself has no effect.
/// \param separation Its distance η is finite and not negative, in units of the coordinates; 0: the
/// pairs that collide.
/// \throws std::invalid_argument for another η.
[[nodiscard]] std::vector<ActiveContact> active_set(const Step& step, const Separation& separation);

/// The contact of a pair at a given time, at any distance: for pairs and times that another solver
/// has found. Its toi_lower and toi_upper are t; u and v are the parameters of the nearest points.
/// \throws std::invalid_argument unless 0 ≤ t ≤ 1; std::out_of_range for numbers out of range.
[[nodiscard]] ActiveContact contact_at(const Step& step, PairKind kind, const IndexPair& pair,
                                       double t, Norm norm = Norm::l2);

}  // namespace touchstone::fast
