#include "verify/baselines/cubic.hpp"

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

Polynomial<3> coplanarity(Kind kind, const Query& query) {
  const auto [a, b, c, d] = motions_of(query);
  return kind == Kind::vertex_face ? dot(a - b, cross(c - b, d - b))
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

}  // namespace

fast::Answer cubic(Kind kind, const Query& query, const fast::MethodOptions& options) {
  for (const double t : candidate_times(coplanarity(kind, query))) {
    if (t > options.t_max) break;
    if (squared_distance_at(kind, query, t) <= options.tolerance * options.tolerance) {
      return {.verdict = fast::Verdict::yes, .toi_lower = t};
    }
  }
  return {.verdict = fast::Verdict::no};
}

std::unique_ptr<fast::Method> cubic_method() {
  return baseline_method({.name = "cubic",
                          .terms = {.times = fast::Times::estimates},
                          .reference = "provot1997",
                          .is_tolerance_driven = true},
                         cubic);
}

}  // namespace touchstone::baselines
