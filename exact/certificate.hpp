#pragma once

/// \file
/// Verdicts that carry their proof, for a checker that trusts nothing of the oracle.
///
/// A certificate is a claim about a query, and a distance at which things count as touching, and what
/// proves it:
///   - no collision: pieces of [0,1] with a separating feature each (exact/certificate/separation_intervals.hpp);
///   - collision: a contact;
///   - time of impact in (lower, upper]: a contact there, and pieces of [0,lower].
///
/// **A contact** is a time t* and a place with its conditions (exact/contact/contact_conditions.hpp).
/// The time is a rational number, or a root of an integer polynomial g in an interval at whose ends g
/// has opposite signs. Then g divides every polynomial of the conditions that is zero at t*, and every other one
/// has one sign on the whole interval: whichever root of g there it is, the conditions hold at it.
/// Hence g is the greatest common divisor of the polynomials that vanish, and the interval is so
/// small that the others do not.
///
/// exact/certificate/certificate_text.hpp writes certificates down, exact/CERTIFICATES.md is the format.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "exact/algebra/number.hpp"
#include "exact/algebra/polynomial.hpp"
#include "exact/certificate/separation_intervals.hpp"
#include "exact/contact/contact_conditions.hpp"
#include "exact/distance/distance_oracle.hpp"
#include "exact/oracle.hpp"
#include "exact/query.hpp"

namespace touchstone::exact {

/// What a certificate says of its query.
enum class Claim : std::uint8_t { no_collision, collision, time_of_impact };

/// A root of the polynomial strictly inside the interval, where its ends' signs are opposite.
struct RootTime {
  RationalInterval interval;
  Polynomial polynomial;
};

/// When and where the primitives touch.
struct ContactProof {
  std::variant<Rational, RootTime> time;
  ContactPlace place;
};

/// A claim about a query with its proof.
struct Certificate {
  Kind kind = Kind::vertex_face;
  Query query{};
  /// How near is a contact.
  Separation separation{};
  Claim claim = Claim::no_collision;
  /// For a time of impact: lower < toi ≤ upper, or both are 0 and so is the toi.
  RationalInterval toi;
  /// Of [0,1] or, for a time of impact, of [0, toi.lower]; none for a collision, nor for a toi of 0.
  std::vector<Piece> pieces;
  /// For a collision and a time of impact.
  std::optional<ContactProof> contact;
};

struct ProveOptions {
  /// What to claim of a query that collides: `collision` or `time_of_impact`.
  Claim collision_claim = Claim::time_of_impact;
  /// The interval of a time of impact is at most so wide, > 0; without a width its ends are
  /// neighbouring doubles, the upper one the toi itself where that is a double.
  std::optional<Rational> width = std::nullopt;
};

/// The proof of the oracle's verdict on a query at a distance: always one, and the same on every machine and in
/// every floating-point environment. Thread-safe.
/// \param verdict decide(kind, query, separation)
/// \throws std::invalid_argument if a coordinate is NaN or infinite, the separation is not valid, the
/// width is not positive, or the claim asked for is `no_collision`.
/// \throws std::logic_error if the verdict is not the query's.
/// \throws CertificateLimitError if the certificate would exceed the format's limits: at most
/// number_limit bits above and below in a number and piece_limit pieces. separate() says when; the
/// interval of a contact needs no more bits than the break points there.
[[nodiscard]] Certificate prove(Kind kind, const Query& query, const Separation& separation,
                                const DistanceVerdict& verdict, const ProveOptions& options = {});

/// The same without a distance.
/// \param verdict decide(kind, query)
[[nodiscard]] Certificate prove(Kind kind, const Query& query, const Verdict& verdict,
                                const ProveOptions& options = {});

/// A certificate has at most so many pieces.
inline constexpr std::size_t piece_limit = 4096;

}  // namespace touchstone::exact
