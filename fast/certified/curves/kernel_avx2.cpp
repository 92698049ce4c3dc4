// The kernel on curves in AVX2 and FMA, four queries at a time. It is compiled for these
// instructions and called only on processors that have them.

#include "fast/certified/curves/stages.hpp"
#include "fast/platform/lanes_avx2.hpp"

namespace touchstone::fast {

const CurvedKernel avx2_curved_kernel = curved_kernel_on<Avx2Lanes>(InstructionSet::avx2);

}  // namespace touchstone::fast
