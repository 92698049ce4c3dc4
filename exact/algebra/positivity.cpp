#include "exact/algebra/positivity.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace touchstone::exact {
namespace {

/// product *= from (1−y) + to y, all as forms in (1−y, y).
void multiply(std::vector<Integer>& product, const Integer& from, const Integer& to) {
  product.emplace_back(0);
  for (std::size_t k = product.size(); k-- > 0;) {
    product[k] *= from;
    if (k > 0) product[k] += product[k - 1] * to;
  }
}

/// A part of the interval with the coefficients on it.
struct Part {
  std::vector<Integer> bernstein;
  unsigned long depth;
  Integer index;
};

/// Both halves of a part by de Casteljau's rule, without its divisions: 2^n times the coefficients.
std::pair<Part, Part> halves(Part part) {
  std::vector<Integer>& row = part.bernstein;
  const std::size_t n = row.size() - 1;
  Part left{std::vector<Integer>(n + 1), part.depth + 1, 2 * part.index};
  Part right{std::vector<Integer>(n + 1), part.depth + 1, 2 * part.index + 1};
  for (std::size_t k = 0; k <= n; ++k) {
    const auto shift = static_cast<mp_bitcnt_t>(n - k);
    left.bernstein[k] = row.front() << shift;
    right.bernstein[n - k] = row.back() << shift;
    for (std::size_t i = 0; i + 1 < row.size(); ++i) row[i] += row[i + 1];
    row.pop_back();
  }
  return {std::move(left), std::move(right)};
}

bool is_positive_at_ends(const std::vector<Integer>& bernstein) {
  return sgn(bernstein.front()) > 0 && sgn(bernstein.back()) > 0;
}

}  // namespace

std::vector<Integer> binomials(std::size_t n) {
  std::vector<Integer> row{1};
  for (unsigned long k = 1; k <= n; ++k) {
    row.emplace_back(row.back() * static_cast<unsigned long>(n - k + 1) / k);
  }
  return row;
}

std::vector<Integer> bernstein_coefficients(std::vector<Integer> form) {
  const auto row = binomials(form.size() - 1);
  Integer multiple = 1;
  for (const Integer& x : row) multiple = lcm(multiple, x);
  for (std::size_t k = 0; k < form.size(); ++k) form[k] *= multiple / row[k];
  return form;
}

std::vector<Integer> bernstein_coefficients(const Polynomial& p, const RationalInterval& interval) {
  // Compute Σ a_i t^i 1^(n−i) by Horner's rule, with t = (a (1−y) + b y)/d, 1 = (d (1−y) + d y)/d.
  const Integer d = lcm(interval.lower.get_den(), interval.upper.get_den());
  const Integer a = interval.lower.get_num() * (d / interval.lower.get_den());
  const Integer b = interval.upper.get_num() * (d / interval.upper.get_den());
  std::vector<Integer> sum{p.leading()}, power{Integer(1)};
  for (std::size_t i = p.degree(); i-- > 0;) {
    multiply(sum, a, b);
    multiply(power, d, d);
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += p[i] * power[k];
  }
  return bernstein_coefficients(std::move(sum));
}

int common_sign(const std::vector<Integer>& numbers) {
  const int sign = sgn(numbers.front());
  const bool common =
      std::ranges::all_of(numbers, [&](const Integer& x) { return sgn(x) == sign; });
  return common ? sign : 0;
}

BisectionProof prove_positive(const std::vector<Integer>& bernstein, unsigned long limit) {
  using Outcome = BisectionProof::Outcome;
  if (!is_positive_at_ends(bernstein)) return {.outcome = Outcome::refuted};
  BisectionProof proof;
  std::vector<Part> parts;
  parts.push_back({bernstein, 0, 0});
  while (!parts.empty()) {
    Part part = std::move(parts.back());
    parts.pop_back();
    if (part.depth > proof.depth) {
      proof.depth = part.depth;
      proof.index = part.index;
    }
    if (common_sign(part.bernstein) > 0) continue;
    if (part.depth == limit) return {.outcome = Outcome::too_deep};
    auto [left, right] = halves(std::move(part));
    if (!is_positive_at_ends(left.bernstein)) return {.outcome = Outcome::refuted};
    parts.push_back(std::move(right));
    parts.push_back(std::move(left));
  }
  return proof;
}

}  // namespace touchstone::exact
