// The filter of pairs of triangles in AArch64's NEON, two pairs at a time.

#include "fast/intersections/filter_on_lanes.hpp"
#include "fast/platform/lanes_neon.hpp"

namespace touchstone::fast {
namespace {

struct Lanes : NeonLanes, pair_order::OneByOne {};

}  // namespace

extern const TriangleKernel neon_triangle_kernel;
const TriangleKernel neon_triangle_kernel = triangle_kernel_on<Lanes>(InstructionSet::neon);

}  // namespace touchstone::fast
