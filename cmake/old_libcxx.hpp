#pragma once

/// \file
/// The part of C++20's library that this project uses and the libc++ of Debian's emscripten (of
/// LLVM 13) lacks. The compiler includes it before each source (cmake/wasm.cmake); from LLVM 16 on
/// it is empty.

#include <ciso646>

#if defined(_LIBCPP_VERSION) && _LIBCPP_VERSION < 16000

#include <algorithm>
#include <array>
#include <charconv>
#include <compare>
#include <cstddef>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <system_error>
#include <type_traits>
#include <utility>

namespace std {  // NOLINT(cert-dcl58-cpp): it takes the library's place

template <class To, class From>
[[nodiscard]] constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

template <class Array>
[[nodiscard]] unique_ptr<Array> make_unique_for_overwrite(size_t size) {
  return unique_ptr<Array>(new remove_extent_t<Array>[size]);
}

template <class T, size_t n>
constexpr auto operator<=>(const array<T, n>& a, const array<T, n>& b) -> decltype(a[0] <=> b[0]) {
  size_t i = 0;
  while (i + 1 < n && a[i] == b[i]) ++i;
  return a[i] <=> b[i];
}

/// Numbers in C's format, which has more of them than C++'s: for texts that end with a zero.
inline from_chars_result from_chars(const char* first, const char* last, double& value) {
  const string text(first, last);
  char* end = nullptr;
  const double read = strtod(text.c_str(), &end);
  if (end == text.c_str()) return {first, errc::invalid_argument};
  value = read;
  return {first + (end - text.c_str()), errc()};
}

namespace ranges {

/// The function of iterators for a range.
#define TOUCHSTONE_ON_RANGE(function)                                                      \
  template <class Range, class... More>                                                    \
  constexpr decltype(auto) function(Range&& range, More&&... more) {                       \
    return std::function(std::begin(range), std::end(range), std::forward<More>(more)...); \
  }
TOUCHSTONE_ON_RANGE(reverse)
TOUCHSTONE_ON_RANGE(replace)
TOUCHSTONE_ON_RANGE(count)
TOUCHSTONE_ON_RANGE(is_sorted)
TOUCHSTONE_ON_RANGE(move)
TOUCHSTONE_ON_RANGE(binary_search)
TOUCHSTONE_ON_RANGE(fill)
TOUCHSTONE_ON_RANGE(transform)
TOUCHSTONE_ON_RANGE(find_if)
TOUCHSTONE_ON_RANGE(count_if)
TOUCHSTONE_ON_RANGE(all_of)
TOUCHSTONE_ON_RANGE(any_of)
TOUCHSTONE_ON_RANGE(none_of)
#undef TOUCHSTONE_ON_RANGE

/// The same for two ranges.
#define TOUCHSTONE_ON_RANGES(function)                                           \
  template <class A, class B, class... More>                                     \
  constexpr decltype(auto) function(A&& a, B&& b, More&&... more) {              \
    return std::function(std::begin(a), std::end(a), std::begin(b), std::end(b), \
                         std::forward<More>(more)...);                           \
  }
TOUCHSTONE_ON_RANGES(is_permutation)
TOUCHSTONE_ON_RANGES(set_difference)
TOUCHSTONE_ON_RANGES(equal)
#undef TOUCHSTONE_ON_RANGES

/// The order of projections, or their equality.
template <class Less, class Projection>
struct ProjectedLess {
  Less less;
  Projection projection;

  template <class A, class B>
  constexpr bool operator()(const A& a, const B& b) const {
    return invoke(less, invoke(projection, a), invoke(projection, b));
  }
};

template <class Range, class Less = std::less<>, class Projection = identity>
constexpr void sort(Range&& range, Less less = {}, Projection projection = {}) {
  std::sort(std::begin(range), std::end(range), ProjectedLess<Less, Projection>{less, projection});
}

template <class Iterator, class Less = std::less<>, class Projection>
constexpr void sort(Iterator first, Iterator last, Less less, Projection projection) {
  std::sort(first, last, ProjectedLess<Less, Projection>{less, projection});
}

template <class Range, class Iterator, class Less = std::less<>, class Projection = identity>
constexpr void nth_element(Range&& range, Iterator nth, Less less = {},
                           Projection projection = {}) {
  std::nth_element(std::begin(range), nth, std::end(range),
                   ProjectedLess<Less, Projection>{less, projection});
}

template <class Range, class Less = std::less<>, class Projection = identity>
[[nodiscard]] constexpr auto min(Range&& range, Less less = {}, Projection projection = {}) {
  return *std::min_element(std::begin(range), std::end(range),
                           ProjectedLess<Less, Projection>{less, projection});
}

template <class Range, class Less = std::less<>, class Projection = identity>
[[nodiscard]] constexpr auto max(Range&& range, Less less = {}, Projection projection = {}) {
  return *std::max_element(std::begin(range), std::end(range),
                           ProjectedLess<Less, Projection>{less, projection});
}

template <class Range, class Less = std::less<>, class Projection = identity>
[[nodiscard]] constexpr auto minmax(Range&& range, Less less = {}, Projection projection = {}) {
  const auto [least, most] = std::minmax_element(std::begin(range), std::end(range),
                                                 ProjectedLess<Less, Projection>{less, projection});
  return std::pair(*least, *most);
}

template <class Range, class Value, class Projection = identity>
[[nodiscard]] constexpr auto find(Range&& range, const Value& value, Projection projection = {}) {
  return std::find_if(std::begin(range), std::end(range),
                      [&](const auto& item) { return invoke(projection, item) == value; });
}

template <class Range, class Value, class Less = std::less<>, class Projection = identity>
[[nodiscard]] constexpr auto lower_bound(Range&& range, const Value& value, Less less = {},
                                         Projection projection = {}) {
  return std::lower_bound(
      std::begin(range), std::end(range), value,
      [&](const auto& item, const Value& x) { return invoke(less, invoke(projection, item), x); });
}

template <class Iterator, class Less = std::less<>, class Projection>
constexpr void nth_element(Iterator first, Iterator nth, Iterator last, Less less,
                           Projection projection) {
  std::nth_element(first, nth, last, ProjectedLess<Less, Projection>{less, projection});
}

template <class Range, class Same = std::equal_to<>, class Projection = identity>
[[nodiscard]] constexpr auto adjacent_find(Range&& range, Same same = {},
                                           Projection projection = {}) {
  return std::adjacent_find(std::begin(range), std::end(range),
                            ProjectedLess<Same, Projection>{same, projection});
}

template <class Range, class Less = std::less<>, class Projection = identity>
constexpr void stable_sort(Range&& range, Less less = {}, Projection projection = {}) {
  std::stable_sort(std::begin(range), std::end(range),
                   ProjectedLess<Less, Projection>{less, projection});
}

template <class Iterator>
struct CopyResult {
  Iterator out;
};

template <class Range, class Iterator>
constexpr CopyResult<Iterator> copy(Range&& range, Iterator to) {
  return {std::copy(std::begin(range), std::end(range), to)};
}

template <class Range, class Iterator, class Condition>
constexpr CopyResult<Iterator> copy_if(Range&& range, Iterator to, Condition condition) {
  return {std::copy_if(std::begin(range), std::end(range), to, condition)};
}

template <class Range, class Function>
constexpr void for_each(Range&& range, Function function) {
  for (auto&& item : range) function(item);
}

}  // namespace ranges
}  // namespace std

#endif
