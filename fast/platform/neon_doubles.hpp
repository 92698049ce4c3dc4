#pragma once

/// \file
/// Two doubles in a register of AArch64's NEON, and masks of them, for the kernels. They are local
/// to the including file, like those of other instruction sets.

#include <arm_neon.h>

#include <array>

namespace touchstone::fast {
namespace {  // NOLINT(cert-dcl59-cpp,google-build-namespaces): see above

struct Mask {
  uint64x2_t set;

  static Mask none() { return {vdupq_n_u64(0)}; }
  static Mask all() { return {vdupq_n_u64(~0ULL)}; }
  [[nodiscard]] unsigned bits() const {
    return static_cast<unsigned>((vgetq_lane_u64(set, 0) & 1U) | (vgetq_lane_u64(set, 1) & 2U));
  }

  friend Mask operator&(const Mask& a, const Mask& b) { return {vandq_u64(a.set, b.set)}; }
  friend Mask operator|(const Mask& a, const Mask& b) { return {vorrq_u64(a.set, b.set)}; }
};

struct Value {
  using Scalar = double;

  float64x2_t x;

  Value() = default;
  explicit Value(double value) : x(vdupq_n_f64(value)) {}
  explicit Value(float64x2_t value) : x(value) {}
  static Value load(const double* from) { return Value(vld1q_f64(from)); }
  /// x, y and z of a point at each of the addresses; a fourth number follows each.
  static std::array<Value, 3> load_points(const double* const* rows) {
    const float64x2_t a = vld1q_f64(rows[0]), b = vld1q_f64(rows[1]);
    return {Value(vzip1q_f64(a, b)), Value(vzip2q_f64(a, b)),
            Value(vcombine_f64(vld1_f64(rows[0] + 2), vld1_f64(rows[1] + 2)))};
  }
  void store(double* to) const { vst1q_f64(to, x); }

  friend Value operator+(const Value& a, const Value& b) { return Value(vaddq_f64(a.x, b.x)); }
  friend Value operator-(const Value& a, const Value& b) { return Value(vsubq_f64(a.x, b.x)); }
  friend Value operator*(const Value& a, const Value& b) { return Value(vmulq_f64(a.x, b.x)); }
  friend Value operator/(const Value& a, const Value& b) { return Value(vdivq_f64(a.x, b.x)); }
  friend Mask operator<(const Value& a, const Value& b) { return {vcltq_f64(a.x, b.x)}; }
  friend Mask operator>(const Value& a, const Value& b) { return {vcgtq_f64(a.x, b.x)}; }
  friend Mask operator<=(const Value& a, const Value& b) { return {vcleq_f64(a.x, b.x)}; }
  friend Mask operator>=(const Value& a, const Value& b) { return {vcgeq_f64(a.x, b.x)}; }
  friend Mask operator==(const Value& a, const Value& b) { return {vceqq_f64(a.x, b.x)}; }
  // The second operand if there is a NaN or both are zeros, as in the other instruction sets.
  friend Value min(const Value& a, const Value& b) { return select(a < b, a, b); }
  friend Value max(const Value& a, const Value& b) { return select(a > b, a, b); }
  friend Value abs(const Value& a) { return Value(vabsq_f64(a.x)); }
  friend Value sqrt(const Value& a) { return Value(vsqrtq_f64(a.x)); }
  friend Value select(const Mask& mask, const Value& a, const Value& b) {
    return Value(vbslq_f64(mask.set, a.x, b.x));
  }
  /// a · b − product, with a single rounding.
  friend Value product_error(const Value& a, const Value& b, const Value& product) {
    return Value(vfmaq_f64(vnegq_f64(product.x), a.x, b.x));
  }
};

}  // namespace
}  // namespace touchstone::fast
