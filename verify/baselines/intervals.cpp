#include "verify/baselines/intervals.hpp"
#include "touchstone/mesh.hpp"

#include <algorithm>

namespace touchstone::baselines {

IntervalVector minus(const IntervalVector& a, const IntervalVector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

IntervalVector cross(const IntervalVector& a, const IntervalVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Interval dot(const IntervalVector& a, const IntervalVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

IntervalVector between(const IntervalVector& start, const IntervalVector& end,
                       const Interval& parameter) {
  IntervalVector result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result[axis] = (end[axis] - start[axis]) * parameter + start[axis];
  }
  return result;
}

IntervalMotion::IntervalMotion(const Query& query) {
  for (std::size_t point = 0; point < moving_points; ++point) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      start_[point][axis] = Interval(query.at(0, point, axis));
      displacement_[point][axis] = Interval(query.at(1, point, axis)) - start_[point][axis];
    }
  }
}

std::array<IntervalVector, moving_points> IntervalMotion::at(const Interval& t) const {
  std::array<IntervalVector, moving_points> result;
  for (std::size_t point = 0; point < moving_points; ++point) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      result[point][axis] = displacement_[point][axis] * t + start_[point][axis];
    }
  }
  return result;
}

double greatest_displacement(const Query& query) {
  double greatest = 0.0;
  for (std::size_t point = 0; point < moving_points; ++point) {
    greatest = std::max(greatest, (point_of(query, 1, point) - point_of(query, 0, point)).norm());
  }
  return greatest;
}

}  // namespace touchstone::baselines
