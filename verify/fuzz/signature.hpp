#pragma once

/// \file
/// The signs by which findings of one cause are recognized from outside.
///
/// A fault of rounding depends on the scale: if its query is multiplied by powers of two, which
/// changes nothing else, the answer is right at some scales, and these tell one wrong bound from
/// another. It shows in queries of any shape and time, of both kinds. A fault of logic does not
/// depend on the scale; it shows in one kind of queries, of one degeneracy, at one time of contact.
/// Findings therefore are of one group if they are of one solver and kind of finding, and
///
/// - the fault ends in the same ranges of scale, if it ends anywhere, or else
/// - kind, degeneracy (plainness.hpp) and time of contact are the same, and both or none are on
///   curves; of hangs the kind alone.
///
/// This is no proof: two faults may have one signature, and one fault two.

#include <compare>
#include <cstdint>
#include <optional>
#include <string>

#include "fast/method.hpp"
#include "touchstone/query.hpp"
#include "verify/base/deadline.hpp"
#include "verify/fuzz/finding.hpp"
#include "verify/fuzz/fuzz.hpp"

namespace touchstone::verify::fuzz {

/// The time at which the primitives touch first.
enum class ContactTime : std::uint8_t { never, at_start, between, at_end };

/// The elements of a query, and its points' plane.
enum class Shape : std::uint8_t { general, coplanar, collapsed };

/// Ranges of the greatest coordinate in which a fault ends.
struct ScaleEnds {
  bool below_everyday = false;  ///< below 2^-10
  bool everyday = false;
  bool above_everyday = false;  ///< from 2^10 on

  [[nodiscard]] bool any() const { return below_everyday || everyday || above_everyday; }
  // NOLINTNEXTLINE(readability-implicit-bool-conversion): in the comparison of two of them
  friend auto operator<=>(const ScaleEnds&, const ScaleEnds&) = default;
};

/// The signature, as above. For a fault that depends on the scale, kind, shape, time and curves are
/// not set.
struct Signature {
  std::string method;
  judge::Fault what = judge::Fault::false_negative;
  bool is_slight = false;  ///< true for a time that is late slightly
  /// The reason of a crash, an exit or an exception; else empty.
  std::string reason = {};
  ScaleEnds ends = {};
  std::optional<Kind> kind = std::nullopt;
  std::optional<Shape> shape = std::nullopt;
  std::optional<ContactTime> time = std::nullopt;
  bool is_on_curves = false;

  // clang-tidy 14 takes the comparison of the bool for a conversion.
  // NOLINTNEXTLINE(readability-implicit-bool-conversion)
  friend auto operator<=>(const Signature&, const Signature&) = default;
};

inline constexpr int greatest_scale = 40;

/// The least scale that is asked, -40 or more. Below 16 times the tolerance of the solvers all
/// points are close to each other.
[[nodiscard]] int least_scale(double tolerance);

/// The scales at which the finding's simplest query is wrong, around its own: it is asked again
/// times powers of two, up and down, until it is right or the greatest coordinate is beyond
/// 2^least_scale() to 2^greatest_scale. For a hang, and for findings about a separation, nothing is
/// asked, and no end is known.
[[nodiscard]] ScaleRange scale_range(const fast::Method& method, const FuzzOptions& options,
                                     const base::Deadline& deadline, const Finding& finding);

/// The signature of a finding's simplest query. \pre its scales are known
[[nodiscard]] Signature signature_of(const Finding& finding);

/// "ends near 1", "ends at large scales", "any scale" and so on.
[[nodiscard]] std::string to_text(const ScaleEnds& scales);

/// "t=0", "t=1", "between", "none"; "any" if it is not set.
[[nodiscard]] std::string to_text(const std::optional<ContactTime>& time);

/// "general", "coplanar", "collapsed"; "any" if it is not set.
[[nodiscard]] std::string to_text(const std::optional<Shape>& shape);

}  // namespace touchstone::verify::fuzz
