#include "fast/certified/exact/curved_polygon.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "fast/certified/exact/enclosing_doubles.hpp"

namespace touchstone::fast::exact_stage {
namespace {

constexpr int no_unit = std::numeric_limits<int>::max();

/// Lowers the unit to the exponent of a number's last bit, if that is lower. Zero has no last bit.
void include_last_bit(int& unit, double x) {
  const BinaryFraction fraction = odd_fraction(x);
  if (fraction.numerator != 0) unit = std::min(unit, fraction.exponent);
}

BigInteger in_units(double x, int unit) {
  const BinaryFraction fraction = odd_fraction(x);
  if (fraction.numerator == 0) return 0;
  return BigInteger(fraction.numerator) << (fraction.exponent - unit);
}

/// Multiplies each control value by its binomial: the form of a Bézier curve.
Polynomial form_of(Polynomial control) {
  const auto degree = static_cast<std::int64_t>(control.size()) - 1;
  std::int64_t binomial = 1;
  for (std::int64_t k = 1; k < degree; ++k) {
    binomial = binomial * (degree - k + 1) / k;
    control[static_cast<std::size_t>(k)] = control[static_cast<std::size_t>(k)] * binomial;
  }
  return control;
}

/// True if the weights matter: equal ones do not.
bool is_rational(const Trajectory& curve) {
  return std::ranges::adjacent_find(curve.weights, std::not_equal_to{}) != curve.weights.end();
}

/// The denominator of a curve, which is 1 for a polynomial one.
Polynomial denominator_of(const Trajectory& curve) {
  if (!is_rational(curve)) return {1};
  int unit = no_unit;
  for (const double weight : curve.weights) include_last_bit(unit, weight);
  Polynomial weights;
  for (const double weight : curve.weights) weights.push_back(in_units(weight, unit));
  return form_of(std::move(weights));
}

/// The coordinate times the curve's denominator.
Polynomial numerator_of(const Trajectory& curve, const Polynomial& denominator, std::size_t axis,
                        int unit) {
  Polynomial control;
  for (const auto& point : curve.control) control.push_back(in_units(point[axis], unit));
  if (!is_rational(curve)) return form_of(std::move(control));
  for (std::size_t k = 0; k < control.size(); ++k) control[k] = control[k] * denominator[k];
  return control;
}

using Vector = std::array<Polynomial, 3>;

/// Raises all to the greatest degree.
void raise_to_one_degree(std::span<Vector> vectors, std::size_t least) {
  std::size_t degree = least;
  for (const Vector& vector : vectors) {
    for (const Polynomial& x : vector) degree = std::max(degree, x.size() - 1);
  }
  for (Vector& vector : vectors) {
    for (Polynomial& x : vector) x = raised_to(std::move(x), degree);
  }
}

/// The points times their denominators.
struct RationalPoints {
  std::array<int, 3> units{no_unit, no_unit, no_unit};
  std::array<Vector, moving_points> numerators;
  std::array<Polynomial, moving_points> denominators;

  /// \param has_one_unit true for one unit of all axes
  RationalPoints(const CurvedQuery& query, bool has_one_unit) {
    for (const Trajectory& curve : query) {
      for (const auto& point : curve.control) {
        for (std::size_t axis = 0; axis < 3; ++axis) include_last_bit(units[axis], point[axis]);
      }
    }
    if (has_one_unit) units.fill(std::ranges::min(units));
    for (int& unit : units) unit = unit == no_unit ? 0 : unit;
    for (std::size_t i = 0; i < moving_points; ++i) {
      denominators[i] = denominator_of(query[i]);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        numerators[i][axis] = numerator_of(query[i], denominators[i], axis, units[axis]);
      }
    }
  }

  /// The denominators that are not 1, equal ones once.
  [[nodiscard]] std::vector<Polynomial> distinct() const {
    std::vector<Polynomial> result;
    for (const Polynomial& own : denominators) {
      if (own.size() > 1 && std::ranges::find(result, own) == result.end()) result.push_back(own);
    }
    return result;
  }
};

/// The denominators by which a corner is multiplied.
std::vector<Polynomial> denominators_of(const RationalPoints& points, const Corner& corner) {
  const Polynomial &a = points.denominators[corner.plus], &b = points.denominators[corner.minus];
  if (a == b) return {a};
  return {a, b};
}

/// The corner times these denominators.
Vector corner_of(const RationalPoints& points, const Corner& corner) {
  std::array<Vector, 2> both{points.numerators[corner.plus], points.numerators[corner.minus]};
  const Polynomial &a = points.denominators[corner.plus], &b = points.denominators[corner.minus];
  if (!(a == b)) {
    for (Polynomial& x : both[0]) x = x * b;
    for (Polynomial& x : both[1]) x = x * a;
  }
  raise_to_one_degree(both, 1);
  return both[0] - both[1];
}

/// The factors of three corners, except the denominators of the points.
std::vector<Polynomial> other_factors(std::vector<Polynomial> factors,
                                      const RationalPoints& points) {
  for (const Polynomial& own : points.denominators) {
    const auto place = std::ranges::find(factors, own);
    if (place != factors.end()) factors.erase(place);
  }
  std::erase_if(factors, [](const Polynomial& factor) { return factor.size() == 1; });
  return factors;
}

/// The motion of a triangle or parallelogram.
MotionOf<Polynomial> motion_of(ContactKind kind, const Vector& first, const Vector& next,
                               const Vector& last) {
  return {kind, first, first - next, first - last, {}};
}

/// The corners of all points times all denominators.
std::vector<Vector> whole_corners(ContactKind kind, RationalPoints points) {
  const std::vector<Polynomial> denominators = points.distinct();
  for (std::size_t i = 0; i < moving_points; ++i) {
    for (const Polynomial& denominator : denominators) {
      if (denominator == points.denominators[i]) continue;
      for (Polynomial& x : points.numerators[i]) x = x * denominator;
    }
  }
  raise_to_one_degree(points.numerators, 1);
  std::vector<Vector> result;
  for (const Corner& corner : corners(kind)) {
    result.push_back(points.numerators[corner.plus] - points.numerators[corner.minus]);
  }
  return result;
}

}  // namespace

CurvedPoints points_of(ContactKind kind, const CurvedQuery& query, double distance) {
  RationalPoints points(query, true);
  CurvedPoints result{.points = {.kind = kind, .points = {}},
                      .denominators = points.distinct(),
                      .distance = scaled_distance(distance, points.units[0])};
  for (std::size_t i = 0; i < moving_points; ++i) {
    const auto own = std::ranges::find(result.denominators, points.denominators[i]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Fraction& x = result.points.points[i][axis];
      x.numerator = std::move(points.numerators[i][axis]);
      x.denominators = result.denominators.data();
      if (own != result.denominators.end()) {
        x.powers[static_cast<std::size_t>(own - result.denominators.begin())] = 1;
      }
    }
  }
  return result;
}

std::vector<PolynomialMotion> motions_of(ContactKind kind, const CurvedQuery& query) {
  const RationalPoints points(query, false);
  const std::vector<Polynomial> distinct = points.distinct();
  std::vector<Polynomial> factors;
  const auto add = [&](const std::vector<Polynomial>& more) {
    factors.insert(factors.end(), more.begin(), more.end());
  };
  if (distinct.size() <= 2) {
    const std::vector<Vector> w = whole_corners(kind, points);
    for (int corner = 0; corner < 3; ++corner) add(distinct);
    return {{motion_of(kind, w[0], w[1], w.back()), other_factors(std::move(factors), points)}};
  }
  std::vector<Vector> w;
  for (const Corner& corner : corners(kind)) w.push_back(corner_of(points, corner));
  raise_to_one_degree(w, 1);
  std::vector<PolynomialMotion> result;
  for (std::size_t i = 1; i + 1 < w.size(); ++i) {
    factors.clear();
    for (const std::size_t k : {std::size_t{0}, i, i + 1}) {
      add(denominators_of(points, corners(kind)[k]));
    }
    result.push_back({motion_of(ContactKind::vertex_face, w[0], w[i], w[i + 1]),
                      other_factors(factors, points)});
  }
  return result;
}

std::optional<Query> on_lines(const CurvedQuery& query) {
  Query result{};
  for (std::size_t i = 0; i < moving_points; ++i) {
    if (query[i].degree() > 1 || is_rational(query[i])) return std::nullopt;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      result.at(0, i, axis) = query[i].control.front()[axis];
      result.at(1, i, axis) = query[i].control.back()[axis];
    }
  }
  return result;
}

bool is_valid(const CurvedQuery& query) {
  return std::ranges::all_of(query, [](const Trajectory& curve) {
    const auto is_finite_point = [](const auto& point) { return is_finite(point); };
    const auto is_weight = [](double x) {
      return is_finite({&x, 1}) && binary_fraction(x).numerator > 0;
    };
    return !curve.control.empty() && std::ranges::all_of(curve.control, is_finite_point) &&
           (curve.weights.empty() || curve.weights.size() == curve.control.size()) &&
           std::ranges::all_of(curve.weights, is_weight);
  });
}

Query at_rest(const CurvedQuery& query, double time) {
  Query result{};
  for (std::size_t point = 0; point < moving_points; ++point) {
    const Trajectory& curve = query[point];
    // Weighted coordinates and the weight, at most 1, by de Casteljau's algorithm.
    const double most = curve.weights.empty() ? 1.0 : std::ranges::max(curve.weights);
    std::vector<std::array<double, 4>> row;
    for (std::size_t k = 0; k < curve.control.size(); ++k) {
      const double weight = curve.weights.empty() ? 1.0 : curve.weights[k] / most;
      const auto& [x, y, z] = curve.control[k];
      row.push_back({weight * x, weight * y, weight * z, weight});
    }
    for (; row.size() > 1; row.pop_back()) {
      for (std::size_t k = 0; k + 1 < row.size(); ++k) {
        for (std::size_t i = 0; i < 4; ++i) {
          row[k][i] = (1.0 - time) * row[k][i] + time * row[k + 1][i];
        }
      }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double x = row[0][axis] / row[0][3];
      result.at(0, point, axis) = result.at(1, point, axis) = std::isfinite(x) ? x : 0.0;
    }
  }
  return result;
}

}  // namespace touchstone::fast::exact_stage
