#pragma once

/// \file
/// Queries on curves for the fuzzer.
///
/// **At another speed.** If the control points of all points are at the start of a straight way up
/// to the same number, and at its end from there on, with weights that the points share, all are at
/// the part s(t) of their ways, which goes from 0 to 1: the curves have the straight query's
/// verdict, for any doubles.
///
/// **Raised.** Curves of degree k and control points b are those of degree k+1 and control points
/// (j b_(j−1) + (k+1−j) b_j) / (k+1). These times k+1 have few bits if b has, and the same truth.
/// Weights r^j are the same curve at another speed.

#include <cstddef>
#include <optional>

#include "touchstone/any_kind.hpp"
#include "verify/base/any_query.hpp"
#include "verify/generate/random_stream.hpp"

namespace touchstone::verify::fuzz {

/// The query at another speed: at the end of its way from that control point on, 1 to the degree.
/// Weights are 1.
[[nodiscard]] base::AnyQuery at_other_speed(const AnyShape& shape, const Query& query,
                                            std::size_t turn);

/// The finite query on curves of the shape: at another speed, or raised, where sums may round.
[[nodiscard]] base::AnyQuery on_curves(const AnyShape& shape, const Query& query,
                                       generate::Random& random);

/// A query of a family of known truth on curves (generate::curved_families()), raised to the shape;
/// of a shape that no family can be raised to, nothing.
[[nodiscard]] std::optional<base::AnyQuery> of_curved_family(const AnyShape& shape,
                                                             generate::Random& random);

/// Control points about the same place, of small multiples of 1/4, which have many degenerate
/// contacts, or of any numbers; with one weight for all points at a control point, for each
/// primitive, or for each point.
/// \param separation With a distance, for which the oracle takes seconds where weights differ,
/// curves of a degree above 1 have one weight for all points.
[[nodiscard]] base::AnyQuery of_numbers(const AnyShape& shape, const Separation& separation,
                                        generate::Random& random);

/// True if the oracle decides queries of the shape at the separation soon, whatever the weights.
[[nodiscard]] bool may_weights_differ(const AnyShape& shape, const Separation& separation);

/// True unless the oracle may take long: on curves with a distance from which coordinates, but for
/// zeros, differ by more than a factor of 2^64.
[[nodiscard]] bool is_decided_soon(const base::AnyQuery& query, const Separation& separation);

}  // namespace touchstone::verify::fuzz
