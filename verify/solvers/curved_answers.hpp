#pragma once

/// \file
/// Answers of the methods that know queries on curves.

#include <cstddef>
#include <string_view>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/curved_query.hpp"

namespace touchstone::verify::solvers {

/// True for "certified" and "tight_inclusion".
[[nodiscard]] bool answers_curves(std::string_view method);
/// True for "certified", and for "tight_inclusion" if the degree is 2 or 3.
[[nodiscard]] bool answers_curves(std::string_view method, std::size_t degree);

/// The answers to all queries of a method that answers such curves. \param threads as many, 0: all
/// cores, for the method that can use them.
/// \throws std::invalid_argument for another method, or one that does not answer such queries.
[[nodiscard]] std::vector<fast::Answer> curved_answers(std::string_view method, Kind kind,
                                                       const CurvedQueries& queries,
                                                       const fast::MethodOptions& options,
                                                       unsigned threads);

}  // namespace touchstone::verify::solvers
