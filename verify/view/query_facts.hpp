#pragma once

/// \file
/// The contents of a view of one query: its points, the oracle's verdict, time and place, a
/// certificate, the nearest approach of the primitives, and the answers of the solvers that were
/// asked, each compared with the truth.

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>

#include "touchstone/algebraic_number.hpp"
#include "touchstone/any_kind.hpp"
#include "verify/judge/judgement.hpp"
#include "verify/view/viewed_query.hpp"

namespace touchstone::verify::view {

/// The facts in the form that a page's script reads (verify/view/page/facts.js). Doubles are texts,
/// in hexadecimal, and rationals "P/Q". A query on curves has no nearest approach, and answers to
/// it are judged by verdict and times.
/// \param asked answers that were given now, to be shown behind the recorded ones
/// \throws std::domain_error if a number is NaN or infinite; std::invalid_argument if a curve or
/// the separation is not valid, or the text not a certificate.
[[nodiscard]] nlohmann::json query_facts(const ViewedQuery& viewed,
                                         std::span<const judge::GivenAnswer> asked);

// The least distance of the primitives of a query without collision, decided by the oracle.
//
// The query collides at distance d in L2 iff the least distance is at most d (docs/theory.md,
// section 1.4), so bisection over the doubles encloses it between two neighbouring ones. The time
// of impact at the upper one is the first time with at most that distance.

/// The least distance in L2 over t ∈ [0,1].
struct NearestApproach {
  double above = 0.0;    ///< a lower bound, exclusive, ≥ 0
  double at_most = 0.0;  ///< the next double, an upper bound
  /// The first time with a distance of at most `at_most`.
  exact::AlgebraicNumber time;
};

/// Empty if the query collides, or the distance is greater than every double.
/// \throws std::domain_error if a coordinate is NaN or infinite.
[[nodiscard]] std::optional<NearestApproach> nearest_approach(ContactKind kind, const Query& query);

// The contents of a certificate for a view: its query, and the subintervals of time with their
// separating directions. The checker (exact/checker/) reads and checks it, also if another program
// wrote it.

/// The only certificate of a stream with its query, under its own label.
/// \throws std::invalid_argument if the text is not a certificate, a coordinate, a weight or the
/// distance is not a double, or curves that are not constant differ in degree.
[[nodiscard]] ViewedQuery certified_query(std::string stream);

/// An object of `claim`, `accepted`, `reason` (of the checker, if rejected), `subintervals`, a list
/// of `from`, `to` (rationals as text) and `feature` ("edge 0 1"), and `text`, the stream. \throws
/// as above
[[nodiscard]] nlohmann::json certificate_facts(const std::string& stream);

}  // namespace touchstone::verify::view
