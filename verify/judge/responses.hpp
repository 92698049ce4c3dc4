#pragma once

/// \file
/// Whether a solver answers at all: one that answers nothing was not judged, and one that hangs too
/// often is at fault.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "verify/judge/judgement.hpp"

namespace touchstone::verify::judge {

/// The responses of a solver to the queries of a run.
struct Responses {
  std::uint64_t asked = 0;
  std::uint64_t hangs = 0;
  std::uint64_t errors = 0;
  std::uint64_t unasked = 0;  ///< outside its terms, or skipped

  [[nodiscard]] static Responses of(const Judgement& judgement);
};

/// What is wrong with the responses of a solver.
struct Silence {
  bool is_unjudged;  ///< it answered nothing; otherwise it hung too often
  std::string text;
};

/// nullopt if the solver answers, or there were no queries. It hangs too often at more than one
/// query in a hundred.
[[nodiscard]] std::optional<Silence> silence_of(std::string_view solver,
                                                const Responses& responses);

}  // namespace touchstone::verify::judge
