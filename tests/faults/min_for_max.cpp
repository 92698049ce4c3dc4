/// \file
/// A plugin with a known fault: an inclusion-based solver of the usual sort, whose numerical filter
/// is a constant times γ³ with γ = min(x_max, 1) instead of max. (The public Tight-Inclusion has
/// had this fault since 2022: verify/published/tight_inclusion_filters.hpp.)
///
/// The rest is right: it halves boxes of (t,u,v), earliest time first, drops those whose corner
/// values are all beyond the filter on one side of an axis, and says yes at the first small box.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <queue>
#include <vector>

#include "touchstone/plugin.h"

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

using PerAxis = std::array<double, 3>;

/// [lower, upper] of t, u and v.
struct Box {
  PerAxis lower{0.0, 0.0, 0.0};
  PerAxis upper{1.0, 1.0, 1.0};
};

struct Later {
  bool operator()(const Box& a, const Box& b) const { return a.lower[0] > b.lower[0]; }
};

/// The least and the greatest corner value of F on an axis.
struct Bounds {
  double least;
  double greatest;
};

class Solver {
 public:
  Solver(std::int32_t kind, const double* coordinates, const TouchstonePluginOptions& options)
      : is_vertex_face_(kind == TOUCHSTONE_VERTEX_FACE), x_(coordinates), options_(options) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double greatest = options.min_separation;
      for (std::size_t i = axis; i < 24; i += 3) greatest = std::max(greatest, std::abs(x_[i]));
      const double gamma = std::min(greatest, 1.0);
      filter_[axis] = 7.6e-15 * gamma * gamma * gamma;
    }
  }

  void solve(TouchstonePluginAnswer& answer) {
    std::priority_queue<Box, std::vector<Box>, Later> boxes;
    boxes.push({});
    answer.verdict = TOUCHSTONE_NO;
    for (std::int64_t checks = 0; !boxes.empty(); ++checks) {
      const Box box = boxes.top();
      boxes.pop();
      double width = 0.0;
      if (is_free(box, width)) continue;
      const std::size_t axis = widest_axis(box);
      const bool is_over = checks >= most_checks || box.upper[axis] - box.lower[axis] < 0x1p-45;
      if (width <= options_.tolerance || is_over) {
        answer.verdict = TOUCHSTONE_YES;
        answer.toi_lower = box.lower[0];
        return;
      }
      split(box, axis, boxes);
    }
  }

 private:
  static constexpr std::int64_t most_checks = 2000;

  static double blend(double a, double b, double s) { return (1.0 - s) * a + s * b; }

  /// F on an axis.
  [[nodiscard]] double value(std::size_t axis, double t, double u, double v) const {
    const auto at = [&](std::size_t i) {
      return blend(x_[3 * i + axis], x_[12 + 3 * i + axis], t);
    };
    if (is_vertex_face_) return at(0) - ((1.0 - u - v) * at(1) + u * at(2) + v * at(3));
    return blend(at(0), at(1), u) - blend(at(2), at(3), v);
  }

  [[nodiscard]] Bounds bounds(const Box& box, std::size_t axis) const {
    Bounds result{infinity, -infinity};
    for (const double t : {box.lower[0], box.upper[0]}) {
      for (const double u : {box.lower[1], box.upper[1]}) {
        for (const double v : {box.lower[2], box.upper[2]}) {
          const double f = value(axis, t, u, v);
          result = {std::min(result.least, f), std::max(result.greatest, f)};
        }
      }
    }
    return result;
  }

  [[nodiscard]] bool is_free(const Box& box, double& width) const {
    if (is_vertex_face_ && box.lower[1] + box.lower[2] > 1.0) return true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Bounds f = bounds(box, axis);
      const double enough = filter_[axis] + options_.min_separation;
      if (f.least > enough || f.greatest < -enough) return true;
      width = std::max(width, f.greatest - f.least);
    }
    return false;
  }

  static std::size_t widest_axis(const Box& box) {
    std::size_t widest = 0;
    for (std::size_t axis = 1; axis < 3; ++axis) {
      if (box.upper[axis] - box.lower[axis] > box.upper[widest] - box.lower[widest]) widest = axis;
    }
    return widest;
  }

  template <class Boxes>
  static void split(const Box& box, std::size_t axis, Boxes& boxes) {
    Box first = box, second = box;
    first.upper[axis] = second.lower[axis] = 0.5 * (box.lower[axis] + box.upper[axis]);
    boxes.push(first);
    boxes.push(second);
  }

  bool is_vertex_face_;
  const double* x_;
  const TouchstonePluginOptions& options_;
  PerAxis filter_{};
};

}  // namespace

std::int32_t touchstone_plugin_version() { return TOUCHSTONE_PLUGIN_VERSION; }

const char* touchstone_plugin_name() { return "min_for_max"; }

void touchstone_plugin_solve(std::int32_t kind, const double* coordinates,
                             const TouchstonePluginOptions* options,
                             TouchstonePluginAnswer* answer) {
  Solver(kind, coordinates, *options).solve(*answer);
}
