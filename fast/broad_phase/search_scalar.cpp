// The search in plain C++: loops over sixteen boxes, which compilers can vectorise.

#include "fast/broad_phase/search_on_lanes.hpp"
#include "fast/broad_phase/words_one_by_one.hpp"
#include "fast/platform/lanes_scalar.hpp"

namespace touchstone::fast {
namespace {

struct Lanes : WordsOneByOne {
  using Value = ScalarLanes::Sixteen;
  using Mask = Value::Mask;
};

}  // namespace

extern const SearchKernel scalar_search_kernel;
const SearchKernel scalar_search_kernel = search_kernel_on<Lanes>(InstructionSet::scalar);

}  // namespace touchstone::fast
