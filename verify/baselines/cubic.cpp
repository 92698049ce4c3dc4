// CUBIC: the zeros of the coplanarity cubic with a tolerance, as simulators of cloth run it
// ([provot1997]; the public ARCSim and El Topo).
//
// det = r·(p×q), a cubic in t, is 0 at a contact. Its zeros are computed in double precision
// (rpoly.hpp). *Filtered*: a zero whose imaginary part and distance from [0,1] are at most 1e-6
// counts, moved to the nearest time of [0,1]; t=0 and t=1 are added. The earliest of these times
// at which the primitives are within δ is the impact. δ is fast::MethodOptions::tolerance.
//
// **Promise.** None: nothing bounds the rounding. Times are estimates.
//
// **Known defects.**
//   - δ and the filter of zeros are absolute: a pass within δ is a false positive; where
//     coordinates are large, the primitives are farther apart than δ at the rounded zero, and the
//     contact is a false negative.
//   - Where all points move in one plane the cubic is 0 throughout, or consists of rounding
//   errors:
//     contacts between t=0 and t=1 are false negatives.
//   - A triple zero is computed as a cluster with a third of the digits.

#include "verify/baselines/baselines.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "verify/baselines/method_support.hpp"
#include "verify/baselines/moving_polynomials.hpp"
#include "verify/baselines/rpoly.hpp"

namespace touchstone::baselines {
namespace {

/// Zeros count up to this distance from [0,1], and with an imaginary part of at most this.
constexpr double zero_tolerance = 1e-6;

Polynomial<3> coplanarity(ContactKind kind, const Query& query) {
  const auto [a, b, c, d] = motions_of(query);
  return kind == ContactKind::vertex_face ? dot(a - b, cross(c - b, d - b))
                                          : dot(c - a, cross(b - a, d - c));
}

/// The filtered zeros, and both ends, in ascending order.
std::vector<double> candidate_times(const Polynomial<3>& f) {
  std::vector<double> times{0.0, 1.0};
  const auto coefficients = descending(f);
  const auto left = without_leading_zeros(coefficients);
  if (!left.empty()) {
    for (const Zero& zero : zeros_of(left)) {
      const double t = std::clamp(zero.re, 0.0, 1.0);
      const double off = std::max(std::abs(zero.im), std::abs(zero.re - t));
      if (off <= zero_tolerance) times.push_back(t);
    }
  }
  std::ranges::sort(times);
  return times;
}

fast::Answer cubic(ContactKind kind, const Query& query, const fast::MethodOptions& options) {
  for (const double t : candidate_times(coplanarity(kind, query))) {
    if (t > options.t_max) break;
    if (squared_distance_at(kind, query, t) <= options.tolerance * options.tolerance) {
      return {.verdict = fast::Verdict::yes, .toi_lower = t};
    }
  }
  return {.verdict = fast::Verdict::no};
}

}  // namespace

std::unique_ptr<fast::Method> cubic_method() {
  return baseline_method({.name = "cubic",
                          .terms = {.times = fast::Times::estimates},
                          .reference = "provot1997",
                          .is_tolerance_driven = true},
                         on_lines<cubic>);
}

}  // namespace touchstone::baselines
