#pragma once

/// \file
/// The names of separations in reports, and conclusions from a claim about one separation
/// about another.
///
/// Contact at distance d is contact at any d' ≥ d, and ‖x‖∞ ≤ ‖x‖₂; so a recorded collision, and
/// the time up to which it happened, stay true at a greater distance in the same norm and from L2
/// to L∞, and at distance 0 the norm does not matter. A recorded "no collision" says nothing about
/// greater distances.

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>

#include "touchstone/query.hpp"

namespace touchstone::verify::judge {

/// True if both are equivalent.
[[nodiscard]] bool same_separation(const Separation& a, const Separation& b);

/// Conclusions from claims about one separation about another.
enum class Inference : std::uint8_t {
  all,         ///< the same separation
  collisions,  ///< a collision is also one there, and no later
  nothing,
};

/// The conclusion from a claim about `claimed` about `asked`.
[[nodiscard]] Inference infer(const Separation& claimed, const Separation& asked);

/// The common separation of a list, if there is one.
[[nodiscard]] std::optional<Separation> common_separation(std::span<const Separation> all);

/// "1e-08 (l2)", with the digits that reproduce the double.
[[nodiscard]] std::string to_text(const Separation& separation);

/// An object of `min_separation`, a number, and `norm`, "linf" or "l2".
[[nodiscard]] nlohmann::json to_json(const Separation& separation);

}  // namespace touchstone::verify::judge
