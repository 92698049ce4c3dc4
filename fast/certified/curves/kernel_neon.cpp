// The kernel on curves in AArch64's NEON, two queries at a time.

#include "fast/certified/curves/stages.hpp"
#include "fast/platform/lanes_neon.hpp"

namespace touchstone::fast {

const CurvedKernel neon_curved_kernel = curved_kernel_on<NeonLanes>(InstructionSet::neon);

}  // namespace touchstone::fast
