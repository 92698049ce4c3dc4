#pragma once

/// \file
/// A number that a test shares with its child processes.

#include <sys/mman.h>

#include <atomic>
#include <cstdint>
#include <new>
#include <stdexcept>

namespace touchstone::tests {

/// Initially 0. Must be constructed before the counting processes.
class SharedCounter {
 public:
  SharedCounter()
      : memory_(::mmap(nullptr, sizeof(Number), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS,
                       -1, 0)) {
    // NOLINTNEXTLINE(performance-no-int-to-ptr): the system's constant
    if (memory_ == MAP_FAILED) throw std::runtime_error("no memory to share");
    number_ = new (memory_) Number{0};
  }
  SharedCounter(const SharedCounter&) = delete;
  SharedCounter& operator=(const SharedCounter&) = delete;
  SharedCounter(SharedCounter&&) = delete;
  SharedCounter& operator=(SharedCounter&&) = delete;
  ~SharedCounter() { ::munmap(memory_, sizeof(Number)); }

  /// Returns the sum.
  std::uint64_t add(std::uint64_t summand = 1) const { return *number_ += summand; }
  [[nodiscard]] std::uint64_t value() const { return *number_; }

 private:
  using Number = std::atomic<std::uint64_t>;
  static_assert(Number::is_always_lock_free);

  void* memory_;
  Number* number_ = nullptr;
};

}  // namespace touchstone::tests
