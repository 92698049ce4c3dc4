// The filter of pairs of triangles in AVX-512 (its foundation, F), eight pairs at a time. It is
// compiled for these instructions and called only on processors that have them.

#include "fast/intersections/filter_on_lanes.hpp"
#include "fast/intersections/pair_order_avx2.hpp"
#include "fast/platform/lanes_avx512.hpp"

namespace touchstone::fast {
namespace {

struct Lanes : Avx512Lanes, pair_order::InOneVector {};

}  // namespace

extern const TriangleKernel avx512_triangle_kernel;
const TriangleKernel avx512_triangle_kernel = triangle_kernel_on<Lanes>(InstructionSet::avx512);

}  // namespace touchstone::fast
