#include "fast/tight_inclusion/curved_box_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "touchstone/filters/error_bounds.hpp"
#include "touchstone/filters/expressions.hpp"

namespace touchstone::fast {
namespace {

/// F on one axis at each control point of a piece of time, at the four corners of (u,v).
using Values = std::array<std::array<double, 4>, BoxProblem::greatest_curve_degree + 1>;

template <std::size_t degree>
void set_values(const BoxProblem& problem, const Box& box, std::size_t axis, Values& values) {
  const auto& [t0, t1, u0, u1, v0, v1] = box.ends;
  const auto& all = problem.control[axis];
  std::array<double, 4 * (degree + 1)> x;
  std::copy_n(all.begin(), x.size(), x.begin());
  const std::array<double, 2> u{u0, u1}, v{v0, v1};
  for (std::size_t k = 0; k <= degree; ++k) {
    std::array<double, 2 * degree> w;
    for (std::size_t level = 0; level < degree; ++level) {
      const double t = level < k ? t1 : t0;
      w[2 * level] = 1.0 - t;
      w[2 * level + 1] = t;
    }
    const std::array<double, 4> points = filters::points_on_curves<degree>(x, w);
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const double at_u = u[corner / 2], at_v = v[corner % 2];
      values[k][corner] = problem.kind == Kind::edge_edge
                              ? filters::CurvedEdgeEdge<degree>::template from_points<double>(
                                    points, {1.0 - at_u, at_u, 1.0 - at_v, at_v})
                              : filters::CurvedVertexFace<degree>::template from_points<double>(
                                    points, {(1.0 - at_u) - at_v, at_u, at_v});
    }
  }
}

Values values_of(const BoxProblem& problem, const Box& box, std::size_t axis) {
  Values values;
  if (problem.degree == 2) {
    set_values<2>(problem, box, axis, values);
  } else {
    set_values<3>(problem, box, axis, values);
  }
  return values;
}

BoxTest test(const BoxProblem& problem, const Box& box) {
  BoxTest result{.rejected = false, .inside = true, .width = 0.0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Values values = values_of(problem, box, axis);
    double least = values[0][0], greatest = values[0][0];
    for (std::size_t k = 0; k <= problem.degree; ++k) {
      for (const double x : values[k]) {
        least = std::min(least, x);
        greatest = std::max(greatest, x);
      }
    }
    const double d = problem.separation, filter = problem.filter[axis];
    if (least - d > filter || greatest + d < -filter)
      return {.rejected = true, .inside = false, .width = 0.0};
    result.inside = result.inside && greatest - d <= filter && least + d >= -filter;
    result.width = std::max(result.width, greatest - least);
  }
  return result;
}

/// The changes of F along t, u and v are at most those of its control values.
std::array<double, 3> changes(const BoxProblem& problem) {
  const Box unit{{0.0, 1.0, 0.0, 1.0, 0.0, 1.0}};
  std::array<double, 3> result{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Values f = values_of(problem, unit, axis);
    for (std::size_t k = 0; k <= problem.degree; ++k) {
      for (std::size_t corner = 0; corner < 4; ++corner) {
        if (k < problem.degree) {
          const double step = std::abs(f[k + 1][corner] - f[k][corner]);
          result[0] = std::max(result[0], static_cast<double>(problem.degree) * step);
        }
        result[1] = std::max(result[1], std::abs(f[k][corner] - f[k][corner ^ 2U]));
        result[2] = std::max(result[2], std::abs(f[k][corner] - f[k][corner ^ 1U]));
      }
    }
  }
  return result;
}

}  // namespace

const BoxKernel& curved_box_kernel() {
  static const BoxKernel kernel{.instructions = InstructionSet::scalar,
                                .digits = std::numeric_limits<double>::digits,
                                .load = nullptr,
                                .test = test,
                                .corners = nullptr,
                                .changes = changes};
  return kernel;
}

Extent load_curves(const CurvedQueries& queries, std::size_t i, BoxProblem& problem) {
  Extent extent{.x_max = {}, .finite = true};
  problem.degree = queries.degree;
  const std::span<const double> row = queries.row(i);
  for (std::size_t place = 0; place < row.size(); ++place) {
    const std::size_t axis = place % 3;
    problem.control[axis][place / 3] = row[place];
    extent.finite = extent.finite && std::isfinite(row[place]);
    extent.x_max[axis] = std::max(extent.x_max[axis], std::abs(row[place]));
  }
  return extent;
}

std::array<double, 3> filter_of_curves(Kind kind, std::size_t degree,
                                       const std::array<double, 3>& x_max, double separation) {
  static_assert(greatest_of_curves <= filters::cubic_vertex_face_separated_double.greatest_x);
  std::array<double, 3> result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double x = std::max(x_max[axis], separation);
    if (kind == Kind::edge_edge) {
      result[axis] = degree == 2 ? filters::quadratic_edge_edge_separated_double(x)
                                 : filters::cubic_edge_edge_separated_double(x);
    } else {
      result[axis] = degree == 2 ? filters::quadratic_vertex_face_separated_double(x)
                                 : filters::cubic_vertex_face_separated_double(x);
    }
  }
  return result;
}

}  // namespace touchstone::fast
