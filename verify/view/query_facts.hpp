#pragma once

/// \file
/// The contents of a view of one query: its points, the oracle's verdict, time and place, a
/// certificate, the nearest approach of the primitives, and the answers of the solvers that were
/// asked, each compared with the truth.

#include <nlohmann/json_fwd.hpp>
#include <span>

#include "verify/judge/judgement.hpp"
#include "verify/view/viewed_query.hpp"

namespace touchstone::verify::view {

/// The facts in the form that a page's script reads (verify/view/page/facts.js). Doubles are texts,
/// in hexadecimal, and rationals "P/Q". A query on curves has no nearest approach, and answers to
/// it are judged by verdict and times.
/// \param asked answers that were given now, to be shown behind the recorded ones
/// \pre answers, of either sort, only to a query in one shape
/// \throws std::domain_error if a number is NaN or infinite; std::invalid_argument if a curve or the
/// separation is not valid, or the text not a certificate.
[[nodiscard]] nlohmann::json query_facts(const ViewedQuery& viewed,
                                         std::span<const judge::GivenAnswer> asked);

}  // namespace touchstone::verify::view
