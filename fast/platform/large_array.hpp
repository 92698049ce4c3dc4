#pragma once

/// \file
/// Arrays without initialisation, for items that are all written before they are read.
///
/// A large array begins at a large page, and on Linux asks for such pages: the first access to each
/// of the usual pages takes longer than what a step does with it.

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>

namespace touchstone::fast {

/// Memory for large arrays. \throws std::bad_alloc
[[nodiscard]] void* allocate_array(std::size_t bytes, std::align_val_t alignment);

/// The alignment of an array of that size and alignment of its items.
[[nodiscard]] std::align_val_t alignment_of_array(std::size_t bytes, std::size_t of_item);

template <class Item>
class LargeArray {
 public:
  LargeArray() = default;
  explicit LargeArray(std::size_t size)
      : items_(allocated(size), Free{alignment_of_array(size * sizeof(Item), alignof(Item))}) {}

  /// Null by default.
  [[nodiscard]] Item* data() const { return items_.get(); }
  [[nodiscard]] Item& operator[](std::size_t i) const { return items_.get()[i]; }

 private:
  static_assert(std::is_trivially_copyable_v<Item>);

  struct Free {
    std::align_val_t alignment{};
    void operator()(Item* items) const { ::operator delete(items, alignment); }
  };

  static Item* allocated(std::size_t size) {
    const std::size_t bytes = size * sizeof(Item);
    return static_cast<Item*>(allocate_array(bytes, alignment_of_array(bytes, alignof(Item))));
  }

  std::unique_ptr<Item, Free> items_;
};

}  // namespace touchstone::fast
