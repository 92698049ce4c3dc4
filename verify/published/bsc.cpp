// BSC: Bernstein sign classification [tang2014], as patched for the comparison of [wang2021].
//
// **Algorithm.** The coplanarity cubic is classified by its Bernstein coefficients: monotone, one
// extremum, or an inflection; its roots are counted, and at each the signs of three inside
// quartics are found from linear forms (bernstein.hpp). First in intervals; if they do not say
// yes, again in exact numbers. Before that, a quick no by absolute thresholds in doubles.
//
// **Answer.** A verdict, without a time of impact (a yes ignores t_max) and without separation.
//
// **Known defects**, from the design or the published code, and reproduced:
//   - *False positives*: a cubic with an inflection throws, and the published harness treats every
//     exception as a collision. This is the answer for more than half of all random collisions,
//     and for the printed query with an inflection, which does not collide. Where k_0 = 0, J
//     vanishes and rejects nothing.
//   - *False negatives*: motion in a common plane makes all coefficients 0. Equal signs are read
//     as monotone, and equal signs at both ends as no root: no collision. Every exactly coplanar
//     contact is missed: the printed coplanar query, two edges at rest that cross.
//   - *False negatives by scale*: the quick no requires values above 100·2^-52 and is safe for
//     coordinates of about 1; with large coordinates rounding exceeds it.
//   - A linear form that vanishes at t = 0 and ends positive is evaluated with the wrong sign (the
//     published flip tests whether the first coefficient is negative). At such a root the answer
//     may be wrong either way.
//
// An exception of the published code skips the restoring of the rounding mode, which then stays
// upward for the rest of the process and invalidates its exact arithmetic. Here the mode is
// restored.
//
// **Promise.** None.

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>

#include "verify/published/bernstein.hpp"
#include "verify/published/exact_number.hpp"
#include "verify/published/published.hpp"
#include "verify/published/upward_interval.hpp"

namespace touchstone::verify::published {
namespace {

/// The quick no: true if every coefficient of Y is beyond a fixed threshold on one side.
bool is_clearly_apart(ContactKind kind, const Query& query) {
  constexpr double threshold = 100 * 0x1p-52;
  const auto points = moving_points_of<double>(kind, query);
  const auto products = coplanarity_products(points, normal_of(points));
  return std::ranges::all_of(products, [](double x) { return x > threshold; }) ||
         std::ranges::all_of(products, [](double x) { return x < -threshold; });
}

/// The test in one number type, which compares the signs of two numbers: for intervals, true if
/// they may be the same; for exact numbers, true if their signs in {−1, 0, 1} are equal.
template <class Number>
class SignClassification {
 public:
  SignClassification(ContactKind kind, const MovingPoints<Number>& points)
      : kind_(kind),
        points_(points),
        normal_(normal_of(points)),
        k_(coplanarity(points, normal_)) {}

  /// \throws std::domain_error at an inflection.
  [[nodiscard]] bool collides() const {
    const auto all_have = [&](int sign) {
      return std::ranges::all_of(k_, [sign](const Number& x) { return x.sign() == sign; });
    };
    if (all_have(1) || all_have(-1)) return false;
    const int roots = count_roots();
    std::array<bool, 2> alive{roots > 0, roots == 2};
    for (std::size_t i = 0; i < 3 && (alive[0] || alive[1]); ++i) {
      kill_violations(inside(kind_, points_, normal_, i), roots, alive);
    }
    return alive[0] || alive[1];
  }

 private:
  using Linear = Bernstein<Number, 1>;

  static bool opposite(const Number& a, const Number& b) { return !same_sign(a, b); }

  [[nodiscard]] int count_roots() const {
    const Course course = course_of(k_, opposite, opposite);
    if (course == Course::inflection) throw std::domain_error("bsc: the cubic has an inflection");
    if (opposite(k_[0], k_[3])) return 1;
    if (course == Course::monotone) return 0;
    return same_sign(at_extremum(), k_[0]) ? 0 : 2;
  }

  /// A number of Y's sign at its only extremum.
  [[nodiscard]] Number at_extremum() const {
    const auto kappa = derivative(k_);
    const auto parts = decompose(k_, kappa);
    if (is_zero(parts.t)) {
      const Number value = value_at(k_, kappa[0], -kappa[2]);
      return kappa[0].sign() < 0 ? -value : value;
    }
    if (same_sign(parts.k[0], parts.k[1])) return parts.k[0];
    const Number there = value_at(kappa, parts.k[0], -parts.k[1]);
    return same_sign(there, kappa[0]) ? parts.k[1] : parts.k[0];
  }

  /// Numbers of a linear form's signs at Y's roots.
  [[nodiscard]] Linear at_roots(const Linear& linear, int roots) const {
    if (same_sign(linear[0], linear[1])) return linear;
    const Number opposite_end = -linear[1];
    Number y = value_at(k_, linear[0], opposite_end);
    if (linear[0].sign() < 0) y = -y;  // as published: not if the first is 0 and the last positive
    const bool is_as_at_start = same_sign(y, k_[0]);
    const Number &first = linear[0], &last = linear[1];
    if (roots == 1) return is_as_at_start ? Linear{last, last} : Linear{first, first};
    if (!is_as_at_start) return linear;
    const auto kappa = derivative(k_);
    const bool is_before = same_sign(value_at(kappa, first, opposite_end), kappa[0]);
    return is_before ? Linear{last, last} : Linear{first, first};
  }

  void kill_violations(const Bernstein<Number, 4>& g, int roots, std::array<bool, 2>& alive) const {
    const auto j = reduce(k_, g);
    const auto parts = decompose(k_, j);
    if (is_zero(j[0] + j[2] - Number(2) * j[1]) || is_zero(parts.t)) {
      const Linear values = at_roots({j[0], j[2]}, roots);
      for (std::size_t i = 0; i < 2; ++i) alive[i] = alive[i] && values[i].sign() >= 0;
      return;
    }
    const Linear l = at_roots(parts.l, roots), rest = at_roots(parts.k, roots);
    for (std::size_t i = 0; i < 2; ++i) alive[i] = alive[i] && !same_sign(l[i], rest[i]);
  }

  ContactKind kind_;
  const MovingPoints<Number>& points_;
  Bernstein<Vector<Number>, 2> normal_;
  Bernstein<Number, 3> k_;
};

/// Not inlined: its arithmetic must stay where the rounding mode is upward.
[[gnu::noinline]] bool collides_in_intervals(ContactKind kind, const Query& query) {
  const auto points = moving_points_of<UpwardInterval>(kind, query);
  return SignClassification(kind, points).collides();
}

bool collides_exactly(ContactKind kind, const Query& query) {
  // Doubled once, products are multiples of 4 and halves of sums of them are integers.
  const auto coordinates = scaled_to_integers(query.coordinates, 1);
  const auto points = moving_points_of(kind, coordinates);
  return SignClassification(kind, points).collides();
}

}  // namespace

Answer bsc(ContactKind kind, const Query& query, const TouchstonePluginOptions& /*options*/) {
  if (is_clearly_apart(kind, query)) return yes_if(false);
  bool collides = false;
  {
    const RoundingMode upward(FE_UPWARD);
    collides = collides_in_intervals(kind, query);
  }
  return yes_if(collides || collides_exactly(kind, query));
}

}  // namespace touchstone::verify::published
