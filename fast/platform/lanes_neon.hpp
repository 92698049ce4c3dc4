#pragma once

/// \file
/// Lanes in registers of AArch64's NEON: two doubles, four floats, four whole numbers.

#include <arm_neon.h>

#include <array>
#include <cstddef>

#include "fast/platform/lanes.hpp"

namespace touchstone::fast {
namespace {  // NOLINT(cert-dcl59-cpp,google-build-namespaces): as of lanes.hpp

struct Neon : Portable {
  static constexpr bool is_fused = true;

  template <class Truth>
  static unsigned bits(const Truth& truth) {
    if constexpr (sizeof(truth[0]) == 4) {
      const uint32x4_t places{1, 2, 4, 8};
      return vaddvq_u32(vandq_u32(reinterpret_cast<uint32x4_t>(truth), places));
    } else {
      return Portable::bits(truth);
    }
  }
  static float64x2_t sqrt(float64x2_t a) { return vsqrtq_f64(a); }
  static float64x2_t product_error(float64x2_t a, float64x2_t b, float64x2_t product) {
    return vfmaq_f64(vnegq_f64(product), a, b);
  }
};

struct NeonLanes {
  using Value = ValueOn<Neon, double, 2>;
  using Mask = Value::Mask;
  using Row = Joined<Value, ValueOn<Portable, double, 1>>;
  using Single = ValueOn<Neon, float, 4>;
  using Rounded = WholesOn<Neon, 4>;
  using Sixteen = Joined<Joined<Single>>;
  static constexpr std::size_t width = 2;

  static std::array<Value, 3> load(const std::array<const double*, 2>& rows) {
    const Value::Vector a = Value::load(rows[0]).x, b = Value::load(rows[1]).x;
    return {Value(__builtin_shufflevector(a, b, 0, 2)), Value(__builtin_shufflevector(a, b, 1, 3)),
            Value(Value::Vector{rows[0][2], rows[1][2]})};
  }
  static std::array<Value, 3> load_backwards(const std::array<const double*, 2>& rows) {
    return load(rows);
  }
  static Row load_row_backwards(const double* from) { return Row::load(from); }
};

}  // namespace
}  // namespace touchstone::fast
