#pragma once

/// \file
/// Simplification of a failing query.
///
/// A finding of a search has 24 long numbers or more, most of which are irrelevant to the fault.
/// Shrinking tries plainer queries (plainness.hpp), keeps each that still fails, and ends when no
/// step leads to a plainer one that fails. The steps, from large changes to small ones:
///
/// - curves: straight lines between two control points, no weights, the next lower degree;
/// - the whole: scaled by powers of two (all axes, or one) to sizes near 1, translated so that a
///   point's coordinate becomes 0, all coordinates or those of an axis rounded to fewer decimal
///   digits;
/// - axes: 0, at rest, like another axis; points: in the same place as another, at rest;
/// - values: all coordinates of one magnitude together become 0, another occurring magnitude, or a
///   decimal of fewer digits; then each coordinate alone, at one end or at both, which may also
///   take the other end's value or lose its sign.
///
/// There are no assumptions about the fault: a step may round and change the truth of the query.
/// Each result is tested again.
///
/// **Termination.** Each accepted step lowers the plainness, which is a tuple of natural numbers in
/// lexicographic order.

#include <functional>

#include "verify/fuzz/plainness.hpp"

namespace touchstone::verify::fuzz {

/// The last of a chain of ever plainer queries for which `still_fails` holds; `query` itself if
/// none is found. When must_end() is true, no further test begins. A function of the arguments
/// alone, if still_fails is one and must_end does not end it. It never tests `query` itself, nor
/// another one twice. \pre all numbers are finite and weights positive, as in all queries that it
/// tests. \throws the exceptions of still_fails.
[[nodiscard]] AnyQuery shrink(
    const AnyQuery& query, const std::function<bool(const AnyQuery&)>& still_fails,
    const std::function<bool()>& must_end = [] { return false; });

}  // namespace touchstone::verify::fuzz
