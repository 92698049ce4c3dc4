// The search in AArch64's NEON: sixteen boxes in four vectors.

#include <arm_neon.h>

#include "fast/broad_phase/search_on_lanes.hpp"
#include "fast/broad_phase/words_one_by_one.hpp"
#include "fast/platform/neon_floats.hpp"

namespace touchstone::fast {
namespace {

struct Lanes : WordsOneByOne {
  using Value = Floats;
  using Mask = FloatMask;

  static FloatMask equal(const std::int32_t* values, std::int32_t value) {
    const int32x4_t all = vdupq_n_s32(value);
    const auto four = [&](std::size_t first) { return vceqq_s32(vld1q_s32(values + first), all); };
    return {four(0), four(4), four(8), four(12)};
  }
};

}  // namespace

extern const SearchKernel neon_search_kernel;
const SearchKernel neon_search_kernel = search_kernel_on<Lanes>(InstructionSet::neon);

}  // namespace touchstone::fast
