// The filter of distances in AArch64's NEON, two queries at a time.

#include "fast/distance/filter_on_lanes.hpp"
#include "fast/platform/lanes_neon.hpp"

namespace touchstone::fast {

extern const DistanceKernel neon_distance_kernel;
const DistanceKernel neon_distance_kernel = distance_kernel_on<NeonLanes>(InstructionSet::neon);

}  // namespace touchstone::fast
