/// \file
/// A map of the plane that stays injective. A square sheet, a micrometre wide, is clamped on its
/// left, and a spring pulls its right side across it. Gradient steps lower the energy of the sheet
/// (the symmetric Dirichlet energy) and of the spring; each ends before a triangle turns over: at
/// the exact time, or at the root of the usual closed formula, which takes coefficients below
/// 1e-10 for 0.

#include <touchstone/step.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <vector>

using namespace touchstone;
using Places = Eigen::MatrixX3d;  // in the plane z = 0
using Limit = double (*)(const Places&, const Places&, const std::vector<fast::Face>&);

double exact_limit(const Places& x, const Places& end, const std::vector<fast::Face>& faces) {
  double limit = 1.0;
  for (const auto& each : fast::Step(x, end, {.plane_triangles = faces}).inversions()) {
    limit = std::min(limit, each.toi_lower);
  }
  return limit;
}

double epsilon_limit(const Places& x, const Places& end, const std::vector<fast::Face>& faces) {
  constexpr double epsilon = 1e-10;
  const auto cross = [](const auto& p, const auto& q) { return p.x() * q.y() - p.y() * q.x(); };
  double limit = 1.0;
  for (const auto& [i, j, k] : faces) {
    const Eigen::RowVector3d p = x.row(j) - x.row(i), q = x.row(k) - x.row(i);
    const Eigen::RowVector3d u = end.row(j) - end.row(i) - p, v = end.row(k) - end.row(i) - q;
    const double a = cross(u, v), b = cross(p, v) + cross(u, q), c = cross(p, q);
    double root = 1.0;
    if (std::abs(a) > epsilon) {
      const double d = b * b - 4 * a * c;
      if (d >= 0) root = 2 * c / (-b + std::sqrt(d));
    } else if (std::abs(b) > epsilon) {
      root = -c / b;
    }
    if (root > 0) limit = std::min(limit, root);
  }
  return limit;
}

/// The energy and, if asked for, its gradient.
double energy(const Places& rest, const Places& x, const std::vector<fast::Face>& faces, int side,
              Places* gradient) {
  double sum = 0;
  if (gradient != nullptr) *gradient = Places::Zero(x.rows(), 3);
  for (const auto& [i, j, k] : faces) {
    Eigen::Matrix2d start, now, cofactor;
    start << (rest.row(j) - rest.row(i)).head<2>().transpose(),
        (rest.row(k) - rest.row(i)).head<2>().transpose();
    now << (x.row(j) - x.row(i)).head<2>().transpose(), (x.row(k) - x.row(i)).head<2>().transpose();
    const Eigen::Matrix2d inverse = start.inverse(), map = now * inverse;
    const double det = map.determinant(), stretch = map.squaredNorm(), area = start.determinant();
    sum += area * stretch * (1 + 1 / (det * det));
    if (gradient == nullptr) continue;
    cofactor << map(1, 1), -map(1, 0), -map(0, 1), map(0, 0);
    const Eigen::Matrix2d slope =
        2 * area * (map * (1 + 1 / (det * det)) - stretch / (det * det * det) * cofactor) *
        inverse.transpose();
    gradient->row(j).head<2>() += slope.col(0).transpose();
    gradient->row(k).head<2>() += slope.col(1).transpose();
    gradient->row(i).head<2>() -= (slope.col(0) + slope.col(1)).transpose();
  }
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    if (i % side != side - 1) continue;  // not on the right
    const Eigen::RowVector3d pull = x.row(i) - Eigen::RowVector3d(-rest(i, 0), rest(i, 1), 0);
    sum += pull.squaredNorm();
    if (gradient != nullptr) gradient->row(i) += 2 * pull;
  }
  return sum;
}

std::size_t count_inverted(const Places& x, const std::vector<fast::Face>& faces) {
  return fast::Step(x, x, {.plane_triangles = faces}).inversions().size();
}

std::size_t turned_over(Limit limit, double width) {
  constexpr int side = 9;
  Places rest(side * side, 3);
  std::vector<fast::Face> faces;
  for (int i = 0; i < side * side; ++i) {
    rest.row(i) << width * (i % side) / (side - 1), width * (i / side) / (side - 1), 0;
    if (i % side + 1 == side || i / side + 1 == side) continue;
    faces.push_back({i, i + 1, i + side + 1});
    faces.push_back({i, i + side + 1, i + side});
  }
  Places x = rest, gradient;
  for (int step = 0; step < 200; ++step) {
    const double before = energy(rest, x, faces, side, &gradient);
    for (int i = 0; i < side * side; i += side) gradient.row(i).setZero();  // clamped
    Places direction = -gradient * (width / gradient.cwiseAbs().maxCoeff());
    double size = std::min(1.0, 0.9 * limit(x, x + direction, faces));
    Places next = x + size * direction;
    // A step ends at rounded places, so its own motion counts.
    while (energy(rest, next, faces, side, nullptr) > before || limit(x, next, faces) < 1.0) {
      size /= 2;
      if (size < 1e-12) return count_inverted(x, faces);
      next = x + size * direction;
    }
    x = next;
  }
  return count_inverted(x, faces);
}

int main() {
  std::printf("turned over: %zu by the formula, %zu by exact times\n",
              turned_over(epsilon_limit, 1e-6), turned_over(exact_limit, 1e-6));
}
