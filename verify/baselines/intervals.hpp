#pragma once

/// \file
/// Closed intervals of doubles with outward rounding (Boost.Interval), and what IRF and UIRF
/// compute with them: points on their way.
///
/// **Theorem.** Replace each operation of an expression by one on intervals that holds all results
/// of operands from the intervals; then the result holds all values of the expression [moore1966].
/// So an interval that excludes 0 proves that the expression has no zero.
///
/// The rounding mode is switched before each operation and put back after it: the policy that Boost
/// calls save-state, standard. Its own class for it writes the operation once for each mode and
/// relies on the compiler to execute both; GCC merges them even under -frounding-math. So here
/// operands are read from volatile memory after each switch, and the result written there before
/// the next.

#include <array>
#include <boost/numeric/interval.hpp>
#include <cstddef>

#include "exact/query.hpp"

namespace touchstone::baselines {

/// Directed rounding, for Boost.Interval. Round to nearest must be the mode outside.
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

/// May the interval hold 0? An interval that is not a number may.
[[nodiscard]] inline bool may_be_zero(const Interval& x) {
  return !(x.lower() > 0.0) && !(x.upper() < 0.0);
}

[[nodiscard]] IntervalVector minus(const IntervalVector& a, const IntervalVector& b);
[[nodiscard]] IntervalVector cross(const IntervalVector& a, const IntervalVector& b);
[[nodiscard]] Interval dot(const IntervalVector& a, const IntervalVector& b);

/// start + parameter (end − start)
[[nodiscard]] IntervalVector between(const IntervalVector& start, const IntervalVector& end,
                                     const Interval& parameter);

/// The four points of a query on their way.
class IntervalMotion {
 public:
  explicit IntervalMotion(const Query& query);

  /// Where they are at the times of t: displacement × t + start.
  [[nodiscard]] std::array<IntervalVector, moving_points> at(const Interval& t) const;

 private:
  std::array<IntervalVector, moving_points> start_;
  std::array<IntervalVector, moving_points> displacement_;
};

/// The greatest Euclidean distance that a point of the query goes, rounded.
[[nodiscard]] double greatest_displacement(const Query& query);

}  // namespace touchstone::baselines
