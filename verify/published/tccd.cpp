// TCCD: Bernstein sign classification in floating point with running error bounds [wang2015].
//
// **Algorithm.** The coplanarity cubic Y is examined on [0,1], or, if it has an inflection, on the
// parts before and after it, so that on each it has at most two roots. Counting them needs the
// sign of Y at its extremum; a contact at one is decided by the signs of three quartics there.
// Both are found without computing a root, by the reductions of bernstein.hpp. Every number
// carries a bound of its error (error_bounded.hpp); a root is rejected only if a sign is certain.
//
// **Answer.** A verdict, without a time of impact (a yes ignores t_max) and without separation.
//
// **Known defects.**
//   - *False positives*: all motion in a common plane (Y ≡ 0). More: where Y is linear within its
//     bounds, as for any pair in relative translation, and changes sign in the middle third of the
//     step, its signs are +, +, −, −; that looks like an inflection at an unknown place and is
//     answered with a collision without any inside test. A vertex that falls through the plane of
//     a triangle five edges away is reported at every crossing time from 0.34 to 0.66. In the
//     outer thirds the decomposition degenerates and often rejects nothing.
//   - *False negatives at unknown signs*. The method is published as free of them. But if Y and
//     its derivative both have unknown signs at the zero of a linear form, the published rule uses
//     the form's signs at the ends as those at the two roots. The zero may also be before both or
//     after both; and if it is a double root of Y, a constraint that is 0 there rejects the first
//     root and another one the second. The test has such a grazing contact of few-bit coordinates.
//   - *False negatives by underflow*, which causes unknown signs. After an inflection the
//     coefficients of both parts are multiplied through by powers of its denominator: cubics have
//     degree 12 in the coordinates' scale, quartics 16, J 40, T 80, K 92, and Y where K vanishes
//     288. Differences of 1e-2 make 1e-576 of that: Y and its derivative are 0 with a bound of 0,
//     and the rule above applies. At other scales bounds vanish before their values and make them
//     certain, or T is "exactly 0" and J linear when it is not. The test scales collisions down by
//     powers of two, which should change no answer: a tenth of them are missed at 2^-8, including
//     all with an inflection (without one the highest degree is 72). When all numbers are 0, every
//     answer is a collision.
//
// Of the true contacts of armadillo-rollers, 4,650 vertex-face and 19,308 edge-edge, it misses 23
// and 171: 2.3 and 6.7 in 200,000 candidates, where the released code was seen to miss 3 and 4.
// With all coordinates times 16 it misses 0 and 3: all others are underflow. In an experiment that
// left the two unknown signs unknown, it missed none of them at either scale.
//
// **Promise.** None, for these reasons. The reading of an uninitialised sign (both ends of the
// derivative unknown) is not reproduced: the signs there follow from the curvature.

#include <algorithm>
#include <array>
#include <cstddef>

#include "verify/published/bernstein.hpp"
#include "verify/published/error_bounded.hpp"
#include "verify/published/published.hpp"

namespace touchstone::verify::published {
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
    const Course course = has_lone_end(part, certainly_opposite)
                              ? Course::monotone
                              : course_without_inflection(part, possibly_opposite);
    const auto inside_part = [&](std::size_t i) { return subdivided<4>(inside(i), n, q).*pick; };
    return has_contact(part, inside_part, course);
  };
  return crosses(cubics.before, &Parts<4>::before) || crosses(cubics.after, &Parts<4>::after);
}

bool tccd_collides(ContactKind kind, const Query& query) {
  const auto points = moving_points_of<Number>(kind, query);
  const auto normal = normal_of(points);
  const Cubic k = coplanarity(points, normal);
  const auto all_have = [&](int sign) {
    return std::ranges::all_of(k, [sign](const Number& x) { return x.sign() == sign; });
  };
  if (all_have(1) || all_have(-1)) return false;
  const Course course = course_of(k, certainly_opposite, possibly_opposite);
  const auto inside = [&](std::size_t i) -> Quartic {
    return published::inside(kind, points, normal, i);
  };
  return course == Course::inflection ? has_contact_beside_inflection(k, inside)
                                      : has_contact(k, inside, course);
}

}  // namespace

Answer tccd(ContactKind kind, const Query& query, const TouchstonePluginOptions& /*options*/) {
  return yes_if(tccd_collides(kind, query));
}

}  // namespace touchstone::verify::published
