#pragma once

/// \file
/// The active set of a step: which pairs a constrained solver has to keep apart, when and where they come
/// near, and in which direction ([wang2021], algorithm 3).
///
/// A constraint of such a solver is n·(x − y) ≥ η at the end of the step, where x and y are points of
/// the two primitives and n is the contact normal. It is active if the primitives come within η at some
/// time of the step. Which pairs do so, and when, is decided exactly (fast/step.hpp). Points and
/// normals are computed in doubles without a bound.
///
/// **The normal** is a unit vector that points from the second primitive to the first. Let F be the
/// difference x − y of the contact points, at the upper end of the time of impact, and F' its rate.
/// - It is parallel to the face's normal, or to the cross product of the edges. Of the two directions it
///   is the one with n·F > 0; where the points coincide, that with n·F' < 0, from which the first
///   primitive comes; else that of the product itself.
/// - *Degenerate pairs* have no such product: parallel edges, a face without an area, a vertex and an
///   edge, two vertices. Their normal is the direction of F; where the points coincide, that of
///   −F' without its part along the edge; else any direction upright on the edge.
///
/// Edges count as parallel, and a face as one without an area, where the sine of the angle is below
/// 2^-20: about half of a normal's digits are right then. Points coincide where F is below 2^-40 of
/// the size of the pair, or below what the pair moves in the enclosure of the time of impact.

#include <Eigen/Core>

#include <vector>

#include "exact/query.hpp"
#include "fast/mesh.hpp"
#include "fast/step.hpp"

namespace touchstone::fast {

/// Two primitives that come within η, and where.
struct ActiveContact : StepCollision {
  /// The contact points at toi_upper: on the first primitive and on the second.
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Vector3d second = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
};

/// Every pair of the step that comes within `eta` up to the step's t_max, exactly these, in the order
/// of toi_lower, toi_upper, kind and pair. The separation that the step was made with does not matter.
/// \param eta η, finite and not negative, in units of the coordinates; 0: the pairs that touch.
/// \throws std::invalid_argument for another η.
[[nodiscard]] std::vector<ActiveContact> active_set(const Step& step, double eta,
                                                    Norm norm = Norm::l2);

/// The contact of a pair at a time as above, whether or not it is near then: for pairs and times that another solver
/// has found. Its toi_lower and toi_upper are t; u and v are where the primitives are nearest.
/// \pre The pair's numbers are in range. \throws std::invalid_argument unless 0 ≤ t ≤ 1.
[[nodiscard]] ActiveContact contact_at(const Step& step, PairKind kind, const IndexPair& pair,
                                       double t, Norm norm = Norm::l2);

}  // namespace touchstone::fast
