// The filter of pairs of triangles in AVX2, four pairs at a time. It is compiled for this
// instruction set and called only on processors that have it.

#include "fast/intersections/filter_on_lanes.hpp"
#include "fast/intersections/pair_order_avx2.hpp"
#include "fast/platform/lanes_avx2.hpp"

namespace touchstone::fast {
namespace {

struct Lanes : Avx2Lanes, pair_order::InOneVector {};

}  // namespace

extern const TriangleKernel avx2_triangle_kernel;
const TriangleKernel avx2_triangle_kernel = triangle_kernel_on<Lanes>(InstructionSet::avx2);

}  // namespace touchstone::fast
