// The filter of pairs of triangles in AVX2, four pairs at a time. It is compiled for this
// instruction set and called only on processors that have it.

#include "fast/intersections/filter_on_lanes.hpp"
#include "fast/intersections/pair_order_avx2.hpp"
#include "fast/platform/avx2_doubles.hpp"

namespace touchstone::fast {
namespace {

struct Lanes : pair_order::InOneVector {
  using Value = touchstone::fast::Value;
  using Mask = touchstone::fast::Mask;
  static constexpr std::size_t width = 4;
};

}  // namespace

extern const TriangleKernel avx2_triangle_kernel;
const TriangleKernel avx2_triangle_kernel = triangle_kernel_on<Lanes>(InstructionSet::avx2);

}  // namespace touchstone::fast
