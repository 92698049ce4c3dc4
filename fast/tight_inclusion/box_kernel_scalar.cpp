// The kernel without explicit vector instructions, for every processor.

#include "fast/tight_inclusion/box_kernel_on_lanes.hpp"
#include "fast/tight_inclusion/lane_by_lane.hpp"

namespace touchstone::fast {

extern const BoxKernel scalar_box_kernel;
const BoxKernel scalar_box_kernel =
    BoxKernelOnLanes<lane_by_lane::Lanes<double>>::kernel(InstructionSet::scalar);

}  // namespace touchstone::fast
