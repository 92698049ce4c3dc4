#include "touchstone/polynomial.hpp"

#include <algorithm>
#include <cstdint>
#include <ostream>
#include <stdexcept>
#include <utility>

namespace touchstone::exact {
namespace {

/// Residues modulo a prime: if two polynomials are coprime there, and the degree of one is kept,
/// they are coprime over the rationals (their resultant is not divisible by the prime, hence not
/// zero). The converse fails for one prime in about 2^31, which costs time and nothing else.
class CoprimalityTest {
 public:
  static bool proves_coprime(const Polynomial& p, const Polynomial& q) {
    Residues a = residues(p), b = residues(q);
    if (a.size() != p.degree() + 1) return false;
    while (!b.empty()) {
      reduce(a, b);
      std::swap(a, b);
    }
    return a.size() == 1;
  }

 private:
  static constexpr std::uint64_t prime = 2147483647;
  using Residues = std::vector<std::uint64_t>;

  static void strip(Residues& a) {
    while (!a.empty() && a.back() == 0) a.pop_back();
  }

  static Residues residues(const Polynomial& p) {
    Residues result;
    for (const Integer& c : p.coefficients()) result.push_back(mpz_fdiv_ui(c.get_mpz_t(), prime));
    strip(result);
    return result;
  }

  static std::uint64_t inverse(std::uint64_t x) {
    std::uint64_t result = 1;
    for (std::uint64_t e = prime - 2; e != 0; e >>= 1U, x = x * x % prime) {
      if ((e & 1U) != 0) result = result * x % prime;
    }
    return result;
  }

  /// a becomes a mod b.
  static void reduce(Residues& a, const Residues& b) {
    const std::uint64_t scale = inverse(b.back());
    while (a.size() >= b.size()) {
      const std::uint64_t factor = prime - a.back() * scale % prime;
      for (std::size_t i = 0; i < b.size(); ++i) {
        std::uint64_t& entry = a[a.size() - b.size() + i];
        entry = (entry + factor * b[i]) % prime;
      }
      strip(a);
    }
  }
};

void strip_leading_zeros(std::vector<Integer>& coefficients) {
  while (coefficients.size() > 1 && sgn(coefficients.back()) == 0) coefficients.pop_back();
}

/// rest − factor · t^shift · q.
void subtract_multiple(std::vector<Integer>& rest, const Integer& factor, std::size_t shift,
                       const Polynomial& q) {
  for (std::size_t i = 0; i <= q.degree(); ++i) rest[shift + i] -= factor * q[i];
}

}  // namespace

Polynomial::Polynomial(std::vector<Integer> coefficients) : coefficients_(std::move(coefficients)) {
  if (coefficients_.empty()) coefficients_.resize(1);
  strip_leading_zeros(coefficients_);
}

Polynomial operator-(const Polynomial& p) {
  std::vector<Integer> result = p.coefficients();
  for (Integer& c : result) c = -c;
  return Polynomial(std::move(result));
}

Polynomial operator+(const Polynomial& p, const Polynomial& q) {
  std::vector<Integer> sum(std::max(p.degree(), q.degree()) + 1);
  for (std::size_t i = 0; i <= p.degree(); ++i) sum[i] = p[i];
  for (std::size_t i = 0; i <= q.degree(); ++i) sum[i] += q[i];
  return Polynomial(std::move(sum));
}

Polynomial operator-(const Polynomial& p, const Polynomial& q) { return p + -q; }

Polynomial operator*(const Polynomial& p, const Polynomial& q) {
  std::vector<Integer> product(p.degree() + q.degree() + 1);
  for (std::size_t i = 0; i <= p.degree(); ++i) {
    for (std::size_t j = 0; j <= q.degree(); ++j) product[i + j] += p[i] * q[j];
  }
  return Polynomial(std::move(product));
}

std::ostream& operator<<(std::ostream& out, const Polynomial& p) {
  if (p.is_zero()) return out << 0;
  for (std::size_t i = p.degree() + 1; i-- > 0;) {
    const int sign = sgn(p[i]);
    if (sign == 0) continue;
    if (i == p.degree()) {
      out << (sign < 0 ? "-" : "");
    } else {
      out << (sign < 0 ? " - " : " + ");
    }
    const Integer magnitude = abs(p[i]);
    if (magnitude != 1 || i == 0) out << magnitude.get_str() << (i > 0 ? " " : "");
    if (i > 0) out << 't';
    if (i > 1) out << '^' << i;
  }
  return out;
}

Polynomial derivative(const Polynomial& p) {
  std::vector<Integer> result(p.degree());
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = p[i + 1] * static_cast<unsigned long>(i + 1);
  return Polynomial(std::move(result));
}

Rational DyadicCell::lower() const {
  return Rational(index) * power_of_two(-static_cast<long>(level));
}

Rational DyadicCell::upper() const {
  return Rational(index + 1) * power_of_two(-static_cast<long>(level));
}

int sign_at(const Polynomial& p, const Rational& x) {
  // Horner's rule on the homogenised polynomial: Σ a_i num^i den^(n−i).
  Integer value = 0, power = 1;
  for (std::size_t i = p.degree() + 1; i-- > 0;) {
    value = value * x.get_num() + p[i] * power;
    power *= x.get_den();
  }
  return sgn(value);
}

std::vector<Integer> local_coefficients(const Polynomial& p, const DyadicCell& cell) {
  std::vector<Integer> a = p.coefficients();
  const std::size_t n = p.degree();
  for (std::size_t i = 0; i < n; ++i) a[i] <<= cell.level * static_cast<mp_bitcnt_t>(n - i);
  if (sgn(cell.index) == 0) return a;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = n; j-- > i;) a[j] += cell.index * a[j + 1];
  }
  return a;
}

std::vector<Integer> bernstein_form(const Polynomial& p, const DyadicCell& cell) {
  // Σ a_i y^i = Σ a_i y^i (s+y)^(n−i), because s + y = 1.
  std::vector<Integer> c = local_coefficients(p, cell);
  const std::size_t n = p.degree();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 1; j + i <= n; ++j) c[j] += c[j - 1];
  }
  return c;
}

int sign_changes(const std::vector<Integer>& coefficients) {
  int changes = 0, last = 0;
  for (const Integer& c : coefficients) {
    const int sign = sgn(c);
    if (sign == 0) continue;
    if (last != 0 && sign != last) ++changes;
    last = sign;
  }
  return changes;
}

int sign_on(const Polynomial& p, const DyadicCell& cell) {
  int result = 0;
  for (const Integer& c : bernstein_form(p, cell)) {
    const int sign = sgn(c);
    if (sign != 0 && result != 0 && sign != result) return 0;
    if (sign != 0) result = sign;
  }
  return result;
}

Polynomial primitive_part(const Polynomial& p) {
  if (p.is_zero()) return p;
  Integer content = 0;
  for (const Integer& c : p.coefficients()) content = gcd(content, c);
  if (sgn(p.leading()) < 0) content = -content;
  if (content == 1) return p;
  std::vector<Integer> result = p.coefficients();
  for (Integer& c : result) mpz_divexact(c.get_mpz_t(), c.get_mpz_t(), content.get_mpz_t());
  return Polynomial(std::move(result));
}

Polynomial greatest_common_divisor(const Polynomial& p, const Polynomial& q) {
  if (p.is_zero()) return primitive_part(q);
  if (q.is_zero()) return primitive_part(p);
  if (CoprimalityTest::proves_coprime(p, q)) return Polynomial(Integer(1));
  Polynomial a = primitive_part(p), b = primitive_part(q);
  if (a.degree() < b.degree()) std::swap(a, b);
  while (b.degree() > 0) {
    Polynomial rest = primitive_part(pseudo_remainder(a, b));
    if (rest.is_zero()) return b;
    a = std::exchange(b, std::move(rest));
  }
  return Polynomial(Integer(1));
}

Polynomial squarefree_part(const Polynomial& p) {
  Polynomial primitive = primitive_part(p);
  const Polynomial repeated = greatest_common_divisor(primitive, derivative(primitive));
  return repeated.degree() == 0 ? primitive : exact_quotient(primitive, repeated);
}

Polynomial pseudo_remainder(const Polynomial& p, const Polynomial& q) {
  if (q.is_zero()) throw std::invalid_argument("division by the zero polynomial");
  std::vector<Integer> rest = p.coefficients();
  const Integer scale = abs(q.leading());
  while (rest.size() > q.degree() && sgn(rest.back()) != 0) {
    const Integer factor = sgn(q.leading()) > 0 ? rest.back() : Integer(-rest.back());
    for (Integer& c : rest) c *= scale;
    subtract_multiple(rest, factor, rest.size() - 1 - q.degree(), q);
    strip_leading_zeros(rest);
  }
  return Polynomial(std::move(rest));
}

std::optional<Polynomial> quotient_if_exact(const Polynomial& p, const Polynomial& q) {
  if (q.is_zero()) throw std::invalid_argument("division by the zero polynomial");
  std::vector<Integer> rest = p.coefficients();
  std::vector<Integer> quotient(p.degree() < q.degree() ? 1 : p.degree() - q.degree() + 1);
  for (std::size_t shift = quotient.size(); shift-- > 0 && q.degree() + shift < rest.size();) {
    const Integer& lead = rest[q.degree() + shift];
    if (mpz_divisible_p(lead.get_mpz_t(), q.leading().get_mpz_t()) == 0) return std::nullopt;
    quotient[shift] = lead / q.leading();
    subtract_multiple(rest, quotient[shift], shift, q);
  }
  const bool divides = std::ranges::all_of(rest, [](const Integer& c) { return sgn(c) == 0; });
  if (!divides) return std::nullopt;
  return Polynomial(std::move(quotient));
}

Polynomial exact_quotient(const Polynomial& p, const Polynomial& q) {
  std::optional<Polynomial> quotient = quotient_if_exact(p, q);
  if (!quotient) throw std::invalid_argument("the polynomial is not divisible");
  return *std::move(quotient);
}

}  // namespace touchstone::exact
