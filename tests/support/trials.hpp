#pragma once

/// \file
/// The number of random cases of a test.

#include <cstdlib>

namespace touchstone::tests {

/// Under the sanitizers a case is several times as expensive, and their findings depend on the
/// path, not on the numbers: one case in eight there.
#ifdef TOUCHSTONE_SANITIZED
inline constexpr int sanitizer_divisor = 8;
#else
inline constexpr int sanitizer_divisor = 1;
#endif

/// `usual`, or its share under the sanitizers. For the number of cases, and for expected numbers of
/// some class of them.
template <class Count>
[[nodiscard]] constexpr Count trials(Count usual) {
  return usual / static_cast<Count>(sanitizer_divisor);
}

/// True in the long versions of the tests: ./run soak tests.
[[nodiscard]] inline bool is_soak() {
  return std::getenv("TOUCHSTONE_SOAK") != nullptr;  // NOLINT(concurrency-mt-unsafe)
}

/// `usual` trials, and this many times as many in the soak.
template <class Count>
[[nodiscard]] Count soak_trials(Count usual, Count times) {
  return trials(is_soak() ? static_cast<Count>(usual * times) : usual);
}

}  // namespace touchstone::tests
