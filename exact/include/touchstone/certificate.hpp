#pragma once

/// \file
/// Verdicts with their proof, for a checker that does not trust the oracle.
///
/// \code{.cpp}
/// // The proof of a verdict, as a file for `touchstone-check`.
/// #include <touchstone/certificate_text.hpp>
/// #include <touchstone/oracle.hpp>
///
/// #include <iostream>
///
/// using namespace touchstone;
///
/// int main() {
///   // A vertex moves towards a resting triangle, and stops before it.
///   const Query query{{1, 1, 3, 0, 0, 0, 4, 0, 0, 0, 4, 0,
///                      1, 1, 1, 0, 0, 0, 4, 0, 0, 0, 4, 0}};
///   const exact::Decision decision = exact::decide(ContactKind::vertex_face, query);
///   const exact::Certificate certificate = exact::prove(ContactKind::vertex_face, query,
///   decision); std::cout << exact::certificate_stream(certificate, "a vertex above a face");
/// }
/// // claim no_collision
/// // separate 0 1 face +
/// \endcode
///
/// A certificate states a query, a separation, a claim and the proof of the claim:
///   - no collision: subintervals of [0,1], each with a feature whose direction separates
///   throughout;
///   - collision: a contact;
///   - time of impact in (lower, upper]: a contact there, and subintervals of [0,lower].
/// Of a cell (touchstone/cell.hpp) the same is said with inversion in the place of
/// collision: a contact is then a time at which the volume is not positive, that is, at which its
/// first point touches the plane of the others, or is behind it.
///
/// **A contact** is a time t* and a place with its sign conditions. The time is a rational number,
/// or a root of an integer polynomial g in an interval at whose ends g has opposite signs. Then g
/// divides every polynomial of the conditions that is zero at t*, and every other one has one sign
/// on the whole interval: the conditions hold at every root of g in the interval. Hence g is the
/// greatest common divisor of the polynomials that vanish, and the interval is so small that the
/// others do not.
///
/// exact/CERTIFICATES.md defines the format, the directions of features and the conditions of
/// places; touchstone/certificate_text.hpp writes it. docs/theory.md, section 5. All functions are
/// thread-safe.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <variant>
#include <vector>

#include "touchstone/any_kind.hpp"
#include "touchstone/curved_query.hpp"
#include "touchstone/number.hpp"
#include "touchstone/oracle.hpp"
#include "touchstone/polynomial.hpp"
#include "touchstone/query.hpp"

namespace touchstone::exact {

// ---- No collision -------------------------------------------------------------------------------

/// The name of a direction, which is a polynomial in time (docs/theory.md, sections 3.2 and 3.3).
struct Feature {
  enum class Sort : std::uint8_t {
    vertex,
    edge,
    positive_face,
    negative_face,
    positive_axis,
    negative_axis,
    cross
  };

  Sort sort = Sort::vertex;
  std::size_t i = 0;     ///< corner, of a vertex, edge or cross
  std::size_t j = 0;     ///< corner, of an edge or cross
  std::size_t axis = 0;  ///< of an axis or cross

  friend bool operator==(const Feature&, const Feature&) = default;
};

/// The feature separates on all of [from, to].
struct Subinterval {
  Rational from;
  Rational to;
  Feature feature;

  friend bool operator==(const Subinterval&, const Subinterval&) = default;
};

// ---- Contact ------------------------------------------------------------------------------------

/// The origin is in the triangle of three corners; their normal's component `axis` is not zero.
struct TriangleContact {
  std::array<std::size_t, 3> corners;
  std::size_t axis;

  friend bool operator==(const TriangleContact&, const TriangleContact&) = default;
};

/// The origin is on the segment between two corners.
struct SegmentContact {
  std::array<std::size_t, 2> corners;

  friend bool operator==(const SegmentContact&, const SegmentContact&) = default;
};

/// This corner is within the distance, in l2.
struct VertexContact {
  std::size_t corner;

  friend bool operator==(const VertexContact&, const VertexContact&) = default;
};

/// A point between two corners is within the distance, in l2.
struct EdgeContact {
  std::array<std::size_t, 2> corners;

  friend bool operator==(const EdgeContact&, const EdgeContact&) = default;
};

/// A point of the face is within the distance, in l2.
struct FaceContact {
  friend bool operator==(const FaceContact&, const FaceContact&) = default;
};

/// No axis separates, in linf.
struct AxesContact {
  friend bool operator==(const AxesContact&, const AxesContact&) = default;
};

/// The volume is 0 or negative, of a cell.
struct PlaneContact {
  friend bool operator==(const PlaneContact&, const PlaneContact&) = default;
};

using ContactPlace = std::variant<TriangleContact, SegmentContact, VertexContact, EdgeContact,
                                  FaceContact, AxesContact, PlaneContact>;

/// A root of the polynomial strictly inside the interval, where its ends' signs are opposite.
struct RootTime {
  RationalInterval interval;
  Polynomial polynomial;
};

/// The time and the place of a contact.
struct ContactProof {
  std::variant<Rational, RootTime> time;
  ContactPlace place;
};

// ---- The certificate ----------------------------------------------------------------------------

/// The kinds of claims about a query; of a cell: no inversion, inversion, time of inversion.
enum class Claim : std::uint8_t { no_collision, collision, time_of_impact };

/// A claim about a query with its proof.
struct Certificate {
  /// vertex_face, edge_edge or tetrahedron: other kinds are proved as one of these (decided_as,
  /// to_tetrahedron).
  AnyKind kind = ContactKind::vertex_face;
  std::variant<Query, CurvedQuery> query{};
  Separation separation{};
  Claim claim = Claim::no_collision;
  /// The interval of a time of impact: lower < toi ≤ upper, or all are 0.
  RationalInterval toi = {};
  /// A cover of [0,1] or, for a time of impact, of [0, toi.lower]. Empty for a collision or toi 0.
  std::vector<Subinterval> subintervals = {};
  /// Present for a collision and a time of impact.
  std::optional<ContactProof> contact = std::nullopt;
};

/// The maximum number of subintervals of a certificate.
inline constexpr std::size_t subinterval_limit = 4096;

/// The maximum number of bits of the numerator and the denominator of a number in a certificate.
inline constexpr std::size_t number_limit = 16384;

/// A certificate would exceed the limits of the format.
class CertificateLimitError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct ProveOptions {
  /// The claim for a query that collides: `collision` or `time_of_impact`.
  Claim collision_claim = Claim::time_of_impact;
  /// The maximum width, > 0, of the interval of a time of impact. Without it the ends are
  /// neighbouring doubles; the upper one is the toi itself if that is a double.
  std::optional<Rational> width = std::nullopt;
};

/// The proof of the oracle's decision on a query: the same on every machine and in every
/// floating-point environment.
/// \param decision decide(kind, query, decision.separation)
/// \throws std::domain_error if a coordinate is NaN or infinite; std::invalid_argument if the
/// separation is not valid, the width is not positive, or the claim asked for is `no_collision`.
/// \throws std::logic_error if the decision is not the query's.
/// \throws CertificateLimitError if the certificate would exceed number_limit or subinterval_limit.
/// exact/certificate/separation_intervals.hpp states for which queries the break points stay within
/// it; the interval of a contact needs no more bits.
[[nodiscard]] Certificate prove(ContactKind kind, const Query& query, const Decision& decision,
                                const ProveOptions& options = {});

/// The same on curves.
/// \throws std::invalid_argument also as decide, if a trajectory is not valid.
[[nodiscard]] Certificate prove(ContactKind kind, const CurvedQuery& query,
                                const Decision& decision, const ProveOptions& options = {});

/// The same for query i, decided by decide(queries, i, decision.separation).
[[nodiscard]] Certificate prove(const Queries& queries, std::size_t i, const Decision& decision,
                                const ProveOptions& options = {});

/// The same for all queries, in this thread. \throws std::invalid_argument also unless there is a
/// decision for each.
[[nodiscard]] std::vector<Certificate> prove(const Queries& queries,
                                             std::span<const Decision> decisions,
                                             const ProveOptions& options = {});

/// The proof of the first inversion of a cell, or that there is none.
/// \param first first_inversion(kind, cell) \throws as above
[[nodiscard]] Certificate prove_inversion(CellKind kind, const Query& cell,
                                          const std::optional<AlgebraicNumber>& first,
                                          const ProveOptions& options = {});
[[nodiscard]] Certificate prove_inversion(CellKind kind, const CurvedQuery& cell,
                                          const std::optional<AlgebraicNumber>& first,
                                          const ProveOptions& options = {});
[[nodiscard]] Certificate prove_inversion(const Cells& cells, std::size_t i,
                                          const std::optional<AlgebraicNumber>& first,
                                          const ProveOptions& options = {});

}  // namespace touchstone::exact
