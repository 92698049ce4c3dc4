// The filter of pairs of triangles in plain C++, a pair at a time.

#include "fast/intersections/filter_on_lanes.hpp"
#include "fast/platform/lanes_scalar.hpp"

namespace touchstone::fast {
namespace {

struct Lanes : ScalarLanes, pair_order::OneByOne {};

}  // namespace

extern const TriangleKernel scalar_triangle_kernel;
const TriangleKernel scalar_triangle_kernel = triangle_kernel_on<Lanes>(InstructionSet::scalar);

}  // namespace touchstone::fast
