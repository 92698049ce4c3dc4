#include "verify/judge/claimed_distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "fast/certified/exact/closest_point_parameters.hpp"
#include "touchstone/filters/expressions.hpp"

namespace touchstone::verify::judge {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double greatest_unscaled = 0x1p1016;

double up(double x) { return std::nextafter(x, infinity); }

std::array<double, 3> greatest_coordinates(const Query& query) {
  std::array<double, 3> greatest{};
  for (std::size_t i = 0; i < query.coordinates.size(); ++i) {
    greatest.at(i % 3) = std::max(greatest.at(i % 3), std::abs(query.coordinates.at(i)));
  }
  return greatest;
}

/// A weight close to x for which 1 − x and sums of two weights are exact: a multiple of 2^-52 in
/// [0,1].
double weight(double x) { return std::clamp((x + 1.0) - 1.0, 0.0, 1.0); }

/// F on one axis, up to the filter. \pre all are weights, and u + v ≤ 1 if need be.
double value_on_axis(ContactKind kind, const Query& query, std::size_t axis, double t, double u,
                     double v) {
  std::array<double, query_points> x{};
  for (std::size_t i = 0; i < x.size(); ++i) x.at(i) = query.coordinates.at(3 * i + axis);
  if (kind == ContactKind::vertex_face) {
    return filters::VertexFace::evaluate<double>(x, {1.0 - t, t, 1.0 - u - v, u, v});
  }
  return filters::EdgeEdge::evaluate<double>(x, {1.0 - t, t, 1.0 - u, u, 1.0 - v, v});
}

Separation stated_distance(const fast::Answer& answer, const Separation& separation) {
  const double sum = answer.tolerance + separation.distance;
  // The sum with 0, the claim of exact solvers, is exact.
  const bool is_exact = answer.tolerance == 0.0 || separation.distance == 0.0;
  return {.distance = is_exact ? sum : up(sum), .norm = separation.norm};
}

Separation tight_inclusion_distance(ContactKind kind, const Query& query,
                                    const fast::Answer& answer, double separation,
                                    fast::ErrorFilter filter) {
  const std::array<double, 3> x_max = greatest_coordinates(query);
  if (std::max(std::ranges::max(x_max), separation) > greatest_unscaled) {
    return {.distance = infinity, .norm = Norm::linf};
  }
  const double greatest = std::ranges::max(filter(kind, x_max, separation));
  return {.distance = up(up(up(answer.tolerance) + separation) + 2.0 * greatest),
          .norm = Norm::linf};
}

}  // namespace

Separation claimed_distance(fast::ErrorFilter filter, ContactKind kind, const Query& query,
                            const fast::Answer& answer, const Separation& separation) {
  if (std::isnan(answer.tolerance)) return {.distance = infinity, .norm = separation.norm};
  if (filter == nullptr) return stated_distance(answer, separation);
  return tight_inclusion_distance(kind, query, answer, separation.distance, filter);
}

bool is_seen_within(ContactKind kind, const Query& query, double t, double distance) {
  if (!(t >= 0.0 && t <= 1.0)) return false;
  const std::array<double, 3> x_max = greatest_coordinates(query);
  if (std::ranges::max(x_max) > greatest_unscaled) return false;
  const std::array<double, 3> filter = fast::error_filter(kind, x_max, 0.0);
  const double time = weight(t);
  const auto is_within = [&](Norm norm) {
    const auto nearest = fast::exact_stage::nearest_parameters(kind, query, time, norm);
    const double u = weight(nearest.u), free = kind == ContactKind::vertex_face ? 1.0 - u : 1.0;
    const double v = std::min(weight(nearest.v), free);
    const auto is_within_on = [&](std::size_t axis) {
      const double value = std::abs(value_on_axis(kind, query, axis, time, u, v));
      return up(value + filter.at(axis)) <= distance;
    };
    return is_within_on(0) && is_within_on(1) && is_within_on(2);
  };
  // The closest points in L2 are faster to find, and mostly sufficient.
  return is_within(Norm::l2) || is_within(Norm::linf);
}

}  // namespace touchstone::verify::judge
