#pragma once

/// \file
/// What a certificate says, for a picture of it: its query, and the pieces of time with their separating directions. It is
/// read and checked by the checker (exact/checker/), whoever wrote it.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "exact/query.hpp"

namespace touchstone::verify::view {

/// The query of a certificate.
struct CertifiedQuery {
  Kind kind = Kind::vertex_face;
  Query query{};
  Separation separation{};
  std::string label;
};

/// The query of the one certificate of a stream.
/// \throws std::invalid_argument if the text is no certificate, or a coordinate or the distance is no
/// double.
[[nodiscard]] CertifiedQuery certified_query(std::string_view stream);

/// An object of `claim`, `accepted`, `reason` (of the checker, where it is not), `pieces`, a list of `from`, `to` (rationals
/// as text) and `feature` ("edge 0 1"), and `text`, the stream. \throws as above
[[nodiscard]] nlohmann::json certificate_facts(const std::string& stream);

}  // namespace touchstone::verify::view
