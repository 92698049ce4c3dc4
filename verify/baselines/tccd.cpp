#include "verify/baselines/tccd.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>

#include "verify/baselines/bernstein.hpp"
#include "verify/baselines/error_bounded.hpp"
#include "verify/baselines/verdicts.hpp"

namespace touchstone::baselines {
namespace {

using Number = ErrorBounded;
using Cubic = Bernstein<Number, 3>;
using Quartic = Bernstein<Number, 4>;

bool certainly_opposite(const Number& a, const Number& b) { return a.sign() * b.sign() < 0; }

/// A sign that is not known counts as opposite.
bool possibly_opposite(const Number& a, const Number& b) { return a.sign() * b.sign() <= 0; }

/// The roots of a cubic on its interval.
struct Roots {
  int count;
  int start_sign;  ///< Y's sign before the first of them; 0 if it is unknown
};

/// The signs of κ at both ends if one extremum lies between them. An unknown sign follows from the
/// other end or, if both are unknown, from the curvature, one end of which may be an inflection.
std::array<int, 2> end_signs(const Bernstein<Number, 2>& kappa) {
  const int start = kappa[0].sign(), end = kappa[2].sign();
  if (start != 0 && end != 0) return {start, end};
  if (start != 0) return {start, -start};
  if (end != 0) return {-end, end};
  const int a = (kappa[1] - kappa[0]).sign(), b = (kappa[2] - kappa[1]).sign();
  const int curvature = a != 0 ? a : b;
  return {-curvature, curvature};
}

/// Y's sign at its only extremum; 0 if it is not known.
int sign_at_extremum(const Cubic& k) {
  const auto kappa = derivative(k);
  const Decomposition<Number> parts = decompose(k, kappa);
  if (parts.t.value == 0.0) {
    const Number opposite_end = kappa[0] - Number(2) * kappa[1];
    return value_at(k, kappa[0], opposite_end).sign() * (kappa[0] - kappa[1]).sign();
  }
  const int first = parts.k[0].sign(), last = parts.k[1].sign();
  if (first == 0 || last == 0 || first == last) return first * last == 0 ? 0 : first;
  const int there = value_at(kappa, parts.k[0], -parts.k[1]).sign();
  const int before = end_signs(kappa)[0];
  if (there == 0 || before == 0) return 0;
  return there == before ? last : first;
}

Roots roots_of(const Cubic& k, Course course) {
  int start = k[0].sign(), end = k[3].sign();
  if (start == 0 && end == 0) return {2, 0};
  const bool end_is_unknown = start == 0 || end == 0;
  // Unknown at an end: without an extremum that is a root, with one it may be.
  const int assumed = course == Course::monotone ? -1 : 1;
  if (start == 0) start = assumed * end;
  if (end == 0) end = assumed * start;
  if (start != end) return {1, start};
  if (course == Course::monotone) return {0, start};
  if (sign_at_extremum(k) == start) return {end_is_unknown ? 1 : 0, start};
  return {2, start};
}

/// The sign of a linear form at each of Y's roots; 0 if it is unknown.
std::array<int, 2> signs_at_roots(const Bernstein<Number, 1>& linear, const Cubic& k,
                                  const Roots& roots) {
  const int first = linear[0].sign(), last = linear[1].sign();
  if (first == last) return {first, first};
  const int denominator = (linear[0] - linear[1]).sign();
  if (denominator == 0) return {0, 0};
  const Number opposite_end = -linear[1];
  const int y = value_at(k, linear[0], opposite_end).sign() * denominator;
  if (roots.count == 1) {
    const int sign = y == roots.start_sign ? last : first;
    return {y == 0 ? 0 : sign, 0};
  }
  if (y != 0 && y != roots.start_sign) return {first, last};
  const auto kappa = derivative(k);
  const int before = kappa[0].sign();
  if (before == 0) return {0, 0};
  const int there = value_at(kappa, linear[0], opposite_end).sign();
  if (y == 0) return {there == before ? 0 : first, there == -before ? 0 : last};
  return there == before ? std::array{last, last} : std::array{first, first};
}

/// The roots of Y at which G is certainly negative.
std::array<bool, 2> violations(const Cubic& k, const Quartic& g, const Roots& roots) {
  const auto j = reduce(k, g);
  const Decomposition<Number> parts = decompose(k, j);
  const bool is_linear = parts.t.value == 0.0 || (j[0] + j[2] - Number(2) * j[1]).value == 0.0;
  if (is_linear && (j[0] - j[1]).value == 0.0) {
    const bool is_negative = j[0].sign() < 0;
    return {is_negative, is_negative};
  }
  if (is_linear) {
    const auto signs = signs_at_roots({j[0], Number(2) * j[1] - j[0]}, k, roots);
    return {signs[0] < 0, signs[1] < 0};
  }
  const auto l = signs_at_roots(parts.l, k, roots), rest = signs_at_roots(parts.k, k, roots);
  return {l[0] * rest[0] > 0, l[1] * rest[1] > 0};
}

/// True if the cubic, which has no inflection, has a root at which no quartic is certainly
/// negative.
/// \param inside the quartic of that index; called only if there is a root.
template <class Inside>
bool has_contact(const Cubic& k, const Inside& inside, Course course) {
  const Roots roots = roots_of(k, course);
  if (roots.count == 0) return false;
  std::array<bool, 2> alive{true, roots.count == 2};
  for (std::size_t index = 0; index < 3; ++index) {
    const auto violated = violations(k, inside(index), roots);
    for (std::size_t i = 0; i < 2; ++i) alive[i] = alive[i] && !violated[i];
    if (!alive[0] && !alive[1]) return false;
  }
  return true;
}

/// The two parts of a form, before and after a time.
template <std::size_t degree>
struct Parts {
  Bernstein<Number, degree> before, after;
};

/// De Casteljau's subdivision at n/q without division: both parts are the form times q^degree.
template <std::size_t degree>
Parts<degree> subdivided(Bernstein<Number, degree> row, const Number& n, const Number& q) {
  Parts<degree> parts;
  const Number rest = q - n;
  parts.before[0] = row[0];
  parts.after[degree] = row[degree];
  for (std::size_t step = 1; step <= degree; ++step) {
    for (std::size_t i = 0; i + step <= degree; ++i) row[i] = rest * row[i] + n * row[i + 1];
    parts.before[step] = row[0];
    parts.after[degree - step] = row[degree - step];
  }
  // Row `step` has that many factors q; the others are multiplied accordingly.
  Number power = q;
  for (std::size_t step = degree; step-- > 0;) {
    parts.before[step] = parts.before[step] * power;
    parts.after[degree - step] = parts.after[degree - step] * power;
    power = power * q;
  }
  return parts;
}

template <class Inside>
bool has_contact_beside_inflection(const Cubic& k, const Inside& inside) {
  const Number two(2), three(3);
  const Number n = k[0] - two * k[1] + k[2];
  const Number q = k[0] - three * k[1] + three * k[2] - k[3];
  if (q.sign() == 0) return true;
  Parts<3> cubics = subdivided<3>(k, n, q);
  const auto crosses = [&](Cubic& part, auto pick) {
    if (q.sign() < 0) std::ranges::transform(part, part.begin(), std::negate<>());
    const Course course = baselines::has_lone_end(part, certainly_opposite)
                              ? Course::monotone
                              : course_without_inflection(part, possibly_opposite);
    const auto inside_part = [&](std::size_t i) { return subdivided<4>(inside(i), n, q).*pick; };
    return has_contact(part, inside_part, course);
  };
  return crosses(cubics.before, &Parts<4>::before) || crosses(cubics.after, &Parts<4>::after);
}

}  // namespace

bool tccd_collides(Kind kind, const Query& query) {
  const auto points = baselines::moving_points_of<Number>(kind, query);
  const auto normal = normal_of(points);
  const Cubic k = coplanarity(points, normal);
  const auto all_have = [&](int sign) {
    return std::ranges::all_of(k, [sign](const Number& x) { return x.sign() == sign; });
  };
  if (all_have(1) || all_have(-1)) return false;
  const Course course = course_of(k, certainly_opposite, possibly_opposite);
  const auto inside = [&](std::size_t i) -> Quartic {
    return baselines::inside(kind, points, normal, i);
  };
  return course == Course::inflection ? has_contact_beside_inflection(k, inside)
                                      : has_contact(k, inside, course);
}

std::unique_ptr<fast::Method> tccd_method() {
  return std::make_unique<VerdictMethod>("tccd", "wang2015", tccd_collides);
}

}  // namespace touchstone::baselines
