#pragma once

/// \file
/// The last stage of the certified solver: any query of finite doubles, decided in integers.
///
/// The coordinates of each axis are multiplied by a power of two that makes them integers, which
/// changes no (t,u,v) of a contact. contact_conditions.hpp then defines the polynomials that
/// decide. With a minimum separation all axes have the same power of two, and distance_decision.hpp
/// defines them.

#include <optional>

#include "touchstone/curved_query.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast {

/// The first contact.
struct ExactImpact {
  double toi_lower = 0.0;  ///< below the time of impact; 0 if that is 0
  double toi_upper = 0.0;  ///< not below the time of impact
  double u = 0.0;          ///< the contact in F's domain, to about the accuracy of a double
  double v = 0.0;
};

/// The first contact up to t_max; empty if there is none: exact for every query of finite doubles.
/// The enclosure of the time of impact is at most toi_tolerance wide, relative to its upper end, or
/// one spacing of doubles; its upper end may be above t_max. If there are several contact points,
/// (u,v) is one of them; at a positive separation, of about the nearest points, without an error
/// bound. Independent of the floating-point environment (rounding mode, flushed subnormals).
/// \pre all coordinates are finite; the separation is valid; 0 ≤ toi_tolerance; 0 ≤ t_max ≤ 1.
[[nodiscard]] std::optional<ExactImpact> decide_exactly(ContactKind kind, const Query& query,
                                                        const Separation& separation,
                                                        double toi_tolerance, double t_max);

/// The same on curves. \pre as above, and the weights are positive.
[[nodiscard]] std::optional<ExactImpact> decide_exactly(ContactKind kind, const CurvedQuery& query,
                                                        const Separation& separation,
                                                        double toi_tolerance, double t_max);

/// The answer about a tetrahedron (touchstone/cell.hpp).
struct ExactInversion {
  int start = 0;           ///< the sign of the volume at t=0
  bool inverts = false;    ///< it is so at a time of at most t_max
  double toi_lower = 0.0;  ///< if it inverts: below the first such time; 0 if that is 0
  double toi_upper = 0.0;  ///< not below that time
};

/// The first time at which at most this part of the volume at t=0 is left, exact for all finite
/// coordinates: D of contact_conditions.hpp is −6 times the volume. The enclosure is of
/// neighbouring doubles. \pre as above; kept_volume in [0,1).
[[nodiscard]] ExactInversion decide_inversion_exactly(const Query& tetrahedron, double t_max,
                                                      double kept_volume);

}  // namespace touchstone::fast
