#include "touchstone/algebraic_number.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>

namespace touchstone::exact {
namespace {

constexpr unsigned long levels_before_zero_test = 8;

/// den·t − num, primitive because num/den is in lowest terms.
Polynomial linear_factor(const Rational& root) {
  return Polynomial(Integer(-root.get_num()), Integer(root.get_den()));
}

/// Sign of Σ a_i y^i at y = index/2^level.
int sign_at_dyadic(const std::vector<Integer>& a, const Integer& index, unsigned long level) {
  Integer value = 0;
  for (std::size_t i = a.size(); i-- > 0;) {
    value *= index;
    value += Integer(a[i] << (level * static_cast<mp_bitcnt_t>(a.size() - 1 - i)));
  }
  return sgn(value);
}

DyadicCell half(const DyadicCell& cell, bool upper) {
  return {2 * cell.index + (upper ? 1 : 0), cell.level + 1};
}

/// A cell that may hold several roots.
struct Crowded {
  DyadicCell cell;
  int changes;
  /// Number of bits that the next approximation of their place should gain.
  unsigned long bits;
};

/// The estimated place of a cluster of roots in a cell, one root for each sign change of its form:
/// Newton's step for a root of that multiplicity, from the lower or the upper end, rounded to the
/// nearest grid point of 2^bits parts strictly inside the cell.
Integer guess_of_cluster(std::vector<Integer> local, const Crowded& crowded, bool from_upper) {
  const Integer parts = Integer(1) << crowded.bits;
  // The value and the slope at an end.
  Integer value = local[0], slope = local[1];
  if (from_upper) {
    value = slope = 0;
    for (std::size_t i = 0; i < local.size(); ++i) {
      value += local[i];
      slope += local[i] * static_cast<unsigned long>(i);
    }
  }
  if (sgn(slope) == 0) return 1;
  Integer guess;
  const Integer step = -2 * crowded.changes * value * parts + slope, twice = 2 * slope;
  mpz_fdiv_q(guess.get_mpz_t(), step.get_mpz_t(), twice.get_mpz_t());
  if (from_upper) guess += parts;
  return std::clamp(guess, Integer(1), Integer(parts - 1));
}

/// The two subcells of width 2^-bits on both sides of a guess, if together they have all sign
/// changes of the cell. Then there is no root elsewhere in the cell, nor at the ends of the two,
/// because the changes of parts and the roots between parts are no more than those of the whole.
std::vector<Crowded> cells_of_cluster(const Polynomial& p, const Crowded& crowded) {
  const auto local = local_coefficients(p, crowded.cell);
  for (const bool from_upper : {false, true}) {
    const Integer guess =
        (crowded.cell.index << crowded.bits) + guess_of_cluster(local, crowded, from_upper);
    const unsigned long level = crowded.cell.level + crowded.bits;
    const DyadicCell above{guess, level}, below{guess - 1, level};
    const int changes_above = sign_changes(bernstein_form(p, above));
    const int changes_below = sign_changes(bernstein_form(p, below));
    if (changes_above + changes_below != crowded.changes) continue;
    return {{above, changes_above, 2 * crowded.bits}, {below, changes_below, 2 * crowded.bits}};
  }
  return {};
}

/// Isolates the roots of a squarefree polynomial in (0,1), ascending; or stops at the first root at
/// a midpoint and returns it, so that the caller divides it out and no root remains at the end of a
/// cell. The method is bisection, but a cell with a cluster of roots is replaced by much smaller
/// ones at once, as long as guesses are right [sagraloff2016].
std::optional<Rational> isolate(const Polynomial& p, std::vector<AlgebraicNumber>& roots) {
  static constexpr unsigned long first_bits = 2;
  const auto crowded = [&](DyadicCell cell, unsigned long bits) {
    const int changes = sign_changes(bernstein_form(p, cell));
    return Crowded{std::move(cell), changes, bits};
  };
  std::vector<Crowded> rest{crowded(DyadicCell{}, 1)};
  while (!rest.empty()) {
    const Crowded here = std::move(rest.back());
    rest.pop_back();
    if (here.changes == 1) roots.emplace_back(p, here.cell);
    if (here.changes < 2) continue;
    std::vector<Crowded> parts;
    if (here.bits > 1) parts = cells_of_cluster(p, here);
    if (parts.empty()) {
      const DyadicCell upper = half(here.cell, true);
      if (sign_at_dyadic(p.coefficients(), upper.index, upper.level) == 0) return upper.lower();
      const unsigned long bits = std::max(here.bits / 2, first_bits);
      parts = {crowded(upper, bits), crowded(half(here.cell, false), bits)};
    }
    std::ranges::move(parts, std::back_inserter(rest));
  }
  return std::nullopt;
}

RationalInterval evaluate(const Polynomial& p, const RationalInterval& x) {
  // Horner's rule in interval arithmetic for 0 ≤ x.
  RationalInterval value{0, 0};
  for (std::size_t i = p.degree() + 1; i-- > 0;) {
    const Rational& low_factor = sgn(value.lower) >= 0 ? x.lower : x.upper;
    const Rational& high_factor = sgn(value.upper) >= 0 ? x.upper : x.lower;
    value = {value.lower * low_factor + p[i], value.upper * high_factor + p[i]};
  }
  return value;
}

RationalInterval quotient(const RationalInterval& a, const RationalInterval& b) {
  const auto [least, greatest] =
      std::minmax({Rational(a.lower / b.lower), Rational(a.lower / b.upper),
                   Rational(a.upper / b.lower), Rational(a.upper / b.upper)});
  return {least, greatest};
}

}  // namespace

AlgebraicNumber::AlgebraicNumber(const Rational& value)
    : polynomial_(linear_factor(value)), rational_(value) {}

AlgebraicNumber::AlgebraicNumber(Polynomial squarefree, DyadicCell cell)
    : polynomial_(std::move(squarefree)), cell_(std::move(cell)) {
  if (polynomial_.degree() == 1) {
    Rational root(-polynomial_[0], polynomial_[1]);
    root.canonicalize();
    rational_ = root;
    return;
  }
  sign_below_ = sign_at(polynomial_, cell_.lower());
}

RationalInterval AlgebraicNumber::interval() const {
  if (rational_) return {*rational_, *rational_};
  return {cell_.lower(), cell_.upper()};
}

void AlgebraicNumber::halve() {
  const DyadicCell upper = half(cell_, true);
  const int sign = sign_at_dyadic(polynomial_.coefficients(), upper.index, upper.level);
  if (sign == 0) {
    rational_ = upper.lower();
  } else {
    cell_ = sign == sign_below_ ? upper : half(cell_, false);
  }
}

bool AlgebraicNumber::narrow(unsigned long bits) {
  const std::vector<Integer> a = local_coefficients(polynomial_, cell_);
  const Integer parts = Integer(1) << bits;
  // The zero of the secant through both ends, rounded to the nearest of the 2^bits grid points.
  Integer rise = -a[0];
  for (const Integer& c : a) rise += c;  // value at the upper end minus value at the lower end
  Integer guess;
  const Integer numerator = (Integer(-a[0]) << (bits + 1)) + rise, denominator = 2 * rise;
  mpz_fdiv_q(guess.get_mpz_t(), numerator.get_mpz_t(), denominator.get_mpz_t());
  guess = std::clamp(guess, Integer(1), Integer(parts - 1));

  const auto settle = [&](const Integer& below) {
    cell_ = {(cell_.index << bits) + below, cell_.level + bits};
    return true;
  };
  const auto meet = [&](const Integer& point) {
    rational_ = DyadicCell{(cell_.index << bits) + point, cell_.level + bits}.lower();
    return true;
  };
  const int sign = sign_at_dyadic(a, guess, bits);
  if (sign == 0) return meet(guess);
  const bool above = sign == sign_below_;
  const Integer neighbour = guess + (above ? 1 : -1);
  const Integer below = above ? guess : neighbour;
  if (neighbour == 0 || neighbour == parts) return settle(below);
  const int neighbour_sign = sign_at_dyadic(a, neighbour, bits);
  if (neighbour_sign == 0) return meet(neighbour);
  if (neighbour_sign == sign) return false;
  return settle(below);
}

void AlgebraicNumber::refine_to_level(unsigned long level) {
  unsigned long bits = 1;
  while (!rational_ && cell_.level < level) {
    if (bits == 1) {
      halve();
      bits = 2;
    } else if (narrow(std::min(bits, level - cell_.level + 1))) {
      bits *= 2;
    } else {
      bits /= 2;
    }
  }
}

void AlgebraicNumber::refine(const Rational& width) {
  if (sgn(width) <= 0)
    throw std::invalid_argument("the width of an isolating interval must be positive");
  unsigned long level = cell_.level;
  while (power_of_two(-static_cast<long>(level)) > width) {
    // log2 of the width to within 2, then step by step.
    const long estimate = static_cast<long>(mpz_sizeinbase(width.get_den_mpz_t(), 2)) -
                          static_cast<long>(mpz_sizeinbase(width.get_num_mpz_t(), 2)) - 1;
    level = std::max(level + 1, static_cast<unsigned long>(std::max(estimate, 0L)));
  }
  refine_to_level(level);
}

int AlgebraicNumber::sign_of(const Polynomial& q) {
  if (q.degree() == 0) return sgn(q[0]);
  bool known_nonzero = false;
  for (unsigned long step = 1;; step *= 2) {
    if (rational_) return sign_at(q, *rational_);
    if (const int sign = sign_on(q, cell_); sign != 0) return sign;
    if (!known_nonzero && step >= levels_before_zero_test) {
      if (is_root_of(q)) return 0;
      known_nonzero = true;
    }
    refine_to_level(cell_.level + step);
  }
}

bool AlgebraicNumber::is_root_of(const Polynomial& q) const {
  if (q.is_zero()) return true;
  if (rational_) return sign_at(q, *rational_) == 0;
  // Much faster than a remainder, whose coefficients grow.
  if (quotient_if_exact(q, polynomial_)) return true;
  const Polynomial rest = q.degree() < polynomial_.degree() ? q : pseudo_remainder(q, polynomial_);
  if (rest.is_zero()) return true;
  const Polynomial divisor = greatest_common_divisor(polynomial_, rest);
  if (divisor.degree() == 0) return false;
  return sign_at(divisor, cell_.lower()) != sign_at(divisor, cell_.upper());
}

DoubleInterval AlgebraicNumber::enclosure() const {
  AlgebraicNumber number = *this;
  for (unsigned long level = 64;; level *= 2) {
    number.refine_to_level(level);
    const auto [lower, upper] = number.interval();
    double below = round_down(lower);
    const double above = round_up(upper);
    if (below == above) return {below, above};
    const double next = std::nextafter(below, std::numeric_limits<double>::infinity());
    if (next >= above) return {below, above};
    // One double strictly inside at most: the number is on one side of it, or is it.
    if (std::nextafter(next, std::numeric_limits<double>::infinity()) < above) continue;
    const auto order = number <=> Rational(next);
    if (order == 0) return {next, next};
    return order < 0 ? DoubleInterval{below, next} : DoubleInterval{next, above};
  }
}

std::strong_ordering operator<=>(const AlgebraicNumber& a, const Rational& b) {
  const auto ordering = [](int sign) { return sign <=> 0; };
  if (a.rational_) return ordering(cmp(*a.rational_, b));
  if (b <= a.cell_.lower()) return std::strong_ordering::greater;
  if (b >= a.cell_.upper()) return std::strong_ordering::less;
  const int sign = sign_at(a.polynomial_, b);
  if (sign == 0) return std::strong_ordering::equal;
  return sign == a.sign_below_ ? std::strong_ordering::greater : std::strong_ordering::less;
}

std::strong_ordering compare(AlgebraicNumber& x, AlgebraicNumber& y) {
  bool known_different = false;
  for (unsigned long step = 1;; step *= 2) {
    if (y.rational_) return x <=> *y.rational_;
    if (x.rational_) return 0 <=> (y <=> *x.rational_);
    const Rational lower = std::max(x.cell_.lower(), y.cell_.lower());
    const Rational upper = std::min(x.cell_.upper(), y.cell_.upper());
    if (lower >= upper) return cmp(x.cell_.lower(), y.cell_.lower()) <=> 0;
    if (!known_different && step >= levels_before_zero_test) {
      const Polynomial divisor = greatest_common_divisor(x.polynomial_, y.polynomial_);
      if (divisor.degree() > 0 && sign_at(divisor, lower) != sign_at(divisor, upper)) {
        return std::strong_ordering::equal;
      }
      known_different = true;
    }
    x.refine_to_level(x.cell_.level + step);
    y.refine_to_level(y.cell_.level + step);
  }
}

std::strong_ordering operator<=>(const AlgebraicNumber& a, const AlgebraicNumber& b) {
  AlgebraicNumber x = a, y = b;
  return compare(x, y);
}

std::vector<AlgebraicNumber> roots_in_unit_interval(const Polynomial& p) {
  if (p.is_zero()) throw std::invalid_argument("every number is a root of the zero polynomial");
  Polynomial rest = squarefree_part(p);
  std::vector<AlgebraicNumber> rational_roots, roots;
  const auto split_off = [&](const Rational& root) {
    rational_roots.emplace_back(root);
    rest = exact_quotient(rest, linear_factor(root));
  };
  for (const Rational& end : {Rational(0), Rational(1)}) {
    if (rest.degree() > 0 && sign_at(rest, end) == 0) split_off(end);
  }
  while (const std::optional<Rational> met = isolate(rest, roots)) {
    split_off(*met);
    roots.clear();
  }
  roots.insert(roots.end(), rational_roots.begin(), rational_roots.end());
  std::ranges::sort(roots, [](const auto& a, const auto& b) { return a < b; });
  return roots;
}

RationalInterval enclose_quotient(const Polynomial& numerator, const Polynomial& denominator,
                                  AlgebraicNumber alpha, const Rational& width) {
  if (sgn(width) <= 0) throw std::invalid_argument("the width of a quotient must be positive");
  for (unsigned long level = 64;; level *= 2) {
    const RationalInterval t = alpha.interval();
    const RationalInterval below = evaluate(denominator, t);
    if (sgn(below.lower) * sgn(below.upper) > 0) {
      RationalInterval result = quotient(evaluate(numerator, t), below);
      if (result.upper - result.lower <= width) return result;
    }
    alpha.refine_to_level(level);
  }
}

}  // namespace touchstone::exact
