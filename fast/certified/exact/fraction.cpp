#include "fast/certified/exact/fraction.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace touchstone::fast::exact_stage {
namespace {

/// Gives both the least common powers and degree.
void make_common(Fraction& a, Fraction& b) {
  const auto raise = [](Fraction& from, const Fraction& to) {
    for (std::size_t i = 0; i < from.powers.size(); ++i) {
      for (; from.powers[i] < to.powers[i]; ++from.powers[i]) {
        from.numerator = from.numerator * to.denominators[i];
      }
    }
  };
  if (a.powers != b.powers) {
    raise(a, b);
    raise(b, a);
    const auto* const denominators = a.denominators != nullptr ? a.denominators : b.denominators;
    a.denominators = b.denominators = denominators;
  }
  const std::size_t degree = std::max(a.numerator.size(), b.numerator.size()) - 1;
  a.numerator = raised_to(std::move(a.numerator), degree);
  b.numerator = raised_to(std::move(b.numerator), degree);
}

bool have_common_form(const Fraction& a, const Fraction& b) {
  return a.powers == b.powers && a.numerator.size() == b.numerator.size();
}

}  // namespace

Fraction& Fraction::operator+=(const Fraction& other) {
  if (have_common_form(*this, other)) {
    numerator += other.numerator;
    return *this;
  }
  Fraction term = other;
  make_common(*this, term);
  numerator += term.numerator;
  return *this;
}

Fraction& Fraction::operator-=(const Fraction& other) {
  if (have_common_form(*this, other)) {
    numerator -= other.numerator;
    return *this;
  }
  Fraction term = other;
  make_common(*this, term);
  numerator -= term.numerator;
  return *this;
}

Fraction operator-(Fraction a) {
  a.numerator = -std::move(a.numerator);
  return a;
}

Fraction operator*(const Fraction& a, const Fraction& b) {
  Fraction product{a.numerator * b.numerator, a.powers,
                   a.denominators != nullptr ? a.denominators : b.denominators};
  for (std::size_t i = 0; i < product.powers.size(); ++i) {
    product.powers[i] = static_cast<std::uint8_t>(product.powers[i] + b.powers[i]);
  }
  return product;
}

Fraction operator*(Fraction a, const BigInteger& factor) {
  a.numerator = std::move(a.numerator) * factor;
  return a;
}

Fraction operator<<(Fraction a, long bits) {
  a.numerator = std::move(a.numerator) << bits;
  return a;
}

std::vector<Polynomial> common_numerators(std::vector<Fraction> fractions) {
  for (std::size_t i = 1; i < fractions.size(); ++i) make_common(fractions[0], fractions[i]);
  for (std::size_t i = 1; i < fractions.size(); ++i) make_common(fractions[0], fractions[i]);
  std::vector<Polynomial> result;
  result.reserve(fractions.size());
  for (Fraction& fraction : fractions) result.push_back(std::move(fraction.numerator));
  return result;
}

}  // namespace touchstone::fast::exact_stage
