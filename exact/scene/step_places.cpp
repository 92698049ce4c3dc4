#include "exact/scene/step_places.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace touchstone::exact {
namespace {

constexpr int coordinate_bits = 50;

/// x·2^shift rounded down.
std::int64_t enlarged(const Rational& x, int shift) {
  const Rational scaled = x * power_of_two(shift);
  Integer result;
  mpz_fdiv_q(result.get_mpz_t(), scaled.get_num_mpz_t(), scaled.get_den_mpz_t());
  return result.get_si();
}

/// Corners at the start, then the same number at the end, up to a common translation.
struct Corners {
  std::array<Eigen::Vector3d, 8> points;
  std::size_t count = 0;

  [[nodiscard]] std::span<const Eigen::Vector3d> all() const {
    return std::span(points).first(count);
  }
};

const Eigen::Vector3d& lowest(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& d) {
  return *std::ranges::min_element(points, {}, [&](const Eigen::Vector3d& w) { return w.dot(d); });
}

/// A direction d with a positive least d·w, if Gilbert's method finds one.
std::optional<Eigen::Vector3d> nearest(std::span<const Eigen::Vector3d> points) {
  constexpr int most_iterations = 48, more_iterations = 4;
  Eigen::Vector3d x = points.front();
  for (const Eigen::Vector3d& w : points.subspan(1)) x += w;
  x /= static_cast<double>(points.size());
  int separated = 0;
  for (int n = 0; n < most_iterations && separated < more_iterations; ++n) {
    const Eigen::Vector3d& w = lowest(points, x);
    if (w.dot(x) > 0.0) ++separated;
    const Eigen::Vector3d step = w - x;
    const double square = step.squaredNorm();
    if (!(square > 0.0)) break;
    x += std::clamp(-x.dot(step) / square, 0.0, 1.0) * step;
  }
  if (separated == 0) return std::nullopt;
  return x;
}

}  // namespace

StepPlaces::StepPlaces(const fast::Motion& vertices, double greatest, const Rational& end) {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      greatest = std::max({greatest, std::abs(vertices[i].start[k]), std::abs(vertices[i].end[k])});
    }
  }
  int exponent = 0;  // greatest < 2^exponent
  std::frexp(greatest, &exponent);
  const int shift = shift_ = coordinate_bits - exponent;
  uncertainty_ = std::ldexp(8.0, -shift);
  const auto rounded_up = [&](const Rational& x) { return -enlarged(-x, shift); };
  bounds_.resize(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Rational start = vertices[i].start[k];
      const Rational last = start + end * (Rational(vertices[i].end[k]) - start);
      bounds_[i].lower[0][k] = enlarged(start, shift);
      bounds_[i].lower[1][k] = enlarged(last, shift);
      bounds_[i].upper[0][k] = rounded_up(start);
      bounds_[i].upper[1][k] = rounded_up(last);
    }
  }
}

std::int64_t StepPlaces::enlarged_distance(double distance) const {
  return -enlarged(-Rational(distance), shift_);
}

bool StepPlaces::is_above(Vertices a, Vertices b, const Direction& d, std::int64_t distance) const {
  const std::int64_t reach = distance * (std::abs(d[0]) + std::abs(d[1]) + std::abs(d[2]));
  for (std::size_t time = 0; time < 2; ++time) {
    const auto sum = [&](std::int32_t vertex, bool is_least) {
      std::int64_t result = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const bool is_lower = (d[k] > 0) == is_least;
        result += d[k] * (is_lower ? at(vertex).lower : at(vertex).upper)[time][k];
      }
      return result;
    };
    std::int64_t greatest = sum(b.front(), false);
    for (const std::int32_t w : b.subspan(1)) greatest = std::max(greatest, sum(w, false));
    for (const std::int32_t v : a) {
      if (sum(v, true) <= greatest + reach) return false;
    }
  }
  return true;
}

bool StepPlaces::is_axis_between(Vertices a, Vertices b, double distance) const {
  const std::int64_t whole = enlarged_distance(distance);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Direction d{};
    d.at(axis) = 1;
    if (is_above(a, b, d, whole) || is_above(b, a, d, whole)) return true;
  }
  return false;
}

std::optional<StepPlaces::Direction> StepPlaces::direction(Vertices a, Vertices b,
                                                           double distance) const {
  const std::int64_t whole = enlarged_distance(distance);
  Corners corners;
  for (std::size_t time = 0; time < 2; ++time) {
    const auto place = [&](std::int32_t v) {
      const Integers& x = at(v).lower[time];
      return Eigen::Vector3d(static_cast<double>(x[0]), static_cast<double>(x[1]),
                             static_cast<double>(x[2]));
    };
    for (const std::int32_t v : a) {
      for (const std::int32_t w : b) corners.points.at(corners.count++) = place(v) - place(w);
    }
  }
  const auto rounded = [&](const Eigen::Vector3d& d) -> std::optional<Direction> {
    const double greatest = d.cwiseAbs().maxCoeff();
    if (!(greatest > 0.0)) return std::nullopt;
    for (const std::int64_t size : {1, 2, 3, 5, 8, 13, 24, 44, 80, 150, 290, 550, 1023}) {
      Direction result;
      for (std::size_t k = 0; k < 3; ++k) {
        result[k] =
            std::llround(d[static_cast<Eigen::Index>(k)] / greatest * static_cast<double>(size));
      }
      if (is_above(a, b, result, whole)) return result;
    }
    return std::nullopt;
  };
  if (const auto x = nearest(corners.all())) {
    if (const auto result = rounded(*x)) return result;
  }
  // The normals at both ends and between, of three corners or more.
  const std::size_t half = corners.count / 2;
  if (half < 3) return std::nullopt;
  const auto normal = [&](std::size_t first) -> Eigen::Vector3d {
    const auto& w = corners.points;
    return (w[first + 1] - w[first]).cross(w[first + 2] - w[first]);
  };
  const Eigen::Vector3d start = normal(0), last = normal(half);
  for (const Eigen::Vector3d& n : {start, last, Eigen::Vector3d(start + last)}) {
    const Eigen::Vector3d d = corners.points.front().dot(n) < 0.0 ? Eigen::Vector3d(-n) : n;
    if (const auto result = rounded(d)) return result;
  }
  return std::nullopt;
}

}  // namespace touchstone::exact
