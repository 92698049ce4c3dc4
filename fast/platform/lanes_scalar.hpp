#pragma once

/// \file
/// One double a lane, for code on lanes that every processor can run; floats in the vectors that
/// the compiler has for it.

#include <array>
#include <cstddef>

#include "fast/platform/lanes.hpp"

namespace touchstone::fast {
namespace {  // NOLINT(cert-dcl59-cpp,google-build-namespaces): as of other instruction sets

struct ScalarLanes {
  using Value = ValueOn<Portable, double, 1>;
  using Mask = Value::Mask;
  using Row = Joined<Joined<Value>, Value>;
  using Single = ValueOn<Portable, float, 4>;
  using Rounded = WholesOn<Portable, 4>;
  using Sixteen = Joined<Joined<Single>>;
  static constexpr std::size_t width = 1;

  static std::array<Value, 3> load(const std::array<const double*, 1>& rows) {
    return {Value(rows[0][0]), Value(rows[0][1]), Value(rows[0][2])};
  }
  static std::array<Value, 3> load_backwards(const std::array<const double*, 1>& rows) {
    return load(rows);
  }
  static Row load_row_backwards(const double* from) { return Row::load(from); }
};

}  // namespace
}  // namespace touchstone::fast
