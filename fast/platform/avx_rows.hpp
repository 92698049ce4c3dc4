#pragma once

/// \file
/// A point in a vector of four, and four points transposed into vectors of x, y and z, for
/// the AVX2 and the AVX-512 kernel. They are templates on a type that is local to the including
/// file, so that no other file links code for these instructions.

#include <immintrin.h>

namespace touchstone::fast {

template <class Local>
struct AvxRowMask {
  __m256d set;

  [[nodiscard]] bool any() const { return (_mm256_movemask_pd(set) & 0b111) != 0; }
  friend AvxRowMask operator&(const AvxRowMask& a, const AvxRowMask& b) {
    return {_mm256_and_pd(a.set, b.set)};
  }
  friend AvxRowMask operator|(const AvxRowMask& a, const AvxRowMask& b) {
    return {_mm256_or_pd(a.set, b.set)};
  }
};

/// x, y, z and an undefined fourth number.
template <class Local>
struct AvxRow {
  __m256d all;

  AvxRow() = default;
  explicit AvxRow(double value) : all(_mm256_set1_pd(value)) {}
  explicit AvxRow(__m256d value) : all(value) {}
  static AvxRow load(const double* from) { return AvxRow(_mm256_loadu_pd(from)); }
  /// Reads the number before the point instead of the one after it.
  static AvxRow load_backwards(const double* from) {
    return AvxRow(_mm256_permute4x64_pd(_mm256_loadu_pd(from - 1), 0b00'11'10'01));
  }
  [[nodiscard]] bool is_finite() const {
    const __m256d difference = _mm256_sub_pd(all, all);
    const __m256d is_zero = _mm256_cmp_pd(difference, _mm256_setzero_pd(), _CMP_EQ_OQ);
    return (_mm256_movemask_pd(is_zero) & 0b111) == 0b111;
  }

  friend AvxRow operator+(const AvxRow& a, const AvxRow& b) {
    return AvxRow(_mm256_add_pd(a.all, b.all));
  }
  friend AvxRow operator-(const AvxRow& a, const AvxRow& b) {
    return AvxRow(_mm256_sub_pd(a.all, b.all));
  }
  friend AvxRow operator*(const AvxRow& a, const AvxRow& b) {
    return AvxRow(_mm256_mul_pd(a.all, b.all));
  }
  friend AvxRow min(const AvxRow& a, const AvxRow& b) {
    return AvxRow(_mm256_min_pd(a.all, b.all));
  }
  friend AvxRow max(const AvxRow& a, const AvxRow& b) {
    return AvxRow(_mm256_max_pd(a.all, b.all));
  }
  friend AvxRowMask<Local> operator<(const AvxRow& a, const AvxRow& b) {
    return {_mm256_cmp_pd(a.all, b.all, _CMP_LT_OQ)};
  }
  friend AvxRowMask<Local> operator>(const AvxRow& a, const AvxRow& b) {
    return {_mm256_cmp_pd(a.all, b.all, _CMP_GT_OQ)};
  }
};

/// The transpose of four rows: vectors of their first to their last numbers.
template <class Local>
struct AvxColumns {
  __m256d first, second, third, fourth;

  static AvxColumns of(const double* a, const double* b, const double* c, const double* d) {
    const __m256d row_a = _mm256_loadu_pd(a), row_b = _mm256_loadu_pd(b);
    const __m256d row_c = _mm256_loadu_pd(c), row_d = _mm256_loadu_pd(d);
    const __m256d even_low = _mm256_unpacklo_pd(row_a, row_b);
    const __m256d odd_low = _mm256_unpackhi_pd(row_a, row_b);
    const __m256d even_high = _mm256_unpacklo_pd(row_c, row_d);
    const __m256d odd_high = _mm256_unpackhi_pd(row_c, row_d);
    return {_mm256_permute2f128_pd(even_low, even_high, 0x20),
            _mm256_permute2f128_pd(odd_low, odd_high, 0x20),
            _mm256_permute2f128_pd(even_low, even_high, 0x31),
            _mm256_permute2f128_pd(odd_low, odd_high, 0x31)};
  }
};

/// The x, y and z of four points.
template <class Local>
struct AvxPoints {
  __m256d x, y, z;

  static AvxPoints load(const double* const* rows) {
    const auto columns = AvxColumns<Local>::of(rows[0], rows[1], rows[2], rows[3]);
    return {columns.first, columns.second, columns.third};
  }
  /// Reads the numbers before the points instead of those after them.
  static AvxPoints load_backwards(const double* const* rows) {
    const auto columns = AvxColumns<Local>::of(rows[0] - 1, rows[1] - 1, rows[2] - 1, rows[3] - 1);
    return {columns.second, columns.third, columns.fourth};
  }
};

}  // namespace touchstone::fast
