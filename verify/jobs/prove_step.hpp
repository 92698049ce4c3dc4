#pragma once

/// \file
/// The certificate of a whole step: there is no collision up to a time, or the earliest
/// contact is between two neighbouring doubles (exact/CERTIFICATES.md, "Steps"). Its text is
/// written by exact/certificate/step_certificate_text.hpp.
///
/// The checker needs an argument for each pair that no axis separates until then. Most have a
/// direction of small integers (step_places.hpp), the others the subintervals of the oracle. It
/// verifies the volumes of all elements, and needs subintervals only for those that are nearly
/// flat.

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "exact/checker/summary.hpp"
#include "touchstone/step.hpp"

namespace touchstone::verify::jobs {

struct StepProofOptions {
  /// A line of text, which the certificate has in the form of exact::label_text.
  std::string label = {};
  /// Cores to use; 0: all of them.
  unsigned threads = 0;
  /// Called with the certificate's lines in order, never from two threads at once.
  std::function<void(std::string_view)> on_text = nullptr;
  /// Called occasionally with the completed fraction, never from two threads at once.
  std::function<void(double)> on_progress = nullptr;
  /// Once true, the certificate ends there and is invalid. May be null.
  const std::atomic<bool>* stop = nullptr;
};

struct StepProof {
  /// The claim, as in the certificate: "no_contact T" or "earliest LO HI".
  std::string claim = {};
  /// What the checker says of it beside others (exact/checker/summary.hpp).
  checker::Statement statement = {};
  /// True if the certificate's scene ends at the frame with which the next step begins.
  bool ends_at_frame = true;
  std::uint64_t directions = 0;    ///< pairs with a direction
  std::uint64_t certificates = 0;  ///< pairs and elements with subintervals
  std::uint64_t bytes = 0;
  /// The reason for a missing proof; empty if there is one.
  std::string failure = {};
  bool interrupted = false;

  [[nodiscard]] bool is_complete() const { return failure.empty() && !interrupted; }
};

/// Proves that the step is free up to its t_max, or the time of its earliest contact or inversion.
/// \pre The step has no rule `can_collide`: certificates know groups alone.
/// \throws the exceptions of on_text.
[[nodiscard]] StepProof prove_step(const fast::Step& step, const StepProofOptions& options);

}  // namespace touchstone::verify::jobs
