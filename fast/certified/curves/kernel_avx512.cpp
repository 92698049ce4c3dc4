// The kernel on curves in AVX-512 (its foundation, F), eight queries at a time. It is compiled for
// these instructions and called only on processors that have them.

#include "fast/certified/curves/stages.hpp"
#include "fast/platform/lanes_avx512.hpp"

namespace touchstone::fast {

const CurvedKernel avx512_curved_kernel = curved_kernel_on<Avx512Lanes>(InstructionSet::avx512);

}  // namespace touchstone::fast
