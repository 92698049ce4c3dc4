#include "fast/certified/exact/closest_point_parameters.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace touchstone::fast::exact_stage {
namespace {

/// a·b. Eigen's order of addition depends on the processor.
double dot(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The length, without underflow.
double length(const Eigen::Vector3d& a) {
  const double greatest = a.cwiseAbs().maxCoeff();
  if (greatest == 0.0) return 0.0;
  const Eigen::Vector3d scaled = a / greatest;
  return greatest * std::sqrt(dot(scaled, scaled));
}

/// r − u p − v q.
struct Polygon {
  ContactKind kind;
  Eigen::Vector3d r, p, q;

  [[nodiscard]] Eigen::Vector3d at(const Parameters& x) const { return r - x.u * p - x.v * q; }
};

/// The vectors at time t, scaled.
Polygon polygon_at(ContactKind kind, const Query& query, double t) {
  const auto [start, end] = scaled_vectors(kind, query);
  return {kind, (1.0 - t) * start.r + t * end.r, (1.0 - t) * start.p + t * end.p,
          (1.0 - t) * start.q + t * end.q};
}

/// Keeps the best of the points of the domain that are considered.
class Search {
 public:
  Search(const Polygon& polygon, Norm norm) : polygon_(polygon), norm_(norm) {}

  /// Takes a point if it is better. Ignores NaN and points outside by more than rounding.
  void consider(const Parameters& x) {
    constexpr double slack = 0x1p-40;
    const double farthest =
        polygon_.kind == ContactKind::vertex_face ? x.u + x.v : std::max(x.u, x.v);
    if (!(std::min(x.u, x.v) >= -slack && farthest <= 1.0 + slack)) return;
    const Eigen::Vector3d f = polygon_.at(x);
    const double distance = norm_ == Norm::l2 ? length(f) : f.cwiseAbs().maxCoeff();
    if (distance >= least_) return;
    least_ = distance;
    best_ = x;
  }

  [[nodiscard]] const Parameters& best() const { return best_; }

 private:
  const Polygon& polygon_;
  Norm norm_;
  double least_ = std::numeric_limits<double>::infinity();
  Parameters best_;
};

/// A side from `from` to `to`, in the domain.
struct DomainSide {
  Parameters from, to;

  [[nodiscard]] Parameters at(double s) const {
    return {(1.0 - s) * from.u + s * to.u, (1.0 - s) * from.v + s * to.v};
  }
};

/// The sides between neighbouring corners; a triangle's fourth is the point (0,0).
constexpr std::array<DomainSide, 4> sides_between(std::span<const Corner> all) {
  const auto parameters = [&](std::size_t i) {
    const Corner& corner = all[i % all.size()];
    return Parameters{static_cast<double>(corner.u), static_cast<double>(corner.v)};
  };
  std::array<DomainSide, 4> result;
  for (std::size_t i = 0; i < all.size(); ++i) result[i] = {parameters(i), parameters(i + 1)};
  return result;
}

std::array<DomainSide, 4> sides(ContactKind kind) {
  constexpr auto of_face = sides_between(vertex_face_corners);
  constexpr auto of_edges = sides_between(edge_edge_corners);
  return kind == ContactKind::vertex_face ? of_face : of_edges;
}

/// Solves the rows a · (u,v) = b.
Parameters solve(const std::array<Eigen::Vector3d, 2>& rows) {
  const double determinant = rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0];
  return {(rows[0][2] * rows[1][1] - rows[0][1] * rows[1][2]) / determinant,
          (rows[0][0] * rows[1][2] - rows[0][2] * rows[1][0]) / determinant};
}

void search_euclidean(const Polygon& polygon, Search& search) {
  const Eigen::Vector3d &r = polygon.r, &p = polygon.p, &q = polygon.q;
  const Eigen::Vector3d n = p.cross(q);
  const double square = dot(n, n);
  search.consider({dot(n, r.cross(q)) / square, dot(n, p.cross(r)) / square});
  for (const DomainSide& side : sides(polygon.kind)) {
    const Eigen::Vector3d start = polygon.at(side.from), step = polygon.at(side.to) - start;
    const double s = -dot(start, step) / dot(step, step);
    search.consider(side.at(s >= 0.0 ? std::min(s, 1.0) : 0.0));
  }
}

/// The lines on which component i and `sign` times component k of F are equal, for all pairs that
/// differ; i = k and sign = −1 gives the line on which component i is 0.
template <class Visit>
void visit_equalities(Visit&& visit) {
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index k = i; k < 3; ++k) {
      for (const double sign : {1.0, -1.0}) {
        if (i != k || sign < 0.0) visit(i, k, sign);
      }
    }
  }
}

void search_greatest_component(const Polygon& polygon, Search& search) {
  const Eigen::Vector3d &r = polygon.r, &p = polygon.p, &q = polygon.q;
  const auto row = [&](Eigen::Index i, Eigen::Index k, double sign) {
    return Eigen::Vector3d(p[i] - sign * p[k], q[i] - sign * q[k], r[i] - sign * r[k]);
  };
  for (const double first : {1.0, -1.0}) {
    for (const double second : {1.0, -1.0}) {
      search.consider(solve({row(0, 1, first), row(0, 2, second)}));
    }
  }
  for (const DomainSide& side : sides(polygon.kind)) {
    search.consider(side.from);
    const Eigen::Vector3d start = polygon.at(side.from), step = polygon.at(side.to) - start;
    visit_equalities([&](Eigen::Index i, Eigen::Index k, double sign) {
      search.consider(side.at(-(start[i] - sign * start[k]) / (step[i] - sign * step[k])));
    });
  }
}

}  // namespace

std::array<AffineVectors, 2> scaled_vectors(ContactKind kind, const Query& query) {
  double largest = 0.0;
  for (const double x : query.coordinates) largest = std::max(largest, std::abs(x));
  int exponent = 0;
  std::frexp(largest, &exponent);
  const auto scaled = [&](double x) { return std::ldexp(x, -exponent); };
  const auto vectors = affine_vectors(kind);
  const auto at = [&](std::size_t end) -> AffineVectors {
    const auto point = [&](std::size_t k) {
      return Eigen::Vector3d(query.at(end, k, 0), query.at(end, k, 1), query.at(end, k, 2))
          .unaryExpr(scaled)
          .eval();
    };
    const auto vector = [&](const std::array<std::size_t, 2>& points) -> Eigen::Vector3d {
      return point(points[0]) - point(points[1]);
    };
    return {vector(vectors[0]), vector(vectors[1]), vector(vectors[2])};
  };
  return {at(0), at(1)};
}

Parameters inside_domain(ContactKind kind, Parameters x) {
  constexpr double least = 0x1p-200;  // smaller values count as 0: no sum is subnormal
  for (double* const one : {&x.u, &x.v}) *one = *one >= least ? std::min(*one, 1.0) : 0.0;
  if (kind == ContactKind::edge_edge) return x;
  double rest = 1.0 - x.u;  // exact, or rounded within [1/2, 1]; there 1 − rest is exact
  if (1.0 - rest < x.u) rest = std::bit_cast<double>(std::bit_cast<std::uint64_t>(rest) - 1);
  x.v = std::min(x.v, rest);
  return x;
}

Parameters nearest_parameters(ContactKind kind, const Query& query, double t, Norm norm) {
  const Polygon polygon = polygon_at(kind, query, t);
  Search search(polygon, norm);
  if (norm == Norm::l2) {
    search_euclidean(polygon, search);
  } else {
    search_greatest_component(polygon, search);
  }
  return search.best();
}

}  // namespace touchstone::fast::exact_stage
