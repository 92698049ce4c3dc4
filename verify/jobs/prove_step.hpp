#pragma once

/// \file
/// The certificate of a whole step: nothing touches up to a time, or the earliest contact lies between
/// two neighbouring doubles (exact/CERTIFICATES.md, "Steps").
///
/// The checker needs an argument for each pair that no axis keeps apart until then. Most have a
/// direction of small integers (step_places.hpp), the others the pieces of the oracle.

#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fast/step.hpp"

namespace touchstone::verify::jobs {

/// The first line of a stream of certificates of steps.
[[nodiscard]] std::string_view step_proofs_header();
/// The last line of a stream of so many: a stream without it is cut.
[[nodiscard]] std::string step_proofs_closing_line(std::uint64_t steps);

struct StepProofOptions {
  /// A line of text, of printable characters.
  std::string label = {};
  /// Cores to use; 0: all of them.
  unsigned threads = 0;
  /// Called with the certificate's lines in order, never from two threads at once.
  std::function<void(std::string_view)> on_text = nullptr;
  /// Called now and then with the fraction that is done, never from two threads at once.
  std::function<void(double)> on_progress = nullptr;
  /// Once true, the certificate ends where it is, and is none.
  const std::atomic<bool>* stop = nullptr;
};

struct StepProof {
  /// What is claimed, as the certificate says it: "no_contact T" or "earliest LO HI".
  std::string claim = {};
  std::uint64_t directions = 0;    ///< pairs with a direction
  std::uint64_t certificates = 0;  ///< pairs with pieces
  std::uint64_t bytes = 0;
  /// Why there is no proof; empty if there is one.
  std::string failure = {};
  bool interrupted = false;

  [[nodiscard]] bool is_complete() const { return failure.empty() && !interrupted; }
};

/// What the step's scene is made of: what it was made from.
struct SceneParts {
  std::span<const fast::Face> faces;
  std::span<const std::int32_t> points;
  fast::CollisionGroups groups = {};
};

/// Proves that the step is free up to its t_max, or when its earliest contact is.
/// \param parts the faces, points and groups of the step's elements and options
/// \throws whatever on_text throws.
[[nodiscard]] StepProof prove_step(const fast::Step& step, const SceneParts& parts,
                                   const StepProofOptions& options);

}  // namespace touchstone::verify::jobs
