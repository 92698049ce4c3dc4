// The search in plain C++: loops over sixteen boxes, which compilers can vectorise.

#include "fast/broad_phase/search_on_lanes.hpp"
#include "fast/broad_phase/words_one_by_one.hpp"
#include "fast/platform/scalar_floats.hpp"

namespace touchstone::fast {
namespace {

struct Lanes : WordsOneByOne {
  using Value = Floats;
  using Mask = FloatMask;

  static FloatMask equal(const std::int32_t* values, std::int32_t value) {
    return each<FloatMask>([&](std::size_t i) { return values[i] == value ? -1 : 0; });
  }
};

}  // namespace

extern const SearchKernel scalar_search_kernel;
const SearchKernel scalar_search_kernel = search_kernel_on<Lanes>(InstructionSet::scalar);

}  // namespace touchstone::fast
