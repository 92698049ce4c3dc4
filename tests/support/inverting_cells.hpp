#pragma once

/// \file
/// Moving cells whose inversion is known by construction.
///
/// The edges from a are the rows of a triangular matrix whose diagonal is f1, f2, f3, each linear
/// in time between integers, and whose other numbers below it move anyhow. So 6 V = f1 f2 f3: the
/// first time is the least root of a factor, and equal factors make double and triple roots. Maps
/// of determinant 1 (a shear, a cyclic change of the axes), a moving translation, and a power of
/// two for each axis keep the truth. All of it is exact in doubles.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fast/cells/decision.hpp"
#include "fast/certified/kernel.hpp"
#include "fast/kernels.hpp"
#include "fast/platform/floating_point_state.hpp"
#include "tests/support/certified_against_oracle.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/root_count.hpp"
#include "touchstone/algebraic_number.hpp"
#include "touchstone/cell.hpp"
#include "touchstone/inversion.hpp"
#include "touchstone/oracle.hpp"
#include "touchstone/query.hpp"

namespace touchstone::tests {

/// A cell with its truth.
struct KnownInversion {
  Query tetrahedron{};
  int start = 0;  ///< sign of the volume
  /// The first time with a volume that is not positive; −1/1 if there is none.
  int numerator = -1;
  int denominator = 1;
};

namespace inverting_cells {

/// A number that moves from the first value to the second.
using Moving = std::array<int, 2>;

[[nodiscard]] inline Moving moving(Random& random, int most) {
  return {random.between(-most, most), random.between(-most, most)};
}

/// The sign and the first root of a product of factors.
inline void set_truth(KnownInversion& known, std::span<const Moving> factors) {
  known.start = 1;
  for (const auto& [from, to] : factors) known.start *= (from > 0 ? 1 : 0) - (from < 0 ? 1 : 0);
  if (known.start <= 0) {
    known.numerator = 0;
    return;
  }
  for (const auto& [from, to] : factors) {
    // From a positive number to one that is not, or the other way round: the root is in (0,1].
    const bool has_root = from > 0 ? to <= 0 : to >= 0;
    const int sign = from > 0 ? 1 : -1, numerator = sign * from, denominator = sign * (from - to);
    if (!has_root) continue;
    if (known.numerator < 0 || numerator * known.denominator < known.numerator * denominator) {
      known.numerator = numerator;
      known.denominator = denominator;
    }
  }
}

/// Mostly positive at the start, often the same as the one before.
[[nodiscard]] inline std::array<Moving, 3> factors(Random& random) {
  std::array<Moving, 3> result;
  for (std::size_t i = 0; i < 3; ++i) {
    const int most = random.coin() ? 3 : 1000;
    result.at(i) = moving(random, most);
    if (random.between(0, 3) != 0) result.at(i)[0] = random.between(1, most);
    if (random.coin()) result.at(i)[1] = random.between(0, most);
    if (random.between(0, 15) == 0) result.at(i)[0] = 0;
    if (i > 0 && random.between(0, 3) == 0) result.at(i) = result.at(i - 1);
    if (i > 0 && random.between(0, 7) == 0) {
      result.at(i) = {-result.at(i - 1)[0], -result.at(i - 1)[1]};
    }
  }
  return result;
}

}  // namespace inverting_cells

/// A tetrahedron of any size, from subnormal to nearly the greatest, and of any place.
[[nodiscard]] inline KnownInversion product_of_factors(Random& random) {
  using inverting_cells::Moving;
  const std::array<Moving, 3> f = inverting_cells::factors(random);
  KnownInversion known;
  inverting_cells::set_truth(known, f);
  const int most = random.coin() ? 2 : 1000;
  // Their products with the shear and the translation stay below 2^53.
  const auto shear = static_cast<double>(random.between(-4, 4));
  const double place = random.coin() ? 0.0 : std::ldexp(1.0, random.between(0, 44));
  const auto first_axis = static_cast<std::size_t>(random.between(0, 2));
  std::array<int, 3> exponent{};
  const int all = random.coin() ? 0 : random.between(-1074, 970);
  for (int& x : exponent) x = random.between(0, 3) == 0 ? random.between(-1074, 970) : all;
  std::array<Moving, 3> below;
  for (Moving& x : below) x = inverting_cells::moving(random, most);
  for (std::size_t end = 0; end < 2; ++end) {
    const auto at = [&](const Moving& x) { return static_cast<double>(x.at(end)); };
    std::array<std::array<double, 3>, 4> points{{{},
                                                 {at(f[0]), 0, 0},
                                                 {at(below[0]), at(f[1]), 0},
                                                 {at(below[1]), at(below[2]), at(f[2])}}};
    const std::array<double, 3> translation{std::round(place * random.uniform(-1.0, 1.0)),
                                            std::round(place * random.uniform(-1.0, 1.0)), place};
    for (std::size_t i = 0; i < points.size(); ++i) {
      auto& x = points.at(i);
      x[1] += shear * x[0];
      x[0] -= shear * x[2];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t to = (axis + first_axis) % 3;
        known.tetrahedron.at(end, i, to) =
            std::ldexp(x.at(axis) + translation.at(axis), exponent.at(to));
      }
    }
  }
  return known;
}

/// The same of a triangle in the plane, with two factors.
[[nodiscard]] inline KnownInversion triangle_of_factors(Random& random) {
  using inverting_cells::Moving;
  const std::array<Moving, 3> f = inverting_cells::factors(random);
  KnownInversion known;
  inverting_cells::set_truth(known, std::span(f).first<2>());
  const Moving below = inverting_cells::moving(random, 1000);
  const auto shear = static_cast<double>(random.between(-4, 4));
  const double place = random.coin() ? 0.0 : std::ldexp(1.0, random.between(0, 44));
  const int all = random.coin() ? 0 : random.between(-1074, 970);
  const std::array<int, 2> exponent{all, random.between(0, 3) == 0 ? 0 : all};
  for (std::size_t end = 0; end < 2; ++end) {
    const auto at = [&](const Moving& x) { return static_cast<double>(x.at(end)); };
    std::array<std::array<double, 2>, 3> points{{{}, {at(f[0]), 0}, {at(below), at(f[1])}}};
    const std::array<double, 2> translation{std::round(place * random.uniform(-1.0, 1.0)), place};
    for (std::size_t i = 0; i < points.size(); ++i) {
      points.at(i)[1] += shear * points.at(i)[0];
      for (std::size_t axis = 0; axis < 2; ++axis) {
        known.tetrahedron.at(end, i, axis) =
            std::ldexp(points.at(i).at(axis) + translation.at(axis), exponent.at(axis));
      }
    }
  }
  known.tetrahedron = to_tetrahedron(CellKind::plane_triangle, known.tetrahedron);
  return known;
}

/// A tetrahedron of this size at this distance from the origin, whose points move by up to `motion`
/// times the size.
[[nodiscard]] inline Query deforming_tetrahedron(Random& random, double size, double place,
                                                 double motion) {
  Query query{};
  for (std::size_t point = 0; point < moving_points; ++point) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double corner = point == axis + 1 ? 1.0 : 0.0;
      const double start = corner + random.uniform(-0.2, 0.2);
      query.at(0, point, axis) = place + size * start;
      query.at(1, point, axis) = place + size * (start + motion * random.uniform(-1.0, 1.0));
    }
  }
  return query;
}

/// The truth about a tetrahedron.
struct InversionTruth {
  int start = 0;  ///< the sign of the volume at t=0
  std::optional<exact::AlgebraicNumber> time = std::nullopt;

  [[nodiscard]] bool inverts() const { return time.has_value(); }
};

/// The exact decision on the first time at which at most this part of the volume at t=0 is left: by
/// the oracle if it is 0, else from the roots of V − f V(0), a polynomial with integer
/// coefficients.
[[nodiscard]] inline InversionTruth inversion_truth(const Query& tetrahedron, double kept = 0.0) {
  using exact::Integer, exact::Rational, exact::Polynomial;
  std::array<root_count::Vector, moving_points> points;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Integer unit = 1;
    for (std::size_t i = axis; i < 24; i += 3) {
      unit = std::max(unit, Integer(Rational(tetrahedron.coordinates.at(i)).get_den()));
    }
    for (std::size_t point = 0; point < moving_points; ++point) {
      const auto at = [&](std::size_t end) {
        return Integer(Rational(Rational(tetrahedron.at(end, point, axis)) * unit).get_num());
      };
      points.at(point).at(axis) = Polynomial(at(0), Integer(at(1) - at(0)));
    }
  }
  const auto& [a, b, c, d] = points;
  const Polynomial volume = root_count::dot(
      root_count::minus(b, a), root_count::cross(root_count::minus(c, a), root_count::minus(d, a)));
  const Integer at_start = volume[0];
  if (kept == 0.0)
    return {sgn(at_start), exact::first_inversion(CellKind::tetrahedron, tetrahedron)};
  const Rational part(kept);
  const Polynomial left =
      Polynomial(part.get_den()) * volume - Polynomial(Integer(part.get_num() * at_start));
  InversionTruth result{.start = sgn(at_start)};
  if (result.start <= 0) {
    result.time = exact::AlgebraicNumber(Rational(0));
  } else if (const auto roots = exact::roots_in_unit_interval(left); !roots.empty()) {
    result.time = roots.front();
  }
  return result;
}

/// The results of tetrahedra of which this part of the volume is to be kept.
/// \param decide fast::decide_cells, or one with a fault
template <class Decide = decltype(fast::decide_cells)>
[[nodiscard]] std::vector<fast::Inversion> inversions_keeping(
    std::span<const Query> tetrahedra, double kept, const fast::InversionOptions& options = {},
    Decide& decide = fast::decide_cells) {
  const fast::StrictFloatingPoint strict;
  std::vector<fast::Inversion> results(tetrahedra.size(), fast::no_inversion);
  for (std::size_t first = 0; first < tetrahedra.size(); first += fast::kernel_block) {
    const std::size_t count = std::min(fast::kernel_block, tetrahedra.size() - first);
    decide(
        {.kind = CellKind::tetrahedron,
         .count = count,
         .queries = &tetrahedra[first],
         .kept_volume = kept},
        options.t_max, options, fast::certified_kernel(options.kernels),
        [&](std::size_t i) { return tetrahedra[first + i]; },
        [&](std::size_t i, const fast::Inversion& found) { results[first + i] = found; });
  }
  return results;
}

/// The fault of an answer, or nothing.
[[nodiscard]] inline std::optional<std::string> inversion_fault(
    const InversionTruth& truth, const fast::Inversion& result,
    const fast::InversionOptions& options = {}) {
  bool inverts = truth.inverts();
  if (inverts && options.t_max < 1.0) inverts = compare(*truth.time, options.t_max) <= 0;
  if (result.start != truth.start) return "the start is another";
  if (result.verdict != (inverts ? fast::Verdict::yes : fast::Verdict::no)) {
    return inverts ? "an inversion is missed" : "an inversion is made up";
  }
  if (!inverts) return std::nullopt;
  return enclosure_fault(*truth.time, result.toi_lower, result.toi_upper, options.toi_tolerance);
}

/// One of all sorts, the first half of them degenerate: exactly so, or up to one spacing of
/// doubles.
inline constexpr int sorts_of_cells = 8;
[[nodiscard]] inline Query cell_of_sort(Random& random, int sort) {
  Query query{};
  switch (sort) {
    case 0:
    case 1:
      return product_of_factors(random).tetrahedron;
    case 2: {
      query = product_of_factors(random).tetrahedron;
      double& x = query.coordinates.at(static_cast<std::size_t>(random.between(0, 23)));
      x = std::nextafter(x, random.coin() ? 2 * x : -x);
      return query;
    }
    case 3:
      // The last point is in the plane of the others at a time, up to rounding.
      query = near_contact_query(random, ContactKind::vertex_face);
      if (random.coin())
        std::swap_ranges(query.coordinates.begin(), query.coordinates.begin() + 3,
                         query.coordinates.begin() + 3);
      return query;
    case 4:
      return deforming_tetrahedron(random, 1.0, 0.0, random.uniform(0.0, 2.0));
    case 5:
      return deforming_tetrahedron(random, std::ldexp(1.0, random.between(-1050, 1000)), 0.0, 1.0);
    case 6:
      return deforming_tetrahedron(random, 1e-3, random.uniform(0.0, 1e6), 0.5);
    default:
      if (random.between(0, 15) != 0) return full_significand_query(random);
      for (double& x : query.coordinates) x = random.finite_double();
      return query;
  }
}

}  // namespace touchstone::tests
