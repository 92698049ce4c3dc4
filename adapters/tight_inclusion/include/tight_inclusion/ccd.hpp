#pragma once

/// \file
/// The interface of Tight-Inclusion (its `tight_inclusion/ccd.hpp`), answered by the certified
/// solver.
///
/// A program that includes that header and links `touchstone::tight_inclusion_adapter` finds this
/// one instead, without a change. Answers are exact, so some arguments have no meaning here:
///
/// | argument | here |
/// |---|---|
/// | the points | at t=0, then at t=1; floats are exact in double |
/// | `err` | no meaning: error bounds are derived for each query |
/// | `ms` | minimum separation, in L∞ as there: within it on all axes is contact |
/// | `toi` | with true a lower bound of the time of impact, by at most 1e-12 of it: 0 only if contact is at t=0 (or before the smallest positive number); with false infinity |
/// | `tolerance` | no meaning |
/// | `t_max` | only contacts up to this time count, in [0,1]: exactly these |
/// | `max_itr` | no meaning: there is no limit |
/// | `output_tolerance` | is set to `tolerance`, which is kept |
/// | `no_zero_toi` | no meaning: it always holds (see `toi`) |
/// | `ccd_method` | no meaning |
///
/// The tolerances of the parameters in that library's search are computed as in [wang2021], section
/// 4.2; the functions that decide queries do not need them.
///
/// A query with a coordinate that is NaN or infinite is a collision at 0, so that nothing moves.
/// All functions are thread-safe.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "tight_inclusion/config.hpp"
#include "tight_inclusion/types.hpp"
#include "touchstone/certified.hpp"

namespace ticcd {

inline constexpr bool DEFAULT_NO_ZERO_TOI = false;
constexpr Scalar DEFAULT_CCD_DISTANCE_TOL = static_cast<Scalar>(1e-6);

enum class CCDRootFindingMethod { DEPTH_FIRST_SEARCH, BREADTH_FIRST_SEARCH };

namespace touchstone_adapter {

inline touchstone::fast::CertifiedOptions options(Scalar ms, Scalar t_max) {
  return {.t_max = touchstone::to_double(t_max),
          .separation = {.distance = touchstone::to_double(ms), .norm = touchstone::Norm::linf}};
}

template <class Number>
Number rounded_down(double x) {
  const auto rounded = static_cast<Number>(x);
  return static_cast<double>(rounded) > x ? std::nextafter(rounded, Number{0}) : rounded;
}

inline bool take(const touchstone::fast::CertifiedResult& result, Scalar& toi, Scalar tolerance,
                 Scalar& output_tolerance) {
  output_tolerance = tolerance;
  switch (result.verdict) {
    case touchstone::fast::Verdict::no:
      toi = std::numeric_limits<Scalar>::infinity();
      return false;
    case touchstone::fast::Verdict::yes:
      toi = rounded_down<Scalar>(result.toi_lower);
      return true;
    default:
      toi = 0;
      return true;
  }
}

/// F at the corners of the domain, numbered by the binary digits t, u, v.
using Corners = std::array<Vector3, 8>;

/// The widths of intervals of t, of u and of v such that F varies by at most the tolerance over a
/// box of three such intervals: by a third of it for each. F is affine in each, so its greatest
/// rate of change is that along an edge of the domain.
inline Array3 tolerances(const Corners& corners, Scalar distance_tolerance) {
  Array3 result;
  for (std::size_t parameter = 0; parameter < 3; ++parameter) {
    const std::size_t digit = std::size_t{4} >> parameter;
    Scalar greatest = 0;
    for (std::size_t corner = 0; corner < 8; ++corner) {
      if ((corner & digit) != 0) continue;
      const Vector3 change = corners[corner + digit] - corners[corner];
      greatest = (std::max)(greatest, change.cwiseAbs().maxCoeff());
    }
    result[static_cast<Eigen::Index>(parameter)] = greatest == 0
                                                       ? std::numeric_limits<Scalar>::infinity()
                                                       : distance_tolerance / (3 * greatest);
  }
  return result;
}

}  // namespace touchstone_adapter

/// Decides whether two edges collide. \throws std::invalid_argument if `ms` or `t_max` is out of
/// range.
inline bool edgeEdgeCCD(
    const Vector3& ea0_t0, const Vector3& ea1_t0, const Vector3& eb0_t0, const Vector3& eb1_t0,
    const Vector3& ea0_t1, const Vector3& ea1_t1, const Vector3& eb0_t1, const Vector3& eb1_t1,
    const Array3& /*err*/, const Scalar ms, Scalar& toi, const Scalar tolerance, const Scalar t_max,
    const long /*max_itr*/, Scalar& output_tolerance, bool /*no_zero_toi*/ = DEFAULT_NO_ZERO_TOI,
    const CCDRootFindingMethod /*ccd_method*/ = CCDRootFindingMethod::BREADTH_FIRST_SEARCH) {
  return touchstone_adapter::take(
      touchstone::fast::solve_edge_edge(ea0_t0, ea1_t0, eb0_t0, eb1_t0, ea0_t1, ea1_t1, eb0_t1,
                                        eb1_t1, touchstone_adapter::options(ms, t_max)),
      toi, tolerance, output_tolerance);
}

/// Decides whether a vertex and a face collide. \throws std::invalid_argument if `ms` or `t_max` is
/// out of range.
inline bool vertexFaceCCD(
    const Vector3& v_t0, const Vector3& f0_t0, const Vector3& f1_t0, const Vector3& f2_t0,
    const Vector3& v_t1, const Vector3& f0_t1, const Vector3& f1_t1, const Vector3& f2_t1,
    const Array3& /*err*/, const Scalar ms, Scalar& toi, const Scalar tolerance, const Scalar t_max,
    const long /*max_itr*/, Scalar& output_tolerance, bool /*no_zero_toi*/ = DEFAULT_NO_ZERO_TOI,
    const CCDRootFindingMethod /*ccd_method*/ = CCDRootFindingMethod::BREADTH_FIRST_SEARCH) {
  return touchstone_adapter::take(
      touchstone::fast::solve_vertex_face(v_t0, f0_t0, f1_t0, f2_t0, v_t1, f0_t1, f1_t1, f2_t1,
                                          touchstone_adapter::options(ms, t_max)),
      toi, tolerance, output_tolerance);
}

/// The widths of intervals of t, u and v over which F varies by at most `distance_tolerance`;
/// infinity for parameters without influence on F.
inline Array3 compute_edge_edge_tolerances(
    const Vector3& ea0_t0, const Vector3& ea1_t0, const Vector3& eb0_t0, const Vector3& eb1_t0,
    const Vector3& ea0_t1, const Vector3& ea1_t1, const Vector3& eb0_t1, const Vector3& eb1_t1,
    const Scalar distance_tolerance = DEFAULT_CCD_DISTANCE_TOL) {
  return touchstone_adapter::tolerances(
      {ea0_t0 - eb0_t0, ea0_t0 - eb1_t0, ea1_t0 - eb0_t0, ea1_t0 - eb1_t0, ea0_t1 - eb0_t1,
       ea0_t1 - eb1_t1, ea1_t1 - eb0_t1, ea1_t1 - eb1_t1},
      distance_tolerance);
}

/// The same for a vertex and a face.
inline Array3 compute_vertex_face_tolerances(
    const Vector3& v_t0, const Vector3& f0_t0, const Vector3& f1_t0, const Vector3& f2_t0,
    const Vector3& v_t1, const Vector3& f0_t1, const Vector3& f1_t1, const Vector3& f2_t1,
    const Scalar distance_tolerance = DEFAULT_CCD_DISTANCE_TOL) {
  return touchstone_adapter::tolerances(
      {v_t0 - f0_t0, v_t0 - f2_t0, v_t0 - f1_t0, v_t0 - (f1_t0 + f2_t0 - f0_t0), v_t1 - f0_t1,
       v_t1 - f2_t1, v_t1 - f1_t1, v_t1 - (f1_t1 + f2_t1 - f0_t1)},
      distance_tolerance);
}

/// The name before version 1.0.4.
inline Array3 compute_face_vertex_tolerances(
    const Vector3& v_t0, const Vector3& f0_t0, const Vector3& f1_t0, const Vector3& f2_t0,
    const Vector3& v_t1, const Vector3& f0_t1, const Vector3& f1_t1, const Vector3& f2_t1,
    const Scalar distance_tolerance = DEFAULT_CCD_DISTANCE_TOL) {
  return compute_vertex_face_tolerances(v_t0, f0_t0, f1_t0, f2_t0, v_t1, f0_t1, f1_t1, f2_t1,
                                        distance_tolerance);
}

/// The size of the queue: 0, because there is none.
inline long return_queue_size() { return 0; }

}  // namespace ticcd
