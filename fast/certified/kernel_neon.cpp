// The kernel in AArch64's NEON, two queries at a time.

#include "fast/certified/kernel_on_lanes.hpp"
#include "fast/platform/neon_doubles.hpp"
#include "fast/platform/neon_floats.hpp"

namespace touchstone::fast {
namespace {

struct RowMask {
  Mask xy, z;

  [[nodiscard]] bool any() const { return (xy | z).bits() != 0; }
  friend RowMask operator&(const RowMask& a, const RowMask& b) { return {a.xy & b.xy, a.z & b.z}; }
  friend RowMask operator|(const RowMask& a, const RowMask& b) { return {a.xy | b.xy, a.z | b.z}; }
};

/// x and y, and z twice.
struct Row {
  Value xy, z;

  Row() = default;
  explicit Row(double value) : xy(value), z(value) {}
  Row(const Value& first, const Value& last) : xy(first), z(last) {}
  static Row load(const double* from) { return {Value::load(from), Value(from[2])}; }
  static Row load_backwards(const double* from) { return load(from); }
  [[nodiscard]] bool is_finite() const {
    const Value zero(0.0);
    return ((xy - xy == zero) & (z - z == zero)).bits() == 0b11;
  }

  friend Row operator+(const Row& a, const Row& b) { return {a.xy + b.xy, a.z + b.z}; }
  friend Row operator-(const Row& a, const Row& b) { return {a.xy - b.xy, a.z - b.z}; }
  friend Row operator*(const Row& a, const Row& b) { return {a.xy * b.xy, a.z * b.z}; }
  friend Row min(const Row& a, const Row& b) { return {min(a.xy, b.xy), min(a.z, b.z)}; }
  friend Row max(const Row& a, const Row& b) { return {max(a.xy, b.xy), max(a.z, b.z)}; }
  friend RowMask operator<(const Row& a, const Row& b) { return {a.xy < b.xy, a.z < b.z}; }
  friend RowMask operator>(const Row& a, const Row& b) { return b < a; }
};

struct Lanes {
  using Value = touchstone::fast::Value;
  using Mask = touchstone::fast::Mask;
  using Row = touchstone::fast::Row;
  using RowMask = touchstone::fast::RowMask;
  using Single = Floats;
  using Rounded = Wholes;
  static constexpr std::size_t width = 2;

  static std::array<Value, 3> load(const std::array<const double*, width>& rows) {
    return Value::load_points(rows.data());
  }
  static std::array<Value, 3> load_backwards(const std::array<const double*, width>& rows) {
    return load(rows);
  }
};

}  // namespace

extern const CertifiedKernel neon_certified_kernel;
const CertifiedKernel neon_certified_kernel = certified_kernel_on<Lanes>(InstructionSet::neon);

}  // namespace touchstone::fast
