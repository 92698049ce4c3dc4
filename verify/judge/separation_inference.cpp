#include "verify/judge/separation_inference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace touchstone::verify::judge {

bool same_separation(const Separation& a, const Separation& b) {
  return a == b || (is_zero(a) && is_zero(b));
}

Inference infer(const Separation& claimed, const Separation& asked) {
  if (same_separation(claimed, asked)) return Inference::all;
  const bool norm_allows =
      is_zero(claimed) || claimed.norm == asked.norm || claimed.norm == Norm::l2;
  const bool follows = norm_allows && claimed.distance <= asked.distance;
  return follows ? Inference::collisions : Inference::nothing;
}

std::optional<Separation> common_separation(std::span<const Separation> all) {
  if (all.empty()) return std::nullopt;
  const bool is_one = std::ranges::all_of(
      all, [&](const Separation& other) { return same_separation(other, all.front()); });
  return is_one ? std::optional(all.front()) : std::nullopt;
}

std::string to_text(const Separation& separation) {
  return fmt::format("{} ({})", separation.distance, to_string(separation.norm));
}

nlohmann::json to_json(const Separation& separation) {
  return {{"min_separation", separation.distance}, {"norm", to_string(separation.norm)}};
}

}  // namespace touchstone::verify::judge
