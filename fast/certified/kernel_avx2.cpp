// The kernel in AVX2 and FMA, four queries at a time. It is compiled for these instructions and
// called only on processors that have them.

#include "fast/certified/kernel_on_lanes.hpp"
#include "fast/platform/lanes_avx2.hpp"

namespace touchstone::fast {

extern const CertifiedKernel avx2_certified_kernel;
const CertifiedKernel avx2_certified_kernel =
    certified_kernel_on<Avx2Lanes>(InstructionSet::avx2, avx2_curved_kernel);

}  // namespace touchstone::fast
