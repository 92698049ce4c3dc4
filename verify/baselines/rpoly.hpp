#pragma once

/// \file
/// The zeros of a real polynomial by the three-stage method of Jenkins and Traub, as released
/// root-finding methods use it. ([jenkins1970]; [jenkins1975], algorithm 493 of the ACM.)
///
/// The iteration uses P and a polynomial K of one degree less. In each step K is replaced by a
/// combination of itself and P divided by a divisor: first x (stage 1, five steps), then a
/// quadratic with two fixed complex zeros (stage 2), then the current guess (stage 3). **Theorem:**
/// the components of K that belong to the zeros of P nearest to the divisor's grow the fastest, so
/// that K yields ever better guesses of a linear and of a quadratic factor of P; with the divisor
/// being the guess, convergence is quadratic. Stage 2 goes on until one of the two sequences of
/// guesses settles. The divisors of stage 2 are x² − 2β cos θ x + β² by the paper, β a lower bound
/// of the moduli of P's zeros; in the program, and here, they end in β; θ turns by 94° when a try
/// fails. Each zero or pair found is divided off, and the method continues with the quotient.
///
/// In floating point multiple zeros are computed as clusters, mostly of complex pairs, with half (a
/// third, …) of the digits. This is the source of most errors of the methods that use it.

#include <array>
#include <cstddef>
#include <span>

namespace touchstone::baselines {

/// The greatest degree that zeros_of() takes.
inline constexpr std::size_t most_zeros = 8;

struct Zero {
  double re;
  double im;
};

/// Zeros in the order of discovery: roughly by modulus, conjugate pairs side by side.
struct Zeros {
  std::array<Zero, most_zeros> zero;
  std::size_t count = 0;

  [[nodiscard]] const Zero* begin() const { return zero.data(); }
  [[nodiscard]] const Zero* end() const { return zero.data() + count; }
};

/// The zeros of the polynomial with these finite coefficients, the highest power's first. Each is
/// repeated according to its multiplicity. Without convergence within 20 angles, only the zeros
/// found until then. None if the first coefficient is 0 or the degree is.
/// \throws std::invalid_argument if there are no coefficients, or more than most_zeros + 1.
[[nodiscard]] Zeros zeros_of(std::span<const double> coefficients);

}  // namespace touchstone::baselines
