// The filter of distances in AVX-512 (its foundation, F), eight queries at a time. It is compiled
// for these instructions and called only on processors that have them.

#include "fast/distance/filter_on_lanes.hpp"
#include "fast/platform/lanes_avx512.hpp"

namespace touchstone::fast {

extern const DistanceKernel avx512_distance_kernel;
const DistanceKernel avx512_distance_kernel =
    distance_kernel_on<Avx512Lanes>(InstructionSet::avx512);

}  // namespace touchstone::fast
