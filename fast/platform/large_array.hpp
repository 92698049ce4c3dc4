#pragma once

/// \file
/// Arrays without initialisation, for items that are all written before they are read.
///
/// The first access to each page of new memory takes longer than what a step does with the page.
/// So a large array begins at a large page, and on Linux asks for such pages; and the memory of the
/// last arrays is kept for the next ones, up to 64 MiB in a process.

#include <cstddef>
#include <memory>
#include <type_traits>

namespace touchstone::fast {

/// Memory for an array.
struct ArrayMemory {
  void* begin = nullptr;
  std::size_t bytes = 0;
};

/// Allocates at least that many bytes, aligned to 64. Thread-safe.
/// \throws std::bad_alloc
[[nodiscard]] ArrayMemory allocate_array(std::size_t bytes);
/// Keeps the memory for the next arrays, or frees it. Thread-safe.
void free_array(const ArrayMemory& memory) noexcept;

template <class Item>
class LargeArray {
 public:
  LargeArray() = default;
  explicit LargeArray(std::size_t size) : LargeArray(allocate_array(size * sizeof(Item))) {}

  /// Null by default.
  [[nodiscard]] Item* data() const { return items_.get(); }
  [[nodiscard]] Item& operator[](std::size_t i) const { return items_.get()[i]; }

 private:
  static_assert(std::is_trivially_copyable_v<Item> && alignof(Item) <= 64);

  struct Free {
    std::size_t bytes = 0;
    void operator()(Item* items) const { free_array({items, bytes}); }
  };

  explicit LargeArray(const ArrayMemory& memory)
      : items_(static_cast<Item*>(memory.begin), Free{memory.bytes}) {}

  std::unique_ptr<Item, Free> items_;
};

}  // namespace touchstone::fast
