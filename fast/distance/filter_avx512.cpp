// The filter of distances in AVX-512 (its foundation, F), eight queries at a time. It is compiled
// for these instructions and called only on processors that have them.

#include "fast/distance/filter_on_lanes.hpp"
#include "fast/platform/avx512_doubles.hpp"

namespace touchstone::fast {
namespace {

struct Lanes {
  using Value = touchstone::fast::Value;
  using Mask = touchstone::fast::Mask;
  static constexpr std::size_t width = 8;
};

}  // namespace

extern const DistanceKernel avx512_distance_kernel;
const DistanceKernel avx512_distance_kernel = distance_kernel_on<Lanes>(InstructionSet::avx512);

}  // namespace touchstone::fast
