#pragma once

/// \file
/// Where a label is judged: what a source records of a query, its verdict and its time of impact,
/// against the truth.
///
/// What is recorded about another separation is compared as far as something follows from it
/// (separation_inference.hpp): collisions, which must be no later.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "touchstone/number.hpp"
#include "touchstone/oracle.hpp"
#include "verify/judge/separation_inference.hpp"

namespace touchstone::verify::judge {

/// The label of a query: what its source claims of it.
struct Label {
  std::optional<bool> collides = std::nullopt;
  std::optional<exact::Rational> toi = std::nullopt;
};

/// The comparison of labels with the truth.
struct LabelComparison {
  Inference inference = Inference::all;
  /// A recorded time of impact may be off by this much.
  exact::Rational tolerance = {};

  /// Is the recorded verdict compared?
  [[nodiscard]] bool uses_verdict(const Label& label) const;
  /// Is the recorded time of impact compared?
  [[nodiscard]] bool uses_toi(const Label& label) const;
};

/// A part of a label that is not the truth.
struct Mismatch {
  enum class Of : std::uint8_t { label, toi };

  Of of;
  std::uint64_t index;
  std::string recorded;
  std::string truth;
};

/// "recorded label: no collision, the truth is collision".
[[nodiscard]] std::string to_text(const Mismatch& mismatch);

/// Judges the label of query number `index`: verdict first, then time. A time of impact of a query
/// that does not collide is a mismatch; a collision without one is not.
[[nodiscard]] std::vector<Mismatch> judge_label(std::uint64_t index, const Label& label,
                                                const exact::Decision& truth,
                                                const LabelComparison& comparison);

}  // namespace touchstone::verify::judge
