#include "fast/tight_inclusion/curved_box_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

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
      values[k][corner] = problem.kind == ContactKind::edge_edge
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

struct Range {
  double least = std::numeric_limits<double>::infinity();
  double greatest = -std::numeric_limits<double>::infinity();

  void add(double x) {
    least = std::min(least, x);
    greatest = std::max(greatest, x);
  }
};

/// The range of F on an axis over a box.
using RangeOf = Range(const BoxProblem& problem, const Box& box, std::size_t axis);

template <RangeOf range_of>
BoxTest test(const BoxProblem& problem, const Box& box) {
  BoxTest result{.rejected = false, .inside = true, .width = 0.0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [least, greatest] = range_of(problem, box, axis);
    const double d = problem.separation, filter = problem.filter[axis];
    if (least - d > filter || greatest + d < -filter)
      return {.rejected = true, .inside = false, .width = 0.0};
    result.inside = result.inside && greatest - d <= filter && least + d >= -filter;
    result.width = std::max(result.width, greatest - least);
  }
  return result;
}

Range range_of_values(const BoxProblem& problem, const Box& box, std::size_t axis) {
  const Values values = values_of(problem, box, axis);
  Range result;
  for (std::size_t k = 0; k <= problem.degree; ++k) {
    for (const double x : values[k]) result.add(x);
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

// ---- Rational curves ----------------------------------------------------------------------------

/// The blossom of the values of a point at k times t1 and degree − k times t0.
double blossom(const BoxProblem& problem, std::span<const double> values, std::size_t point,
               std::size_t k, double t0, double t1) {
  std::array<double, BoxProblem::greatest_curve_degree + 1> x{};
  for (std::size_t j = 0; j <= problem.degree; ++j) x.at(j) = values[moving_points * j + point];
  for (std::size_t level = 0; level < problem.degree; ++level) {
    const double t = level < k ? t1 : t0;
    for (std::size_t j = 0; j + level < problem.degree; ++j) {
      x.at(j) = x.at(j) * (1.0 - t) + x.at(j + 1) * t;
    }
  }
  return x[0];
}

Range range_of_rational(const BoxProblem& problem, const Box& box, std::size_t axis) {
  const auto& [t0, t1, u0, u1, v0, v1] = box.ends;
  std::array<Range, moving_points> x;
  for (std::size_t point = 0; point < moving_points; ++point) {
    for (std::size_t k = 0; k <= problem.degree; ++k) {
      const double at = blossom(problem, problem.control[axis], point, k, t0, t1) /
                        blossom(problem, problem.curve_weights, point, k, t0, t1);
      x.at(point).add(at);
    }
  }
  Range result;
  for (const double u : {u0, u1}) {
    for (const double v : {v0, v1}) {
      const auto f = [&](double Range::*a, double Range::*b) {
        if (problem.kind == ContactKind::edge_edge) {
          return filters::CurvedEdgeEdge<2>::from_points<double>(
              {x[0].*a, x[1].*a, x[2].*b, x[3].*b}, {1.0 - u, u, 1.0 - v, v});
        }
        // The weight of f0 is negative where a box is beyond the domain.
        const double w = (1.0 - u) - v;
        return filters::CurvedVertexFace<2>::from_points<double>(
            {x[0].*a, x[1].*(w < 0.0 ? a : b), x[2].*b, x[3].*b}, {w, u, v});
      };
      result.add(f(&Range::least, &Range::greatest));
      result.add(f(&Range::greatest, &Range::least));
    }
  }
  return result;
}

/// F changes along t by at most degree (Ω/ω)² times the steps between control points, Ω and ω the
/// greatest and the least weight ([floater1992]), along u and v by the range of the unit box.
std::array<double, 3> changes_of_rational(const BoxProblem& problem) {
  const Box unit{{0.0, 1.0, 0.0, 1.0, 0.0, 1.0}};
  const std::size_t count = moving_points * (problem.degree + 1);
  const std::span<const double> weights(problem.curve_weights.data(), count);
  const double ratio = std::ranges::max(weights) / std::ranges::min(weights);
  std::array<double, 3> result{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [least, greatest] = range_of_rational(problem, unit, axis);
    const auto at = [&](std::size_t place) {
      return problem.control[axis][place] / weights[place];
    };
    for (std::size_t place = moving_points; place < count; ++place) {
      const double step = std::abs(at(place) - at(place - moving_points));
      result[0] =
          std::max(result[0], 2.0 * static_cast<double>(problem.degree) * ratio * ratio * step);
    }
    result[1] = result[2] = std::max(result[1], greatest - least);
  }
  return result;
}

}  // namespace

const BoxKernel& rational_box_kernel() {
  static const BoxKernel kernel{.instructions = InstructionSet::scalar,
                                .digits = std::numeric_limits<double>::digits,
                                .load = nullptr,
                                .test = test<range_of_rational>,
                                .corners = nullptr,
                                .changes = changes_of_rational};
  return kernel;
}

const BoxKernel& curved_box_kernel() {
  static const BoxKernel kernel{.instructions = InstructionSet::scalar,
                                .digits = std::numeric_limits<double>::digits,
                                .load = nullptr,
                                .test = test<range_of_values>,
                                .corners = nullptr,
                                .changes = changes};
  return kernel;
}

Extent load_curves(const Queries& queries, std::size_t i, BoxProblem& problem) {
  Extent extent{.x_max = {}, .finite = true};
  problem.degree = queries.degree;
  const std::span<const double> row = queries.row(i);
  const std::size_t stride = queries.numbers_of_point();
  for (std::size_t place = 0; place < row.size(); ++place) {
    const std::size_t axis = place % stride, point = place / stride;
    const double weight = queries.is_rational ? row[stride * point + 3] : 1.0;
    extent.finite = extent.finite && std::isfinite(row[place]) && weight > 0.0;
    if (axis == 3) {
      problem.curve_weights[point] = weight;
      continue;
    }
    problem.control[axis][point] = row[place] * weight;
    extent.x_max[axis] = std::max(extent.x_max[axis], std::abs(row[place]));
  }
  return extent;
}

std::optional<std::array<double, 3>> filter_of_rational_curves(const BoxProblem& problem,
                                                               const std::array<double, 3>& x_max,
                                                               double separation) {
  constexpr double greatest = 0x1p900, least_weight = 0x1p-30, most_weight = 0x1p30;
  for (std::size_t place = 0; place < moving_points * (problem.degree + 1); ++place) {
    const double weight = problem.curve_weights[place];
    if (weight < least_weight || weight > most_weight) return std::nullopt;
  }
  std::array<double, 3> result{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double x = std::max(x_max[axis], separation);
    if (x > greatest) return std::nullopt;
    result[axis] = (16.0 * static_cast<double>(problem.degree) + 64.0) * 0x1p-53 * x + 0x1p-1000;
  }
  return result;
}

std::array<double, 3> filter_of_curves(ContactKind kind, std::size_t degree,
                                       const std::array<double, 3>& x_max, double separation) {
  static_assert(greatest_of_curves <= filters::cubic_vertex_face_separated_double.greatest_x);
  std::array<double, 3> result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double x = std::max(x_max[axis], separation);
    if (kind == ContactKind::edge_edge) {
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
