#pragma once

/// \file
/// Closed intervals of doubles with outward rounding (Boost.Interval), and the moving points
/// of IRF and UIRF.
///
/// **Theorem.** Replace each operation of an expression by one on intervals whose result contains
/// all results for operands from the intervals; then the result contains all values of the
/// expression [moore1966]. An interval that excludes 0 therefore proves that the expression has no
/// zero.
///
/// The rounding mode is switched before each operation and restored after it: the policy that Boost
/// calls save-state, standard. Boost's own class for this policy contains the operation once for
/// each mode and relies on the compiler to execute both, but GCC merges them even with
/// -frounding-math. Therefore operands are read from volatile memory after each switch, and the
/// result written there before the next.

#include <array>
#include <boost/numeric/interval.hpp>

#include "touchstone/query.hpp"

namespace touchstone::baselines {

/// Directed rounding, for Boost.Interval. Outside, the mode must be round to nearest.
struct DirectedArithmetic : boost::numeric::interval_lib::rounding_control<double> {
  using Control = boost::numeric::interval_lib::rounding_control<double>;

  /// The same number, unknown to the compiler.
  static double opaque(const double& x) {
    const volatile double memory = x;
    return memory;
  }

  static void init() {}
  static double add_down(const double& x, const double& y) {
    downward();
    return force_rounding(opaque(x) + opaque(y));
  }
  static double add_up(const double& x, const double& y) {
    upward();
    return force_rounding(opaque(x) + opaque(y));
  }
  static double sub_down(const double& x, const double& y) {
    downward();
    return force_rounding(opaque(x) - opaque(y));
  }
  static double sub_up(const double& x, const double& y) {
    upward();
    return force_rounding(opaque(x) - opaque(y));
  }
  static double mul_down(const double& x, const double& y) {
    downward();
    return force_rounding(opaque(x) * opaque(y));
  }
  static double mul_up(const double& x, const double& y) {
    upward();
    return force_rounding(opaque(x) * opaque(y));
  }
  static double median(const double& x, const double& y) {
    to_nearest();
    return force_rounding((opaque(x) + opaque(y)) / 2.0);
  }
};

/// Overflow gives infinity.
using Interval =
    boost::numeric::interval<double,
                             boost::numeric::interval_lib::policies<
                                 boost::numeric::interval_lib::save_state<DirectedArithmetic>,
                                 boost::numeric::interval_lib::checking_base<double>>>;

using IntervalVector = std::array<Interval, 3>;

/// True if the interval may contain 0, as an interval that is NaN may.
[[nodiscard]] inline bool may_be_zero(const Interval& x) {
  return !(x.lower() > 0.0) && !(x.upper() < 0.0);
}

[[nodiscard]] IntervalVector minus(const IntervalVector& a, const IntervalVector& b);
[[nodiscard]] IntervalVector cross(const IntervalVector& a, const IntervalVector& b);
[[nodiscard]] Interval dot(const IntervalVector& a, const IntervalVector& b);

/// start + parameter (end − start)
[[nodiscard]] IntervalVector between(const IntervalVector& start, const IntervalVector& end,
                                     const Interval& parameter);

/// The four moving points of a query.
class IntervalMotion {
 public:
  explicit IntervalMotion(const Query& query);

  /// Their positions at the times of t: displacement × t + start.
  [[nodiscard]] std::array<IntervalVector, moving_points> at(const Interval& t) const;

 private:
  std::array<IntervalVector, moving_points> start_;
  std::array<IntervalVector, moving_points> displacement_;
};

/// The greatest Euclidean displacement of a point of the query, rounded.
[[nodiscard]] double greatest_displacement(const Query& query);

}  // namespace touchstone::baselines
