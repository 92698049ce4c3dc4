#include "fast/certified/exact/contact_decision.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "fast/certified/exact/enclosing_doubles.hpp"
#include "fast/certified/exact/floating_point_filter.hpp"

namespace touchstone::fast::exact_stage {
namespace {

/// A form whose coefficients have this number of limbs.
template <std::size_t limbs, std::size_t degree>
using Fixed = Form<FixedInteger<limbs>, degree>;

using Time = BasicTime<std::int64_t>;
using FineTime = BasicTime<SignedWideLimb>;

constexpr Time start_time{1, 0}, end_time{0, 1};

template <class Weight>
constexpr std::size_t limbs_of = sizeof(Weight) / 8;

template <class Weight>
FixedInteger<limbs_of<Weight>> fixed(Weight weight) {
  return FixedInteger<limbs_of<Weight>>(weight);
}

/// Sign of a − b.
template <class A, class B>
int compare(const BasicTime<A>& a, const BasicTime<B>& b) {
  return (fixed(a.y) * fixed(b.sum()) - fixed(b.y) * fixed(a.sum())).sign();
}

template <class AnyTime>
AnyTime as(const Time& t) {
  return {t.x, t.y};
}

/// The double with these bits, if its denominator is not too large.
template <class AnyTime>
std::optional<AnyTime> time_of(std::uint64_t bits) {
  using Weight = decltype(AnyTime::x);
  const auto [numerator, exponent] = odd_fraction(std::bit_cast<double>(bits));
  if (-exponent > 64 * static_cast<int>(limbs_of<Weight>) - 2) return std::nullopt;
  const Weight y = numerator;
  return AnyTime{static_cast<Weight>((Weight{1} << static_cast<unsigned>(-exponent)) - y), y};
}

/// True if the time is later than the double with these bits. A nonzero time is at least 2^-62.
bool is_later(const Time& t, std::uint64_t bits) {
  const auto other = time_of<FineTime>(bits);
  return other ? compare(t, *other) > 0 : t.y != 0;
}

// ---- Signs on intervals ------------------------------------------------------------------------

/// The signs of the form's Bernstein coefficients on an interval that is not [0,1].
template <std::size_t limbs, class AnyTime>
std::array<int, 2> signs_within(const FilteredForm<limbs, 2>& b, const AnyTime& lower,
                                const AnyTime& upper) {
  return {b.sign(lower), b.sign(upper)};
}
template <std::size_t limbs, class AnyTime>
std::array<int, 3> signs_within(const FilteredForm<limbs, 3>& b, const AnyTime& lower,
                                const AnyTime& upper) {
  return {b.sign(lower, lower), b.sign(lower, upper), b.sign(upper, upper)};
}
template <std::size_t limbs, class AnyTime>
std::array<int, 4> signs_within(const FilteredForm<limbs, 4>& b, const AnyTime& lower,
                                const AnyTime& upper) {
  return {b.sign(lower, lower, lower), b.sign(lower, lower, upper), b.sign(lower, upper, upper),
          b.sign(upper, upper, upper)};
}

/// The signs of the form's Bernstein coefficients on an interval.
template <std::size_t limbs, std::size_t count, class AnyTime>
std::array<int, count> signs_on(const FilteredForm<limbs, count>& b, const AnyTime& lower,
                                const AnyTime& upper) {
  if (lower.y != 0 || upper.x != 0) return signs_within(b, lower, upper);
  std::array<int, count> signs;
  for (std::size_t i = 0; i < count; ++i) signs[i] = b.coefficient_sign(i);
  return signs;
}

/// The pattern of these signs.
template <std::size_t limbs, std::size_t count, class AnyTime>
IntervalSigns signs_between(const FilteredForm<limbs, count>& b, const AnyTime& lower,
                            const AnyTime& upper) {
  return interval_signs(signs_on(b, lower, upper));
}

// ---- Signs at roots ----------------------------------------------------------------------------

/// The form with x and y exchanged, and the time 1 − t.
template <std::size_t limbs, std::size_t count>
std::array<FixedInteger<limbs>, count> reversed(std::array<FixedInteger<limbs>, count> form) {
  std::ranges::reverse(form);
  return form;
}
template <class Weight>
BasicTime<Weight> mirrored(const BasicTime<Weight>& t) {
  return {t.y, t.x};
}

/// The linear form in f g_2 − g f_2 = x (m_02 x + m_12 y), where m_ij = f_i g_j − f_j g_i.
template <std::size_t f_limbs, std::size_t g_limbs>
Fixed<f_limbs + g_limbs, 1> remainder(const Fixed<f_limbs, 2>& f, const Fixed<g_limbs, 2>& g) {
  return {f[0] * g[2] - f[2] * g[0], f[1] * g[2] - f[2] * g[1]};
}

template <std::size_t limbs, std::size_t count, class AnyTime>
bool changes_sign(const FilteredForm<limbs, count>& b, const AnyTime& lower, const AnyTime& upper) {
  return b.sign_at(lower) * b.sign_at(upper) < 0;
}

/// The sign of q at the root of a linear form.
template <std::size_t limbs, std::size_t q_limbs>
int sign_at_root(const Fixed<limbs, 1>& line, const Fixed<q_limbs, 2>& q) {
  return (line[1] * line[1] * q[0] - line[0] * line[1] * q[1] + line[0] * line[0] * q[2]).sign();
}

/// The sign of q at f's only root α in the open interval, if q has one root β there. The linear
/// form is f(β) times the sign of `factor` at β.
///
/// If the linear form changes its sign, the sign of q at its root tells on which side of that root
/// β is. This gives the sign of f(β), and hence the side of α on which β is.
template <std::size_t limbs, std::size_t q_limbs, class Weight>
std::optional<int> sign_by_remainder(const Fixed<limbs, 1>& line, int factor,
                                     const IntervalSigns& of_f, const Fixed<q_limbs, 2>& q,
                                     const BasicTime<Weight>& lower,
                                     const BasicTime<Weight>& upper) {
  const IntervalSigns of_q = signs_between(FilteredForm(q), lower, upper);
  const IntervalSigns of_line = signs_between(FilteredForm(line), lower, upper);
  if (of_q.changes != 1) return std::nullopt;
  int at_beta = of_line.first;
  if (of_line.changes == 1) {
    const int at_root = sign_at_root(line, q);
    if (at_root == 0) return 0;
    at_beta = at_root == of_q.first ? of_line.last : of_line.first;
  }
  if (at_beta == 0) return 0;
  return at_beta * factor == of_f.last ? of_q.first : of_q.last;
}

/// The sign of q at the only root of f in the open interval, a simple one. Empty unless q is known
/// to have at most one root there. (f and q are not given by Bernstein coefficients.)
template <std::size_t f_limbs, std::size_t q_limbs, class Weight>
std::optional<int> sign_at_root(const Fixed<f_limbs, 1>& f, const Fixed<q_limbs, 2>& q,
                                const BasicTime<Weight>& /*lower*/,
                                const BasicTime<Weight>& /*upper*/) {
  return sign_at_root(f, q);
}

/// The remainder at a root β of q is f q_2 / x, and x > 0. If q_2 = 0, x and y change places.
template <std::size_t f_limbs, std::size_t q_limbs, class Weight>
std::optional<int> sign_at_root(const Fixed<f_limbs, 2>& f, const Fixed<q_limbs, 2>& q,
                                const BasicTime<Weight>& lower, const BasicTime<Weight>& upper) {
  if (q[2].sign() == 0 && q[0].sign() != 0) {
    return sign_at_root(reversed(f), reversed(q), mirrored(upper), mirrored(lower));
  }
  return sign_by_remainder(remainder(f, q), q[2].sign(),
                           signs_between(FilteredForm(f), lower, upper), q, lower, upper);
}

/// The remainder at β is g q_2 / x = f q_2² / x², with g such that x g = q_2 f − f_3 y q.
template <std::size_t f_limbs, std::size_t q_limbs, class Weight>
std::optional<int> sign_at_root(const Fixed<f_limbs, 3>& f, const Fixed<q_limbs, 2>& q,
                                const BasicTime<Weight>& lower, const BasicTime<Weight>& upper) {
  if (q[2].sign() == 0 && q[0].sign() != 0) {
    return sign_at_root(reversed(f), reversed(q), mirrored(upper), mirrored(lower));
  }
  const Fixed<f_limbs + q_limbs, 2> g{f[0] * q[2], f[1] * q[2] - f[3] * q[0],
                                      f[2] * q[2] - f[3] * q[1]};
  return sign_by_remainder(remainder(g, q), 1, signs_between(FilteredForm(f), lower, upper), q,
                           lower, upper);
}

/// Properties of the roots of a cubic form.
template <std::size_t limbs>
struct CubicRoots {
  bool is_one = false;         ///< only one is real, and it is simple
  int multiplicity = 1;        ///< of the multiple root, if it has one
  Fixed<limbs, 1> multiple{};  ///< a linear form with that
};

/// A multiple root is a common root of both derivatives, by x and by y: they are proportional, or
/// their resultant m_02² − m_01 m_12 is 0 and the root is that of their remainder. The resultant is
/// a negative multiple of the discriminant.
template <std::size_t limbs>
CubicRoots<2 * limbs> cubic_roots(const Fixed<limbs, 3>& f) {
  const auto twice = [](const FixedInteger<limbs>& c) { return c + c; };
  const auto thrice = [](const FixedInteger<limbs>& c) { return c + c + c; };
  const Fixed<limbs, 2> by_x{thrice(f[0]), twice(f[1]), f[2]};
  const Fixed<limbs, 2> by_y{f[1], twice(f[2]), thrice(f[3])};
  const auto line = remainder(by_x, by_y);
  const auto m01 = by_x[0] * by_y[1] - by_x[1] * by_y[0];
  const int resultant = (line[0] * line[0] - m01 * line[1]).sign();
  if (resultant != 0) return {resultant > 0, 1, {}};
  if (!is_zero(line)) return {false, 2, line};
  const FixedInteger<limbs> one(std::int64_t{1});
  return {false, 3, {by_x[0] * one, f[1] * one}};
}

// ---- Guesses -----------------------------------------------------------------------------------

/// Guesses of roots.
struct Guesses {
  std::array<double, 4> t{};
  std::size_t count = 0;

  void add(double guess) {
    if (guess > 0.0 && guess < 1.0 && count < t.size()) t[count++] = guess;
  }
};

/// Roots of b0 (1−t)² + 2 b1 t (1−t) + b2 t², a double root once.
Guesses quadratic_roots(double b0, double b1, double b2) {
  Guesses roots;
  const double square = b1 * b1, discriminant = square - b0 * b2;
  const auto add = [&](double y, double x) { roots.add(y / (x + y)); };
  if (std::abs(discriminant) <= 0x1p-40 * square) {
    add(-b1, b2);
    return roots;
  }
  if (discriminant < 0.0) return roots;
  const double sum = -(b1 + std::copysign(std::sqrt(discriminant), b1));
  add(sum, b2);
  add(b0, sum);
  return roots;
}

Guesses quadratic_roots(const std::array<double, 3>& b) {
  return quadratic_roots(b[0], b[1], b[2]);
}

/// A root of the form with these coefficients that changes its sign between two times.
double guess_root(const std::array<double, 2>& b, double /*lower*/, double /*upper*/) {
  return b[0] / (b[0] - b[1]);
}

double guess_root(const std::array<double, 3>& b, double lower, double upper) {
  const Guesses roots = quadratic_roots(b);
  for (std::size_t i = 0; i < roots.count; ++i) {
    if (roots.t[i] >= lower && roots.t[i] <= upper) return roots.t[i];
  }
  return 0.5 * (lower + upper);
}

double guess_root(const std::array<double, 4>& b, double lower, double upper) {
  const auto value = [&](double t) {
    const double s = 1.0 - t;
    return ((b[0] * s / 3.0 + b[1] * t) * s + b[2] * t * t) * s + b[3] * t * t * t / 3.0;
  };
  const auto slope = [&](double t) {
    const double s = 1.0 - t;
    return ((b[1] - b[0]) * s + 2.0 * (b[2] - b[1]) * t) * s + (b[3] - b[2]) * t * t;
  };
  const double at_lower = value(lower), at_upper = value(upper);
  const bool rises = at_upper > at_lower;
  double t = lower + (upper - lower) * (at_lower / (at_lower - at_upper));
  if (!(t > lower && t < upper)) t = 0.5 * (lower + upper);
  for (int i = 0; i < 40; ++i) {
    const double at = value(t);
    ((at > 0.0) == rises ? upper : lower) = t;
    double next = t - at / slope(t);
    if (!(next > lower && next < upper)) next = 0.5 * (lower + upper);
    // The convergence is quadratic: the next step would be the square of this one.
    if (std::abs(next - t) <= 0x1p-40 * t) return next;
    t = next;
  }
  return t;
}

/// Places for a split: roots of quadratic events, extrema of a cubic one.
Guesses landmarks(const std::array<double, 3>& b) { return quadratic_roots(b); }
Guesses landmarks(const std::array<double, 4>& b) {
  return quadratic_roots(b[1] - b[0], b[2] - b[1], b[3] - b[2]);
}

/// The first convergent of the continued fraction of t that equals t up to rounding, if it has a
/// small denominator.
std::optional<Time> small_fraction(double t) {
  constexpr double largest_denominator = 0x1p12, accuracy = 0x1p-44;
  double numerator = 0.0, denominator = 1.0;            // of this convergent
  double last_numerator = 1.0, last_denominator = 0.0;  // of the previous one
  double rest = t;
  for (;;) {
    if (std::abs(t * denominator - numerator) <= accuracy * denominator) break;
    rest = 1.0 / rest;
    const double whole = std::floor(rest);
    const double next = whole * denominator + last_denominator;
    if (!(next <= largest_denominator)) return std::nullopt;
    last_denominator = std::exchange(denominator, next);
    last_numerator = std::exchange(numerator, whole * numerator + last_numerator);
    rest -= whole;
  }
  if (!(numerator >= 0.0 && numerator <= denominator)) return std::nullopt;
  const auto y = static_cast<std::int64_t>(numerator);
  return Time{static_cast<std::int64_t>(denominator) - y, y};
}

/// The dyadic number of the least exponent between two guesses, if there is one of at most 40 bits.
std::optional<Time> dyadic_between(double lower, double upper) {
  if (!(lower >= 0.0 && lower < upper && upper <= 1.0)) return std::nullopt;
  for (int exponent = 1; exponent <= 40; ++exponent) {
    const double scale = std::ldexp(1.0, exponent);
    const double numerator = std::floor(lower * scale) + 1.0;
    if (numerator < upper * scale) {
      const auto y = static_cast<std::int64_t>(numerator);
      return Time{(std::int64_t{1} << static_cast<unsigned>(exponent)) - y, y};
    }
  }
  return std::nullopt;
}

// ---- The decision ------------------------------------------------------------------------------

enum class Outcome : std::uint8_t {
  none,     ///< no first contact in the interval
  decided,  ///< the answer is known
  unknown   ///< for the general decision
};

/// An event of theorem 2.
template <std::size_t limbs, std::size_t degree>
using Event = FilteredForm<limbs, degree + 1>;

/// A form with the same roots inside (0,1), each simple: a double root of c_0 x² + c_1 x y + c_2 y²
/// is the one of its derivative c_1 x + 2 c_2 y. Empty if no root is real.
template <std::size_t limbs>
std::optional<Fixed<limbs, 2>> simple(const Fixed<limbs, 2>& c) {
  const auto twice = c[2] + c[2];
  const int discriminant = (c[1] * c[1] - (c[0] + c[0]) * twice).sign();
  if (discriminant < 0) return std::nullopt;
  if (discriminant > 0) return c;
  return Fixed<limbs, 2>{c[1], twice, FixedInteger<limbs>(std::int64_t{0})};
}

bool is_inside(const Time& t, const Time& lower, const Time& upper) {
  return compare(lower, t) < 0 && compare(t, upper) < 0;
}

/// A time strictly inside for a split: a root (or extremum) that is a small fraction, or a time
/// between the first landmark and the next, or a time close to the middle.
template <std::size_t limbs, std::size_t count>
std::optional<Time> split(std::span<const FilteredForm<limbs, count>> events, const Time& lower,
                          const Time& upper) {
  constexpr double resolution = 0x1p-30;
  const double low = lower.guess(), high = upper.guess();
  double first = high, second = high;
  for (const auto& event : events) {
    const Guesses marks = landmarks(event.rounded());
    for (std::size_t i = 0; i < marks.count; ++i) {
      const double t = marks.t[i];
      if (!(t > low && t < high)) continue;
      const auto fraction = small_fraction(t);
      if (fraction && event.sign_at(*fraction) == 0 && is_inside(*fraction, lower, upper)) {
        return fraction;
      }
      if (t < first - resolution) second = std::exchange(first, t);
      if (t > first + resolution) second = std::min(second, t);
    }
  }
  auto middle = dyadic_between(first, 0.75 * first + 0.25 * second);
  if (!middle) middle = dyadic_between(0.75 * low + 0.25 * high, 0.25 * low + 0.75 * high);
  if (!middle || !is_inside(*middle, lower, upper)) return std::nullopt;
  return middle;
}

/// The decision for one motion.
template <class Number>
class Decision {
 public:
  Decision(const Motion<Number>& motion, std::uint64_t latest, std::uint64_t step)
      : motion_(motion),
        latest_(latest),
        step_(std::min(step, widest_step)),
        normal_(normal(motion)),
        determinant_(determinant(motion, normal_)) {}

  FixedSizeAnswer run() {
    const Outcome outcome = first();
    return {outcome != Outcome::unknown, impact_};
  }

 private:
  static constexpr std::size_t square_limbs = Square<Number>::limbs,
                               cube_limbs = Cube<Number>::limbs;
  using Quadratic = Fixed<square_limbs, 2>;
  using Filtered = FilteredForm<square_limbs, 3>;
  using Contact = ContactForms<Filtered>;
  using PlaneEvent = Event<square_limbs, 2>;
  using SpaceEvent = Event<cube_limbs, 3>;

  static constexpr int deepest = 12;
  /// The depth of splitting from which roots are treated as clusters.
  static constexpr int deep = 2;
  /// The greatest width of enclosures: in wider ones fewer signs are certain, and (u,v), which are
  /// interpolated, are less accurate.
  static constexpr std::uint64_t widest_step = 1U << 12U;

  Outcome first() {
    if (determinant_.form()[0].sign() == 0) {
      const auto contact =
          contact_by([](const Filtered& form) { return form.coefficient_sign(0); });
      if (contact) return found(*contact, start_time, {bits_of_zero, bits_of_zero});
    }
    const Outcome inner =
        is_zero(determinant_.form())
            ? search_plane()
            : search(std::span<const SpaceEvent>(&determinant_, 1), start_time, end_time, 0);
    return inner == Outcome::none ? at_time(end_time) : inner;
  }

  Outcome search_plane() {
    std::vector<PlaneEvent> events;
    for (const Quadratic& form : events_in_plane(motion_, normal_)) {
      if (const auto event = simple(form)) events.emplace_back(*event);
    }
    return search(std::span<const PlaneEvent>(events), start_time, end_time, 0);
  }

  /// The open interval; there is no contact at its lower end.
  template <class AnyEvent>
  Outcome search(std::span<const AnyEvent> events, const Time& lower, const Time& upper,
                 int depth) {
    int changes = 0;
    const AnyEvent* active = nullptr;
    for (const auto& event : events) {
      const int here = signs_between(event, lower, upper).changes;
      if (here != 0) active = &event;
      changes += here;
    }
    if (changes == 0 || is_separated(lower, upper)) return Outcome::none;
    if (changes == 1) return at_root(*active, lower, upper);
    if (depth >= deep) {
      const auto outcome = in_cluster(events, changes, lower, upper);
      if (outcome) return *outcome;
    }
    const auto middle = split(events, lower, upper);
    if (depth == deepest || !middle) return Outcome::unknown;
    Outcome outcome = search(events, lower, *middle, depth + 1);
    if (outcome == Outcome::none) outcome = at_time(*middle);
    if (outcome == Outcome::none) outcome = search(events, *middle, upper, depth + 1);
    return outcome;
  }

  /// The case in which the determinant has only a multiple root in the open interval, or none.
  std::optional<Outcome> in_cluster(std::span<const SpaceEvent> events, int changes,
                                    const Time& lower, const Time& upper) {
    const auto roots = cubic_roots(events[0].form());
    if (roots.is_one && changes % 2 == 0) return Outcome::none;
    if (changes != roots.multiplicity ||
        !changes_sign(FilteredForm(roots.multiple), lower, upper)) {
      return std::nullopt;
    }
    return at_root(Event<2 * cube_limbs, 1>(roots.multiple), lower, upper);
  }

  /// The case in which every event has at most one root in the open interval: the roots in
  /// ascending order.
  std::optional<Outcome> in_cluster(std::span<const PlaneEvent> events, int /*changes*/,
                                    const Time& lower, const Time& upper) {
    std::vector<const PlaneEvent*> active;
    for (const PlaneEvent& event : events) {
      const int changes = signs_between(event, lower, upper).changes;
      if (changes > 1) return std::nullopt;
      if (changes == 1) active.push_back(&event);
    }
    // The root of f is before that of g iff g has its initial sign there.
    std::ranges::sort(active, [&](const PlaneEvent* f, const PlaneEvent* g) {
      return sign_at_root(f->form(), g->form(), lower, upper) ==
             signs_between(*g, lower, upper).first;
    });
    for (const PlaneEvent* event : active) {
      const Outcome outcome = at_root(*event, lower, upper);
      if (outcome != Outcome::none) return outcome;
    }
    return Outcome::none;
  }

  /// Component k of N.
  const Filtered& n_at(std::size_t k) {
    if (!n_[k]) n_[k].emplace(normal_[k]);
    return *n_[k];
  }

  /// Component k of N and of the bounds.
  const Bounds<Filtered>& bounds_at(std::size_t k) {
    if (bounds_[k].count == 0) {
      const auto in = bounds(motion_, normal_[k], k);
      bounds_[k] = {n_at(k), {}, in.count};
      for (std::size_t i = 0; i < in.count; ++i) bounds_[k].bound[i] = Filtered(in.bound[i]);
    }
    return bounds_[k];
  }

  /// True if N_k and a bound keep opposite signs in the open interval.
  bool is_separated(const Time& lower, const Time& upper) {
    for (const std::size_t k : axes_at(0.5 * (lower.guess() + upper.guess()))) {
      const IntervalSigns on_normal = signs_between(n_at(k), lower, upper);
      if (on_normal.first == 0 || on_normal.changes != 0) continue;
      const auto& in = bounds_at(k);
      for (std::size_t i = 0; i < in.count; ++i) {
        const IntervalSigns on_bound = signs_between(in.bound[i], lower, upper);
        if (on_bound.first == -on_normal.first && on_bound.changes == 0) return true;
      }
      return false;
    }
    return false;
  }

  /// Theorem 1 at a time with D = 0; k is the first of `axes` with N_k ≠ 0.
  template <class SignOf>
  std::optional<Contact> contact_by(const SignOf& sign_of,
                                    const std::array<std::size_t, 3>& axes = {0, 1, 2}) {
    for (const std::size_t k : axes) {
      const int orientation = sign_of(n_at(k));
      if (orientation == 0) continue;
      const auto& in = bounds_at(k);
      if (!is_in_bounds(in, orientation, sign_of)) return std::nullopt;
      return Contact{in.bound[0], in.bound[1], in.n};
    }
    const auto contact =
        contact_on_line(motion_, [&](const Quadratic& form) { return sign_of(Filtered(form)); });
    if (!contact) return std::nullopt;
    return Contact{Filtered(contact->u), Filtered(contact->v), Filtered(contact->denominator)};
  }

  /// Decides at a time > 0 that is known exactly.
  Outcome at_time(const Time& t) {
    if (determinant_.sign_at(t) != 0) return Outcome::none;
    if (is_later(t, latest_)) return Outcome::decided;
    const auto contact = contact_by([&](const Filtered& form) { return form.sign_at(t); });
    if (!contact) return Outcome::none;
    const auto is_above = [&](std::uint64_t bits) { return is_later(t, bits); };
    return found(*contact, t, enclose(t.guess(), step_, is_above));
  }

  /// Decides at the only root of any event in the open interval, a simple root of this event.
  template <class AnyEvent>
  Outcome at_root(const AnyEvent& event, const Time& lower, const Time& upper) {
    const double root = guess_root(event.rounded(), lower.guess(), upper.guess());
    const auto fraction = small_fraction(root);
    if (fraction && is_inside(*fraction, lower, upper) && event.sign_at(*fraction) == 0) {
      return at_time(*fraction);
    }
    return at_irrational<Time>(event, root, lower, upper);
  }

  /// The same for a root that may be irrational, with doubles as times of a type.
  template <class AnyTime, class AnyEvent>
  Outcome at_irrational(const AnyEvent& event, double root, const Time& lower, const Time& upper) {
    const int sign_below = signs_between(event, lower, upper).first;
    bool beyond = false;
    const auto is_above = [&](std::uint64_t bits) {
      const auto t = time_of<AnyTime>(bits);
      if (!t) beyond = true;
      if (!t || compare(*t, lower) <= 0) return true;
      return compare(*t, upper) < 0 && event.sign_at(*t) == sign_below;
    };
    const BitInterval cell = enclose(root, step_, is_above);
    const bool too_late = latest_ <= cell.lower || (latest_ < cell.upper && is_above(latest_));
    const auto first = time_of<AnyTime>(cell.lower), last = time_of<AnyTime>(cell.upper);
    if (beyond || !first || !last) {
      if constexpr (std::is_same_v<AnyTime, FineTime>) return Outcome::unknown;
      return at_irrational<FineTime>(event, root, lower, upper);
    }
    if (too_late) return Outcome::decided;
    // The cell may reach beyond the interval, where other roots may be; there may be one at
    // `upper`.
    const AnyTime low = compare(*first, lower) < 0 ? as<AnyTime>(lower) : *first;
    const bool is_within = compare(*last, upper) < 0;
    const AnyTime high = is_within ? *last : as<AnyTime>(upper);
    const bool is_high = is_within && event.sign_at(high) == 0;
    const Outcome outcome = in_cell(event, cell, low, high, is_high);
    if constexpr (std::is_same_v<AnyTime, Time>) {
      if (outcome == Outcome::unknown) return in_narrow_cell(event, cell, low, high);
    }
    return outcome;
  }

  /// Decides at a root of this event in a cell of doubles: the only root of any event strictly
  /// between `low` and `high`, or `high` itself.
  template <class AnyTime, class AnyEvent>
  Outcome in_cell(const AnyEvent& event, const BitInterval& cell, const AnyTime& low,
                  const AnyTime& high, bool is_high) {
    // The secant is about one digit more accurate than this.
    constexpr double variation = 0x1p-41;
    bool unsure = false;
    const auto sign_of = [&](const Filtered& form) {
      if (is_high) return form.sign_at(high);
      const IntervalSigns here = signs_between(form, low, high);
      if (here.changes == 0) return here.first;
      const auto sign = sign_at_root(event.form(), form.form(), low, high);
      if (!sign) unsure = true;
      return sign.value_or(0);
    };
    const auto contact = contact_by(sign_of, axes_at(high.guess()));
    if (unsure) return Outcome::unknown;
    if (!contact) return Outcome::none;
    const auto [first_u, first_v] = parameters(*contact, is_high ? high : low);
    const auto [last_u, last_v] = parameters(*contact, high);
    if (!(std::abs(first_u - last_u) + std::abs(first_v - last_v) <= variation)) {
      return Outcome::unknown;
    }
    const auto value = [&](const AnyTime& t) {
      return divided(event.rounded_value_at(t).value, t, event.degree);
    };
    const double part = is_high ? 1.0 : secant(value(low), value(high));
    impact_ =
        impact_at(cell, first_u + part * (last_u - first_u), first_v + part * (last_v - first_v));
    return Outcome::decided;
  }

  /// The part of the interval before its form's root, guessed by a secant through these values.
  static double secant(double at_low, double at_high) {
    const double part = at_low / (at_low - at_high);
    return part >= 0.0 && part <= 1.0 ? part : 0.5;
  }

  /// value / sum^power
  template <class AnyTime>
  static double divided(double value, const AnyTime& t, std::size_t power) {
    for (std::size_t i = 0; i < power; ++i) value /= static_cast<double>(t.sum());
    return value;
  }

  /// The same between two times closer to the root, guessed by a secant; repeated once if
  /// necessary.
  template <class AnyTime, class AnyEvent>
  Outcome in_narrow_cell(const AnyEvent& event, const BitInterval& cell, const AnyTime& low,
                         const AnyTime& high) {
    constexpr bool again = std::is_same_v<AnyTime, Time>;
    constexpr std::int64_t whole = std::int64_t{1} << (again ? 36U : 26U), slack = 4;
    // Weights are interpolated below instead of times, which saves a division.
    const auto value = [&](const AnyTime& t) {
      return divided(event.value_at(t).rounded(), t, event.degree - 1);
    };
    const auto weight =
        static_cast<std::int64_t>(secant(value(low), value(high)) * static_cast<double>(whole));
    const auto mixed = [&](std::int64_t of_high) {
      const auto mix = [&](SignedWideLimb a, SignedWideLimb b) {
        return a * (whole - of_high) + b * of_high;
      };
      return FineTime{mix(low.x, high.x), mix(low.y, high.y)};
    };
    const FineTime first = mixed(std::max(weight - slack, std::int64_t{0}));
    const FineTime last = mixed(std::min(weight + slack, whole));
    if (!changes_sign(event, first, last)) return Outcome::unknown;
    const Outcome outcome = in_cell(event, cell, first, last, false);
    if constexpr (again) {
      if (outcome == Outcome::unknown) return in_narrow_cell(event, cell, first, last);
    }
    return outcome;
  }

  /// The axes, beginning with the one of the normal's greatest component, on which the projection
  /// is best conditioned and (u,v) vary least.
  std::array<std::size_t, 3> axes_at(double t) {
    const auto& unit = motion_.unit;
    const int greatest = std::max({unit[0], unit[1], unit[2]});
    std::array<double, 3> weight{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::array<double, 3>& b = n_at(k).rounded();
      const double s = 1.0 - t, value = (b[0] * s + 2.0 * b[1] * t) * s + b[2] * t * t;
      const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
      weight[k] = std::ldexp(std::abs(value), (unit[i] - greatest) + (unit[j] - greatest));
    }
    std::array<std::size_t, 3> axes{0, 1, 2};
    std::ranges::sort(axes, std::greater{}, [&](std::size_t k) { return weight[k]; });
    return axes;
  }

  Outcome found(const Contact& contact, const Time& t, const BitInterval& cell) {
    const auto [u, v] = parameters(contact, t);
    impact_ = impact_at(cell, std::isnan(u) ? 0.0 : u, std::isnan(v) ? 0.0 : v);
    return Outcome::decided;
  }

  template <class AnyTime>
  static std::array<double, 2> parameters(const Contact& contact, const AnyTime& t) {
    const auto value = [&](const Filtered& form) {
      const RoundedBlossom rounded = form.rounded_value_at(t);
      return rounded.is_near() ? rounded.value : form.value_at(t).rounded();
    };
    if (contact.denominator.is_zero()) return {0.0, 0.0};
    const double denominator = value(contact.denominator);
    return {value(contact.u) / denominator, value(contact.v) / denominator};
  }

  const Motion<Number>& motion_;
  std::uint64_t latest_;
  std::uint64_t step_;
  MovingNormal<Number> normal_;
  SpaceEvent determinant_;
  std::array<std::optional<Filtered>, 3> n_;  ///< the computed components: see n_at
  std::array<Bounds<Filtered>, 3> bounds_{};  ///< the bounds of these components: see bounds_at
  std::optional<ExactImpact> impact_;
};

}  // namespace

FixedSizeAnswer fixed_size_first_impact(const Motion<FixedInteger<1>>& motion, std::uint64_t latest,
                                        std::uint64_t step) {
  return Decision<FixedInteger<1>>(motion, latest, step).run();
}

FixedSizeAnswer fixed_size_first_impact(const Motion<FixedInteger<2>>& motion, std::uint64_t latest,
                                        std::uint64_t step) {
  return Decision<FixedInteger<2>>(motion, latest, step).run();
}

}  // namespace touchstone::fast::exact_stage
