#pragma once

/// \file
/// The built-in set: degenerate queries from a seed, whose truth is known by construction.
///
/// The truth of these queries does not come from an oracle, so they can judge one. Each family
/// first chooses the contact (or its absence) and draws the coordinates around it; the family's
/// `reason` states why that decides the verdict, and the comment above its function has the proof.
///
/// With coordinates of few bits every floating-point step is exact, which hides faults of filters.
/// Hence the queries with an odd index have full significands, at scales that are no powers of two
/// (or, where sums must be exact, on a grid of some fifty bits); exactness then comes from
/// equality: the same double in two places, an exact difference of two doubles, an integer sum
/// below 2^53.
///
/// Every query is then turned by a random exact symmetry (axes permuted and mirrored, the
/// primitives' points renumbered), so that no position among the 24 coordinates is special.
///
/// With a minimum separation there are additional families, whose truth refers to that separation:
/// their odd queries have full significands only as far as the distance permits. The truth of all
/// other families still refers to distance 0.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "touchstone/any_kind.hpp"
#include "touchstone/number.hpp"
#include "verify/data/query_source.hpp"

namespace touchstone::verify::generate {

/// The verdicts that occur in a family.
enum class Verdicts : std::uint8_t { collisions, no_collisions, both };

/// A named kind of degeneracy.
struct Family {
  /// Unique, kebab-case.
  std::string_view name;
  /// The reason why the truth of its queries is known.
  std::string_view reason;
  /// The verdicts that occur among its queries.
  Verdicts verdicts;
  /// The curves of its queries.
  std::size_t degree = 1;
  bool is_rational = false;
};

/// A query with the truth that its construction provides.
struct KnownQuery {
  Query query{};
  bool collides = false;
  /// The exact time of impact, if the construction yields it: for nearly all collisions.
  std::optional<exact::Rational> toi;
};

/// All families about contact, always in the same order.
[[nodiscard]] std::span<const Family> families();

/// All families about a separation, always in the same order.
[[nodiscard]] std::span<const Family> separation_families();

/// All families about the inversion of cells, always in the same order; they "collide" as
/// touchstone/query.hpp says.
[[nodiscard]] std::span<const Family> cell_families();

/// True if those families have queries for this separation: for distances from 2^-1000 to 2^1000.
[[nodiscard]] bool has_separation_families(const Separation& separation);

/// The built-in set for a separation: families(), followed by separation_families() if they have
/// queries.
[[nodiscard]] std::vector<Family> families(const Separation& separation);

/// All families on curves (curved_families.hpp), of degree 2, of degree 3, and rational, always in
/// the same order.
[[nodiscard]] std::span<const Family> curved_families();

/// The families whose degree_text is among `degrees`: those for a separation, those on curves,
/// whose truth refers to distance 0, and those of cells, which are on straight lines.
[[nodiscard]] std::vector<Family> families(const Separation& separation,
                                           std::span<const std::string> degrees);

/// "1", "2", "3" or "rational".
[[nodiscard]] std::string degree_text(const Family& family);

/// The family of that name, about contact, a separation or inversion, or on curves.
/// \throws std::invalid_argument if there is none.
[[nodiscard]] const Family& family_from_name(std::string_view name);

/// True if the family has queries of this kind. Nearly all have both kinds.
/// \throws std::invalid_argument if no family has the name of `family`.
[[nodiscard]] bool supports(const Family& family, AnyKind kind);

/// Query number `index` of a family on straight lines: a function of the arguments alone, the same
/// on every machine. Families about contact ignore the separation. \throws std::invalid_argument if
/// the family does not support the kind, is unknown or on curves, or has no queries for the
/// separation.
[[nodiscard]] KnownQuery make_query(const Family& family, AnyKind kind, std::uint64_t seed,
                                    std::uint64_t index, const Separation& separation = {});

/// The queries 0 to count−1 of one family and kind as a stream; its name is the family's name.
/// \throws std::invalid_argument as make_query does, on curves too.
[[nodiscard]] std::unique_ptr<data::QuerySource> open_family(const Family& family, AnyKind kind,
                                                             std::uint64_t seed,
                                                             std::uint64_t count,
                                                             const Separation& separation = {});

}  // namespace touchstone::verify::generate
