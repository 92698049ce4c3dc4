#pragma once

/// \file
/// All that a view says about one query: what it is, the oracle's verdict, time and place, a
/// certificate of it, how near the primitives come, and the answers of the solvers that were asked,
/// each held against the truth.

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/curved_query.hpp"
#include "touchstone/query.hpp"
#include "verify/judge/judgement.hpp"

namespace touchstone::verify::view {

/// A query to be looked at. Texts may hold any bytes.
struct ViewedQuery {
  std::string label;  ///< where it is from
  Kind kind = Kind::vertex_face;
  Query query{};  ///< finite
  /// In place of `query`, if the points move on curves: finite numbers, positive weights.
  std::optional<CurvedQuery> curves = std::nullopt;
  Separation separation = {};
  std::vector<std::string> notes = {};  ///< what is recorded of it, a sentence each
  std::vector<judge::GivenAnswer> answers = {};
  /// False: how near the primitives come without a collision, which takes longest, is left out.
  bool with_approach = true;
  /// A stream of one certificate; where it is empty, the oracle's own is shown.
  std::string certificate = {};
};

/// As the script of a page reads it, see verify/view/page/facts.js. Doubles are texts, in
/// hexadecimal, and rationals "P/Q". A query on curves has no nearest approach, and answers to it
/// are judged by verdict and times.
/// \param asked answers that were given now, to be shown behind the recorded ones
/// \throws std::domain_error if a number is NaN or infinite; std::invalid_argument if a curve or the
/// separation is not valid, or the text not a certificate.
[[nodiscard]] nlohmann::json query_facts(const ViewedQuery& viewed,
                                         std::span<const judge::GivenAnswer> asked);

}  // namespace touchstone::verify::view
