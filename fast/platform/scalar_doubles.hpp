#pragma once

/// \file
/// One double, and one truth value, for code on lanes.

#include <array>

namespace touchstone::fast {
namespace {  // NOLINT(cert-dcl59-cpp,google-build-namespaces): as of other instruction sets

struct Mask {
  bool set;

  static Mask none() { return {false}; }
  static Mask all() { return {true}; }
  [[nodiscard]] unsigned bits() const { return set ? 1U : 0U; }

  friend Mask operator&(Mask a, Mask b) { return {a.set && b.set}; }
  friend Mask operator|(Mask a, Mask b) { return {a.set || b.set}; }
};

struct Value {
  using Scalar = double;

  double x;

  Value() = default;
  explicit Value(double value) : x(value) {}
  static Value load(const double* from) { return Value(*from); }
  /// x, y and z of a point at each of the addresses; a fourth number follows each.
  static std::array<Value, 3> load_points(const double* const* rows) {
    return {Value(rows[0][0]), Value(rows[0][1]), Value(rows[0][2])};
  }
  void store(double* to) const { *to = x; }

  friend Value operator+(Value a, Value b) { return Value(a.x + b.x); }
  friend Value operator-(Value a, Value b) { return Value(a.x - b.x); }
  friend Value operator*(Value a, Value b) { return Value(a.x * b.x); }
  friend Value operator/(Value a, Value b) { return Value(a.x / b.x); }
  friend Mask operator<(Value a, Value b) { return {a.x < b.x}; }
  friend Mask operator>(Value a, Value b) { return {a.x > b.x}; }
  friend Mask operator<=(Value a, Value b) { return {a.x <= b.x}; }
  friend Mask operator>=(Value a, Value b) { return {a.x >= b.x}; }
  friend Mask operator==(Value a, Value b) { return {a.x == b.x}; }
  // The second operand if there is a NaN, as in the vector instructions.
  friend Value min(Value a, Value b) { return a.x < b.x ? a : b; }
  friend Value max(Value a, Value b) { return a.x > b.x ? a : b; }
  friend Value abs(Value a) { return Value(__builtin_fabs(a.x)); }
  friend Value sqrt(Value a) { return Value(__builtin_sqrt(a.x)); }
  friend Value select(Mask mask, Value a, Value b) { return mask.set ? a : b; }
};

}  // namespace
}  // namespace touchstone::fast
