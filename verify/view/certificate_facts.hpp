#pragma once

/// \file
/// The contents of a certificate for a view: its query, and the subintervals of time with their
/// separating directions. The checker (exact/checker/) reads and checks it, also if another program
/// wrote it.

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "touchstone/curved_query.hpp"
#include "touchstone/query.hpp"

namespace touchstone::verify::view {

/// The query of a certificate.
struct CertifiedQuery {
  Kind kind = Kind::vertex_face;
  Query query{};
  /// In place of `query`, if the points move on curves.
  std::optional<CurvedQuery> curves = std::nullopt;
  Separation separation{};
  std::string label;
};

/// The query of the only certificate of a stream.
/// \throws std::invalid_argument if the text is not a certificate, or a coordinate, a weight or
/// the distance is not a double.
[[nodiscard]] CertifiedQuery certified_query(std::string_view stream);

/// An object of `claim`, `accepted`, `reason` (of the checker, if rejected), `subintervals`, a list
/// of `from`, `to` (rationals as text) and `feature` ("edge 0 1"), and `text`, the stream. \throws
/// as above
[[nodiscard]] nlohmann::json certificate_facts(const std::string& stream);

}  // namespace touchstone::verify::view
