#include "touchstone/tight_inclusion.hpp"

#include <algorithm>
#include <limits>

#include "touchstone/filters/error_bounds.hpp"

namespace touchstone::fast {
namespace {

const filters::ErrorBound<double, 1>& derived_bound(ContactKind kind, bool separated) {
  if (kind == ContactKind::edge_edge) {
    return separated ? filters::edge_edge_separated_double : filters::edge_edge_double;
  }
  return separated ? filters::vertex_face_separated_double : filters::vertex_face_double;
}

}  // namespace

std::array<double, 3> error_filter(ContactKind kind, const std::array<double, 3>& x_max,
                                   double distance) {
  const filters::ErrorBound<double, 1>& bound = derived_bound(kind, distance > 0.0);
  std::array<double, 3> result{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double x = std::max(x_max[axis], distance);
    result[axis] = x > bound.greatest_x ? std::numeric_limits<double>::infinity() : bound(x);
  }
  return result;
}

}  // namespace touchstone::fast
