#pragma once

/// \file
/// The place of a point of a rigid body at a time, to the nearest doubles.

#include <array>

#include "touchstone/rigid_motion.hpp"

namespace touchstone::exact {

/// The factor of |p| + |v| (greatest magnitudes of coordinates) in the error of a coordinate of a
/// place.
inline constexpr double place_error = 0x1p-50;

/// x(t) of a point v in units of 2^unit, each coordinate with an error of at most place_error (|p|
/// +
/// |v|), where |p| is the greater of the positions' magnitudes at both ends, and 2^-1075, as a
/// double may be subnormal. \param t In [0,1].
[[nodiscard]] std::array<double, 3> place_of(const RigidMotion& motion,
                                             const std::array<double, 3>& v, double t,
                                             int unit = 0);

}  // namespace touchstone::exact
