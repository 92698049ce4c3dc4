#include "touchstone/certificate.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "exact/algebra/positivity.hpp"
#include "exact/certificate/separation_intervals.hpp"
#include "exact/contact/contact_conditions.hpp"
#include "exact/contact/corner_motion.hpp"
#include "touchstone/algebraic_number.hpp"

namespace touchstone::exact {
namespace {

// ---- Times --------------------------------------------------------------------------------------

/// The same number, represented as rational if it is. It is then a multiple of 1/l, where l is the
/// leading coefficient of a polynomial of which it is a root.
AlgebraicNumber recognised(const AlgebraicNumber& number) {
  if (number.rational()) return number;
  AlgebraicNumber near = number;
  const Integer& leading = near.polynomial().leading();
  near.refine_to_level(static_cast<unsigned long>(mpz_sizeinbase(leading.get_mpz_t(), 2)) + 1);
  // An interval shorter than the distance of the multiples contains at most one.
  const auto [lower, upper] = near.interval();
  if (near.rational()) return near;
  const Rational scaled = upper * abs(leading);
  Integer multiple;
  mpz_fdiv_q(multiple.get_mpz_t(), scaled.get_num_mpz_t(), scaled.get_den_mpz_t());
  Rational value(multiple, abs(leading));
  value.canonicalize();
  const bool is_the_root = lower < value && value < upper && sign_at(near.polynomial(), value) == 0;
  return is_the_root ? AlgebraicNumber(value) : near;
}

constexpr long significand_bits = 53;
constexpr long least_unit = -1074;

/// The exponent of the last bit of doubles of the size of x > 0.
long double_unit(const Rational& x) {
  const auto bits = [](const Integer& n) {
    return static_cast<long>(mpz_sizeinbase(n.get_mpz_t(), 2));
  };
  long exponent = bits(x.get_num()) - bits(x.get_den());  // 2^(exponent−1) < x < 2^(exponent+1)
  if (x >= power_of_two(exponent)) ++exponent;
  return std::max(exponent - significand_bits, least_unit);
}

/// A double as a whole number of units 2^unit.
struct Double {
  Integer units;
  long unit;

  [[nodiscard]] Rational value() const { return Rational(units) * power_of_two(unit); }
  [[nodiscard]] Rational next() const { return Rational(units + 1) * power_of_two(unit); }
  /// \pre not zero.
  [[nodiscard]] Rational previous() const {
    const Integer least = Integer(1) << static_cast<unsigned long>(significand_bits - 1);
    if (units > least || unit == least_unit) return Rational(units - 1) * power_of_two(unit);
    return Rational(2 * units - 1) * power_of_two(unit - 1);
  }
};

/// The greatest double that is not above x ≥ 0. Computed in integers, because a floating-point
/// environment may flush subnormals to zero.
Double double_below(const Rational& x) {
  const long unit = sgn(x) == 0 ? least_unit : double_unit(x);
  const Rational scaled = x * power_of_two(-unit);
  Integer units;
  mpz_fdiv_q(units.get_mpz_t(), scaled.get_num_mpz_t(), scaled.get_den_mpz_t());
  return {std::move(units), unit};
}

/// Neighbouring doubles with lower < number ≤ upper. \pre number > 0
RationalInterval neighbouring_doubles(AlgebraicNumber number) {
  for (unsigned long level = 64;; level *= 2) {
    const auto [lower, upper] = number.interval();
    const Double below = double_below(upper);
    if (sgn(below.units) == 0) return {Rational(0), below.next()};
    const auto order = number <=> below.value();
    if (order > 0) return {below.value(), below.next()};
    const Rational previous = below.previous();
    if (order == 0 || previous <= lower) return {previous, below.value()};
    number.refine_to_level(level);
  }
}

/// An interval for a time of impact > 0.
RationalInterval toi_interval(AlgebraicNumber& toi, const std::optional<Rational>& width) {
  if (!width) return neighbouring_doubles(toi);
  if (toi.rational()) {
    const Rational lower = *toi.rational() - *width;
    return {std::max(Rational(0), lower), *toi.rational()};
  }
  toi.refine(*width);
  if (toi.rational()) return toi_interval(toi, width);
  return toi.interval();
}

// ---- Contacts -----------------------------------------------------------------------------------

/// True if the polynomial changes sign across the interval and every other one has a sign on it.
bool proves(const Polynomial& g, const std::vector<Polynomial>& nonzero,
            const RationalInterval& interval) {
  if (sign_at(g, interval.lower) * sign_at(g, interval.upper) >= 0) return false;
  return std::ranges::all_of(nonzero, [&](const Polynomial& p) {
    return common_sign(bernstein_coefficients(p, interval)) != 0;
  });
}

/// \param within An interval that holds the time.
std::variant<Rational, RootTime> proved_time(AlgebraicNumber time,
                                             const ContactConditions& conditions,
                                             const RationalInterval& within) {
  if (time.rational()) return *time.rational();
  Polynomial g = time.polynomial();
  for (const Polynomial& p : conditions.zero) g = greatest_common_divisor(g, p);
  if (proves(g, conditions.nonzero, within)) return RootTime{within, std::move(g)};
  const unsigned long greatest_level = 2 * number_limit;
  for (unsigned long level = 8; level <= greatest_level; level += level / 2) {
    time.refine_to_level(level);
    if (time.rational()) return *time.rational();
    const RationalInterval interval = time.interval();
    const bool inside = within.lower <= interval.lower && interval.upper <= within.upper;
    if (inside && proves(g, conditions.nonzero, interval)) {
      return RootTime{interval, std::move(g)};
    }
  }
  throw CertificateLimitError("the interval of a contact needs too many bits");
}

// ---- Certificates -------------------------------------------------------------------------------

bool is_within_limits(const RationalInterval& interval) {
  return is_within_limit(interval.lower) && is_within_limit(interval.upper);
}

bool is_within_limits(const ContactProof& contact) {
  if (const auto* rational = std::get_if<Rational>(&contact.time)) {
    return is_within_limit(*rational);
  }
  const auto& root = std::get<RootTime>(contact.time);
  return is_within_limits(root.interval) &&
         std::ranges::all_of(root.polynomial.coefficients(),
                             [](const Integer& x) { return is_within_limit(Rational(x)); });
}

void require_limits(const Certificate& certificate) {
  if (certificate.subintervals.size() > subinterval_limit) {
    throw CertificateLimitError("a separation needs too many subintervals");
  }
  if (!is_within_limits(certificate.toi) ||
      (certificate.contact && !is_within_limits(*certificate.contact))) {
    throw CertificateLimitError("the time of a contact needs too many bits");
  }
}

/// The one condition of an inversion; empty if the volume is positive at the time.
template <class Order>
std::optional<ContactConditions> find_inversion(const MotionOf<Order>& motion,
                                                AlgebraicNumber& time) {
  const auto volume = -determinant(motion);
  const int sign = sign_at(volume, time);
  if (sign > 0) return std::nullopt;
  ContactConditions conditions{PlaneContact{}, {}, {}};
  auto& polynomials = sign == 0 ? conditions.zero : conditions.nonzero;
  if (!volume.is_zero()) polynomials.push_back(to_polynomial(volume));
  return conditions;
}

template <class Order>
std::optional<ContactConditions> conditions_at(const MotionOf<Order>& motion, bool is_tetrahedron,
                                               AlgebraicNumber& time) {
  if (is_tetrahedron) return find_inversion(motion, time);
  return sgn(motion.distance) > 0 ? find_near_contact(motion, time) : find_contact(motion, time);
}

template <class Order>
std::vector<Subinterval> free_until(const MotionOf<Order>& motion, bool is_tetrahedron,
                                    const Rational& until) {
  return is_tetrahedron ? keep_volume(motion, until) : separate(motion, until);
}

template <class Order>
void prove_collision(const MotionOf<Order>& motion, const AlgebraicNumber& first,
                     const ProveOptions& options, Certificate& certificate) {
  AlgebraicNumber toi = recognised(first);
  const bool is_tetrahedron = certificate.kind.is_cell();
  const auto conditions = conditions_at(motion, is_tetrahedron, toi);
  if (!conditions)
    throw std::logic_error("touchstone: no contact at the decision's time of impact");
  RationalInterval within{Rational(0), Rational(1)};
  certificate.claim = options.collision_claim;
  if (certificate.claim == Claim::time_of_impact) {
    certificate.toi = RationalInterval{Rational(0), Rational(0)};
    if (toi != Rational(0)) {
      certificate.toi = toi_interval(toi, options.width);
      certificate.subintervals = free_until(motion, is_tetrahedron, certificate.toi.lower);
    }
    within = certificate.toi;
  }
  certificate.contact = {proved_time(std::move(toi), *conditions, within), conditions->place};
}

/// Proves the first contact, or that there is none, of a certificate that has its query.
template <class Order>
Certificate prove_motion(Certificate certificate, const MotionOf<Order>& motion,
                         const std::optional<AlgebraicNumber>& first, const ProveOptions& options) {
  if (options.width && sgn(*options.width) <= 0) {
    throw std::invalid_argument("the interval of a time of impact must have a positive width");
  }
  if (options.collision_claim == Claim::no_collision) {
    throw std::invalid_argument("no collision cannot be claimed of a query that collides");
  }
  if (first) {
    prove_collision(motion, *first, options, certificate);
  } else {
    certificate.subintervals = free_until(motion, certificate.kind.is_cell(), Rational(1));
  }
  require_limits(certificate);
  return certificate;
}

/// Proves the first contact, or that there is none.
/// \tparam AnyQuery Query or CurvedQuery.
template <class AnyQuery>
Certificate prove_any(ContactKind given, const AnyQuery& asked, const Decision& decision,
                      const ProveOptions& options) {
  const ContactKind kind = decided_as(given);
  const AnyQuery query = decided_query(given, asked);
  auto motion = scale_uniformly(kind, query, decision.separation);
  // Both norms mean the same at distance 0, and l2 has fewer features.
  if (sgn(motion.distance) == 0) motion.norm = Norm::l2;
  return prove_motion({.kind = kind, .query = query, .separation = decision.separation}, motion,
                      decision.toi, options);
}

/// \tparam Cell Query or CurvedQuery.
template <class Cell>
Certificate prove_tetrahedron(const Cell& tetrahedron, const std::optional<AlgebraicNumber>& first,
                              const ProveOptions& options) {
  return prove_motion({.kind = CellKind::tetrahedron, .query = tetrahedron},
                      scale(ContactKind::vertex_face, tetrahedron), first, options);
}

}  // namespace

Certificate prove(ContactKind kind, const Query& query, const Decision& decision,
                  const ProveOptions& options) {
  return prove_any(kind, query, decision, options);
}

Certificate prove(ContactKind kind, const CurvedQuery& query, const Decision& decision,
                  const ProveOptions& options) {
  return prove_any(kind, query, decision, options);
}

Certificate prove(const Queries& queries, std::size_t i, const Decision& decision,
                  const ProveOptions& options) {
  if (queries.is_straight()) return prove(queries.kind, queries.straight()[i], decision, options);
  return prove(queries.kind, to_curved(queries, i), decision, options);
}

Certificate prove_inversion(CellKind kind, const Query& cell,
                            const std::optional<AlgebraicNumber>& first,
                            const ProveOptions& options) {
  return prove_tetrahedron(to_tetrahedron(kind, cell), first, options);
}

Certificate prove_inversion(CellKind kind, const CurvedQuery& cell,
                            const std::optional<AlgebraicNumber>& first,
                            const ProveOptions& options) {
  return prove_tetrahedron(to_tetrahedron(kind, cell), first, options);
}

Certificate prove_inversion(const Cells& cells, std::size_t i,
                            const std::optional<AlgebraicNumber>& first,
                            const ProveOptions& options) {
  if (cells.is_straight()) return prove_inversion(cells.kind, cells.straight()[i], first, options);
  return prove_inversion(cells.kind, to_curved(cells, i), first, options);
}

std::vector<Certificate> prove(const Queries& queries, std::span<const Decision> decisions,
                               const ProveOptions& options) {
  if (decisions.size() != queries.size()) {
    throw std::invalid_argument("prove: " + std::to_string(decisions.size()) + " decisions for " +
                                std::to_string(queries.size()) + " queries");
  }
  std::vector<Certificate> certificates;
  certificates.reserve(queries.size());
  for (std::size_t i = 0; i < queries.size(); ++i) {
    certificates.push_back(prove(queries, i, decisions[i], options));
  }
  return certificates;
}

}  // namespace touchstone::exact
