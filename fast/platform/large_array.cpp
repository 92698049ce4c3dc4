#include "fast/platform/large_array.hpp"

#include <algorithm>
#include <array>
#include <mutex>
#include <new>
#include <utility>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace touchstone::fast {
namespace {

constexpr std::size_t large_page = std::size_t{1} << 21U;
/// Below this size, the unused end of the last large page would be too great a part.
constexpr std::size_t least_large = 2 * large_page;

std::align_val_t alignment_of(std::size_t bytes) {
  return std::align_val_t{bytes < least_large ? 64 : large_page};
}

ArrayMemory allocate(std::size_t bytes) {
  if (bytes < least_large) return {::operator new(bytes, alignment_of(bytes)), bytes};
  const std::size_t whole = (bytes + large_page - 1) / large_page * large_page;
  const ArrayMemory result{::operator new(whole, alignment_of(whole)), whole};
#ifdef __linux__
  // A hint: without it everything works, slower.
  static_cast<void>(madvise(result.begin, whole, MADV_HUGEPAGE));
#endif
  return result;
}

void free(const ArrayMemory& memory) {
  ::operator delete(memory.begin, alignment_of(memory.bytes));
}

/// The memory of the last arrays. Where another thread uses it, both functions do nothing: nothing
/// waits, not even in a process that was forked meanwhile.
class KeptMemory {
 public:
  /// Null if nothing fits.
  ArrayMemory take(std::size_t bytes) {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock) return {};
    ArrayMemory* const end = kept_.data() + count_;
    const auto fits = [bytes](const ArrayMemory& one) {
      return one.bytes >= bytes && one.bytes / 2 <= bytes;
    };
    ArrayMemory* const found = std::find_if(kept_.data(), end, fits);
    if (found == end) return {};
    const ArrayMemory result = *found;
    remove(found);
    return result;
  }

  /// Keeps it in place of the oldest ones, or frees it.
  void keep(const ArrayMemory& memory) {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock || memory.bytes < least_bytes || memory.bytes > most_bytes) return free(memory);
    while (count_ == kept_.size() || bytes_ + memory.bytes > most_bytes) {
      free(kept_[0]);
      remove(kept_.data());
    }
    kept_[count_++] = memory;
    bytes_ += memory.bytes;
  }

 private:
#ifdef TOUCHSTONE_SANITIZED
  // An access to freed memory is to be found.
  static constexpr std::size_t most_bytes = 0;
#else
  static constexpr std::size_t most_bytes = std::size_t{64} << 20U;
#endif
  /// The C library keeps smaller pieces itself.
  static constexpr std::size_t least_bytes = std::size_t{64} << 10U;

  void remove(ArrayMemory* one) {
    bytes_ -= one->bytes;
    std::move(one + 1, kept_.data() + count_, one);
    --count_;
  }

  std::mutex mutex_;
  std::array<ArrayMemory, 32> kept_;  ///< the oldest first
  std::size_t count_ = 0;
  std::size_t bytes_ = 0;  ///< of all
};

/// It is never destroyed: arrays may be freed by destructors of static variables.
KeptMemory& kept_memory() {
  static KeptMemory& kept = *new KeptMemory;
  return kept;
}

}  // namespace

ArrayMemory allocate_array(std::size_t bytes) {
  const ArrayMemory kept = kept_memory().take(bytes);
  return kept.begin != nullptr ? kept : allocate(bytes);
}

void free_array(const ArrayMemory& memory) noexcept { kept_memory().keep(memory); }

}  // namespace touchstone::fast
