// The kernel in AArch64's NEON, two queries at a time.

#include "fast/certified/kernel_on_lanes.hpp"
#include "fast/platform/lanes_neon.hpp"

namespace touchstone::fast {

extern const CertifiedKernel neon_certified_kernel;
const CertifiedKernel neon_certified_kernel =
    certified_kernel_on<NeonLanes>(InstructionSet::neon, neon_curved_kernel);

}  // namespace touchstone::fast
