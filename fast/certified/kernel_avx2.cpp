// The kernel in AVX2 and FMA, four queries at a time. It is compiled for these instructions and
// called only on processors that have them.

#include "fast/certified/kernel_on_lanes.hpp"
#include "fast/platform/avx2_doubles.hpp"
#include "fast/platform/avx2_floats.hpp"
#include "fast/platform/avx_rows.hpp"

namespace touchstone::fast {
namespace {

struct Lanes {
  using Value = touchstone::fast::Value;
  using Mask = touchstone::fast::Mask;
  using Row = AvxRow<Value>;
  using RowMask = AvxRowMask<Value>;
  using Single = EightFloats;
  using Rounded = EightWholes;
  static constexpr std::size_t width = 4;

  static std::array<Value, 3> load(const std::array<const double*, width>& rows) {
    return Value::load_points(rows.data());
  }
  static std::array<Value, 3> load_backwards(const std::array<const double*, width>& rows) {
    const auto points = AvxPoints<Value>::load_backwards(rows.data());
    return {Value(points.x), Value(points.y), Value(points.z)};
  }
};

}  // namespace

extern const CertifiedKernel avx2_certified_kernel;
const CertifiedKernel avx2_certified_kernel = certified_kernel_on<Lanes>(InstructionSet::avx2);

}  // namespace touchstone::fast
