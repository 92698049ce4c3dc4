#pragma once

/// \file
/// The simplest query that still fails, found from one that does.
///
/// A finding of a search has 24 long numbers, and most of them have nothing to do with the fault.
/// Shrinking tries simpler queries, keeps each that still fails, and ends where no step leads to a
/// simpler one that does. Steps, from those that change much to those that change little:
///
/// - the whole: scaled by powers of two (all axes, or one), translated so that a point's coordinate
///   becomes 0, seen from a point that moves, all coordinates rounded to fewer bits;
/// - axes: 0, at rest, like another axis; points: in the same place as another, at rest, exchanged
///   where the kind does not care for their order;
/// - values: all coordinates of one magnitude together become 0, another magnitude that occurs, or a
///   number of fewer bits; then each coordinate alone, which may also take the other end's value or
///   lose its sign.
///
/// Nothing is assumed of the fault: a step may round, and need not keep what is true of the query.
/// Whether the result still fails is asked each time.
///
/// **Why it ends.** Each step that is kept lowers the complexity, which is a tuple of natural numbers
/// in lexicographic order.

#include <compare>
#include <cstdint>
#include <functional>

#include "exact/query.hpp"

namespace touchstone::verify::fuzz {

/// The complexity of a query: less is simpler. Two queries may be equally simple.
struct Complexity {
  /// The length of its description. For each magnitude that occurs (0 apart): 8, its significant
  /// bits, the empty binary places between these and the point, and 2 if it is no integer. For each
  /// coordinate: 2 unless it is 0, 1 for a sign, 1 if it moves.
  std::uint64_t length = 0;
  /// Sum over the magnitudes, each as a number that orders doubles.
  std::uint64_t size = 0;
  /// Pairs of points whose order the kind does not care for (the triangle's, an edge's), the greater
  /// one first.
  std::uint64_t disorder = 0;

  friend auto operator<=>(const Complexity&, const Complexity&) = default;
};

/// \pre all coordinates are finite.
[[nodiscard]] Complexity complexity(Kind kind, const Query& query);

struct ShrinkOptions {
  /// So often still_fails is called at most; 0: never.
  std::uint64_t most_calls = 50'000;
  /// May be null. Once true, no call is begun.
  std::function<bool()> must_end = nullptr;
};

/// The last of a chain of ever simpler queries for which `still_fails` holds; `query` itself if none
/// is found. A function of the arguments alone, as long as still_fails is one and must_end does not end it.
/// Never asks about `query`, nor twice about another one. \pre all coordinates are finite.
/// \throws what still_fails throws.
[[nodiscard]] Query shrink(Kind kind, const Query& query,
                           const std::function<bool(const Query&)>& still_fails,
                           const ShrinkOptions& options = {});

}  // namespace touchstone::verify::fuzz
