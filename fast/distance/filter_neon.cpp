// The filter of distances in AArch64's NEON, two queries at a time.

#include "fast/distance/filter_on_lanes.hpp"
#include "fast/platform/neon_doubles.hpp"

namespace touchstone::fast {
namespace {

struct Lanes {
  using Value = touchstone::fast::Value;
  using Mask = touchstone::fast::Mask;
  static constexpr std::size_t width = 2;
};

}  // namespace

extern const DistanceKernel neon_distance_kernel;
const DistanceKernel neon_distance_kernel = distance_kernel_on<Lanes>(InstructionSet::neon);

}  // namespace touchstone::fast
