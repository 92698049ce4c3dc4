#include "exact/certificate/separation_intervals.hpp"

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>

#include "exact/algebra/positivity.hpp"
#include "exact/distance/separating_axes.hpp"

namespace touchstone::exact {
namespace {

/// The number of levels that are left at the deepest place of a subinterval after it was divided
/// for the limit.
constexpr unsigned long depth_left = 100;
static_assert(depth_left + 2 <= bisection_limit);

/// A depth at which no break point within the limit can help.
constexpr unsigned long greatest_depth = number_limit + depth_left;

/// The form on [0,until] as one on [0,1], times the denominator of `until` to the power of its
/// degree: whole (1−t) = whole (1−y) + (whole−end) y and whole t = end y, by Horner's rule in t.
template <AnyForm F>
F restricted(F form, const Rational& until) {
  const Integer &end = until.get_num(), &whole = until.get_den();
  const Integer rest = whole - end;
  const std::size_t degree = form.c.size() - 1;
  std::vector<Integer> sum{form.c[degree]};
  std::vector<Integer> power{Integer(1)};  // of whole (1−t)
  for (std::size_t k = degree; k-- > 0;) {
    power.emplace_back(0);
    for (std::size_t i = power.size() - 1; i > 0; --i) {
      power[i] = power[i] * whole + power[i - 1] * rest;
    }
    power[0] *= whole;
    sum.emplace_back(0);
    for (std::size_t i = sum.size() - 1; i > 0; --i) {
      sum[i] = sum[i - 1] * end + form.c[k] * power[i];
    }
    sum[0] = form.c[k] * power[0];
  }
  std::ranges::move(sum, form.c.begin());
  return form;
}

/// The motion on [0,until] as one on [0,1], in other units.
template <class Order>
MotionOf<Order> restricted(const MotionOf<Order>& motion, const Rational& until) {
  MotionOf<Order> result = motion;
  if (until == 1) return result;
  for (std::size_t i = 0; i < motion.corner_count; ++i) {
    for (auto& x : result.corners[i]) x = restricted(std::move(x), until);
  }
  if constexpr (std::same_as<Order, Curved>) {
    result.denominator.value = restricted(std::move(result.denominator.value), until);
  } else {
    result.distance *= until.get_den();  // 1 stays 1 times the denominator of `until`
  }
  return result;
}

// ---- One subinterval ----------------------------------------------------------------------------------

/// A separator that holds at all times of the motion and that a checker can verify.
std::optional<Feature> single_feature(const std::vector<Separator>& separators) {
  for (const Separator& separator : separators) {
    bool holds = true;
    for (std::size_t n = 0; n < separator.size() && holds; ++n) {
      const auto proof = prove_positive(bernstein_coefficients(separator.form(n)));
      holds = proof.outcome == BisectionProof::Outcome::positive;
    }
    if (holds) return separator.feature();
  }
  return std::nullopt;
}

// ---- Many subintervals --------------------------------------------------------------------------------
// Here time is the fraction y of [0,until].

/// The span of the separator that holds longest. \pre one holds
Span span_at(std::vector<Separator>& separators, const AlgebraicNumber& y) {
  std::optional<Span> span = farthest(separators, y);
  if (!span) throw std::logic_error("touchstone: no separation where there should be no contact");
  return std::move(*span);
}

/// The dyadic number of fewest bits strictly between two numbers.
Rational shortest_between(const Rational& lower, const Rational& upper) {
  for (unsigned long level = 0;; ++level) {
    const Rational scaled = lower * power_of_two(static_cast<long>(level));
    Integer above;
    mpz_fdiv_q(above.get_mpz_t(), scaled.get_num_mpz_t(), scaled.get_den_mpz_t());
    ++above;
    Rational result = Rational(above) * power_of_two(-static_cast<long>(level));
    if (result < upper) return result;
  }
}

/// A time of few bits between two fractions of [0,until]. \pre lower < upper, until > 0
Rational break_between(AlgebraicNumber lower, AlgebraicNumber upper, const Rational& until) {
  for (unsigned long level = 8; level <= 2 * number_limit; level *= 2) {
    const RationalInterval below = lower.interval(), above = upper.interval();
    const Rational gap = above.lower - below.upper;
    // A part of the gap that is large enough for its shortest number to be nearly the shortest of
    // the gap.
    if (sgn(gap) > 0 && 2 * gap >= above.upper - below.lower) {
      return shortest_between(until * below.upper, until * above.lower);
    }
    lower.refine_to_level(level);
    upper.refine_to_level(level);
  }
  throw CertificateLimitError("a break point between two features needs too many bits");
}

/// A subinterval with the times of its ends.
struct LongSubinterval {
  Rational from;
  Rational to;
  Separator* separator;
};

/// The fewest subintervals, without regard to the checker's limit.
std::vector<LongSubinterval> fewest_subintervals(std::vector<Separator>& separators,
                                                 const Rational& until) {
  std::vector<LongSubinterval> subintervals;
  Rational from = 0;
  Span span = span_at(separators, AlgebraicNumber(0));
  while (span.end) {
    Span next = span_at(separators, *span.end);
    AlgebraicNumber earliest(Rational(from / until));
    const auto begin = next.separator->begin_before(*span.end);
    if (begin && earliest < *begin) earliest = *begin;
    Rational to = break_between(std::move(earliest), *span.end, until);
    subintervals.push_back({from, to, span.separator});
    from = std::move(to);
    span = std::move(next);
  }
  subintervals.push_back({from, until, span.separator});
  return subintervals;
}

/// The deepest place of all proofs that a subinterval needs; empty if it is within the checker's
/// limit.
std::optional<BisectionProof> beyond_checker(const LongSubinterval& subinterval,
                                             const Rational& until) {
  const RationalInterval fractions{subinterval.from / until, subinterval.to / until};
  std::optional<BisectionProof> deepest;
  for (std::size_t n = 0; n < subinterval.separator->size(); ++n) {
    const auto bernstein = bernstein_coefficients(subinterval.separator->polynomial(n), fractions);
    BisectionProof proof = prove_positive(bernstein, greatest_depth);
    if (proof.outcome != BisectionProof::Outcome::positive) {
      throw CertificateLimitError("a separation is too near to a contact for the limits");
    }
    if (proof.depth > bisection_limit && (!deepest || proof.depth > deepest->depth)) {
      deepest = std::move(proof);
    }
  }
  return deepest;
}

/// Appends the subinterval in parts that a checker can verify. The neighbourhood of the deepest
/// place is one part, whose proof needs at most depth_left + 2 levels.
void append_visible(const LongSubinterval& whole, const Rational& until,
                    std::vector<Subinterval>& subintervals) {
  std::vector<LongSubinterval> rest{whole};
  while (!rest.empty()) {
    const LongSubinterval subinterval = std::move(rest.back());
    rest.pop_back();
    const auto deepest = beyond_checker(subinterval, until);
    if (!deepest) {
      subintervals.push_back({subinterval.from, subinterval.to, subinterval.separator->feature()});
      continue;
    }
    const unsigned long level = deepest->depth - depth_left;
    const Integer middle = deepest->index >> depth_left;
    const Rational part =
        (subinterval.to - subinterval.from) * power_of_two(-static_cast<long>(level));
    const Rational lower =
        std::max(subinterval.from, Rational(subinterval.from + part * (middle - 1)));
    const Rational upper =
        std::min(subinterval.to, Rational(subinterval.from + part * (middle + 2)));
    // The stack must yield the first part first.
    if (upper < subinterval.to) rest.push_back({upper, subinterval.to, subinterval.separator});
    rest.push_back({lower, upper, subinterval.separator});
    if (subinterval.from < lower) rest.push_back({subinterval.from, lower, subinterval.separator});
  }
}

/// The fewest subintervals of these separators that a checker can verify.
std::vector<Subinterval> cover(std::vector<Separator> separators, const Rational& until) {
  if (const auto feature = single_feature(separators)) return {{Rational(0), until, *feature}};
  std::vector<Subinterval> subintervals;
  for (const LongSubinterval& subinterval : fewest_subintervals(separators, until)) {
    append_visible(subinterval, until, subintervals);
  }
  const auto too_long = [](const Subinterval& subinterval) {
    return !is_within_limit(subinterval.to);
  };
  if (std::ranges::any_of(subintervals, too_long)) {
    throw CertificateLimitError("a break point has too many bits");
  }
  return subintervals;
}

}  // namespace

bool is_within_limit(const Rational& number) {
  return mpz_sizeinbase(number.get_num_mpz_t(), 2) <= number_limit &&
         mpz_sizeinbase(number.get_den_mpz_t(), 2) <= number_limit;
}

template <class Order>
std::vector<Subinterval> separate(const MotionOf<Order>& motion, const Rational& until) {
  return cover(separators(restricted(motion, until)), until);
}

template <class Order>
std::vector<Subinterval> keep_volume(const MotionOf<Order>& motion, const Rational& until) {
  const auto volume = -determinant(restricted(motion, until));
  return cover({{{.sort = Feature::Sort::negative_face}, {{{volume.c.begin(), volume.c.end()}}}}},
               until);
}

template std::vector<Subinterval> separate(const MotionOf<Straight>&, const Rational&);
template std::vector<Subinterval> separate(const MotionOf<Curved>&, const Rational&);
template std::vector<Subinterval> keep_volume(const MotionOf<Straight>&, const Rational&);
template std::vector<Subinterval> keep_volume(const MotionOf<Curved>&, const Rational&);

}  // namespace touchstone::exact
