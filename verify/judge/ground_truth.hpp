#pragma once

/// \file
/// The truth about a query for comparisons with answers: the oracle's verdict
/// (touchstone/oracle.hpp) in doubles.

#include <cstdint>
#include <optional>
#include <string>

#include "touchstone/number.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::verify::judge {

/// The truth about one query.
struct GroundTruth {
  std::uint64_t index;
  bool collides;
  /// With a collision: the exact time of impact if it is a double, else the neighbouring doubles
  /// around it.
  std::optional<exact::DoubleInterval> toi;
};

/// The truth of query number `index` of its source from the oracle's verdict.
[[nodiscard]] GroundTruth truth_of(std::uint64_t index, const exact::Decision& verdict);

/// "no collision", "collision at 0.5" or "collision after 0.1 and before 0.2", both exclusive, so
/// that a time of impact that differs from the exact one by less than a spacing of doubles is
/// visibly wrong.
[[nodiscard]] std::string to_text(const GroundTruth& truth);

}  // namespace touchstone::verify::judge
