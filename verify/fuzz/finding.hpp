#pragma once

/// \file
/// Findings of the fuzzer: wrong answers of a solver, or missing ones.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "fast/method.hpp"
#include "touchstone/any_kind.hpp"
#include "touchstone/number.hpp"
#include "verify/base/any_query.hpp"
#include "verify/judge/fault.hpp"

namespace touchstone::verify::fuzz {

/// "vertex-face" on straight lines, "edge-edge, rational, degree 2" on curves.
[[nodiscard]] std::string to_text(const AnyShape& shape);

/// A line a point: its name, and its places at t=0 and t=1 or its control points, each with its
/// weight, in decimals that are these very doubles.
[[nodiscard]] std::string as_points(const base::AnyQuery& query);

/// A query that a solver answers wrongly, its answer, and the truth: all of the same query.
struct FailingCase {
  base::AnyQuery query = {};
  fast::Answer answer = {};
  bool collides = false;  ///< the truth
  /// Neighbouring doubles around the exact time of impact, or one; nothing if they do not collide.
  std::optional<exact::DoubleInterval> toi = std::nullopt;
  std::string truth = {};   ///< "no collision", or "collision between … and …"
  std::string detail = {};  ///< the fault, in words
  /// The proof of the truth, as a stream of one certificate (exact/CERTIFICATES.md); empty if
  /// beyond the format's limits.
  std::string certificate = {};
};

/// Outcome of the attempt to simplify a finding's query.
enum class Shrinking : std::uint8_t {
  not_tried,
  complete,        ///< no step leads to a simpler query that fails
  cut_short,       ///< the time was over before
  not_reproduced,  ///< asked alone, the solver is not wrong
};

/// "not tried", "complete", "cut short" or "not reproduced".
[[nodiscard]] std::string_view to_string(Shrinking shrinking);

/// Bounds of a time of impact that a solver gives with nearly every collision, but not with this
/// one.
struct MissingBounds {
  bool lower = false;
  bool upper = false;

  [[nodiscard]] bool any() const { return lower || upper; }
};

/// A fault of a solver, confirmed by the oracle.
struct Finding {
  judge::Fault what = judge::Fault::false_negative;
  Separation separation = {};
  std::string method;  ///< the method that is wrong: the one asked, or "certified" if the judge is
  FailingCase original = {};  ///< as it was found
  FailingCase simplest = {};  ///< the simplest query with the same fault: the original if none was
  Shrinking shrinking = Shrinking::not_tried;
  /// Set if the fault consists in missing bounds alone.
  MissingBounds missing = {};
  /// True for a late time that is late slightly (judge::slight_lateness).
  bool is_slight = false;
  std::size_t group = 0;      ///< in FuzzResult::groups
  double seconds = 0.0;       ///< wall-clock time of the run when it was found
  std::uint64_t queries = 0;  ///< asked by then, itself included
  std::string generator;      ///< that made the query

  /// Simpler queries are of the same kind, but may be on curves of a lower degree.
  [[nodiscard]] AnyKind kind() const { return original.query.kind(); }
};

}  // namespace touchstone::verify::fuzz
