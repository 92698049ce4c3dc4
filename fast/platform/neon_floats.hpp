#pragma once

/// \file
/// Sixteen floats in four registers of AArch64's NEON, masks of them, and sixteen whole numbers,
/// for the kernels, local to the including file.

#include <arm_neon.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace touchstone::fast {
namespace {  // NOLINT(cert-dcl59-cpp,google-build-namespaces): see above

// GCC 12 loses stores to arrays of vectors.

/// Applies an operation on vectors to sixteen lanes.
template <class Result, class Operation, class... Sixteen>
Result each(const Operation& operation, const Sixteen&... lanes) {
  return {operation(lanes.first...), operation(lanes.second...), operation(lanes.third...),
          operation(lanes.fourth...)};
}

struct FloatMask {
  uint32x4_t first, second, third, fourth;

  static FloatMask of(std::uint32_t word) {
    const uint32x4_t words = vdupq_n_u32(word);
    return {words, words, words, words};
  }
  static FloatMask none() { return of(0); }
  static FloatMask all() { return of(~0U); }
  [[nodiscard]] unsigned bits() const {
    return eight_bits(first, second) | eight_bits(third, fourth) << 8U;
  }

  friend FloatMask operator&(const FloatMask& a, const FloatMask& b) {
    return each<FloatMask>([](uint32x4_t x, uint32x4_t y) { return vandq_u32(x, y); }, a, b);
  }
  friend FloatMask operator|(const FloatMask& a, const FloatMask& b) {
    return each<FloatMask>([](uint32x4_t x, uint32x4_t y) { return vorrq_u32(x, y); }, a, b);
  }

 private:
  static unsigned eight_bits(uint32x4_t low, uint32x4_t high) {
    // A byte for each lane, then a bit of its own in each byte, then their sum.
    const uint8x8_t bytes = vmovn_u16(vcombine_u16(vmovn_u32(low), vmovn_u32(high)));
    return vaddv_u8(vand_u8(bytes, vcreate_u8(0x8040201008040201)));
  }
};

struct Floats {
  using Scalar = float;
  static constexpr std::size_t width = 16;

  float32x4_t first, second, third, fourth;

  Floats() = default;
  explicit Floats(float value)
      : first(vdupq_n_f32(value)), second(first), third(first), fourth(first) {}
  Floats(float32x4_t a, float32x4_t b, float32x4_t c, float32x4_t d)
      : first(a), second(b), third(c), fourth(d) {}
  static Floats load(const float* from) {
    return {vld1q_f32(from), vld1q_f32(from + 4), vld1q_f32(from + 8), vld1q_f32(from + 12)};
  }
  void store(float* to) const {
    vst1q_f32(to, first);
    vst1q_f32(to + 4, second);
    vst1q_f32(to + 8, third);
    vst1q_f32(to + 12, fourth);
  }

  friend Floats operator+(const Floats& a, const Floats& b) {
    return each<Floats>([](float32x4_t x, float32x4_t y) { return vaddq_f32(x, y); }, a, b);
  }
  friend Floats operator-(const Floats& a, const Floats& b) {
    return each<Floats>([](float32x4_t x, float32x4_t y) { return vsubq_f32(x, y); }, a, b);
  }
  friend Floats operator*(const Floats& a, const Floats& b) {
    return each<Floats>([](float32x4_t x, float32x4_t y) { return vmulq_f32(x, y); }, a, b);
  }
  friend Floats operator/(const Floats& a, const Floats& b) {
    return each<Floats>([](float32x4_t x, float32x4_t y) { return vdivq_f32(x, y); }, a, b);
  }
  friend FloatMask operator<(const Floats& a, const Floats& b) {
    return each<FloatMask>([](float32x4_t x, float32x4_t y) { return vcltq_f32(x, y); }, a, b);
  }
  friend FloatMask operator>(const Floats& a, const Floats& b) {
    return each<FloatMask>([](float32x4_t x, float32x4_t y) { return vcgtq_f32(x, y); }, a, b);
  }
  friend FloatMask operator<=(const Floats& a, const Floats& b) {
    return each<FloatMask>([](float32x4_t x, float32x4_t y) { return vcleq_f32(x, y); }, a, b);
  }
  friend FloatMask operator>=(const Floats& a, const Floats& b) {
    return each<FloatMask>([](float32x4_t x, float32x4_t y) { return vcgeq_f32(x, y); }, a, b);
  }
  friend FloatMask operator==(const Floats& a, const Floats& b) {
    return each<FloatMask>([](float32x4_t x, float32x4_t y) { return vceqq_f32(x, y); }, a, b);
  }
  // The second operand if there is a NaN, as in the other instruction sets.
  friend Floats min(const Floats& a, const Floats& b) {
    return each<Floats>(
        [](float32x4_t x, float32x4_t y) { return vbslq_f32(vcltq_f32(x, y), x, y); }, a, b);
  }
  friend Floats max(const Floats& a, const Floats& b) {
    return each<Floats>(
        [](float32x4_t x, float32x4_t y) { return vbslq_f32(vcgtq_f32(x, y), x, y); }, a, b);
  }
  friend Floats select(const FloatMask& mask, const Floats& a, const Floats& b) {
    return each<Floats>(
        [](uint32x4_t m, float32x4_t x, float32x4_t y) { return vbslq_f32(m, x, y); }, mask, a, b);
  }
  friend Floats abs(const Floats& a) {
    return each<Floats>([](float32x4_t x) { return vabsq_f32(x); }, a);
  }
};

struct Wholes {
  int32x4_t first, second, third, fourth;

  /// x, y and z of a member of sixteen items; a fourth number follows each.
  template <class Item>
  static std::array<Wholes, 3> load(const Item* const* items,
                                    std::array<std::int32_t, 4> Item::*member) {
    const auto row = [=](std::size_t i) { return (items[i]->*member).data(); };
    const Columns a = columns(row, 0), b = columns(row, 4);
    const Columns c = columns(row, 8), d = columns(row, 12);
    return {Wholes{a.x, b.x, c.x, d.x}, Wholes{a.y, b.y, c.y, d.y}, Wholes{a.z, b.z, c.z, d.z}};
  }

  /// The difference, rounded to a float.
  friend Floats operator-(const Wholes& a, const Wholes& b) {
    return each<Floats>([](int32x4_t p, int32x4_t q) { return vcvtq_f32_s32(vsubq_s32(p, q)); }, a,
                        b);
  }

 private:
  struct Columns {
    int32x4_t x, y, z;
  };
  template <class Row>
  static Columns columns(const Row& row, std::size_t first) {
    const int32x4_t a = vld1q_s32(row(first)), b = vld1q_s32(row(first + 1));
    const int32x4_t c = vld1q_s32(row(first + 2)), d = vld1q_s32(row(first + 3));
    const int32x4_t xz_ab = vtrn1q_s32(a, b), y_ab = vtrn2q_s32(a, b);
    const int32x4_t xz_cd = vtrn1q_s32(c, d), y_cd = vtrn2q_s32(c, d);
    return {vcombine_s32(vget_low_s32(xz_ab), vget_low_s32(xz_cd)),
            vcombine_s32(vget_low_s32(y_ab), vget_low_s32(y_cd)),
            vcombine_s32(vget_high_s32(xz_ab), vget_high_s32(xz_cd))};
  }
};

}  // namespace
}  // namespace touchstone::fast
