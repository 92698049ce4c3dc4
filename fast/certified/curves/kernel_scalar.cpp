// The kernel on curves in plain C++, a query at a time.

#include "fast/certified/curves/stages.hpp"
#include "fast/platform/lanes_scalar.hpp"

namespace touchstone::fast {

const CurvedKernel scalar_curved_kernel = curved_kernel_on<ScalarLanes>(InstructionSet::scalar);

}  // namespace touchstone::fast
