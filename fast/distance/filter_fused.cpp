// The filter of distances for one query, with fused operations. It is compiled for processors that
// have them, and called only there.

#include "fast/distance/filter_on_lanes.hpp"
#include "fast/platform/lanes_scalar.hpp"

namespace touchstone::fast {
namespace {

struct Fused : Portable {
  static constexpr bool is_fused = true;
  static double product_error(double a, double b, double product) {
    return __builtin_fma(a, b, -product);
  }
};

struct Lanes {
  using Value = ValueOn<Fused, double, 1>;
  using Mask = Value::Mask;
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
