// The filter of distances for one query, with fused operations. It is compiled for processors that
// have them, and called only there.

#include "fast/distance/filter_on_lanes.hpp"
#include "fast/platform/scalar_doubles.hpp"

namespace touchstone::fast {
namespace {

/// a · b − product, with a single rounding (touchstone/filters/double_double.hpp).
Value product_error(const Value& a, const Value& b, const Value& product) {
  return Value(__builtin_fma(a.x, b.x, -product.x));
}

struct Lanes {
  using Value = touchstone::fast::Value;
  using Mask = touchstone::fast::Mask;
  static constexpr std::size_t width = 1;
};

#ifdef TOUCHSTONE_X86_64
constexpr InstructionSet instructions = InstructionSet::avx2;
#else
constexpr InstructionSet instructions = InstructionSet::neon;
#endif

}  // namespace

extern const DistanceKernel fused_distance_kernel;
const DistanceKernel fused_distance_kernel = distance_kernel_on<Lanes>(instructions);

}  // namespace touchstone::fast
