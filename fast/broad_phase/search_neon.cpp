// The search in AArch64's NEON: sixteen boxes in four vectors.

#include "fast/broad_phase/search_on_lanes.hpp"
#include "fast/broad_phase/words_one_by_one.hpp"
#include "fast/platform/lanes_neon.hpp"

namespace touchstone::fast {
namespace {

struct Lanes : WordsOneByOne {
  using Value = NeonLanes::Sixteen;
  using Mask = Value::Mask;
};

}  // namespace

extern const SearchKernel neon_search_kernel;
const SearchKernel neon_search_kernel = search_kernel_on<Lanes>(InstructionSet::neon);

}  // namespace touchstone::fast
