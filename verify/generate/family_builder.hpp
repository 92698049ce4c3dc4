#pragma once

/// \file
/// Common parts of the builders of all families: their input, their outcomes, exact symmetries.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "fast/method.hpp"
#include "touchstone/any_kind.hpp"
#include "touchstone/number.hpp"
#include "verify/data/query_source.hpp"
#include "verify/generate/families.hpp"
#include "verify/generate/random_stream.hpp"

namespace touchstone::verify::generate {

/// The input of a builder.
struct Recipe {
  AnyKind kind;
  /// Number of the query in its family.
  std::uint64_t index;
  /// The number of the query among those with the same `full`, with which builders cycle their
  /// variants.
  std::uint64_t variant;
  /// Full significands (else few bits).
  bool full;
  /// The query's stream of random numbers.
  Random random;
  /// Minimum separation, for families about it.
  Separation separation = {};
  /// Set by a builder for a query that is printed in the paper: no symmetry is applied.
  bool as_printed = false;

  /// The kind of a family of contacts.
  [[nodiscard]] ContactKind contact() const { return kind.contact(); }
  /// True for a vertex and a face.
  [[nodiscard]] bool vertex_face() const { return kind == ContactKind::vertex_face; }
};

/// A family with its builder.
struct Definition {
  Family family;
  /// Builds the query in its canonical position.
  KnownQuery (*build)(Recipe&);
  /// The kinds it has.
  bool vertex_face = true;
  bool edge_edge = true;
  bool cells = false;
};

/// The definitions in dyadic.cpp, degenerate.cpp and so on, one list for each file.
[[nodiscard]] std::span<const Definition> dyadic_definitions();
[[nodiscard]] std::span<const Definition> degenerate_definitions();
[[nodiscard]] std::span<const Definition> silhouette_definitions();
[[nodiscard]] std::span<const Definition> endpoint_definitions();
[[nodiscard]] std::span<const Definition> coplanar_definitions();
[[nodiscard]] std::span<const Definition> product_definitions();
[[nodiscard]] std::span<const Definition> tangential_definitions();
[[nodiscard]] std::span<const Definition> published_definitions();
[[nodiscard]] std::span<const Definition> scaled_definitions();

/// The definitions of the families about a separation, in separated.cpp.
[[nodiscard]] std::span<const Definition> separated_definitions();

/// The definitions of the families about inversion, in cells.cpp.
[[nodiscard]] std::span<const Definition> cell_definitions();

/// Every definition that does not build on another: all lists but the scaled ones.
[[nodiscard]] std::span<const Definition> base_definitions();

/// What is common to the queries of a family.
struct DrawnSet {
  std::string name;
  AnyShape shape;
  Separation separation = {};  ///< of their truth
};

/// The queries 0 to count−1 of a family as a stream.
/// \param draw called with 0, 1, 2, … in order
[[nodiscard]] std::unique_ptr<data::QuerySource> open_drawn(
    DrawnSet set, std::uint64_t count,
    std::function<data::RecordedQuery(std::uint64_t index)> draw);

/// The outcomes of a construction.
[[nodiscard]] KnownQuery collision(const Query& query, std::optional<exact::Rational> toi);
[[nodiscard]] KnownQuery no_collision(const Query& query);

/// Coordinate `axis` of a corner at time t.
[[nodiscard]] exact::Rational corner_at(const Query& query, const Corner& corner, std::size_t axis,
                                        const exact::Rational& t);

/// True if more than half of the different magnitudes among the coordinates need 45 bits or more,
/// and they have at least two binary exponents. Zeros are ignored.
[[nodiscard]] bool uses_full_significands(const Query& query);

/// Replaces a query by one of its mirror images: axes permuted and mirrored, the face's vertices or
/// the edges' ends permuted, the two edges exchanged. Verdict and toi do not change, nor the
/// significand of any coordinate.
void apply_random_symmetry(AnyKind kind, Random& random, Query& query);

/// Multiplies every axis by its own power of two. Verdict and toi do not change, since a diagonal
/// map of full rank maps F to F; an exponent that would not be exact is replaced by its negative.
void scale_axes(const std::array<int, 3>& exponents, Query& query);

}  // namespace touchstone::verify::generate
