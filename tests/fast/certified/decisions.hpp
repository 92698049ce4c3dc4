#pragma once

/// \file
/// Queries of integers as motions, for the tests of decisions.

#include <cstddef>
#include <cstdint>

#include "fast/certified/exact/contact_conditions.hpp"
#include "fast/certified/exact/general_contact_decision.hpp"
#include "tests/support/queries.hpp"

namespace touchstone::tests {

/// r, p and q of a query with integer coordinates, times a power of two; all below 2^63.
template <class Number>
[[nodiscard]] fast::exact_stage::Motion<Number> integer_motion(const PosedQuery& posed,
                                                               double scale = 1.0) {
  fast::exact_stage::Motion<Number> motion{posed.kind, {}, {}, {}, {}};
  const auto line = [&](std::size_t a, std::size_t b, std::size_t k) {
    const auto at = [&](std::size_t end) {
      const double difference = posed.query.at(end, a, k) - posed.query.at(end, b, k);
      return Number(static_cast<std::int64_t>(difference * scale));
    };
    return fast::exact_stage::Form<Number, 1>{at(0), at(1)};
  };
  const bool face = posed.kind == Kind::vertex_face;
  for (std::size_t k = 0; k < 3; ++k) {
    motion.r[k] = face ? line(0, 1, k) : line(0, 2, k);
    motion.p[k] = face ? line(2, 1, k) : line(0, 1, k);
    motion.q[k] = face ? line(3, 1, k) : line(3, 2, k);
  }
  return motion;
}

}  // namespace touchstone::tests
