// The kernel in AVX-512 (its foundation, F), eight queries at a time. It is compiled for these
// instructions and called only on processors that have them.

#include <immintrin.h>

#include "fast/certified/kernel_on_lanes.hpp"
#include "fast/platform/avx512_doubles.hpp"
#include "fast/platform/avx512_floats.hpp"
#include "fast/platform/avx_rows.hpp"

namespace touchstone::fast {
namespace {

struct Lanes {
  using Value = touchstone::fast::Value;
  using Mask = touchstone::fast::Mask;
  using Row = AvxRow<Value>;
  using RowMask = AvxRowMask<Value>;
  using Single = Floats;
  using Rounded = Wholes;
  static constexpr std::size_t width = 8;

  static std::array<Value, 3> load(const std::array<const double*, width>& rows) {
    return Value::load_points(rows.data());
  }
  static std::array<Value, 3> load_backwards(const std::array<const double*, width>& rows) {
    using Four = AvxPoints<Value>;
    const auto low = Four::load_backwards(rows.data()),
               high = Four::load_backwards(rows.data() + 4);
    return {Value::joined(low.x, high.x), Value::joined(low.y, high.y),
            Value::joined(low.z, high.z)};
  }
};

}  // namespace

extern const CertifiedKernel avx512_certified_kernel;
const CertifiedKernel avx512_certified_kernel = certified_kernel_on<Lanes>(InstructionSet::avx512);

}  // namespace touchstone::fast
