#include "exact/separation.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <optional>
#include <utility>

#include "exact/positivity.hpp"

namespace touchstone::exact {
namespace {

/// A piece that needs more depth than the limit is broken around its deepest place so that this
/// many levels are left there.
constexpr unsigned long depth_left = 100;
static_assert(depth_left + 2 <= bisection_limit);

/// Deeper than any break point within the limit can help.
constexpr unsigned long greatest_depth = number_limit + depth_left;

// ---- Scaling ------------------------------------------------------------------------------------

/// The exponent of the last nonzero bit of a finite double; 0 is no such number.
int last_exponent(double x) {
  static constexpr int fraction_bits = 52, exponent_bias = 1075, exponent_mask = 0x7FF;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const int field = static_cast<int>(bits >> fraction_bits) & exponent_mask;
  std::uint64_t significand = bits & ((std::uint64_t{1} << fraction_bits) - 1);
  if (field != 0) significand |= std::uint64_t{1} << fraction_bits;
  return std::max(field, 1) - exponent_bias + std::countr_zero(significand);
}

/// The exponent of the power of two that one unit of an axis of the motion is; empty if all
/// coordinates are zero.
std::optional<int> unit_exponent(const Query& query, const Motion& motion, std::size_t axis) {
  for (std::size_t end = 0; end < 2; ++end) {
    for (std::size_t point = 0; point < moving_points; ++point) {
      const Integer& scaled = motion.points[point][axis].c[end];
      if (sgn(scaled) == 0) continue;
      const auto zeros = static_cast<int>(mpz_scan1(scaled.get_mpz_t(), 0));
      return last_exponent(query.at(end, point, axis)) - zeros;
    }
  }
  return std::nullopt;
}

void shift_axis(Motion& motion, std::size_t axis, unsigned long bits) {
  const auto shift = [&](Motion::Point& point) {
    for (Integer& x : point[axis].c) x <<= bits;
  };
  std::ranges::for_each(motion.points, shift);
  std::ranges::for_each(motion.corners, shift);
}

// ---- Features and their values ------------------------------------------------------------------

bool is_positive(const Integer& x) { return sgn(x) > 0; }

/// d·w_i for the features' directions d, as forms; products of corners are made when first needed.
class Values {
 public:
  explicit Values(const Motion& motion) : motion_(motion) {}

  /// All features, the cheaper ones first.
  [[nodiscard]] std::vector<Feature> features() const {
    using Sort = Feature::Sort;
    std::vector<Feature> result{{.sort = Sort::positive_face}, {.sort = Sort::negative_face}};
    for (std::size_t i = 0; i < corners(); ++i) result.push_back({.sort = Sort::vertex, .i = i});
    for (std::size_t i = 0; i < corners(); ++i) {
      result.push_back({.sort = Sort::edge, .i = i, .j = (i + 1) % corners()});
    }
    return result;
  }

  /// Does it hold for the feature's values at all corners? Values that agree are asked once, and
  /// none after the first for which it does not hold.
  template <class Predicate>
  bool every(const Feature& feature, Predicate holds) {
    switch (feature.sort) {
      case Feature::Sort::vertex:
        return every_of_vertex(feature.i, holds);
      case Feature::Sort::edge:
        return every_of_edge(feature.i, feature.j, holds);
      case Feature::Sort::positive_face:
        return holds(face());
      default:
        return holds(-face());
    }
  }

 private:
  [[nodiscard]] std::size_t corners() const { return motion_.corner_count; }

  /// w_i · w_j.
  const Form<2>& product(std::size_t i, std::size_t j) {
    auto& form = products_.at(std::min(i, j)).at(std::max(i, j));
    if (!form) form = dot(motion_, i, j);
    return *form;
  }

  /// N·w_i, the same for all corners of the polygon.
  const Form<3>& face() {
    if (!face_) face_ = determinant(motion_);
    return *face_;
  }

  template <class Predicate>
  bool every_of_vertex(std::size_t i, Predicate holds) {
    for (std::size_t k = 0; k < corners(); ++k) {
      if (!holds(product(i, k))) return false;
    }
    return true;
  }

  /// The value is the same at both ends of the edge.
  template <class Predicate>
  bool every_of_edge(std::size_t i, std::size_t j, Predicate holds) {
    const Form<2> from = product(i, j) - product(i, i);           // w_i·e
    const Form<2> length = product(j, j) - product(i, j) - from;  // |e|²
    for (std::size_t k = 0; k < corners(); ++k) {
      if (k == j) continue;
      Form<4> value = length * product(i, k);
      subtract_product(value, from, product(j, k) - product(i, k));
      if (!holds(value)) return false;
    }
    return true;
  }

  const Motion& motion_;
  std::array<std::array<std::optional<Form<2>>, 4>, 4> products_;
  std::optional<Form<3>> face_;
};

/// The motion on [0,until] as one on [0,1], in other units.
Motion restricted(const Motion& motion, const Rational& until) {
  Motion result = motion;
  if (until == 1) return result;
  const Integer& end = until.get_num();
  const Integer& whole = until.get_den();
  const Integer rest = whole - end;
  for (std::size_t i = 0; i < motion.corner_count; ++i) {
    for (Form<1>& x : result.corners[i]) {
      x.c[1] = x.c[0] * rest + x.c[1] * end;
      x.c[0] *= whole;
    }
  }
  return result;
}

// ---- One piece ----------------------------------------------------------------------------------

/// A feature that separates at all times of the motion, and for which a checker can see it.
std::optional<Feature> single_feature(Values& values) {
  const std::vector<Feature> features = values.features();
  const auto find = [&](auto holds) -> std::optional<Feature> {
    const auto found =
        std::ranges::find_if(features, [&](const Feature& f) { return values.every(f, holds); });
    return found == features.end() ? std::nullopt : std::optional(*found);
  };
  const auto plain =
      find([](const auto& form) { return std::ranges::all_of(form.c, is_positive); });
  if (plain) return plain;
  return find([](const auto& form) {
    const auto bernstein = bernstein_coefficients({form.c.begin(), form.c.end()});
    return prove_positive(bernstein).outcome == BisectionProof::Outcome::positive;
  });
}

// ---- Many pieces --------------------------------------------------------------------------------
// Here time is the fraction y of [0,until].

/// A feature that separates at some times, with its values as polynomials, and the times where one
/// is zero, found when first needed. Values whose forms are positive throughout are left out.
class Candidate {
 public:
  Candidate(const Feature& feature, std::vector<Polynomial> values)
      : feature_(feature), values_(std::move(values)) {}

  [[nodiscard]] const Feature& feature() const { return feature_; }
  [[nodiscard]] const std::vector<Polynomial>& values() const { return values_; }

  /// Does it separate at this time?
  [[nodiscard]] bool holds_at(AlgebraicNumber& y) const {
    return std::ranges::all_of(values_, [&](const Polynomial& p) { return y.sign_of(p) > 0; });
  }

  const std::vector<AlgebraicNumber>& roots() {
    if (!roots_) {
      roots_.emplace();
      for (const Polynomial& p : values_) {
        auto roots = roots_in_unit_interval(p);
        std::ranges::move(roots, std::back_inserter(*roots_));
      }
    }
    return *roots_;
  }

 private:
  Feature feature_;
  std::vector<Polynomial> values_;
  std::optional<std::vector<AlgebraicNumber>> roots_;
};

std::vector<Candidate> find_candidates(Values& values) {
  std::vector<Candidate> result;
  for (const Feature& feature : values.features()) {
    std::vector<Polynomial> polynomials;
    const bool possible = values.every(feature, [&](const auto& form) {
      if (std::ranges::none_of(form.c, is_positive)) return false;
      if (!std::ranges::all_of(form.c, is_positive)) polynomials.push_back(to_polynomial(form));
      return true;
    });
    if (possible) result.emplace_back(feature, std::move(polynomials));
  }
  return result;
}

/// The times around a given one at which a candidate separates: the open interval between two roots,
/// or from or to the end of all times.
struct Span {
  const Candidate* candidate = nullptr;
  std::optional<AlgebraicNumber> begin;
  std::optional<AlgebraicNumber> end;
};

Span span_around(Candidate& candidate, const AlgebraicNumber& y) {
  Span span{.candidate = &candidate, .begin = {}, .end = {}};
  for (const AlgebraicNumber& root : candidate.roots()) {
    if (root < y) {
      if (!span.begin || *span.begin < root) span.begin = root;
    } else if (!span.end || root < *span.end) {
      span.end = root;
    }
  }
  return span;
}

/// Of the candidates that separate at a time the one that does so longest.
Span farthest(std::vector<Candidate>& candidates, AlgebraicNumber y) {
  std::optional<Span> best;
  for (Candidate& candidate : candidates) {
    if (!candidate.holds_at(y)) continue;
    Span span = span_around(candidate, y);
    if (!best || (best->end && (!span.end || *best->end < *span.end))) best = std::move(span);
    if (!best->end) break;
  }
  if (!best) throw std::logic_error("touchstone: no separation where nothing was to touch");
  return std::move(*best);
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
    // Enough of the gap for its shortest number to be as short as any, or nearly.
    if (sgn(gap) > 0 && 2 * gap >= above.upper - below.lower) {
      return shortest_between(until * below.upper, until * above.lower);
    }
    lower.refine_to_level(level);
    upper.refine_to_level(level);
  }
  throw CertificateLimitError("a break point between two features needs too many bits");
}

/// A piece by the times of its ends.
struct LongPiece {
  Rational from;
  Rational to;
  const Candidate* candidate;
};

/// The fewest pieces, as if a checker could see everything.
std::vector<LongPiece> fewest_pieces(std::vector<Candidate>& candidates, const Rational& until) {
  std::vector<LongPiece> pieces;
  Rational from = 0;
  Span span = farthest(candidates, AlgebraicNumber(0));
  while (span.end) {
    Span next = farthest(candidates, *span.end);
    AlgebraicNumber earliest(Rational(from / until));
    if (next.begin && earliest < *next.begin) earliest = *next.begin;
    Rational to = break_between(std::move(earliest), *span.end, until);
    pieces.push_back({from, to, span.candidate});
    from = std::move(to);
    span = std::move(next);
  }
  pieces.push_back({from, until, span.candidate});
  return pieces;
}

/// The deepest place of all proofs that a piece is one; empty if a checker reaches it.
std::optional<BisectionProof> beyond_checker(const LongPiece& piece, const Rational& until) {
  const RationalInterval fractions{piece.from / until, piece.to / until};
  std::optional<BisectionProof> deepest;
  for (const Polynomial& p : piece.candidate->values()) {
    BisectionProof proof = prove_positive(bernstein_coefficients(p, fractions), greatest_depth);
    if (proof.outcome != BisectionProof::Outcome::positive) {
      throw CertificateLimitError("a separation is too near to a contact for the limits");
    }
    if (proof.depth > bisection_limit && (!deepest || proof.depth > deepest->depth)) {
      deepest = std::move(proof);
    }
  }
  return deepest;
}

/// The piece in parts that a checker can see, appended: the surroundings of the deepest place are
/// one, and there its proof has depth_left levels less than two to go.
void append_visible(const LongPiece& whole, const Rational& until, std::vector<Piece>& pieces) {
  std::vector<LongPiece> rest{whole};
  while (!rest.empty()) {
    const LongPiece piece = std::move(rest.back());
    rest.pop_back();
    const auto deepest = beyond_checker(piece, until);
    if (!deepest) {
      pieces.push_back({piece.from, piece.to, piece.candidate->feature()});
      continue;
    }
    const unsigned long level = deepest->depth - depth_left;
    const Integer middle = deepest->index >> depth_left;
    const Rational part = (piece.to - piece.from) * power_of_two(-static_cast<long>(level));
    const Rational lower = std::max(piece.from, Rational(piece.from + part * (middle - 1)));
    const Rational upper = std::min(piece.to, Rational(piece.from + part * (middle + 2)));
    // The first part is to be taken first.
    if (upper < piece.to) rest.push_back({upper, piece.to, piece.candidate});
    rest.push_back({lower, upper, piece.candidate});
    if (piece.from < lower) rest.push_back({piece.from, lower, piece.candidate});
  }
}

}  // namespace

bool is_within_limit(const Rational& number) {
  return mpz_sizeinbase(number.get_num_mpz_t(), 2) <= number_limit &&
         mpz_sizeinbase(number.get_den_mpz_t(), 2) <= number_limit;
}

Motion scale_uniformly(Kind kind, const Query& query) {
  Motion motion = scale_to_integers(kind, query);
  std::array<std::optional<int>, 3> units;
  int least = std::numeric_limits<int>::max();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    units.at(axis) = unit_exponent(query, motion, axis);
    if (units.at(axis)) least = std::min(least, *units.at(axis));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int shift = units.at(axis).value_or(least) - least;
    if (shift != 0) shift_axis(motion, axis, static_cast<unsigned long>(shift));
  }
  return motion;
}

std::vector<Piece> separate(const Motion& motion, const Rational& until) {
  const Motion until_then = restricted(motion, until);
  Values values(until_then);
  if (const auto feature = single_feature(values)) return {{Rational(0), until, *feature}};
  std::vector<Piece> pieces;
  std::vector<Candidate> candidates = find_candidates(values);
  for (const LongPiece& piece : fewest_pieces(candidates, until)) {
    append_visible(piece, until, pieces);
  }
  const auto too_long = [](const Piece& piece) { return !is_within_limit(piece.to); };
  if (std::ranges::any_of(pieces, too_long)) {
    throw CertificateLimitError("a break point has too many bits");
  }
  return pieces;
}

}  // namespace touchstone::exact
