#pragma once

/// \file
/// The plainest query that still fails, found from one that does.
///
/// A finding of a search has 24 long numbers, and most of them have nothing to do with the fault.
/// Shrinking tries plainer queries (plainness.hpp), keeps each that still fails, and ends where no step
/// leads to a plainer one that does. Steps, from those that change much to those that change little:
///
/// - the whole: scaled by powers of two (all axes, or one) to everyday size, translated so that a point's
///   coordinate becomes 0, seen from a point that moves, all coordinates or those of an axis rounded to
///   fewer decimal digits, or evenly spaced in their order;
/// - axes: 0, at rest, like another axis; points: in the same place as another, at rest, exchanged
///   where the kind does not care for their order;
/// - values: all coordinates of one magnitude together become 0, another magnitude that occurs, or a
///   decimal of fewer digits; then each coordinate alone, at one end or at both, which may also take
///   the other end's value or lose its sign.
///
/// Nothing is assumed of the fault: a step may round, and need not keep what is true of the query.
/// Whether the result still fails is asked each time.
///
/// **Why it ends.** Each step that is kept lowers the plainness, which is a tuple of natural numbers in
/// lexicographic order. **Never worse than the original**: no step is kept that is worse than the
/// original by one of the first four of these numbers, whatever the others are.

#include <cstdint>
#include <functional>

#include "exact/query.hpp"

namespace touchstone::verify::fuzz {

struct ShrinkOptions {
  /// So often still_fails is called at most; 0: never.
  std::uint64_t most_calls = 50'000;
  /// May be null. Once true, no call is begun.
  std::function<bool()> must_end = nullptr;
};

/// The last of a chain of ever plainer queries for which `still_fails` holds; `query` itself if none
/// is found. A function of the arguments alone, as long as still_fails is one and must_end does not end it.
/// Never asks about `query`, nor twice about another one. \pre all coordinates are finite.
/// \throws what still_fails throws.
[[nodiscard]] Query shrink(Kind kind, const Query& query,
                           const std::function<bool(const Query&)>& still_fails,
                           const ShrinkOptions& options = {});

}  // namespace touchstone::verify::fuzz
