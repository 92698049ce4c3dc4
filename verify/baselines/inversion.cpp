// INVERSION_CUBIC and INVERSION_ADDITIVE: when a cell loses its volume, in floating point, as
// line searches of injective maps and simulators of solids ask it. docs/methods.md, section 4.
//
// Six times the volume V is a cubic in t; for a triangle in the plane twice the area, a quadratic.
//
// - *Cubic* ([smith2015]): its coefficients, then its real zeros by the closed formulas, with
//   cosines where there are three. A leading coefficient of at most 1e-10 counts as 0. The least
//   zero in [0,1] is the time.
// - *Additive* ([li2021], there of distances): from t, where V is positive, V stays so for V / L
//   more, L being a bound of the change of V per unit of time from the lengths of edges; so t
//   advances by that, until V is at most δ (fast::MethodOptions::tolerance).
//
// **Promise.** None: nothing bounds the rounding. Times are estimates of the one, and bounds from
// below of the other. Both take cells of a positive volume at t=0.
//
// **Known defects.** Both look at numbers of absolute size: small cells have zero volume or no
// zeros. Where V touches 0 the discriminant is a rounding error, so every other such inversion is
// missed; in the other method V is then above δ if coordinates are large, and it goes on behind
// the time. Far from the origin, or for flat cells, V itself is a rounding error.

#include "verify/baselines/baselines.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "touchstone/cell.hpp"
#include "touchstone/mesh.hpp"
#include "verify/baselines/method_support.hpp"
#include "verify/baselines/moving_polynomials.hpp"

namespace touchstone::baselines {
namespace {

/// Leading coefficients of at most this count as 0.
constexpr double leading_tolerance = 1e-10;

std::vector<double> zeros_of_quadratic(double c, double b, double a) {
  if (std::abs(a) <= leading_tolerance) {
    return std::abs(b) <= leading_tolerance ? std::vector<double>{} : std::vector<double>{-c / b};
  }
  const double discriminant = b * b - 4.0 * a * c;
  if (discriminant < 0.0) return {};
  const double root = std::sqrt(discriminant);
  return {(-b - root) / (2.0 * a), (-b + root) / (2.0 * a)};
}

/// By Cardano's formula, and Viète's where there are three.
std::vector<double> zeros_of(const Polynomial<3>& f) {
  const auto& [c0, c1, c2, c3] = f.c;
  if (std::abs(c3) <= leading_tolerance) return zeros_of_quadratic(c0, c1, c2);
  const double a = c2 / c3, b = c1 / c3, c = c0 / c3;
  const double q = (a * a - 3.0 * b) / 9.0, r = (2.0 * a * a * a - 9.0 * a * b + 27.0 * c) / 54.0;
  const double shift = a / 3.0;
  if (r * r < q * q * q) {
    const double angle = std::acos(std::clamp(r / std::sqrt(q * q * q), -1.0, 1.0));
    const auto zero = [&](double turns) {
      return -2.0 * std::sqrt(q) * std::cos((angle + 2.0 * std::numbers::pi * turns) / 3.0) - shift;
    };
    return {zero(0.0), zero(1.0), zero(-1.0)};
  }
  const double u = -std::copysign(std::cbrt(std::abs(r) + std::sqrt(r * r - q * q * q)), r);
  return {u + (u == 0.0 ? 0.0 : q / u) - shift};
}

double volume_at(const Query& query, double t) {
  const Eigen::Vector3d a = position_at(query, 0, t);
  return (position_at(query, 1, t) - a)
      .dot((position_at(query, 2, t) - a).cross(position_at(query, 3, t) - a));
}

/// A bound of the change of the volume per unit of time: one edge from a changes, the others are
/// not longer than at an end.
double greatest_change(const Query& query) {
  std::array<double, 3> change{}, length{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d start = point_of(query, 0, i + 1) - point_of(query, 0, 0);
    const Eigen::Vector3d end = point_of(query, 1, i + 1) - point_of(query, 1, 0);
    change.at(i) = (end - start).norm();
    length.at(i) = std::max(start.norm(), end.norm());
  }
  return change[0] * length[1] * length[2] + length[0] * change[1] * length[2] +
         length[0] * length[1] * change[2];
}

constexpr fast::Terms terms_of(fast::Times times) {
  return {.contacts = {}, .cells = fast::all_cells, .starts_apart = 0.0, .times = times};
}

fast::Answer inversion_cubic(CellKind kind, const Query& query,
                             const fast::MethodOptions& options) {
  const auto [a, b, c, d] = motions_of(to_tetrahedron(kind, query));
  double first = 2.0;
  for (const double t : zeros_of(dot(b - a, cross(c - a, d - a)))) {
    if (t >= 0.0) first = std::min(first, t);
  }
  if (first > options.t_max) return {.verdict = fast::Verdict::no};
  return {.verdict = fast::Verdict::yes, .toi_lower = first};
}

fast::Answer inversion_additive(CellKind kind, const Query& query,
                                const fast::MethodOptions& options) {
  const Query cell = to_tetrahedron(kind, query);
  const double change = greatest_change(cell);
  double t = 0.0;
  for (std::int64_t steps = 1; t <= options.t_max; ++steps) {
    const double volume = volume_at(cell, t), next = t + volume / change;
    if (volume <= options.tolerance || next == t || steps == options.max_checks) {
      return {.verdict = fast::Verdict::yes, .checks = to_checks(steps), .toi_lower = t};
    }
    t = next;
  }
  return {.verdict = fast::Verdict::no};
}

}  // namespace

std::unique_ptr<fast::Method> inversion_cubic_method() {
  return baseline_method({.name = "inversion_cubic",
                          .terms = terms_of(fast::Times::estimates),
                          .reference = "smith2015"},
                         on_lines<inversion_cubic>);
}

std::unique_ptr<fast::Method> inversion_additive_method() {
  return baseline_method({.name = "inversion_additive",
                          .terms = terms_of(fast::Times::bounds),
                          .reference = "li2021",
                          .is_tolerance_driven = true},
                         on_lines<inversion_additive>);
}

}  // namespace touchstone::baselines
