#pragma once

/// \file
/// Expressions evaluated in rationals, random inputs for them, and expressions that only tests use.

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string_view>
#include <vector>

#include "touchstone/derivation/worst_case.hpp"
#include "touchstone/filters/expressions.hpp"
#include "touchstone/filters/polynomial_expressions.hpp"

namespace touchstone::filters {

/// The exact value of an expression.
template <class Expression>
mpq_class exact_value(const Inputs& inputs) {
  return evaluate_with<Expression>(inputs, [](double x) { return mpq_class(x); });
}

/// The value computed in Scalar (double or float).
template <class Expression, class Scalar>
Scalar computed_value(const Inputs& inputs) {
  return evaluate_with<Expression>(inputs, [](double x) { return static_cast<Scalar>(x); });
}

inline double greatest_coordinate(const Inputs& inputs) {
  double greatest = 0;
  for (const double x : inputs.coordinates) greatest = std::max(greatest, std::abs(x));
  return greatest;
}

/// Random weights of an expression's groups: t, u, v are multiples of 2^-bits. With two vertices a
/// group is (1−t, t), with four (1−u−v, u, v); a group of one weight is that weight.
template <class Expression>
std::vector<double> random_weights(std::mt19937_64& random, int bits) {
  const auto fraction = [&] {
    const std::uint64_t whole = std::uint64_t{1} << static_cast<unsigned>(bits);
    return std::ldexp(static_cast<double>(random() % (whole + 1)), -bits);
  };
  std::vector<double> weights;
  Expression::visit_groups([&](const auto& group) {
    if (group.front().size() == 1) {
      weights.push_back(fraction());
      return;
    }
    double rest = 1;
    const std::size_t first = weights.size();
    weights.push_back(0);
    for (std::size_t i = 1; i < group.front().size(); ++i) {
      weights.push_back(fraction());
      rest -= weights.back();
    }
    weights[first] = rest;
  });
  return weights;
}

using RationalVector = Vector3<mpq_class>;

/// The start of a motion and its end.
struct RationalMotion {
  RationalVector start;
  RationalVector end;

  [[nodiscard]] RationalVector at(const mpq_class& time) const {
    RationalVector result;
    for (std::size_t i = 0; i < 3; ++i) result[i] = start[i] + time * (end[i] - start[i]);
    return result;
  }
};

/// Draws small rational numbers, times in [0,1], vectors and motions.
class SmallRationals {
 public:
  mpq_class number() {
    return mpq_class(static_cast<int>(random_() % 41) - 20) / (1 + static_cast<int>(random_() % 7));
  }
  mpq_class fraction() { return mpq_class(static_cast<int>(random_() % 9)) / 8; }
  RationalVector vector() { return {number(), number(), number()}; }
  RationalMotion motion() { return {vector(), vector()}; }
  std::array<RationalMotion, 3> three_motions() { return {motion(), motion(), motion()}; }

 private:
  std::mt19937_64 random_{1};
};

/// (a, b) blended once: small enough to check by hand.
struct Blend {
  static constexpr std::string_view name = "blend";
  static constexpr std::size_t coordinates = 2;
  static constexpr std::size_t weights = 2;

  template <class Visitor>
  static constexpr void visit_groups(const Visitor& visit) {
    visit(unit_segment);
  }

  template <class Scalar>
  static constexpr Scalar evaluate(const std::array<Scalar, 2>& x, const std::array<Scalar, 2>& w) {
    return blend(x[0], x[1], w[0], w[1]);
  }
};

/// a w0 − a w2: zero where both weights are 1, with a separate error of each.
struct TwoErrors {
  static constexpr std::string_view name = "two_errors";
  static constexpr std::size_t coordinates = 1;
  static constexpr std::size_t weights = 4;

  template <class Visitor>
  static constexpr void visit_groups(const Visitor& visit) {
    visit(unit_segment);
    visit(unit_segment);
  }

  template <class Scalar>
  static constexpr Scalar evaluate(const std::array<Scalar, 1>& x, const std::array<Scalar, 4>& w) {
    return x[0] * w[0] - x[0] * w[2];
  }
};

}  // namespace touchstone::filters
