#pragma once

/// \file
/// The judgement of labels: the verdict and the time of impact that a source records of a query,
/// compared with the truth.
///
/// A label for another separation is compared as far as it implies something
/// (separation_inference.hpp): a collision, which must be no later.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "touchstone/number.hpp"
#include "touchstone/oracle.hpp"
#include "verify/judge/separation_inference.hpp"

namespace touchstone::verify::judge {

/// The label of a query: the claim of its source.
struct Label {
  std::optional<bool> collides = std::nullopt;
  std::optional<exact::Rational> toi = std::nullopt;
};

/// The comparison of labels with the truth.
struct LabelComparison {
  Inference inference = Inference::all;
  /// The tolerated error of a recorded time of impact.
  exact::Rational tolerance = {};

  /// True if the recorded verdict is compared.
  [[nodiscard]] bool uses_verdict(const Label& label) const;
  /// True if the recorded time of impact is compared.
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
