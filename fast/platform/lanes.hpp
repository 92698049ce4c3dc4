#pragma once

/// \file
/// Numbers and truth values in the lanes of a register, for the kernels: one template over the
/// instruction set, the numbers and the width, on the vectors that compilers have for every
/// processor. An instruction set is a type that derives from Portable and hides what it does in
/// another way (lanes_*.hpp). A register of one number is the number itself.
///
/// All names are local to the including file, so that no other file links code for its
/// instructions.

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace touchstone::fast {
namespace {  // NOLINT(cert-dcl59-cpp,google-build-namespaces): see above

template <class Number, std::size_t count>
struct Register {
  using Type __attribute__((vector_size(sizeof(Number) * count))) = Number;
  /// The same anywhere in memory.
  using InMemory
      __attribute__((vector_size(sizeof(Number) * count), aligned(alignof(Number)), may_alias)) =
          Number;
};
template <class Number>
struct Register<Number, 1> {
  using Type = Number;
  using InMemory = Number;
};

template <class Number, std::size_t count>
using RegisterOf = typename Register<Number, count>::Type;

template <class Number, std::size_t count>
RegisterOf<Number, count> load_register(const Number* from) {
  return *reinterpret_cast<const typename Register<Number, count>::InMemory*>(from);
}

/// The x, y and z of points.
template <class Vector>
struct Columns {
  Vector x, y, z;
};

/// Operations on registers and on single numbers.
struct Portable {
  /// A truth value in each lane: a bool, or whole numbers with all bits or none.
  template <class Number, std::size_t count>
  using Truth = decltype(RegisterOf<Number, count>{} < RegisterOf<Number, count>{});
  /// True if there is product_error().
  static constexpr bool is_fused = false;

  template <class Vector>
  static auto less(const Vector& a, const Vector& b) {
    return a < b;
  }
  template <class Vector>
  static auto less_equal(const Vector& a, const Vector& b) {
    return a <= b;
  }
  template <class Vector>
  static auto equal(const Vector& a, const Vector& b) {
    return a == b;
  }

  template <class Truth>
  static Truth both(const Truth& a, const Truth& b) {
    return static_cast<Truth>(a & b);
  }
  template <class Truth>
  static Truth either(const Truth& a, const Truth& b) {
    return static_cast<Truth>(a | b);
  }
  /// The lanes, one bit each.
  template <class Truth>
  static unsigned bits(const Truth& truth) {
    if constexpr (std::is_integral_v<Truth>) {
      return truth;
    } else {
      unsigned result = 0;
      for (std::size_t i = 0; i < sizeof(truth) / sizeof(truth[0]); ++i)
        result |= static_cast<unsigned>(truth[i]) & 1U << i;
      return result;
    }
  }

  template <class Truth, class Vector>
  static Vector select(const Truth& truth, const Vector& a, const Vector& b) {
    if constexpr (std::is_integral_v<Truth>) {
      return truth ? a : b;
    } else {
      return reinterpret_cast<Vector>((truth & reinterpret_cast<Truth>(a)) |
                                      (~truth & reinterpret_cast<Truth>(b)));
    }
  }
  // The second operand if there is a NaN or both are zeros, as in the vector instructions of x86.
  template <class Vector>
  static Vector min(const Vector& a, const Vector& b) {
    return a < b ? a : b;
  }
  template <class Vector>
  static Vector max(const Vector& a, const Vector& b) {
    return a > b ? a : b;
  }
  template <class Vector>
  static Vector abs(const Vector& a) {
    if constexpr (std::is_same_v<Vector, double>) {
      return __builtin_fabs(a);
    } else {
      using Words = decltype(a < a);
      const auto sign = reinterpret_cast<Words>(-Vector{});
      return reinterpret_cast<Vector>(reinterpret_cast<Words>(a) & ~sign);
    }
  }
  static double sqrt(double a) { return __builtin_sqrt(a); }

  /// The first three of four whole numbers at each of four addresses, which row(i) returns.
  template <std::size_t count, class Row>
  static Columns<RegisterOf<std::int32_t, count>> columns(const Row& row) {
    static_assert(count == 4);
    const auto load = [&](std::size_t i) { return load_register<std::int32_t, 4>(row(i)); };
    const auto a = load(0), b = load(1), c = load(2), d = load(3);
    const auto xy_ab = __builtin_shufflevector(a, b, 0, 4, 1, 5);
    const auto xy_cd = __builtin_shufflevector(c, d, 0, 4, 1, 5);
    return {__builtin_shufflevector(xy_ab, xy_cd, 0, 1, 4, 5),
            __builtin_shufflevector(xy_ab, xy_cd, 2, 3, 6, 7),
            __builtin_shufflevector(__builtin_shufflevector(a, b, 2, 6, 3, 7),
                                    __builtin_shufflevector(c, d, 2, 6, 3, 7), 0, 1, 4, 5)};
  }
};

template <class Set, class Number, std::size_t count>
struct MaskOn {
  using Truth = typename Set::template Truth<Number, count>;
  static constexpr std::size_t width = count;

  Truth set;

  static MaskOn none() { return {Truth{}}; }
  static MaskOn all() {
    const RegisterOf<Number, count> zero{};
    return {reinterpret_cast<Truth>(Set::equal(zero, zero))};
  }
  /// The lanes in which whole numbers in memory are a value.
  static MaskOn equal(const std::int32_t* values, std::int32_t value) {
    const RegisterOf<std::int32_t, count> same = value - RegisterOf<std::int32_t, count>{};
    return {reinterpret_cast<Truth>(Set::equal(load_register<std::int32_t, count>(values), same))};
  }
  [[nodiscard]] unsigned bits() const { return Set::bits(set); }

  friend MaskOn operator&(const MaskOn& a, const MaskOn& b) { return {Set::both(a.set, b.set)}; }
  friend MaskOn operator|(const MaskOn& a, const MaskOn& b) { return {Set::either(a.set, b.set)}; }
};

template <class Set, class Number, std::size_t count>
struct ValueOn {
  using Scalar = Number;
  using Vector = RegisterOf<Number, count>;
  using Mask = MaskOn<Set, Number, count>;
  static constexpr std::size_t width = count;

  Vector x;

  ValueOn() = default;
  explicit ValueOn(Number value) requires(count > 1) : x(value - Vector{}) {}
  explicit ValueOn(const Vector& value) : x(value) {}
  static ValueOn load(const Number* from) { return ValueOn(load_register<Number, count>(from)); }
  void store(Number* to) const {
    *reinterpret_cast<typename Register<Number, count>::InMemory*>(to) = x;
  }

  friend ValueOn operator+(const ValueOn& a, const ValueOn& b) { return ValueOn(a.x + b.x); }
  friend ValueOn operator-(const ValueOn& a, const ValueOn& b) { return ValueOn(a.x - b.x); }
  friend ValueOn operator*(const ValueOn& a, const ValueOn& b) { return ValueOn(a.x * b.x); }
  friend ValueOn operator/(const ValueOn& a, const ValueOn& b) { return ValueOn(a.x / b.x); }
  friend Mask operator<(const ValueOn& a, const ValueOn& b) {
    return {reinterpret_cast<typename Mask::Truth>(Set::less(a.x, b.x))};
  }
  friend Mask operator<=(const ValueOn& a, const ValueOn& b) {
    return {reinterpret_cast<typename Mask::Truth>(Set::less_equal(a.x, b.x))};
  }
  friend Mask operator==(const ValueOn& a, const ValueOn& b) {
    return {reinterpret_cast<typename Mask::Truth>(Set::equal(a.x, b.x))};
  }
  friend Mask operator>(const ValueOn& a, const ValueOn& b) { return b < a; }
  friend Mask operator>=(const ValueOn& a, const ValueOn& b) { return b <= a; }
  friend ValueOn min(const ValueOn& a, const ValueOn& b) {
    return ValueOn(Vector(Set::min(a.x, b.x)));
  }
  friend ValueOn max(const ValueOn& a, const ValueOn& b) {
    return ValueOn(Vector(Set::max(a.x, b.x)));
  }
  friend ValueOn abs(const ValueOn& a) { return ValueOn(Set::abs(a.x)); }
  friend ValueOn sqrt(const ValueOn& a) { return ValueOn(Vector(Set::sqrt(a.x))); }
  friend ValueOn select(const Mask& mask, const ValueOn& a, const ValueOn& b) {
    return ValueOn(Vector(Set::select(mask.set, a.x, b.x)));
  }
  /// a · b − product, with a single rounding (touchstone/filters/double_double.hpp).
  friend ValueOn product_error(const ValueOn& a, const ValueOn& b, const ValueOn& product) requires(
      Set::is_fused&& std::is_same_v<Number, double>) {
    return ValueOn(Vector(Set::product_error(a.x, b.x, product.x)));
  }
};

/// Whole numbers, of which differences are rounded to floats.
template <class Set, std::size_t count>
struct WholesOn {
  RegisterOf<std::int32_t, count> x;

  /// x, y and z of a member of some items; a fourth number follows each.
  template <class Item>
  static std::array<WholesOn, 3> load(const Item* const* items,
                                      std::array<std::int32_t, 4> Item::*member) {
    const auto columns =
        Set::template columns<count>([=](std::size_t i) { return (items[i]->*member).data(); });
    return {WholesOn{columns.x}, WholesOn{columns.y}, WholesOn{columns.z}};
  }
  friend ValueOn<Set, float, count> operator-(const WholesOn& a, const WholesOn& b) {
    using Floats = RegisterOf<float, count>;
    return ValueOn<Set, float, count>(__builtin_convertvector(a.x - b.x, Floats));
  }
};

// ---- Lanes in several registers -----------------------------------------------------------------

// Not arrays: GCC 12 loses stores to arrays of vectors.

template <class Low, class High>
struct JoinedMask {
  static constexpr std::size_t width = Low::width + High::width;

  Low low;
  High high;

  static JoinedMask none() { return {Low::none(), High::none()}; }
  static JoinedMask equal(const std::int32_t* values, std::int32_t value) {
    return {Low::equal(values, value), High::equal(values + Low::width, value)};
  }
  [[nodiscard]] unsigned bits() const { return low.bits() | high.bits() << Low::width; }

  friend JoinedMask operator&(const JoinedMask& a, const JoinedMask& b) {
    return {a.low & b.low, a.high & b.high};
  }
  friend JoinedMask operator|(const JoinedMask& a, const JoinedMask& b) {
    return {a.low | b.low, a.high | b.high};
  }
};

/// The lanes of Low, then those of High.
template <class Low, class High = Low>
struct Joined {
  using Scalar = typename Low::Scalar;
  using Mask = JoinedMask<typename Low::Mask, typename High::Mask>;
  static constexpr std::size_t width = Low::width + High::width;

  Low low;
  High high;

  Joined() = default;
  explicit Joined(Scalar value) : low(value), high(value) {}
  Joined(const Low& first, const High& second) : low(first), high(second) {}
  static Joined load(const Scalar* from) {
    return {Low::load(from), High::load(from + Low::width)};
  }
  void store(Scalar* to) const {
    low.store(to);
    high.store(to + Low::width);
  }

  friend Joined operator+(const Joined& a, const Joined& b) {
    return {a.low + b.low, a.high + b.high};
  }
  friend Joined operator-(const Joined& a, const Joined& b) {
    return {a.low - b.low, a.high - b.high};
  }
  friend Joined operator*(const Joined& a, const Joined& b) {
    return {a.low * b.low, a.high * b.high};
  }
  friend Mask operator>(const Joined& a, const Joined& b) {
    return {a.low > b.low, a.high > b.high};
  }
  friend Mask operator>=(const Joined& a, const Joined& b) {
    return {a.low >= b.low, a.high >= b.high};
  }
  friend Mask operator<(const Joined& a, const Joined& b) { return b > a; }
  friend Mask operator==(const Joined& a, const Joined& b) {
    return {a.low == b.low, a.high == b.high};
  }
  friend Joined min(const Joined& a, const Joined& b) {
    return {min(a.low, b.low), min(a.high, b.high)};
  }
  friend Joined max(const Joined& a, const Joined& b) {
    return {max(a.low, b.low), max(a.high, b.high)};
  }
};

}  // namespace
}  // namespace touchstone::fast
