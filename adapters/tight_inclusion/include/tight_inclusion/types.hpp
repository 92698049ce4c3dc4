#pragma once

/// \file
/// The types of Tight-Inclusion's interface: double, or float where TOUCHSTONE_TICCD_FLOAT is
/// defined (as that library when it is configured for single precision).

#include <Eigen/Core>

#include "tight_inclusion/config.hpp"

namespace ticcd {

#ifdef TIGHT_INCLUSION_WITH_DOUBLE_PRECISION
using Scalar = double;
#else
using Scalar = float;
#endif
using Vector3 = Eigen::Matrix<Scalar, 3, 1>;
using Array3 = Eigen::Array<Scalar, 3, 1>;

}  // namespace ticcd
