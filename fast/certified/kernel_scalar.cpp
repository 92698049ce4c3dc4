// The kernel in plain C++, a query at a time.

#include "fast/certified/kernel_on_lanes.hpp"
#include "fast/platform/lanes_scalar.hpp"

namespace touchstone::fast {

extern const CertifiedKernel scalar_certified_kernel;
const CertifiedKernel scalar_certified_kernel =
    certified_kernel_on<ScalarLanes>(InstructionSet::scalar, scalar_curved_kernel);

}  // namespace touchstone::fast
