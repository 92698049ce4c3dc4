#include "touchstone/tight_inclusion.hpp"

#include <algorithm>
#include <limits>

#include "touchstone/filters/error_bounds.hpp"

namespace touchstone::fast {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

const filters::ErrorBound<double, 1>& derived_bound(Kind kind, bool separated) {
  if (kind == Kind::edge_edge) {
    return separated ? filters::edge_edge_separated_double : filters::edge_edge_double;
  }
  return separated ? filters::vertex_face_separated_double : filters::vertex_face_double;
}

const filters::ErrorBound<float, 1>& bound_in_float(Kind kind, bool separated) {
  if (kind == Kind::edge_edge) {
    return separated ? filters::edge_edge_separated_float : filters::edge_edge_float;
  }
  return separated ? filters::vertex_face_separated_float : filters::vertex_face_float;
}

/// The derived bound, in the precision of x. Infinite if overflow could occur.
template <class Scalar>
double evaluate(const filters::ErrorBound<Scalar, 1>& bound, Scalar x) {
  return x > bound.greatest_x ? infinity : static_cast<double>(bound(x));
}

/// The published constants ([wang2021], section 4.2 and appendix; docs/theory.md, section 4.10).
double published_constant(Kind kind, bool separated) {
  if (kind == Kind::edge_edge) return separated ? 7.105427357601002e-15 : 6.217248937900877e-15;
  return separated ? 7.549516567451064e-15 : 6.661338147750939e-15;
}

double filter_on_axis(Kind kind, double x_max, double separation, ErrorModel model) {
  const bool separated = separation > 0.0;
  const double x = std::max(x_max, separation);
  if (model == ErrorModel::single_precision) {
    return evaluate(bound_in_float(kind, separated), static_cast<float>(x));
  }
  const double derived = evaluate(derived_bound(kind, separated), x);
  if (model == ErrorModel::derived || derived == infinity) return derived;
  // The released filter ignores the separation here.
  const double gamma = model == ErrorModel::published ? std::max(x, 1.0) : std::min(x_max, 1.0);
  return published_constant(kind, separated) * gamma * gamma * gamma;
}

}  // namespace

std::array<double, 3> error_filter(Kind kind, const std::array<double, 3>& x_max, double distance,
                                   ErrorModel model) {
  require_contact(kind);
  std::array<double, 3> result{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result[axis] = filter_on_axis(kind, x_max[axis], distance, model);
  }
  return result;
}

}  // namespace touchstone::fast
