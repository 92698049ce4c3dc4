#pragma once

/// \file
/// The interface of Tight-Inclusion (its `tight_inclusion/ccd.hpp`), answered by the certified solver.
///
/// A program that includes that header finds this one instead once it links `touchstone::tight_inclusion_adapter`, and
/// needs no change. Answers are exact, so some arguments have no meaning here:
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
/// A query with a coordinate that is NaN or infinite is a collision at 0: nothing can be said of it, so nothing may move.
/// Both functions may be called from several threads at once.

#include <cmath>
#include <limits>

#include "adapters/tight_inclusion/types.hpp"
#include "fast/primitive_pairs.hpp"

namespace ticcd {

inline constexpr bool DEFAULT_NO_ZERO_TOI = false;

enum class CCDRootFindingMethod { DEPTH_FIRST_SEARCH, BREADTH_FIRST_SEARCH };

namespace touchstone_adapter {

inline touchstone::fast::CertifiedOptions options(Scalar ms, Scalar t_max) {
  return {.t_max = static_cast<double>(t_max),
          .separation = {.distance = static_cast<double>(ms), .norm = touchstone::Norm::linf}};
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

}  // namespace touchstone_adapter

/// Do two edges collide? \throws std::invalid_argument if `ms` or `t_max` is out of range.
inline bool edgeEdgeCCD(
    const Vector3& ea0_t0, const Vector3& ea1_t0, const Vector3& eb0_t0, const Vector3& eb1_t0,
    const Vector3& ea0_t1, const Vector3& ea1_t1, const Vector3& eb0_t1, const Vector3& eb1_t1,
    const Array3& /*err*/, const Scalar ms, Scalar& toi, const Scalar tolerance, const Scalar t_max,
    const long /*max_itr*/, Scalar& output_tolerance, bool /*no_zero_toi*/ = DEFAULT_NO_ZERO_TOI,
    const CCDRootFindingMethod /*ccd_method*/ = CCDRootFindingMethod::BREADTH_FIRST_SEARCH) {
  return touchstone_adapter::take(
      touchstone::fast::edge_edge(ea0_t0, ea1_t0, eb0_t0, eb1_t0, ea0_t1, ea1_t1, eb0_t1, eb1_t1,
                                  touchstone_adapter::options(ms, t_max)),
      toi, tolerance, output_tolerance);
}

/// Do a vertex and a face collide? \throws std::invalid_argument if `ms` or `t_max` is out of range.
inline bool vertexFaceCCD(
    const Vector3& v_t0, const Vector3& f0_t0, const Vector3& f1_t0, const Vector3& f2_t0,
    const Vector3& v_t1, const Vector3& f0_t1, const Vector3& f1_t1, const Vector3& f2_t1,
    const Array3& /*err*/, const Scalar ms, Scalar& toi, const Scalar tolerance, const Scalar t_max,
    const long /*max_itr*/, Scalar& output_tolerance, bool /*no_zero_toi*/ = DEFAULT_NO_ZERO_TOI,
    const CCDRootFindingMethod /*ccd_method*/ = CCDRootFindingMethod::BREADTH_FIRST_SEARCH) {
  return touchstone_adapter::take(
      touchstone::fast::point_triangle(v_t0, f0_t0, f1_t0, f2_t0, v_t1, f0_t1, f1_t1, f2_t1,
                                       touchstone_adapter::options(ms, t_max)),
      toi, tolerance, output_tolerance);
}

}  // namespace ticcd
