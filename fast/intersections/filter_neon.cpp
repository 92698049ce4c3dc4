// The filter of pairs of triangles in AArch64's NEON, two pairs at a time.

#include "fast/intersections/filter_on_lanes.hpp"
#include "fast/platform/neon_doubles.hpp"

namespace touchstone::fast {
namespace {

struct Lanes : pair_order::OneByOne {
  using Value = touchstone::fast::Value;
  using Mask = touchstone::fast::Mask;
  static constexpr std::size_t width = 2;
};

}  // namespace

extern const TriangleKernel neon_triangle_kernel;
const TriangleKernel neon_triangle_kernel = triangle_kernel_on<Lanes>(InstructionSet::neon);

}  // namespace touchstone::fast
