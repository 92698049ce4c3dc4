// The search in AArch64's NEON: sixteen boxes in four vectors.

#include <arm_neon.h>

#include "fast/broad_phase/search_on_lanes.hpp"
#include "fast/broad_phase/words_one_by_one.hpp"

namespace touchstone::fast {
namespace {

// GCC 12 loses stores to arrays of vectors.

struct Numbers {
  float32x4_t first, second, third, fourth;
};

struct Mask {
  uint32x4_t first, second, third, fourth;
};

/// Applies an operation on vectors to sixteen lanes.
template <class Result, class Operation, class... Sixteen>
Result each(const Operation& operation, const Sixteen&... lanes) {
  return {operation(lanes.first...), operation(lanes.second...), operation(lanes.third...),
          operation(lanes.fourth...)};
}

Mask operator|(const Mask& a, const Mask& b) {
  return each<Mask>([](uint32x4_t x, uint32x4_t y) { return vorrq_u32(x, y); }, a, b);
}

struct Lanes : WordsOneByOne {
  using Numbers = touchstone::fast::Numbers;
  using Mask = touchstone::fast::Mask;

  static Numbers load(const float* from) {
    return {vld1q_f32(from), vld1q_f32(from + 4), vld1q_f32(from + 8), vld1q_f32(from + 12)};
  }
  static Numbers load_unaligned(const float* from) { return load(from); }
  static Numbers broadcast(float x) {
    const float32x4_t all = vdupq_n_f32(x);
    return {all, all, all, all};
  }
  static void store(float* to, const Numbers& numbers) {
    vst1q_f32(to, numbers.first);
    vst1q_f32(to + 4, numbers.second);
    vst1q_f32(to + 8, numbers.third);
    vst1q_f32(to + 12, numbers.fourth);
  }
  static Numbers least(const Numbers& a, const Numbers& b) {
    const auto lesser = [](float32x4_t x, float32x4_t y) {
      return vbslq_f32(vcltq_f32(x, y), x, y);
    };
    return each<Numbers>(lesser, a, b);
  }
  static Numbers greatest(const Numbers& a, const Numbers& b) {
    const auto larger = [](float32x4_t x, float32x4_t y) {
      return vbslq_f32(vcgtq_f32(x, y), x, y);
    };
    return each<Numbers>(larger, a, b);
  }
  static Mask none() {
    const uint32x4_t zero = vdupq_n_u32(0);
    return {zero, zero, zero, zero};
  }
  static Mask greater(const Numbers& a, const Numbers& b) {
    return each<Mask>([](float32x4_t x, float32x4_t y) { return vcgtq_f32(x, y); }, a, b);
  }
  static Mask equal(const Numbers& a, const Numbers& b) {
    return each<Mask>([](float32x4_t x, float32x4_t y) { return vceqq_f32(x, y); }, a, b);
  }
  static Mask greater_where(const Mask& mask, const Numbers& a, const Numbers& b) {
    return each<Mask>([](uint32x4_t x, uint32x4_t y) { return vandq_u32(x, y); }, mask,
                      greater(a, b));
  }
  static unsigned bits(const Mask& mask) {
    return eight_bits(mask.first, mask.second) | eight_bits(mask.third, mask.fourth) << 8U;
  }

  static unsigned equal_bits(const std::int32_t* values, std::int32_t value) {
    const int32x4_t all = vdupq_n_s32(value);
    const auto equal = [&](std::size_t first) { return vceqq_s32(vld1q_s32(values + first), all); };
    return bits({equal(0), equal(4), equal(8), equal(12)});
  }

 private:
  static unsigned eight_bits(uint32x4_t low, uint32x4_t high) {
    // A byte for each lane, then a bit of its own in each byte, then their sum.
    const uint8x8_t bytes = vmovn_u16(vcombine_u16(vmovn_u32(low), vmovn_u32(high)));
    return vaddv_u8(vand_u8(bytes, vcreate_u8(0x8040201008040201)));
  }
};

}  // namespace

extern const SearchKernel neon_search_kernel;
const SearchKernel neon_search_kernel = search_kernel_on<Lanes>(InstructionSet::neon);

}  // namespace touchstone::fast
