#pragma once

/// \file
/// The public Tight-Inclusion as far as a standalone program calls it: declarations of the same signatures, to compile
/// against.

#include <Eigen/Core>

namespace ticcd {

using Scalar = double;
using Vector3 = Eigen::Vector3d;
using Array3 = Eigen::Array3d;

bool edgeEdgeCCD(const Vector3& ea0_t0, const Vector3& ea1_t0, const Vector3& eb0_t0,
                 const Vector3& eb1_t0, const Vector3& ea0_t1, const Vector3& ea1_t1,
                 const Vector3& eb0_t1, const Vector3& eb1_t1, const Array3& err, Scalar ms,
                 Scalar& toi, Scalar tolerance, Scalar t_max, long max_itr,
                 Scalar& output_tolerance, bool no_zero_toi = false);

bool vertexFaceCCD(const Vector3& v_t0, const Vector3& f0_t0, const Vector3& f1_t0,
                   const Vector3& f2_t0, const Vector3& v_t1, const Vector3& f0_t1,
                   const Vector3& f1_t1, const Vector3& f2_t1, const Array3& err, Scalar ms,
                   Scalar& toi, Scalar tolerance, Scalar t_max, long max_itr,
                   Scalar& output_tolerance, bool no_zero_toi = false);

}  // namespace ticcd
