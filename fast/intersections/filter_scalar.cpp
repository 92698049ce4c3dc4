// The filter of pairs of triangles in plain C++, a pair at a time.

#include "fast/intersections/filter_on_lanes.hpp"
#include "fast/platform/scalar_doubles.hpp"

namespace touchstone::fast {
namespace {

struct Lanes : pair_order::OneByOne {
  using Value = touchstone::fast::Value;
  using Mask = touchstone::fast::Mask;
  static constexpr std::size_t width = 1;
};

}  // namespace

extern const TriangleKernel scalar_triangle_kernel;
const TriangleKernel scalar_triangle_kernel = triangle_kernel_on<Lanes>(InstructionSet::scalar);

}  // namespace touchstone::fast
