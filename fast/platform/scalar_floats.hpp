#pragma once

/// \file
/// Sixteen floats, masks of them, and sixteen whole numbers, for the kernels, in loops that
/// compilers can vectorise.

#include <array>
#include <cstddef>
#include <cstdint>

namespace touchstone::fast {
namespace {  // NOLINT(cert-dcl59-cpp,google-build-namespaces): as of other instruction sets

/// Applies an operation to the lanes, one by one.
template <class Result, class Operation>
Result each(const Operation& operation) {
  Result result;
  for (std::size_t i = 0; i < result.lanes.size(); ++i) result.lanes[i] = operation(i);
  return result;
}

/// −1 in each lane where the condition is true, 0 elsewhere.
struct FloatMask {
  std::array<std::int32_t, 16> lanes;

  static FloatMask none() { return {}; }
  static FloatMask all() {
    return each<FloatMask>([](std::size_t /*i*/) { return -1; });
  }
  [[nodiscard]] unsigned bits() const {
    std::int32_t result = 0;
    for (std::size_t i = 0; i < lanes.size(); ++i) result |= lanes[i] & (1 << i);
    return static_cast<unsigned>(result);
  }

  friend FloatMask operator&(const FloatMask& a, const FloatMask& b) {
    return each<FloatMask>([&](std::size_t i) { return a.lanes[i] & b.lanes[i]; });
  }
  friend FloatMask operator|(const FloatMask& a, const FloatMask& b) {
    return each<FloatMask>([&](std::size_t i) { return a.lanes[i] | b.lanes[i]; });
  }
};

struct Floats {
  using Scalar = float;
  static constexpr std::size_t width = 16;

  std::array<float, 16> lanes;

  Floats() = default;
  explicit Floats(float value) {
    for (float& lane : lanes) lane = value;
  }
  static Floats load(const float* from) {
    return each<Floats>([&](std::size_t i) { return from[i]; });
  }
  void store(float* to) const {
    for (std::size_t i = 0; i < lanes.size(); ++i) to[i] = lanes[i];
  }

  friend Floats operator+(const Floats& a, const Floats& b) {
    return each<Floats>([&](std::size_t i) { return a.lanes[i] + b.lanes[i]; });
  }
  friend Floats operator-(const Floats& a, const Floats& b) {
    return each<Floats>([&](std::size_t i) { return a.lanes[i] - b.lanes[i]; });
  }
  friend Floats operator*(const Floats& a, const Floats& b) {
    return each<Floats>([&](std::size_t i) { return a.lanes[i] * b.lanes[i]; });
  }
  friend Floats operator/(const Floats& a, const Floats& b) {
    return each<Floats>([&](std::size_t i) { return a.lanes[i] / b.lanes[i]; });
  }
  friend FloatMask operator>(const Floats& a, const Floats& b) {
    return each<FloatMask>([&](std::size_t i) { return a.lanes[i] > b.lanes[i] ? -1 : 0; });
  }
  friend FloatMask operator<(const Floats& a, const Floats& b) { return b > a; }
  friend FloatMask operator<=(const Floats& a, const Floats& b) {
    return each<FloatMask>([&](std::size_t i) { return a.lanes[i] <= b.lanes[i] ? -1 : 0; });
  }
  friend FloatMask operator>=(const Floats& a, const Floats& b) {
    return each<FloatMask>([&](std::size_t i) { return a.lanes[i] >= b.lanes[i] ? -1 : 0; });
  }
  friend FloatMask operator==(const Floats& a, const Floats& b) {
    return each<FloatMask>([&](std::size_t i) { return a.lanes[i] == b.lanes[i] ? -1 : 0; });
  }
  // The second operand if there is a NaN, as in the vector instructions.
  friend Floats min(const Floats& a, const Floats& b) {
    return each<Floats>(
        [&](std::size_t i) { return a.lanes[i] < b.lanes[i] ? a.lanes[i] : b.lanes[i]; });
  }
  friend Floats max(const Floats& a, const Floats& b) {
    return each<Floats>(
        [&](std::size_t i) { return a.lanes[i] > b.lanes[i] ? a.lanes[i] : b.lanes[i]; });
  }
  friend Floats select(const FloatMask& mask, const Floats& a, const Floats& b) {
    return each<Floats>(
        [&](std::size_t i) { return mask.lanes[i] != 0 ? a.lanes[i] : b.lanes[i]; });
  }
  friend Floats abs(const Floats& a) {
    return each<Floats>([&](std::size_t i) { return __builtin_fabsf(a.lanes[i]); });
  }
};

struct Wholes {
  std::array<std::int32_t, 16> lanes;

  /// x, y and z of a member of sixteen items; a fourth number follows each.
  template <class Item>
  static std::array<Wholes, 3> load(const Item* const* items,
                                    std::array<std::int32_t, 4> Item::*member) {
    const auto row = [=](std::size_t i) { return (items[i]->*member).data(); };
    const auto column = [&](std::size_t axis) {
      return each<Wholes>([&](std::size_t i) { return row(i)[axis]; });
    };
    return {column(0), column(1), column(2)};
  }

  /// The difference, rounded to a float.
  friend Floats operator-(const Wholes& a, const Wholes& b) {
    return each<Floats>([&](std::size_t i) { return static_cast<float>(a.lanes[i] - b.lanes[i]); });
  }
};

}  // namespace
}  // namespace touchstone::fast
