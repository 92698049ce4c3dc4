#include "exact/checker/resting_pair.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace touchstone::checker {
namespace {

Vector operator-(const Vector& a, const Vector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Vector operator*(const mpz_class& factor, const Vector& a) {
  return {factor * a[0], factor * a[1], factor * a[2]};
}

mpz_class dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

bool is_zero(const Vector& a) { return a[0] == 0 && a[1] == 0 && a[2] == 0; }

// ---- Doubles as integers ------------------------------------------------------------------------

constexpr int bits_of_double = 53;

/// The exponent e of a number below 2^e that is a multiple of 2^(e−53).
int exponent_of(double x) {
  int exponent = 0;
  std::frexp(x, &exponent);
  return exponent;
}

/// x · 2^(53−least). \pre least ≤ exponent_of(x) or x = 0
mpz_class enlarged(double x, int least) {
  if (x == 0.0) return 0;
  const int exponent = exponent_of(x);
  const mpz_class significand(std::ldexp(x, bits_of_double - exponent));
  return significand << static_cast<mp_bitcnt_t>(exponent - least);
}

// ---- Lines --------------------------------------------------------------------------------------

/// The greatest difference of two of the points, 0 if they are one point. \pre they are on a line
Vector extent(std::span<const Vector> points) {
  const auto [least, greatest] = std::ranges::minmax(points);
  return greatest - least;
}

bool are_on_line(std::span<const Vector> points, const Vector& direction) {
  return std::ranges::all_of(
      points, [&](const Vector& x) { return is_zero(cross(x - points.front(), direction)); });
}

}  // namespace

RestingPair::RestingPair(const std::vector<Motion>& vertices, const Primitive& a,
                         const Primitive& b) {
  const auto start_of = [&](std::int32_t v) -> const std::array<double, 3>& {
    return vertices[static_cast<std::size_t>(v)].start;
  };
  bool is_any = false;
  int least = 0;
  for (const Primitive& element : {a, b}) {
    for (const std::int32_t v : element.vertices) {
      for (const double x : start_of(v)) {
        if (x == 0.0) continue;
        least = is_any ? std::min(least, exponent_of(x)) : exponent_of(x);
        is_any = true;
      }
    }
  }
  const auto place_of = [&](std::int32_t v) {
    const auto& [x, y, z] = start_of(v);
    return Vector{enlarged(x, least), enlarged(y, least), enlarged(z, least)};
  };
  const auto has = [](const Primitive& element, std::int32_t v) {
    return std::ranges::find(element.vertices, v) != element.vertices.end();
  };
  for (std::size_t i = 0; i < 3; ++i) {
    a_[i] = place_of(a.vertices[i]);
    b_[i] = place_of(b.vertices[i]);
    if (has(b, a.vertices[i])) common_.push_back(a_[i]);
    are_duplicates_ = are_duplicates_ && has(b, a.vertices[i]) && has(a, b.vertices[i]);
  }
}

bool RestingPair::is_in_common_hull(const Vector& x, const mpz_class& scale) const {
  // C has at most two vertices: one of them stands at each end of the list, or between them again.
  if (common_.empty()) return false;
  const auto is_between = [&](const Vector& from, const Vector& to) {
    const Vector p = x - scale * from, q = x - scale * to;
    return is_zero(cross(p, q)) && dot(p, q) <= 0;
  };
  return std::ranges::any_of(
      common_, [&](const Vector& other) { return is_between(common_.front(), other); });
}

bool RestingPair::is_separated_by(const Vector& d) const {
  if (are_duplicates()) return false;
  const auto value = [&](const Vector& x) { return dot(d, x); };
  std::array<mpz_class, 3> of_a, of_b;
  std::ranges::transform(a_, of_a.begin(), value);
  std::ranges::transform(b_, of_b.begin(), value);
  if (common_.empty()) return std::ranges::min(of_a) > std::ranges::max(of_b);
  const mpz_class h = value(common_.front());
  const auto is_on_plane = [&](const Vector& c) { return value(c) == h; };
  if (std::ranges::min(of_a) < h || std::ranges::max(of_b) > h) return false;
  const auto is_beyond_or_common = [&](const Vector& x) {
    return !is_on_plane(x) || is_in_common_hull(x);
  };
  return std::ranges::all_of(a_, is_beyond_or_common) ||
         std::ranges::all_of(b_, is_beyond_or_common);
}

bool RestingPair::is_separated_by_first_plane() const {
  const Vector normal = cross(a_[1] - a_[0], a_[2] - a_[0]);
  return is_separated_by(normal) || is_separated_by(-1 * normal);
}

bool RestingPair::are_separated_on_lines() const {
  if (are_duplicates() || common_.empty()) return false;
  const Vector along_a = extent(a_), along_b = extent(b_);
  if (!are_on_line(a_, along_a) || !are_on_line(b_, along_b)) return false;
  if (!is_zero(cross(along_a, along_b))) return true;
  // They have a vertex in common, so they are on one line, and its points are ordered as x, then y,
  // then z.
  const auto [least_a, greatest_a] = std::ranges::minmax(a_);
  const auto [least_b, greatest_b] = std::ranges::minmax(b_);
  const auto [least, greatest] = std::ranges::minmax(common_);
  return std::max(least_a, least_b) >= least && std::min(greatest_a, greatest_b) <= greatest;
}

bool RestingPair::is_common_point(std::span<const mpz_class> of_a,
                                  std::span<const mpz_class> of_b) const {
  const auto is_negative = [](const mpz_class& weight) { return weight < 0; };
  if (std::ranges::any_of(of_a, is_negative) || std::ranges::any_of(of_b, is_negative))
    return false;
  const auto weighted = [](std::span<const mpz_class> weights, const Corners& corners) {
    std::array<mpz_class, 4> sums;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) sums[k] += weights[i] * corners[i][k];
      sums[3] += weights[i];
    }
    return sums;
  };
  const auto [ax, ay, az, alpha] = weighted(of_a, a_);
  const auto [bx, by, bz, beta] = weighted(of_b, b_);
  if (alpha == 0 || beta == 0) return false;
  const Vector x = beta * Vector{ax, ay, az};
  return x == alpha * Vector{bx, by, bz} && !is_in_common_hull(x, alpha * beta);
}

}  // namespace touchstone::checker
