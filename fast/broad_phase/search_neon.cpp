// The search in AArch64's NEON: sixteen boxes in four vectors.

#include <arm_neon.h>

#include "fast/broad_phase/search_on_lanes.hpp"
#include "fast/broad_phase/words_one_by_one.hpp"

namespace touchstone::fast {
namespace {

// GCC 12 loses stores to arrays of vectors.

/// Applies an operation on vectors to sixteen lanes.
template <class Result, class Operation, class... Sixteen>
Result each(const Operation& operation, const Sixteen&... lanes) {
  return {operation(lanes.first...), operation(lanes.second...), operation(lanes.third...),
          operation(lanes.fourth...)};
}

struct Mask {
  uint32x4_t first, second, third, fourth;

  static Mask of(std::uint32_t word) {
    const uint32x4_t words = vdupq_n_u32(word);
    return {words, words, words, words};
  }
  static Mask none() { return of(0); }
  static Mask all() { return of(~0U); }
  [[nodiscard]] unsigned bits() const {
    return eight_bits(first, second) | eight_bits(third, fourth) << 8U;
  }

  friend Mask operator&(const Mask& a, const Mask& b) {
    return each<Mask>([](uint32x4_t x, uint32x4_t y) { return vandq_u32(x, y); }, a, b);
  }
  friend Mask operator|(const Mask& a, const Mask& b) {
    return each<Mask>([](uint32x4_t x, uint32x4_t y) { return vorrq_u32(x, y); }, a, b);
  }

 private:
  static unsigned eight_bits(uint32x4_t low, uint32x4_t high) {
    // A byte for each lane, then a bit of its own in each byte, then their sum.
    const uint8x8_t bytes = vmovn_u16(vcombine_u16(vmovn_u32(low), vmovn_u32(high)));
    return vaddv_u8(vand_u8(bytes, vcreate_u8(0x8040201008040201)));
  }
};

struct Value {
  using Scalar = float;

  float32x4_t first, second, third, fourth;

  Value() = default;
  explicit Value(float value)
      : first(vdupq_n_f32(value)), second(first), third(first), fourth(first) {}
  Value(float32x4_t a, float32x4_t b, float32x4_t c, float32x4_t d)
      : first(a), second(b), third(c), fourth(d) {}
  static Value load(const float* from) {
    return {vld1q_f32(from), vld1q_f32(from + 4), vld1q_f32(from + 8), vld1q_f32(from + 12)};
  }
  void store(float* to) const {
    vst1q_f32(to, first);
    vst1q_f32(to + 4, second);
    vst1q_f32(to + 8, third);
    vst1q_f32(to + 12, fourth);
  }

  friend Value operator+(const Value& a, const Value& b) {
    return each<Value>([](float32x4_t x, float32x4_t y) { return vaddq_f32(x, y); }, a, b);
  }
  friend Value operator-(const Value& a, const Value& b) {
    return each<Value>([](float32x4_t x, float32x4_t y) { return vsubq_f32(x, y); }, a, b);
  }
  friend Value operator*(const Value& a, const Value& b) {
    return each<Value>([](float32x4_t x, float32x4_t y) { return vmulq_f32(x, y); }, a, b);
  }
  friend Mask operator<(const Value& a, const Value& b) {
    return each<Mask>([](float32x4_t x, float32x4_t y) { return vcltq_f32(x, y); }, a, b);
  }
  friend Mask operator>(const Value& a, const Value& b) {
    return each<Mask>([](float32x4_t x, float32x4_t y) { return vcgtq_f32(x, y); }, a, b);
  }
  friend Mask operator<=(const Value& a, const Value& b) {
    return each<Mask>([](float32x4_t x, float32x4_t y) { return vcleq_f32(x, y); }, a, b);
  }
  friend Mask operator==(const Value& a, const Value& b) {
    return each<Mask>([](float32x4_t x, float32x4_t y) { return vceqq_f32(x, y); }, a, b);
  }
  // As elsewhere: the second operand if there is a NaN.
  friend Value min(const Value& a, const Value& b) {
    return each<Value>(
        [](float32x4_t x, float32x4_t y) { return vbslq_f32(vcltq_f32(x, y), x, y); }, a, b);
  }
  friend Value max(const Value& a, const Value& b) {
    return each<Value>(
        [](float32x4_t x, float32x4_t y) { return vbslq_f32(vcgtq_f32(x, y), x, y); }, a, b);
  }
  friend Value abs(const Value& a) {
    return each<Value>([](float32x4_t x) { return vabsq_f32(x); }, a);
  }
};

struct Lanes : WordsOneByOne {
  using Value = touchstone::fast::Value;
  using Mask = touchstone::fast::Mask;

  static Value pick(const float* from, const Words<std::int32_t>& indices) {
    FloatLanes result;
    for (std::size_t i = 0; i < group_size; ++i) result[i] = from[indices[i]];
    return Value::load(result.data());
  }
  static unsigned equal_bits(const std::int32_t* values, std::int32_t value) {
    const int32x4_t all = vdupq_n_s32(value);
    const auto equal = [&](std::size_t first) { return vceqq_s32(vld1q_s32(values + first), all); };
    return Mask{equal(0), equal(4), equal(8), equal(12)}.bits();
  }
};

}  // namespace

extern const SearchKernel neon_search_kernel;
const SearchKernel neon_search_kernel = search_kernel_on<Lanes>(InstructionSet::neon);

}  // namespace touchstone::fast
