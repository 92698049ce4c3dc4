#include "fast/platform/large_array.hpp"

#include <algorithm>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace touchstone::fast {
namespace {

constexpr std::size_t large_page = std::size_t{1} << 21U;
/// Below this size, the unused end of the last large page would be too great a part.
constexpr std::size_t least_bytes = 2 * large_page;

}  // namespace

std::align_val_t alignment_of_array(std::size_t bytes, std::size_t of_item) {
  return std::align_val_t{bytes < least_bytes ? of_item : std::max(of_item, large_page)};
}

void* allocate_array(std::size_t bytes, std::align_val_t alignment) {
  if (bytes < least_bytes) return ::operator new(bytes, alignment);
  const std::size_t whole = (bytes + large_page - 1) / large_page * large_page;
  void* const result = ::operator new(whole, alignment);
#ifdef __linux__
  // A hint: without it everything works, slower.
  static_cast<void>(madvise(result, whole, MADV_HUGEPAGE));
#endif
  return result;
}

}  // namespace touchstone::fast
