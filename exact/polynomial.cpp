#include "exact/polynomial.hpp"

#include <CGAL/Polynomial_traits_d.h>

#include <cstdint>
#include <utility>

namespace touchstone::exact {
namespace {

using Traits = CGAL::Polynomial_traits_d<Polynomial>;

std::vector<Integer> coefficients(const Polynomial& p) { return {p.begin(), p.end()}; }

/// Residues modulo a prime: if two polynomials are coprime there, and the degree of one is kept,
/// they are coprime over the rationals (their resultant is not divisible by the prime, hence not
/// zero). The converse fails for one prime in about 2^31, which costs time and nothing else.
class CoprimalityTest {
 public:
  static bool proves_coprime(const Polynomial& p, const Polynomial& q) {
    Residues a = residues(p), b = residues(q);
    if (a.size() != static_cast<std::size_t>(p.degree()) + 1) return false;
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
    for (const Integer& c : coefficients(p)) result.push_back(mpz_fdiv_ui(c.get_mpz_t(), prime));
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

}  // namespace

Rational DyadicCell::lower() const {
  return Rational(index) * power_of_two(-static_cast<long>(level));
}

Rational DyadicCell::upper() const {
  return Rational(index + 1) * power_of_two(-static_cast<long>(level));
}

int sign_at(const Polynomial& p, const Rational& x) {
  // Horner's rule on the homogenised polynomial: Σ a_i num^i den^(n−i).
  Integer value = 0, power = 1;
  for (auto c = p.end(); c != p.begin();) {
    value = value * x.get_num() + *--c * power;
    power *= x.get_den();
  }
  return sgn(value);
}

std::vector<Integer> local_coefficients(const Polynomial& p, const DyadicCell& cell) {
  std::vector<Integer> a = coefficients(p);
  const std::size_t n = a.size() - 1;
  for (std::size_t i = 0; i < n; ++i) a[i] <<= cell.level * (n - i);
  if (sgn(cell.index) == 0) return a;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = n; j-- > i;) a[j] += cell.index * a[j + 1];
  }
  return a;
}

std::vector<Integer> bernstein_form(const Polynomial& p, const DyadicCell& cell) {
  // Σ a_i y^i = Σ a_i y^i (s+y)^(n−i), because s + y = 1.
  std::vector<Integer> c = local_coefficients(p, cell);
  const std::size_t n = c.size() - 1;
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
  Integer content = p.content();
  if (sgn(p.lcoeff()) < 0) content = -content;
  if (content == 1) return p;
  std::vector<Integer> c = coefficients(p);
  for (Integer& entry : c) mpz_divexact(entry.get_mpz_t(), entry.get_mpz_t(), content.get_mpz_t());
  return {c.begin(), c.end()};
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
  const Polynomial primitive = primitive_part(p);
  if (primitive.degree() < 2) return primitive;
  Polynomial derivative = primitive;
  derivative.diff();
  return exact_quotient(primitive, greatest_common_divisor(primitive, derivative));
}

Polynomial pseudo_remainder(const Polynomial& p, const Polynomial& q) {
  const std::vector<Integer> divisor = coefficients(q);
  std::vector<Integer> rest = coefficients(p);
  const Integer scale = abs(divisor.back());
  while (rest.size() >= divisor.size()) {
    const Integer lead = sgn(divisor.back()) > 0 ? rest.back() : Integer(-rest.back());
    const std::size_t shift = rest.size() - divisor.size();
    for (Integer& entry : rest) entry *= scale;
    for (std::size_t i = 0; i < divisor.size(); ++i) rest[shift + i] -= lead * divisor[i];
    while (!rest.empty() && sgn(rest.back()) == 0) rest.pop_back();
  }
  if (rest.empty()) return Polynomial(Integer(0));
  return {rest.begin(), rest.end()};
}

Polynomial exact_quotient(const Polynomial& p, const Polynomial& q) {
  if (q.degree() == 0) return p;
  return CGAL::integral_division(p, q);
}

}  // namespace touchstone::exact
