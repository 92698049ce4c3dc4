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
template <class Range, class Iterator>
constexpr void nth_element(Range&& range, Iterator nth) {
  std::nth_element(std::begin(range), nth, std::end(range));
}
template <class Range>
constexpr void reverse(Range&& range) {
  std::reverse(std::begin(range), std::end(range));
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
template <class Range, class Value>
constexpr void replace(Range&& range, const Value& from, const Value& to) {
  std::replace(std::begin(range), std::end(range), from, to);
}
template <class Range, class Same = std::equal_to<>, class Projection = identity>
[[nodiscard]] constexpr auto adjacent_find(Range&& range, Same same = {},
                                           Projection projection = {}) {
  return std::adjacent_find(std::begin(range), std::end(range),
                            ProjectedLess<Same, Projection>{same, projection});
}
template <class Range, class Value>
[[nodiscard]] constexpr auto count(Range&& range, const Value& value) {
  return std::count(std::begin(range), std::end(range), value);
}
template <class Range>
[[nodiscard]] constexpr bool is_sorted(Range&& range) {
  return std::is_sorted(std::begin(range), std::end(range));
}
template <class A, class B>
[[nodiscard]] constexpr bool is_permutation(A&& a, B&& b) {
  return std::is_permutation(std::begin(a), std::end(a), std::begin(b), std::end(b));
}
template <class Range, class Less = std::less<>, class Projection = identity>
constexpr void stable_sort(Range&& range, Less less = {}, Projection projection = {}) {
  std::stable_sort(std::begin(range), std::end(range),
                   ProjectedLess<Less, Projection>{less, projection});
}
template <class Range, class Iterator>
constexpr void move(Range&& range, Iterator to) {
  std::move(std::begin(range), std::end(range), to);
}
template <class A, class B, class Iterator>
constexpr void set_difference(A&& a, B&& b, Iterator to) {
  std::set_difference(std::begin(a), std::end(a), std::begin(b), std::end(b), to);
}

template <class Range, class Value>
[[nodiscard]] constexpr bool binary_search(Range&& range, const Value& value) {
  return std::binary_search(std::begin(range), std::end(range), value);
}

template <class Range, class Value>
constexpr void fill(Range&& range, const Value& value) {
  std::fill(std::begin(range), std::end(range), value);
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
template <class A, class B>
[[nodiscard]] constexpr bool equal(const A& a, const B& b) {
  return std::equal(std::begin(a), std::end(a), std::begin(b), std::end(b));
}
template <class Range, class Iterator, class Function>
constexpr void transform(Range&& range, Iterator to, Function function) {
  std::transform(std::begin(range), std::end(range), to, function);
}
template <class Range, class Function>
constexpr void for_each(Range&& range, Function function) {
  for (auto&& item : range) function(item);
}

template <class Range, class Condition>
[[nodiscard]] constexpr auto find_if(Range&& range, Condition condition) {
  return std::find_if(std::begin(range), std::end(range), condition);
}
template <class Range, class Condition>
[[nodiscard]] constexpr auto count_if(Range&& range, Condition condition) {
  return std::count_if(std::begin(range), std::end(range), condition);
}
template <class Range, class Condition>
[[nodiscard]] constexpr bool all_of(Range&& range, Condition condition) {
  return std::all_of(std::begin(range), std::end(range), condition);
}
template <class Range, class Condition>
[[nodiscard]] constexpr bool any_of(Range&& range, Condition condition) {
  return std::any_of(std::begin(range), std::end(range), condition);
}
template <class Range, class Condition>
[[nodiscard]] constexpr bool none_of(Range&& range, Condition condition) {
  return std::none_of(std::begin(range), std::end(range), condition);
}

}  // namespace ranges
}  // namespace std

#endif
