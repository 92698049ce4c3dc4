/// \file
/// A plugin for curves alone: yes at the first of STEPS + 1 equally spaced times at which the boxes
/// of both primitives are within the minimum separation, with the time before it as the lower
/// bound. It misses contacts between these times. With LATE the lower bound is a step too late.
/// PROMISE is one of TouchstonePromise.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "touchstone/plugin.h"

namespace {

struct Box {
  std::array<double, 3> lower;
  std::array<double, 3> upper;
};

/// x, y, z times the weight, and the weight.
using Homogeneous = std::array<double, 4>;

/// The control points of the four points, from t=0 to t=1.
using Curves = std::vector<std::array<Homogeneous, 4>>;

Curves curves_of(std::int32_t degree, bool is_rational, const double* control) {
  Curves curves(static_cast<std::size_t>(degree) + 1);
  for (auto& points : curves) {
    for (Homogeneous& point : points) {
      const double weight = is_rational ? control[3] : 1.0;
      point = {weight * control[0], weight * control[1], weight * control[2], weight};
      control += is_rational ? 4 : 3;
    }
  }
  return curves;
}

/// The four points at a time, by De Casteljau's algorithm.
std::array<Homogeneous, 4> points_at(Curves curves, double t) {
  for (; curves.size() > 1; curves.pop_back()) {
    for (std::size_t j = 0; j + 1 < curves.size(); ++j) {
      for (std::size_t i = 0; i < 16; ++i) {
        double& value = curves[j].at(i / 4).at(i % 4);
        value = (1.0 - t) * value + t * curves[j + 1].at(i / 4).at(i % 4);
      }
    }
  }
  return curves.front();
}

Box box_of(const std::array<Homogeneous, 4>& points, std::size_t first, std::size_t last) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Box box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
  for (std::size_t point = first; point < last; ++point) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double x = points.at(point).at(axis) / points.at(point)[3];
      box.lower.at(axis) = std::min(box.lower.at(axis), x);
      box.upper.at(axis) = std::max(box.upper.at(axis), x);
    }
  }
  return box;
}

bool are_near(const Box& a, const Box& b, double distance) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (a.lower.at(axis) - b.upper.at(axis) > distance) return false;
    if (b.lower.at(axis) - a.upper.at(axis) > distance) return false;
  }
  return true;
}

}  // namespace

std::int32_t touchstone_plugin_version() { return TOUCHSTONE_PLUGIN_VERSION; }

const char* touchstone_plugin_name() { return "curved_sampling"; }

void touchstone_plugin_promise(TouchstonePluginPromise* promise) { promise->promise = PROMISE; }

void touchstone_plugin_solve_curved(std::int32_t kind, std::int32_t degree,
                                    std::int32_t is_rational, const double* control,
                                    const TouchstonePluginOptions* options,
                                    TouchstonePluginAnswer* answer) {
  const std::size_t first = kind == TOUCHSTONE_VERTEX_FACE ? 1 : 2;
  const Curves curves = curves_of(degree, is_rational == 1, control);
  constexpr double step = 1.0 / STEPS;
  answer->verdict = TOUCHSTONE_NO;
  for (int i = 0; i <= STEPS; ++i) {
    const double t = i * step;
    const auto points = points_at(curves, t);
    if (!are_near(box_of(points, 0, first), box_of(points, first, 4), options->min_separation)) {
      continue;
    }
    answer->verdict = TOUCHSTONE_YES;
#ifdef LATE
    answer->toi_lower = t + step;
#else
    answer->toi_lower = std::max(0.0, t - step);
#endif
    return;
  }
}
