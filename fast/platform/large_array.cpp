#include "fast/platform/large_array.hpp"

#include <array>
#include <atomic>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace touchstone::fast {
namespace {

constexpr std::size_t large_page = std::size_t{1} << 21U;
/// The size below which the unused end of the last large page would be too great a part.
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

/// The memory of the last arrays. While another thread uses it, `take` finds nothing and `keep`
/// frees: nothing waits, not even in a process forked meanwhile.
class KeptMemory {
 public:
  /// Takes the last array that fits; null if none does.
  ArrayMemory take(std::size_t bytes) {
    const Use use(*this);
    if (!use.is_alone) return {};
    for (std::size_t i = count_; i-- > 0;) {
      const ArrayMemory one = kept_[i];
      if (one.bytes < bytes || one.bytes / 2 > bytes) continue;
      remove(i);
      return one;
    }
    return {};
  }

  /// Keeps it in place of the oldest ones, or frees it.
  void keep(const ArrayMemory& memory) {
    const Use use(*this);
    if (!use.is_alone || memory.bytes < least_bytes || memory.bytes > most_bytes) {
      free(memory);
      return;
    }
    while (count_ == kept_.size() || bytes_ + memory.bytes > most_bytes) free_oldest();
    kept_[count_++] = memory;
    bytes_ += memory.bytes;
  }

  void free_all() {
    const Use use(*this);
    while (use.is_alone && count_ > 0) free_oldest();
  }

 private:
#ifdef TOUCHSTONE_SANITIZED
  // Sanitizers find accesses to freed memory.
  static constexpr std::size_t most_bytes = 0;
#else
  static constexpr std::size_t most_bytes = std::size_t{64} << 20U;
#endif
  /// The least size: the C library keeps smaller pieces itself.
  static constexpr std::size_t least_bytes = std::size_t{64} << 10U;

  /// The use by a thread, if no other one uses it.
  struct Use {
    explicit Use(KeptMemory& of) : memory(of), is_alone(!of.is_used_.test_and_set()) {}
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    Use(Use&&) = delete;
    Use& operator=(Use&&) = delete;
    ~Use() {
      if (is_alone) memory.is_used_.clear();
    }

    KeptMemory& memory;
    bool is_alone;
  };

  void free_oldest() {
    free(kept_[0]);
    remove(0);
  }

  void remove(std::size_t i) {
    bytes_ -= kept_[i].bytes;
    std::move(kept_.data() + i + 1, kept_.data() + count_, kept_.data() + i);
    --count_;
  }

  std::atomic_flag is_used_;
  std::array<ArrayMemory, 32> kept_{};  ///< the oldest first
  std::size_t count_ = 0;
  std::size_t bytes_ = 0;  ///< of all
};

// Arrays may be freed by destructors of static variables.
static_assert(std::is_trivially_destructible_v<KeptMemory>);
constinit KeptMemory kept_memory;

}  // namespace

ArrayMemory allocate_array(std::size_t bytes) {
  const ArrayMemory kept = kept_memory.take(bytes);
  if (kept.begin != nullptr) return kept;
  try {
    return allocate(bytes);
  } catch (const std::bad_alloc&) {
    kept_memory.free_all();
    return allocate(bytes);
  }
}

void free_array(const ArrayMemory& memory) noexcept { kept_memory.keep(memory); }

}  // namespace touchstone::fast
