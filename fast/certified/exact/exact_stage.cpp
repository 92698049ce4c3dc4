#include "fast/certified/exact/exact_stage.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "fast/certified/exact/big_integer.hpp"
#include "fast/certified/exact/closest_point_parameters.hpp"
#include "fast/certified/exact/contact_conditions.hpp"
#include "fast/certified/exact/contact_decision.hpp"
#include "fast/certified/exact/curved_polygon.hpp"
#include "fast/certified/exact/distance_decision.hpp"
#include "fast/certified/exact/enclosing_doubles.hpp"
#include "fast/certified/exact/fixed_integer.hpp"
#include "fast/certified/exact/general_contact_decision.hpp"
#include "fast/certified/exact/real_root.hpp"

namespace touchstone::fast {
namespace {

using namespace exact_stage;

/// The limits of bits of coordinates for each type. Coordinates below 2^60 have differences below
/// 2^61, and likewise for the others.
constexpr int one_limb_bits = 60, two_limb_bits = 124;

/// The eight coordinates of one axis.
struct Axis {
  std::array<std::array<BinaryFraction, moving_points>, 2> x;
  int lowest;   ///< all are multiples of 2^lowest
  int highest;  ///< all magnitudes are below 2^highest
};

Axis axis_of(const Query& query, std::size_t axis) {
  constexpr int none = std::numeric_limits<int>::max();
  Axis result;
  result.lowest = none;
  result.highest = -none;
  for (std::size_t end = 0; end < 2; ++end) {
    for (std::size_t i = 0; i < moving_points; ++i) {
      const BinaryFraction x = result.x[end][i] = binary_fraction(query.at(end, i, axis));
      if (x.numerator == 0) continue;
      // The number of trailing zeros of its magnitude.
      const int zeros = std::countr_zero(static_cast<std::uint64_t>(x.numerator));
      result.lowest = std::min(result.lowest, x.exponent + zeros);
      result.highest = std::max(result.highest, x.exponent + significand_bits);
    }
  }
  if (result.lowest == none) result.lowest = result.highest = 0;
  return result;
}

BigInteger shifted(const BigInteger& x, int bits) { return bits >= 0 ? x << bits : x >> -bits; }
template <class Whole>
Whole shifted(Whole x, int bits) {
  return bits >= 0 ? x << bits : x >> -bits;
}

/// r, p and q in units of 2^lowest on each axis. `Whole` must hold the differences of coordinates.
template <class Number, class Whole>
Motion<Number> motion_of(ContactKind kind, const std::array<Axis, 3>& axes) {
  const auto points = affine_vectors(kind);
  Motion<Number> motion;
  motion.kind = kind;
  const std::array<MovingVector<Number>*, 3> vectors{&motion.r, &motion.p, &motion.q};
  for (std::size_t k = 0; k < 3; ++k) {
    motion.unit[k] = axes[k].lowest;
    for (std::size_t end = 0; end < 2; ++end) {
      std::array<Whole, moving_points> x;
      for (std::size_t i = 0; i < moving_points; ++i) {
        const BinaryFraction& from = axes[k].x[end][i];
        x[i] = from.numerator == 0 ? Whole(0)
                                   : shifted(Whole(from.numerator), from.exponent - axes[k].lowest);
      }
      for (std::size_t i = 0; i < 3; ++i) {
        (*vectors[i])[k][end] = Number(x[points[i][0]] - x[points[i][1]]);
      }
    }
  }
  return motion;
}

/// The axes in one unit.
std::array<Axis, 3> axes_of_one_unit(const Query& query) {
  std::array<Axis, 3> axes{axis_of(query, 0), axis_of(query, 1), axis_of(query, 2)};
  int lowest = std::numeric_limits<int>::max();
  for (const Axis& axis : axes) {
    const bool is_zero = axis.highest == axis.lowest;
    if (!is_zero) lowest = std::min(lowest, axis.lowest);
  }
  if (lowest == std::numeric_limits<int>::max()) lowest = 0;
  for (Axis& axis : axes) axis.lowest = lowest;
  return axes;
}

std::optional<ExactImpact> first_impact_of(ContactKind kind, const Query& query,
                                           std::uint64_t latest, std::uint64_t step) {
  const std::array<Axis, 3> axes{axis_of(query, 0), axis_of(query, 1), axis_of(query, 2)};
  int bits = 0;
  for (const Axis& axis : axes) bits = std::max(bits, axis.highest - axis.lowest);
  FixedSizeAnswer answer;
  if (bits <= one_limb_bits) {
    answer =
        fixed_size_first_impact(motion_of<FixedInteger<1>, std::int64_t>(kind, axes), latest, step);
  } else if (bits <= two_limb_bits) {
    answer = fixed_size_first_impact(motion_of<FixedInteger<2>, SignedWideLimb>(kind, axes), latest,
                                     step);
  }
  if (answer.decided) return answer.impact;
  return first_impact(motion_of<BigInteger, BigInteger>(kind, axes), latest);
}

/// Contact at distance 0 implies contact at the distance, so the first contact at the distance is
/// not later. If there is none at the distance until just before the first contact at 0, the
/// enclosure of that one is the result. For small distances this is the common case.
std::optional<BitInterval> first_approach_of(ContactKind kind, const Query& query,
                                             const Separation& separation, std::uint64_t latest,
                                             std::uint64_t step) {
  const auto impact = first_impact_of(kind, query, latest, step);
  const auto contact = impact ? std::optional(time_of(*impact)) : std::nullopt;
  if (contact && contact->upper == bits_of_zero) return contact;
  const auto axes = axes_of_one_unit(query);
  const auto motion = motion_of<BigInteger, BigInteger>(kind, axes);
  const ScaledDistance distance = scaled_distance(separation.distance, axes[0].lowest);
  const auto approach_until = [&](std::uint64_t time) {
    return first_approach(motion, distance, separation.norm, time, step);
  };
  if (!contact || contact->upper > latest) return approach_until(latest);
  const auto before = approach_until(contact->lower);
  return before ? before : contact;
}

/// The first contact of any of the motions.
std::optional<BitInterval> first_contact_of(ContactKind kind, const CurvedQuery& query,
                                            std::uint64_t latest) {
  std::optional<BitInterval> result;
  for (const auto& motion : motions_of(kind, query)) {
    if (const auto time = first_contact(motion, latest)) {
      result = time;
      latest = time->upper;
    }
  }
  return result;
}

std::optional<BitInterval> first_approach_of(ContactKind kind, const CurvedQuery& query,
                                             const Separation& separation, std::uint64_t latest,
                                             std::uint64_t step) {
  const CurvedPoints curved = points_of(kind, query, separation.distance);
  return first_approach(curved.points, curved.distance, separation.norm, latest, step);
}

/// The maximum width, in spacings of doubles, of an enclosure with the relative width `tolerance`:
/// spacings are at most 2^-52 of a normal number.
std::uint64_t step_of(double tolerance) {
  constexpr double widest = 0x1p-12;
  if (!(tolerance > 0.0)) return 1;
  return std::max(static_cast<std::uint64_t>(std::min(tolerance, widest) * 0x1p52),
                  std::uint64_t{1});
}

ExactImpact approach_at(ContactKind kind, const BitInterval& time, const Parameters& nearest) {
  const auto [u, v] = inside_domain(kind, nearest);
  return impact_at(time, u, v);
}

}  // namespace

std::optional<ExactImpact> decide_exactly(ContactKind kind, const Query& query,
                                          const Separation& separation, double toi_tolerance,
                                          double t_max) {
  const std::uint64_t latest = unit_bits(t_max), step = step_of(toi_tolerance);
  if (separation.distance == 0.0) {
    const auto impact = first_impact_of(kind, query, latest, step);
    if (!impact) return std::nullopt;
    const auto [u, v] = inside_domain(kind, {impact->u, impact->v});
    return ExactImpact{impact->toi_lower, impact->toi_upper, u, v};
  }
  const auto time = first_approach_of(kind, query, separation, latest, step);
  if (!time) return std::nullopt;
  const auto toi_upper = std::bit_cast<double>(time->upper);
  return approach_at(kind, *time, nearest_parameters(kind, query, toi_upper, separation.norm));
}

std::optional<ExactImpact> decide_exactly(ContactKind kind, const CurvedQuery& query,
                                          const Separation& separation, double toi_tolerance,
                                          double t_max) {
  if (const auto lines = on_lines(query)) {
    return decide_exactly(kind, *lines, separation, toi_tolerance, t_max);
  }
  const auto time =
      is_zero(separation)
          ? first_contact_of(kind, query, unit_bits(t_max))
          : first_approach_of(kind, query, separation, unit_bits(t_max), step_of(toi_tolerance));
  if (!time) return std::nullopt;
  const Query at_impact = at_rest(query, std::bit_cast<double>(time->upper));
  return approach_at(kind, *time, nearest_parameters(kind, at_impact, 0.0, separation.norm));
}

ExactInversion decide_inversion_exactly(const Query& tetrahedron, double t_max,
                                        double kept_volume) {
  const auto motion = motion_of<BigInteger, BigInteger>(
      ContactKind::vertex_face,
      {axis_of(tetrahedron, 0), axis_of(tetrahedron, 1), axis_of(tetrahedron, 2)});
  auto det = determinant(motion, normal(motion));
  ExactInversion result{.start = -det.front().sign()};
  if (result.start <= 0) {
    result.inverts = true;
    return result;
  }
  if (kept_volume > 0.0) {
    const BinaryFraction kept = odd_fraction(kept_volume);  // its exponent is negative
    const BigInteger of_start = det.front() * BigInteger(kept.numerator);
    for (std::size_t i = 0; i < det.size(); ++i) {
      det[i] <<= -kept.exponent;
      det[i] -= of_start * BigInteger(i % 3 == 0 ? 1 : 3);
    }
  }
  const auto end_at = [&](Instant& first) {
    if (first.is_above(unit_bits(t_max))) return true;
    const auto [lower, upper] =
        enclose(first.guess(), 1, [&](std::uint64_t bits) { return first.is_above(bits); });
    result.inverts = true;
    result.toi_lower = std::bit_cast<double>(lower);
    result.toi_upper = std::bit_cast<double>(upper);
    return true;
  };
  if (!visit_roots(inner_polynomial(det), end_at) && det.back().sign() == 0) {
    Instant end(Dyadic{1, 0});
    static_cast<void>(end_at(end));
  }
  return result;
}

}  // namespace touchstone::fast
