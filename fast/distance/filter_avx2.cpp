// The filter of distances in AVX2 and FMA, four queries at a time. It is compiled for these
// instructions and called only on processors that have them.

#include "fast/distance/filter_on_lanes.hpp"
#include "fast/platform/lanes_avx2.hpp"

namespace touchstone::fast {

extern const DistanceKernel avx2_distance_kernel;
const DistanceKernel avx2_distance_kernel = distance_kernel_on<Avx2Lanes>(InstructionSet::avx2);

}  // namespace touchstone::fast
