#include "touchstone/mesh.hpp"

#include <algorithm>

#include "fast/platform/floating_point_state.hpp"

namespace touchstone::fast {

Motion::Motion(std::size_t degree, bool is_rational, std::vector<double> control_points)
    : shape_{.degree = degree, .is_rational = is_rational},
      control_points_(std::move(control_points)) {
  require_degree(degree);
  const std::size_t stride = shape_.numbers_of_point(), size = (degree + 1) * stride;
  if (control_points_.size() % size != 0) {
    throw std::invalid_argument("vertices: the control points are not those of whole vertices");
  }
  const StrictFloatingPoint strict;
  vertices_.resize(control_points_.size() / size);
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const auto points = this->control_points(i);
    auto& [start, end] = vertices_[i];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      start[axis] = points[axis];
      end[axis] = points[size - stride + axis];
      if (is_straight()) continue;
      for (std::size_t at = axis; at < size; at += stride) {
        start[axis] = std::min(start[axis], points[at]);
        end[axis] = std::max(end[axis], points[at]);
      }
    }
  }
  if (is_straight()) control_points_ = {};
}

}  // namespace touchstone::fast
