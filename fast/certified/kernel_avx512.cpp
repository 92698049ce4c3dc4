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
    using Four = AvxPoints<Value>;
    return joined(Four::load(rows.data()), Four::load(rows.data() + 4));
  }
  static std::array<Value, 3> load_backwards(const std::array<const double*, width>& rows) {
    using Four = AvxPoints<Value>;
    return joined(Four::load_backwards(rows.data()), Four::load_backwards(rows.data() + 4));
  }

 private:
  static Value joined(__m256d low, __m256d high) {
    return Value(_mm512_insertf64x4(_mm512_castpd256_pd512(low), high, 1));
  }
  static std::array<Value, 3> joined(const AvxPoints<Value>& low, const AvxPoints<Value>& high) {
    return {joined(low.x, high.x), joined(low.y, high.y), joined(low.z, high.z)};
  }
};

}  // namespace

extern const CertifiedKernel avx512_certified_kernel;
const CertifiedKernel avx512_certified_kernel = certified_kernel_on<Lanes>(InstructionSet::avx512);

}  // namespace touchstone::fast
