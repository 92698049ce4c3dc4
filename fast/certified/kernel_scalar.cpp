// The kernel in plain C++, a query at a time.

#include "fast/certified/kernel_on_lanes.hpp"
#include "fast/platform/scalar_doubles.hpp"
#include "fast/platform/scalar_floats.hpp"

namespace touchstone::fast {
namespace {

struct RowMask {
  std::array<bool, 3> set;

  [[nodiscard]] bool any() const { return set[0] || set[1] || set[2]; }
  friend RowMask operator&(const RowMask& a, const RowMask& b) {
    return {{a.set[0] && b.set[0], a.set[1] && b.set[1], a.set[2] && b.set[2]}};
  }
  friend RowMask operator|(const RowMask& a, const RowMask& b) {
    return {{a.set[0] || b.set[0], a.set[1] || b.set[1], a.set[2] || b.set[2]}};
  }
};

struct Row {
  std::array<double, 3> x;

  Row() = default;
  explicit Row(double value) : x{value, value, value} {}
  explicit Row(const std::array<double, 3>& values) : x(values) {}
  static Row load(const double* from) { return Row({from[0], from[1], from[2]}); }
  static Row load_backwards(const double* from) { return load(from); }
  [[nodiscard]] bool is_finite() const {
    return x[0] - x[0] == 0.0 && x[1] - x[1] == 0.0 && x[2] - x[2] == 0.0;
  }

  template <class Function>
  static Row each(const Row& a, const Row& b, const Function& function) {
    return Row({function(a.x[0], b.x[0]), function(a.x[1], b.x[1]), function(a.x[2], b.x[2])});
  }
  friend Row operator+(const Row& a, const Row& b) {
    return each(a, b, [](double p, double q) { return p + q; });
  }
  friend Row operator-(const Row& a, const Row& b) {
    return each(a, b, [](double p, double q) { return p - q; });
  }
  friend Row operator*(const Row& a, const Row& b) {
    return each(a, b, [](double p, double q) { return p * q; });
  }
  friend Row min(const Row& a, const Row& b) {
    return each(a, b, [](double p, double q) { return p < q ? p : q; });
  }
  friend Row max(const Row& a, const Row& b) {
    return each(a, b, [](double p, double q) { return p > q ? p : q; });
  }
  friend RowMask operator<(const Row& a, const Row& b) {
    return {{a.x[0] < b.x[0], a.x[1] < b.x[1], a.x[2] < b.x[2]}};
  }
  friend RowMask operator>(const Row& a, const Row& b) { return b < a; }
};

struct Lanes {
  using Value = touchstone::fast::Value;
  using Mask = touchstone::fast::Mask;
  using Row = touchstone::fast::Row;
  using RowMask = touchstone::fast::RowMask;
  using Single = Floats;
  using Rounded = Wholes;
  static constexpr std::size_t width = 1;

  static std::array<Value, 3> load(const std::array<const double*, width>& rows) {
    return Value::load_points(rows.data());
  }
  static std::array<Value, 3> load_backwards(const std::array<const double*, width>& rows) {
    return load(rows);
  }
};

}  // namespace

extern const CertifiedKernel scalar_certified_kernel;
const CertifiedKernel scalar_certified_kernel = certified_kernel_on<Lanes>(InstructionSet::scalar);

}  // namespace touchstone::fast
