#include "verify/judge/ground_truth.hpp"

#include <fmt/format.h>

namespace touchstone::verify::judge {

GroundTruth truth_of(std::uint64_t index, const exact::Decision& verdict) {
  GroundTruth truth{.index = index, .collides = verdict.collides(), .toi = std::nullopt};
  if (truth.collides) truth.toi = verdict.toi->enclosure();
  return truth;
}

std::string to_text(const GroundTruth& truth) {
  if (!truth.collides) return "no collision";
  const auto [lower, upper] = truth.toi.value();
  return lower == upper ? fmt::format("collision at {}", lower)
                        : fmt::format("collision after {} and before {}", lower, upper);
}

}  // namespace touchstone::verify::judge
