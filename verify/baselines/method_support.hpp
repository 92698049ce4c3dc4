#pragma once

/// \file
/// Common parts of the baselines as methods: which queries they refuse, the
/// floating-point state they run under, and the rule of the benchmark's harness that whatever a
/// method throws counts as a collision. ([wang2021]: CCD-Wrapper.)

#include <Eigen/Core>

#include <cfenv>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "exact/query.hpp"
#include "fast/method.hpp"

namespace touchstone::baselines {

/// While it lives, this thread rounds to nearest, in x87 and SSE registers alike, keeps subnormals
/// and traps nothing. Then the caller's state is back. Boost.Interval saves the mode of the former
/// and restores it to both, so that fast::StrictFloatingPoint, which sets SSE's, is not enough.
class NearestRounding {
 public:
  NearestRounding();
  ~NearestRounding();
  NearestRounding(const NearestRounding&) = delete;
  NearestRounding& operator=(const NearestRounding&) = delete;
  NearestRounding(NearestRounding&&) = delete;
  NearestRounding& operator=(NearestRounding&&) = delete;

 private:
  std::fenv_t callers_;
};

/// A method as a function of one query. It is called with finite coordinates and options that
/// are_valid(), rounding to nearest.
using AnswerFunction = fast::Answer (*)(Kind kind, const Query& query,
                                        const fast::MethodOptions& options);

/// Are the tolerance positive and finite, the separation finite and not negative, and t_max in
/// [0,1]?
[[nodiscard]] bool are_valid(const fast::MethodOptions& options);

/// As many steps as an answer can say.
[[nodiscard]] std::uint32_t to_checks(std::int64_t steps);

/// Where a point of the query is at time t, as most baselines compute it: start + t (end − start).
[[nodiscard]] Eigen::Vector3d position_at(const Query& query, std::size_t point, double t);

/// The baseline of that description (is_baseline is set) as a fast::Method. Its answer is
/// fast::Verdict::error for coordinates that are not finite and options that are not valid, and yes,
/// without times, where the function throws.
[[nodiscard]] std::unique_ptr<fast::Method> baseline_method(fast::MethodInfo info,
                                                            AnswerFunction answer);

}  // namespace touchstone::baselines
