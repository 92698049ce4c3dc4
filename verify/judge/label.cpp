#include "verify/judge/label.hpp"

#include <fmt/format.h>

#include "verify/data/ground_truth_files.hpp"

namespace touchstone::verify::judge {
namespace {

std::string verdict_text(bool collides) { return collides ? "collision" : "no collision"; }

/// The first significant digits, by which the relative error is far below a unit in the last one.
std::string decimal_text(const exact::AlgebraicNumber& number, unsigned digits) {
  const exact::Rational relative_width =
      exact::power_of_two(-16 - 10 * static_cast<long>(digits) / 3);
  exact::AlgebraicNumber refined = number;
  // Zero would be known as rational, so the lower end leaves zero sooner or later.
  for (unsigned long level = 1; !refined.rational(); level *= 2) {
    refined.refine_to_level(level);
    const auto [lower, upper] = refined.interval();
    if (upper - lower <= relative_width * lower) break;
  }
  return data::to_decimal(refined.interval().lower, digits);
}

/// The mismatch of a recorded time of impact and the true one, both with enough digits for the
/// texts to differ, at least 45, as published times have.
Mismatch toi_mismatch(std::uint64_t index, const exact::Rational& recorded,
                      const exact::AlgebraicNumber& toi) {
  Mismatch mismatch{Mismatch::Of::toi, index, {}, {}};
  for (unsigned digits = 45; mismatch.recorded == mismatch.truth; digits *= 2) {
    mismatch.recorded = data::to_decimal(recorded, digits);
    mismatch.truth = decimal_text(toi, digits);
  }
  return mismatch;
}

bool accepts(const LabelComparison& comparison, const exact::Rational& recorded,
             const exact::AlgebraicNumber& toi) {
  const exact::Rational lower = recorded - comparison.tolerance;
  const exact::Rational upper = recorded + comparison.tolerance;
  return toi <= upper && (comparison.inference == Inference::collisions || toi >= lower);
}

}  // namespace

bool LabelComparison::uses_verdict(const Label& label) const {
  if (inference == Inference::collisions) return label.collides.value_or(false);
  return inference == Inference::all && label.collides;
}

bool LabelComparison::uses_toi(const Label& label) const {
  return inference != Inference::nothing && label.toi;
}

std::string to_text(const Mismatch& mismatch) {
  return fmt::format("recorded {}: {}, the truth is {}",
                     mismatch.of == Mismatch::Of::label ? "label" : "time of impact",
                     mismatch.recorded, mismatch.truth);
}

std::vector<Mismatch> judge_label(std::uint64_t index, const Label& label,
                                  const exact::Decision& truth, const LabelComparison& comparison) {
  std::vector<Mismatch> mismatches;
  const std::string true_verdict = verdict_text(truth.collides());
  if (comparison.uses_verdict(label) && *label.collides != truth.collides()) {
    mismatches.push_back({Mismatch::Of::label, index, verdict_text(*label.collides), true_verdict});
  }
  if (!comparison.uses_toi(label)) return mismatches;
  if (!truth.collides()) {
    mismatches.push_back({Mismatch::Of::toi, index, data::to_decimal(*label.toi), true_verdict});
  } else if (!accepts(comparison, *label.toi, *truth.toi)) {
    mismatches.push_back(toi_mismatch(index, *label.toi, *truth.toi));
  }
  return mismatches;
}

}  // namespace touchstone::verify::judge
