#pragma once

/// \file
/// The contents of a certificate for a view: its query, and the subintervals of time with their
/// separating directions. The checker (exact/checker/) reads and checks it, also if another program
/// wrote it.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "verify/view/viewed_query.hpp"

namespace touchstone::verify::view {

/// The only certificate of a stream with its query, under its own label.
/// \throws std::invalid_argument if the text is not a certificate, or a coordinate, a weight or
/// the distance is not a double.
[[nodiscard]] ViewedQuery certified_query(std::string stream);

/// An object of `claim`, `accepted`, `reason` (of the checker, if rejected), `subintervals`, a list
/// of `from`, `to` (rationals as text) and `feature` ("edge 0 1"), and `text`, the stream. \throws
/// as above
[[nodiscard]] nlohmann::json certificate_facts(const std::string& stream);

}  // namespace touchstone::verify::view
