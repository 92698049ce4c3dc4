#pragma once

/// \file
/// Common parts of the baselines as methods: the queries that they reject, and the rule of the
/// benchmark's harness that an exception of a method counts as a collision. ([wang2021]:
/// CCD-Wrapper.)

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <memory>

#include "fast/method.hpp"
#include "touchstone/any_kind.hpp"

namespace touchstone::baselines {

/// A method as a function of query i, of a shape that its terms name. It is called with finite
/// coordinates and options that are_valid(), rounding to nearest.
using AnswerFunction = fast::Answer (*)(const AnyQueries& queries, std::size_t i,
                                        const fast::MethodOptions& options);

/// That of a method for contacts, or for cells, on straight lines.
template <fast::Answer (*answer)(ContactKind, const Query&, const fast::MethodOptions&)>
fast::Answer on_lines(const AnyQueries& queries, std::size_t i,
                      const fast::MethodOptions& options) {
  return answer(queries.kind.contact(), queries.straight()[i], options);
}
template <fast::Answer (*answer)(CellKind, const Query&, const fast::MethodOptions&)>
fast::Answer on_lines(const AnyQueries& queries, std::size_t i,
                      const fast::MethodOptions& options) {
  return answer(queries.kind.cell(), queries.straight()[i], options);
}

/// True if the tolerance is positive and finite, the separation finite and not negative, and t_max
/// in [0,1].
[[nodiscard]] bool are_valid(const fast::MethodOptions& options);

/// Saturates a number of steps at the maximum of an answer.
[[nodiscard]] std::uint32_t to_checks(std::int64_t steps);

/// The position of a point of the query at time t, as most baselines compute it: start + t (end −
/// start).
[[nodiscard]] Eigen::Vector3d position_at(const Query& query, std::size_t point, double t);

/// The squared distance of a query's primitives at time t, from their closest points
/// (closest_features.hpp).
[[nodiscard]] double squared_distance_at(ContactKind kind, const Query& query, double t);

/// The baseline of that description (is_baseline is set) as a fast::Method. Its answer is
/// fast::Verdict::error for coordinates that are not finite and options that are not valid, and
/// yes, without times, if the function throws.
[[nodiscard]] std::unique_ptr<fast::Method> baseline_method(fast::MethodInfo info,
                                                            AnswerFunction answer);

}  // namespace touchstone::baselines
