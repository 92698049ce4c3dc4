// The kernel in AVX-512 (its foundation, F), eight queries at a time. It is compiled for these
// instructions and called only on processors that have them.

#include "fast/certified/kernel_on_lanes.hpp"
#include "fast/platform/lanes_avx512.hpp"

namespace touchstone::fast {

extern const CertifiedKernel avx512_certified_kernel;
const CertifiedKernel avx512_certified_kernel =
    certified_kernel_on<Avx512Lanes>(InstructionSet::avx512, avx512_curved_kernel);

}  // namespace touchstone::fast
