#include "fast/certified/exact/curved_polygon.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "fast/certified/exact/enclosing_doubles.hpp"

namespace touchstone::fast::exact_stage {
namespace {

constexpr int no_unit = std::numeric_limits<int>::max();

/// The exponent of the last bit of a number, or the unit if that is lower. A zero has no last bit.
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

/// The denominator of a curve, which is constant for a polynomial one.
Polynomial denominator_of(const Trajectory& curve) {
  if (curve.weights.size() < 2) return {1};
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
  if (curve.weights.size() < 2) return form_of(std::move(control));
  for (std::size_t k = 0; k < control.size(); ++k) control[k] = control[k] * denominator[k];
  return control;
}

/// The same function as a form of this degree.
Polynomial raised_to(Polynomial form, std::size_t degree) {
  while (form.size() <= degree) form = form * Polynomial{1, 1};
  return form;
}

}  // namespace

CurvedPolygon polygon_of(Kind kind, const CurvedQuery& query, double distance) {
  int unit = no_unit;
  std::array<Polynomial, moving_points> own;
  std::vector<Polynomial> denominators;
  for (std::size_t i = 0; i < moving_points; ++i) {
    for (const auto& point : query[i].control) {
      for (const double x : point) include_last_bit(unit, x);
    }
    own[i] = denominator_of(query[i]);
    if (own[i].size() > 1 && std::ranges::find(denominators, own[i]) == denominators.end()) {
      denominators.push_back(own[i]);
    }
  }
  if (unit == no_unit) unit = 0;
  Polynomial common{1};
  for (const Polynomial& denominator : denominators) common = common * denominator;
  std::array<std::array<Polynomial, 3>, moving_points> points;
  std::size_t degree = std::max<std::size_t>(common.size() - 1, 1);
  for (std::size_t i = 0; i < moving_points; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Polynomial& x = points[i][axis] = numerator_of(query[i], own[i], axis, unit);
      for (const Polynomial& denominator : denominators) {
        if (!(denominator == own[i])) x = x * denominator;
      }
      degree = std::max(degree, x.size() - 1);
    }
  }
  CurvedPolygon result{
      .polygon = {.kind = kind, .corners = {}, .denominator = raised_to(std::move(common), degree)},
      .distance = {}};
  for (auto& point : points) {
    for (Polynomial& x : point) x = raised_to(std::move(x), degree);
  }
  for (const Corner& corner : corners(kind)) {
    auto& w = result.polygon.corners.emplace_back();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      w[axis] = points[corner.plus][axis] - points[corner.minus][axis];
    }
  }
  const BinaryFraction d = odd_fraction(distance);
  if (d.numerator != 0) {
    const int exponent = d.exponent - unit;
    result.distance = {BigInteger(d.numerator) << std::max(exponent, 0), std::max(-exponent, 0)};
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
    // Weighted coordinates and the weight, by de Casteljau's algorithm. Weights of at most 1.
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
