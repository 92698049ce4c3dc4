#pragma once

/// \file
/// Common parts of the baselines as methods: the queries that they reject, their
/// floating-point state, and the rule of the benchmark's harness that an exception of a method
/// counts as a collision. ([wang2021]: CCD-Wrapper.)

#include <Eigen/Core>

#include <cfenv>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "fast/method.hpp"
#include "touchstone/query.hpp"
#include "verify/generate/random_stream.hpp"

namespace touchstone::baselines {

/// During its lifetime this thread rounds to nearest, in x87 and SSE registers, keeps subnormals
/// and has no traps. The destructor restores the caller's state. Boost.Interval saves the mode of
/// x87 and restores it to both, so fast::StrictFloatingPoint, which sets the mode of SSE, is not
/// enough.
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
/// The same as a verdict alone, of a method that ignores all options.
using VerdictFunction = bool (*)(Kind kind, const Query& query);
/// The same of query i, of any shape that the method's terms name.
using AnyAnswerFunction = fast::Answer (*)(const Queries& queries, std::size_t i,
                                           const fast::MethodOptions& options);

/// True if the tolerance is positive and finite, the separation finite and not negative, and t_max
/// in [0,1].
[[nodiscard]] bool are_valid(const fast::MethodOptions& options);

using Random = verify::generate::Random;

/// The stream of a method that tries random directions. Its seed is the query's own bits, so a
/// query gets the same answer every time, in any order and in any thread.
[[nodiscard]] Random random_of(const Query& query);

/// Saturates a number of steps at the maximum of an answer.
[[nodiscard]] std::uint32_t to_checks(std::int64_t steps);

/// The position of a point of the query at time t, as most baselines compute it: start + t (end −
/// start).
[[nodiscard]] Eigen::Vector3d position_at(const Query& query, std::size_t point, double t);

/// The squared distance of a query's primitives at time t, from their closest points
/// (closest_features.hpp).
[[nodiscard]] double squared_distance_at(Kind kind, const Query& query, double t);

/// The baseline of that description (is_baseline is set) as a fast::Method. Its answer is
/// fast::Verdict::error for coordinates that are not finite and options that are not valid, and
/// yes, without times, if the function throws. That rule of the harness decides most answers of
/// some methods (bsc.cpp).
[[nodiscard]] std::unique_ptr<fast::Method> baseline_method(fast::MethodInfo info,
                                                            AnswerFunction answer);
[[nodiscard]] std::unique_ptr<fast::Method> baseline_method(fast::MethodInfo info,
                                                            VerdictFunction collides);
[[nodiscard]] std::unique_ptr<fast::Method> baseline_method(fast::MethodInfo info,
                                                            AnyAnswerFunction answer);

}  // namespace touchstone::baselines
