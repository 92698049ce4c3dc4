#include "fast/certified/exact/polynomial.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "fast/certified/exact/fixed_integer.hpp"

namespace touchstone::fast::exact_stage {
namespace {

/// Divides by the greatest power of two that divides all coefficients.
void remove_twos(Polynomial& c) {
  long zeros = -1;
  for (const BigInteger& x : c) {
    if (x.sign() == 0) continue;
    zeros = zeros < 0 ? x.trailing_zeros() : std::min(zeros, x.trailing_zeros());
  }
  if (zeros <= 0) return;
  for (BigInteger& x : c) x >>= zeros;
}

void drop_top_zeros(Polynomial& c) {
  while (!c.empty() && c.back().sign() == 0) c.pop_back();
}

/// Divides by x + y as often as it divides.
void remove_sums(Polynomial& c) {
  while (c.size() > 1) {
    Polynomial quotient(c.begin(), c.end() - 1);
    for (std::size_t k = 1; k < quotient.size(); ++k) quotient[k] -= quotient[k - 1];
    if (!(quotient.back() == c.back())) return;
    c = std::move(quotient);
  }
}

/// The pseudo-remainder: a times b's top coefficient to the power 1 + the difference of degrees,
/// modulo b.
/// \pre a is not of lower degree than b.
Polynomial pseudo_remainder(Polynomial a, const Polynomial& b) {
  for (std::size_t left = a.size() - b.size() + 1; left-- > 0;) {
    const bool reduces = a.size() == b.size() + left;
    const BigInteger top = reduces ? a.back() : 0;
    for (BigInteger& x : a) x = x * b.back();
    if (!reduces) continue;
    for (std::size_t k = 0; k < b.size(); ++k) a[k + left].subtract_product(top, b[k]);
    drop_top_zeros(a);
  }
  return a;
}

BigInteger power(const BigInteger& x, std::size_t exponent) {
  BigInteger result = 1;
  for (; exponent > 0; --exponent) result = result * x;
  return result;
}

/// A multiple of the greatest common divisor: the last of the subresultants [brown1971], which stay
/// short because their known common factors are divided out. \pre a is not of lower degree than b.
Polynomial last_subresultant(Polynomial a, Polynomial b) {
  BigInteger g = 1, h = 1;
  for (;;) {
    const std::size_t step = a.size() - b.size();
    Polynomial remainder = pseudo_remainder(a, b);
    if (remainder.empty()) return b;
    const BigInteger divisor = g * power(h, step);
    for (BigInteger& x : remainder) x = x.divided_exactly(divisor);
    a = std::move(b);
    b = std::move(remainder);
    g = a.back();
    if (step > 0) h = power(g, step).divided_exactly(power(h, step - 1));
  }
}

// ---- Modulo a prime -----------------------------------------------------------------------------

constexpr unsigned prime_bits = 61;
constexpr std::uint64_t prime = (std::uint64_t{1} << prime_bits) - 1;

/// a b modulo the prime: 2^61 is 1.
std::uint64_t product(std::uint64_t a, std::uint64_t b) {
  const WideLimb whole = WideLimb{a} * b;
  const std::uint64_t sum =
      (static_cast<std::uint64_t>(whole) & prime) + static_cast<std::uint64_t>(whole >> prime_bits);
  return sum >= prime ? sum - prime : sum;
}

std::uint64_t difference(std::uint64_t a, std::uint64_t b) {
  return a >= b ? a - b : a + prime - b;
}

using Residues = std::vector<std::uint64_t>;

void drop_top_zeros(Residues& c) {
  while (!c.empty() && c.back() == 0) c.pop_back();
}

Residues residues(const Polynomial& c) {
  Residues result;
  for (const BigInteger& x : c) result.push_back(x.residue(prime));
  drop_top_zeros(result);
  return result;
}

/// A multiple of a modulo b.
void reduce(Residues& a, const Residues& b) {
  while (a.size() >= b.size()) {
    const std::uint64_t top = a.back();
    const std::size_t shift = a.size() - b.size();
    for (std::uint64_t& x : a) x = product(x, b.back());
    for (std::size_t k = 0; k < b.size(); ++k) {
      a[k + shift] = difference(a[k + shift], product(top, b[k]));
    }
    drop_top_zeros(a);
  }
}

}  // namespace

Polynomial& operator+=(Polynomial& a, const Polynomial& b) {
  for (std::size_t k = 0; k < a.size(); ++k) a[k] += b[k];
  return a;
}

Polynomial& operator-=(Polynomial& a, const Polynomial& b) {
  for (std::size_t k = 0; k < a.size(); ++k) a[k] -= b[k];
  return a;
}

Polynomial operator-(Polynomial a, const Polynomial& b) { return a -= b; }

Polynomial operator-(Polynomial a) {
  for (BigInteger& c : a) c = -std::move(c);
  return a;
}

Polynomial operator*(const Polynomial& a, const Polynomial& b) {
  Polynomial product(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < b.size(); ++k) product[i + k].add_product(a[i], b[k]);
  }
  return product;
}

Polynomial operator*(Polynomial a, const BigInteger& factor) {
  for (BigInteger& c : a) c = c * factor;
  return a;
}

Polynomial operator<<(Polynomial a, long bits) {
  for (BigInteger& c : a) c <<= bits;
  return a;
}

Polynomial raised_to(Polynomial form, std::size_t degree) {
  while (form.size() <= degree) {
    form.emplace_back();
    for (std::size_t k = form.size() - 1; k > 0; --k) form[k] += form[k - 1];
  }
  return form;
}

Polynomial inner_polynomial(std::span<const BigInteger> form) {
  const auto is_not_zero = [](const BigInteger& c) { return c.sign() != 0; };
  Polynomial result(std::ranges::find_if(form, is_not_zero), form.end());
  drop_top_zeros(result);
  remove_sums(result);
  remove_twos(result);
  return result;
}

bool surely_coprime(const Polynomial& a, const Polynomial& b) {
  Residues first = residues(a), second = residues(b);
  if (first.size() != a.size()) return false;  // the prime divides the top coefficient
  while (!second.empty()) {
    reduce(first, second);
    std::swap(first, second);
  }
  return first.size() == 1;
}

Polynomial common_divisor(Polynomial a, Polynomial b) {
  if (surely_coprime(a, b)) return {1};
  if (a.size() < b.size()) std::swap(a, b);
  const BigInteger top = b.back();
  Polynomial divisor = last_subresultant(std::move(a), std::move(b));
  if (divisor.size() == 1) return {1};
  // The primitive divisor's top coefficient divides that of b.
  const BigInteger own = divisor.back();
  for (BigInteger& x : divisor) x = (x * top).divided_exactly(own);
  remove_twos(divisor);
  return divisor;
}

Polynomial scaled_quotient(Polynomial a, const Polynomial& b) {
  Polynomial quotient(a.size() - b.size() + 1);
  for (BigInteger& x : a) x = x * b.back();
  drop_top_zeros(a);
  while (a.size() >= b.size()) {
    const std::size_t shift = a.size() - b.size();
    const BigInteger factor = quotient[shift] = a.back().divided_exactly(b.back());
    for (std::size_t k = 0; k < b.size(); ++k) a[k + shift].subtract_product(factor, b[k]);
    drop_top_zeros(a);
  }
  remove_twos(quotient);
  return quotient;
}

Polynomial squarefree(const Polynomial& f) {
  if (f.size() <= 2) return f;
  Polynomial derivative;
  for (std::size_t k = 1; k < f.size(); ++k) {
    derivative.push_back(BigInteger(static_cast<std::int64_t>(k)) * f[k]);
  }
  const Polynomial repeated = common_divisor(f, derivative);
  return repeated.size() == 1 ? f : scaled_quotient(f, repeated);
}

}  // namespace touchstone::fast::exact_stage
