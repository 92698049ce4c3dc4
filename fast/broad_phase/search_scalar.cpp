// The search in plain C++: loops over sixteen boxes, which compilers can vectorise.

#include "fast/broad_phase/search_on_lanes.hpp"
#include "fast/broad_phase/words_one_by_one.hpp"

namespace touchstone::fast {
namespace {

/// −1 in each lane where the condition is true, 0 elsewhere.
struct Mask {
  IndexLanes set;

  friend Mask operator|(const Mask& a, const Mask& b) {
    Mask result;
    for (std::size_t i = 0; i < group_size; ++i) result.set[i] = a.set[i] | b.set[i];
    return result;
  }
};

struct Lanes : WordsOneByOne {
  using Numbers = FloatLanes;
  using Mask = touchstone::fast::Mask;

  static Numbers load(const float* from) {
    Numbers result;
    for (std::size_t i = 0; i < group_size; ++i) result[i] = from[i];
    return result;
  }
  static Numbers broadcast(float x) {
    Numbers result;
    for (float& lane : result) lane = x;
    return result;
  }
  static Numbers load_unaligned(const float* from) { return load(from); }
  static void store(float* to, const Numbers& numbers) {
    for (std::size_t i = 0; i < group_size; ++i) to[i] = numbers[i];
  }
  static Numbers least(const Numbers& a, const Numbers& b) {
    Numbers result;
    for (std::size_t i = 0; i < group_size; ++i) result[i] = a[i] < b[i] ? a[i] : b[i];
    return result;
  }
  static Numbers greatest(const Numbers& a, const Numbers& b) {
    Numbers result;
    for (std::size_t i = 0; i < group_size; ++i) result[i] = a[i] > b[i] ? a[i] : b[i];
    return result;
  }
  static Mask none() { return {}; }
  static Mask greater(const Numbers& a, const Numbers& b) {
    Mask result;
    for (std::size_t i = 0; i < group_size; ++i) result.set[i] = a[i] > b[i] ? -1 : 0;
    return result;
  }
  static Mask equal(const Numbers& a, const Numbers& b) {
    Mask result;
    for (std::size_t i = 0; i < group_size; ++i) result.set[i] = a[i] == b[i] ? -1 : 0;
    return result;
  }
  static Mask greater_where(const Mask& mask, const Numbers& a, const Numbers& b) {
    Mask result = greater(a, b);
    for (std::size_t i = 0; i < group_size; ++i) result.set[i] &= mask.set[i];
    return result;
  }
  static unsigned bits(const Mask& mask) {
    std::int32_t result = 0;
    for (std::size_t i = 0; i < group_size; ++i) result |= mask.set[i] & (1 << i);
    return static_cast<unsigned>(result);
  }

  static unsigned equal_bits(const std::int32_t* values, std::int32_t value) {
    Mask equal;
    for (std::size_t i = 0; i < group_size; ++i) equal.set[i] = values[i] == value ? -1 : 0;
    return bits(equal);
  }
};

}  // namespace

extern const SearchKernel scalar_search_kernel;
const SearchKernel scalar_search_kernel = search_kernel_on<Lanes>(InstructionSet::scalar);

}  // namespace touchstone::fast
