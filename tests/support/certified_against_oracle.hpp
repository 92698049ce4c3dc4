#pragma once

/// \file
/// Comparison of a result of the certified solver with the oracle: all that the solver promises.

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "touchstone/certified.hpp"
#include "touchstone/number.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::tests {

/// The sign of toi − x.
[[nodiscard]] inline int compare(exact::AlgebraicNumber toi, double x) {
  const exact::Rational value(x);
  return toi.sign_of(exact::Polynomial(exact::Integer(-value.get_num()), value.get_den()));
}

/// The fault of an enclosure of an exact time of impact, or nothing.
[[nodiscard]] inline std::optional<std::string> enclosure_fault(const exact::AlgebraicNumber& toi,
                                                                double lower, double upper,
                                                                double tolerance) {
  if (!(lower <= upper && lower >= 0.0 && upper <= 1.0)) return "the enclosure is none";
  const bool is_zero = compare(toi, 0.0) == 0;
  if (is_zero && !(lower == 0.0 && upper == 0.0)) return "the toi is 0";
  if (!is_zero && compare(toi, lower) <= 0) return "toi_lower is not below the toi";
  if (compare(toi, upper) > 0) return "toi_upper is below the toi";
  const double spacing = upper - std::nextafter(upper, 0.0);
  const exact::Rational width = exact::Rational(upper) - exact::Rational(lower);
  const exact::Rational allowed = exact::Rational(tolerance) * exact::Rational(upper);
  if (width > allowed && width > exact::Rational(spacing)) return "the enclosure is too wide";
  return std::nullopt;
}

/// The fault of a result about a query whose truth is known, or nothing.
[[nodiscard]] inline std::optional<std::string> fault(ContactKind kind,
                                                      const exact::Decision& truth,
                                                      const fast::CertifiedResult& result,
                                                      const fast::CertifiedOptions& options) {
  bool collides = truth.collides();
  if (collides && options.t_max < 1.0) collides = compare(*truth.toi, options.t_max) <= 0;
  if (result.verdict != (collides ? fast::Verdict::yes : fast::Verdict::no)) {
    return collides ? "a collision is missed" : "a collision is made up";
  }
  if (!collides) return std::nullopt;
  const auto [u, v] = std::pair(result.u, result.v);
  const bool in_domain =
      u >= 0 && v >= 0 && u <= 1 && v <= 1 &&
      (kind == ContactKind::edge_edge || exact::Rational(u) + exact::Rational(v) <= 1);
  if (!in_domain) return "(u,v) is not in the domain";
  return enclosure_fault(*truth.toi, result.toi_lower, result.toi_upper, options.toi_tolerance);
}

/// The fault of a result, or nothing.
[[nodiscard]] inline std::optional<std::string> fault(ContactKind kind, const Query& query,
                                                      const fast::CertifiedResult& result,
                                                      const fast::CertifiedOptions& options = {}) {
  return fault(kind, exact::decide(kind, query, options.separation), result, options);
}

}  // namespace touchstone::tests
