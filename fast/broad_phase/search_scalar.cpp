// The search in plain C++: loops over sixteen boxes, which compilers can vectorise.

#include "fast/broad_phase/search_on_lanes.hpp"
#include "fast/broad_phase/words_one_by_one.hpp"

namespace touchstone::fast {
namespace {

/// Applies an operation to the lanes, one by one.
template <class Result, class Operation>
Result each(const Operation& operation) {
  Result result;
  for (std::size_t i = 0; i < group_size; ++i) result.lanes[i] = operation(i);
  return result;
}

/// −1 in each lane where the condition is true, 0 elsewhere.
struct Mask {
  IndexLanes lanes;

  static Mask none() { return {}; }
  static Mask all() {
    return each<Mask>([](std::size_t /*i*/) { return -1; });
  }
  [[nodiscard]] unsigned bits() const {
    std::int32_t result = 0;
    for (std::size_t i = 0; i < group_size; ++i) result |= lanes[i] & (1 << i);
    return static_cast<unsigned>(result);
  }

  friend Mask operator&(const Mask& a, const Mask& b) {
    return each<Mask>([&](std::size_t i) { return a.lanes[i] & b.lanes[i]; });
  }
  friend Mask operator|(const Mask& a, const Mask& b) {
    return each<Mask>([&](std::size_t i) { return a.lanes[i] | b.lanes[i]; });
  }
};

struct Value {
  using Scalar = float;

  FloatLanes lanes;

  Value() = default;
  explicit Value(float value) {
    for (float& lane : lanes) lane = value;
  }
  static Value load(const float* from) {
    return each<Value>([&](std::size_t i) { return from[i]; });
  }
  void store(float* to) const {
    for (std::size_t i = 0; i < group_size; ++i) to[i] = lanes[i];
  }

  friend Value operator+(const Value& a, const Value& b) {
    return each<Value>([&](std::size_t i) { return a.lanes[i] + b.lanes[i]; });
  }
  friend Value operator-(const Value& a, const Value& b) {
    return each<Value>([&](std::size_t i) { return a.lanes[i] - b.lanes[i]; });
  }
  friend Value operator*(const Value& a, const Value& b) {
    return each<Value>([&](std::size_t i) { return a.lanes[i] * b.lanes[i]; });
  }
  friend Mask operator>(const Value& a, const Value& b) {
    return each<Mask>([&](std::size_t i) { return a.lanes[i] > b.lanes[i] ? -1 : 0; });
  }
  friend Mask operator<(const Value& a, const Value& b) { return b > a; }
  friend Mask operator<=(const Value& a, const Value& b) {
    return each<Mask>([&](std::size_t i) { return a.lanes[i] <= b.lanes[i] ? -1 : 0; });
  }
  friend Mask operator==(const Value& a, const Value& b) {
    return each<Mask>([&](std::size_t i) { return a.lanes[i] == b.lanes[i] ? -1 : 0; });
  }
  // As the vector instructions: the second operand if there is a NaN.
  friend Value min(const Value& a, const Value& b) {
    return each<Value>(
        [&](std::size_t i) { return a.lanes[i] < b.lanes[i] ? a.lanes[i] : b.lanes[i]; });
  }
  friend Value max(const Value& a, const Value& b) {
    return each<Value>(
        [&](std::size_t i) { return a.lanes[i] > b.lanes[i] ? a.lanes[i] : b.lanes[i]; });
  }
  friend Value abs(const Value& a) {
    return each<Value>([&](std::size_t i) { return __builtin_fabsf(a.lanes[i]); });
  }
};

struct Lanes : WordsOneByOne {
  using Value = touchstone::fast::Value;
  using Mask = touchstone::fast::Mask;

  static Value pick(const float* from, const Words<std::int32_t>& indices) {
    return each<Value>([&](std::size_t i) { return from[indices[i]]; });
  }
  static unsigned equal_bits(const std::int32_t* values, std::int32_t value) {
    return each<Mask>([&](std::size_t i) { return values[i] == value ? -1 : 0; }).bits();
  }
};

}  // namespace

extern const SearchKernel scalar_search_kernel;
const SearchKernel scalar_search_kernel = search_kernel_on<Lanes>(InstructionSet::scalar);

}  // namespace touchstone::fast
