#pragma once

/// \file
/// How many random cases a test takes.

namespace touchstone::tests {

/// Under the sanitizers a case costs several times as much, and what they look for depends on the path
/// taken and not on the numbers: one case in eight there.
#ifdef TOUCHSTONE_SANITIZED
inline constexpr int sanitizer_divisor = 8;
#else
inline constexpr int sanitizer_divisor = 1;
#endif

/// `usual`, or its share under the sanitizers. For the number of cases, and for how many of them a test
/// expects to be of some sort.
template <class Count>
[[nodiscard]] constexpr Count trials(Count usual) {
  return usual / static_cast<Count>(sanitizer_divisor);
}

}  // namespace touchstone::tests
