#pragma once

/// \file
/// Certificates from the oracle to the checker, and the truth of accepted claims.

#include <cmath>
#include <cstddef>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>

#include "tests/support/checker_outcome.hpp"
#include "tests/support/queries.hpp"
#include "touchstone/any_kind.hpp"
#include "touchstone/certificate.hpp"
#include "touchstone/certificate_text.hpp"
#include "touchstone/number.hpp"
#include "touchstone/oracle.hpp"
#include "verify/base/any_decision.hpp"

namespace touchstone::tests {

/// The certificate of a query's own verdict.
[[nodiscard]] inline exact::Certificate prove(const PosedQuery& posed, const Separation& separation,
                                              const exact::ProveOptions& options = {}) {
  const exact::Decision verdict = exact::decide(posed.kind, posed.query, separation);
  return exact::prove(posed.kind, posed.query, verdict, options);
}
[[nodiscard]] inline exact::Certificate prove(const PosedQuery& posed,
                                              const exact::ProveOptions& options = {}) {
  return prove(posed, Separation{}, options);
}

/// The reason for which the checker rejects the certificate; empty if it accepts it.
[[nodiscard]] inline std::string rejection(const exact::Certificate& certificate) {
  return refusal(exact::certificate_stream(certificate));
}

/// The claim of a certificate, read from its text.
struct ReadClaim {
  AnyKind kind = ContactKind::vertex_face;
  Query query{};
  Separation separation;
  exact::Claim claim = exact::Claim::no_collision;
  exact::RationalInterval toi;
};

/// A number as certificates write it.
[[nodiscard]] inline std::string written(const exact::Rational& value) {
  std::string text;
  exact::write_number(text, value);
  return text;
}

/// A number in one of the format's forms.
[[nodiscard]] inline exact::Rational read_number(std::string_view word) {
  const bool negative = word.starts_with('-');
  if (negative || word.starts_with('+')) word.remove_prefix(1);
  exact::Rational value;
  if (!word.starts_with("0x")) {
    value = exact::Rational(std::string(word));
    value.canonicalize();
  } else {
    word.remove_prefix(2);
    const std::size_t exponent = word.find('p');
    std::string digits(word.substr(0, exponent));
    const std::size_t point = digits.find('.');
    long shift = std::stol(std::string(word.substr(exponent + 1)));
    if (point != std::string::npos) {
      shift -= 4 * static_cast<long>(digits.size() - point - 1);
      digits.erase(point, 1);
    }
    value = exact::Rational(exact::Integer(digits, 16)) * exact::power_of_two(shift);
  }
  return negative ? exact::Rational(-value) : value;
}

/// The number as a double, if it is one.
[[nodiscard]] inline std::optional<double> read_double(std::string_view word) {
  const exact::Rational value = read_number(word);
  const double rounded = exact::round_to_nearest(value);
  if (std::abs(rounded) > 1.7976931348623157e308 || exact::Rational(rounded) != value) {
    return std::nullopt;
  }
  return rounded;
}

/// The claim of the last certificate in a stream that the checker accepted; empty if a coordinate
/// or the distance is not a double, because the oracle then does not apply. \pre it has the lines
/// of a certificate.
[[nodiscard]] inline std::optional<ReadClaim> read_claim(const std::string& stream) {
  ReadClaim result;
  std::istringstream lines(stream);
  std::size_t coordinate = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "query") {
      words >> word;
      result = {};
      result.kind = ContactKind::vertex_face;
      if (word == "edge_edge") result.kind = ContactKind::edge_edge;
      if (word == "tetrahedron") result.kind = CellKind::tetrahedron;
      coordinate = 0;
    } else if (word == "point") {
      while (words >> word && coordinate < result.query.coordinates.size()) {
        const auto value = read_double(word);
        if (!value) return std::nullopt;
        result.query.coordinates.at(coordinate++) = *value;
      }
    } else if (word == "separation") {
      std::string norm;
      words >> word >> norm;
      const auto value = read_double(word);
      if (!value) return std::nullopt;
      result.separation = {*value, norm_from_string(norm)};
    } else if (word == "claim") {
      std::string lower, upper;
      words >> word >> lower >> upper;
      result.claim = word.starts_with("no_")     ? exact::Claim::no_collision
                     : word.starts_with("time_") ? exact::Claim::time_of_impact
                                                 : exact::Claim::collision;
      if (!upper.empty()) result.toi = {read_number(lower), read_number(upper)};
    }
  }
  return result;
}

/// True if the claim is true by the oracle.
[[nodiscard]] inline bool is_true(const ReadClaim& claim) {
  const AnyQueries asked(claim.kind, {&claim.query, 1});
  const auto first = verify::base::decide(asked, 0, claim.separation).toi;
  if (claim.claim == exact::Claim::no_collision) return !first;
  if (claim.claim == exact::Claim::collision || !first) return first.has_value();
  const exact::AlgebraicNumber& toi = *first;
  if (claim.toi.lower == claim.toi.upper) return claim.toi.upper == 0 && toi == exact::Rational(0);
  return toi > claim.toi.lower && toi <= claim.toi.upper;
}

}  // namespace touchstone::tests
