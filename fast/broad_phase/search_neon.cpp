// The search in AArch64's NEON: sixteen boxes in four vectors.

#include <arm_neon.h>

#include "fast/broad_phase/search_on_lanes.hpp"
#include "fast/broad_phase/words_one_by_one.hpp"

namespace touchstone::fast {
namespace {

/// Sixteen lanes, four to a vector.
template <class Vector>
struct Four {
  std::array<Vector, 4> part;

  /// The lanes that function(i) returns for the vectors.
  template <class Function>
  static Four each(const Function& function) {
    return {{function(std::size_t{0}), function(std::size_t{1}), function(std::size_t{2}),
             function(std::size_t{3})}};
  }
};

struct Mask : Four<uint32x4_t> {
  friend Mask operator|(const Mask& a, const Mask& b) {
    return {each([&](std::size_t i) { return vorrq_u32(a.part[i], b.part[i]); })};
  }
};

struct Lanes : WordsOneByOne {
  using Numbers = Four<float32x4_t>;
  using Mask = touchstone::fast::Mask;

  static Numbers load(const float* from) {
    return Numbers::each([&](std::size_t i) { return vld1q_f32(from + 4 * i); });
  }
  static Numbers load_unaligned(const float* from) { return load(from); }
  static Numbers broadcast(float x) {
    return Numbers::each([&](std::size_t) { return vdupq_n_f32(x); });
  }
  static void store(float* to, const Numbers& numbers) {
    for (std::size_t i = 0; i < 4; ++i) vst1q_f32(to + 4 * i, numbers.part[i]);
  }
  static Numbers least(const Numbers& a, const Numbers& b) {
    return Numbers::each([&](std::size_t i) {
      return vbslq_f32(vcltq_f32(a.part[i], b.part[i]), a.part[i], b.part[i]);
    });
  }
  static Numbers greatest(const Numbers& a, const Numbers& b) {
    return Numbers::each([&](std::size_t i) {
      return vbslq_f32(vcgtq_f32(a.part[i], b.part[i]), a.part[i], b.part[i]);
    });
  }
  static Mask none() {
    return {Mask::each([](std::size_t) { return vdupq_n_u32(0); })};
  }
  static Mask greater(const Numbers& a, const Numbers& b) {
    return {Mask::each([&](std::size_t i) { return vcgtq_f32(a.part[i], b.part[i]); })};
  }
  static Mask equal(const Numbers& a, const Numbers& b) {
    return {Mask::each([&](std::size_t i) { return vceqq_f32(a.part[i], b.part[i]); })};
  }
  static Mask greater_where(const Mask& mask, const Numbers& a, const Numbers& b) {
    return {Mask::each(
        [&](std::size_t i) { return vandq_u32(mask.part[i], vcgtq_f32(a.part[i], b.part[i])); })};
  }
  static unsigned bits(const Mask& mask) {
    // A byte for each lane, then a bit of its own in each byte of a half, then their sums.
    const auto half = [&](std::size_t i) {
      return vcombine_u16(vmovn_u32(mask.part[i]), vmovn_u32(mask.part[i + 1]));
    };
    const uint8x8_t places = vcreate_u8(0x8040201008040201);
    const auto sum = [&](std::size_t i) {
      return static_cast<unsigned>(vaddv_u8(vand_u8(vmovn_u16(half(i)), places)));
    };
    return sum(0) | sum(2) << 8U;
  }

  static unsigned equal_bits(const std::int32_t* values, std::int32_t value) {
    const int32x4_t all = vdupq_n_s32(value);
    return bits(
        {Mask::each([&](std::size_t i) { return vceqq_s32(vld1q_s32(values + 4 * i), all); })});
  }
};

}  // namespace

extern const SearchKernel neon_search_kernel;
const SearchKernel neon_search_kernel = search_kernel_on<Lanes>(InstructionSet::neon);

}  // namespace touchstone::fast
