// FPRF: the floating-point root finder ([provot1997]; in the interval form of E. Vouga's
// public code [vouga2010], as compared by [wang2021]).
//
// The primitives' planes, or lines, are within η of each other where D(t) = f(t)² − η²‖n(t)‖² ≤ 0,
// f being the triple product n·q that vanishes in coplanarity. Further polynomials are not
// negative while the vertex is inside the face, or the nearest points are inside the edges. The
// times at which each has its sign are found as intervals (SignSearch); their
// intersection, if not empty, is a collision at its earliest time. All computations are in double
// precision, without error bounds. η is the minimum separation; it is Euclidean, and 0 in the
// paper's table 1.
//
// **Promise.** None.
//
// **Known defects.**
//   - With η = 0, D is a square, and all its zeros double. They are computed as clusters, and a
//     collision is found only if the value in the middle of one rounds to 0 or less: false
//     negatives by chance. (Of random triangles with a collision in the middle at t=1/2, one in
//     six is missed if they translate, three in five if their vertices move independently; of
//     edges two in five.)
//   - The plane through face vertices that move differently turns by a quadratic, but the inside
//     tests treat it as linear: false negatives for deforming faces, for any η. (Of triangles with
//     independent random vertices and a collision in the middle at t=1/2, η = 1e-3, two in seven
//     are missed; none if the triangle translates.)
//   - Edges that are parallel at contact, |e × g| < 1e-8 in units of the coordinates squared, are
//     left to a handler that does not exist: false negatives. (This includes all edges of a
//     ten-thousandth.)
//   - η acts between the interiors: a vertex that passes a face's edge, or edges whose ends pass,
//     within η are false negatives.
//   - D vanishes together with n: false positives, and times too early. (The printed query H: t =
//     0.5, and contact is at 0.9.)
//   - The time is a rounded zero, which at times is later than the contact (on the public data one
//     answer in ten); callers use it as a safe time, and it is reported as toi_lower.

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "verify/baselines/method_support.hpp"
#include "verify/baselines/moving_polynomials.hpp"
#include "verify/baselines/rpoly.hpp"
#include "verify/published/published.hpp"

namespace touchstone::verify::published {
namespace {

// ---- The times in [0,1] at which a polynomial has a required sign -------------------------------

// The sign of a polynomial can only change at its zeros, so its value in the middle between
// neighbouring ones decides. Zeros come from zeros_of() (rpoly.hpp) with their real parts alone:
// those of complex pairs cut intervals too, which is harmless in exact arithmetic, and in floating
// point represents double zeros that were computed as a complex pair.

/// A closed interval of times in [0,1], of any length, 0 as well.
struct TimeInterval {
  double from;
  double to;
};

enum class WantedSign { not_negative, not_positive };

/// Real parts of zeros, ascending.
struct Breaks {
  std::array<double, baselines::most_zeros> t;
  std::size_t count = 0;

  void add(double value) { t[count++] = value; }
  void sort() { std::sort(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(count)); }
};

/// A polynomial that must not be negative.
class SignSearch {
 public:
  SignSearch(std::span<const double> coefficients, WantedSign sign) {
    double greatest = 0.0;
    for (const double c : coefficients) greatest = std::max(greatest, std::abs(c));
    const double scale = greatest == 0.0 ? 1.0 : greatest;
    for (const double c : coefficients) {
      c_[size_++] = sign == WantedSign::not_negative ? c / scale : -c / scale;
    }
    const auto left = baselines::without_leading_zeros({c_.data(), size_});
    std::copy(left.begin(), left.end(), c_.begin());
    size_ = left.size();
  }

  [[nodiscard]] std::vector<TimeInterval> run() {
    if (size_ <= 1) {
      if (size_ == 0 || c_[0] >= 0.0) return {{0.0, 1.0}};
      return {};
    }
    if (size_ > 3 && is_hopeless()) return {};
    find_breaks();
    return intervals();
  }

 private:
  /// True if the constant with all positive contributions is still negative.
  [[nodiscard]] bool is_hopeless() const {
    double greatest = c_[size_ - 1];
    for (std::size_t i = 0; i + 1 < size_; ++i) greatest += std::max(c_[i], 0.0);
    return greatest < 0.0;
  }

  void find_breaks() {
    if (size_ == 2) {
      breaks_.add(-c_[1] / c_[0]);
    } else if (size_ == 3) {
      const double discriminant = c_[1] * c_[1] - 4.0 * c_[0] * c_[2];
      if (discriminant < 0.0) return;
      const double q = -0.5 * (c_[1] + std::copysign(std::sqrt(discriminant), c_[1]));
      const double first = q / c_[0];
      const double second = c_[2] / q;
      // In this order a NaN, which is neither, stays behind the other.
      breaks_.add(second < first ? second : first);
      breaks_.add(second < first ? first : second);
    } else {
      for (const baselines::Zero& zero : baselines::zeros_of({c_.data(), size_}))
        breaks_.add(zero.re);
      breaks_.sort();
    }
  }

  [[nodiscard]] std::vector<TimeInterval> intervals() const {
    std::vector<TimeInterval> result;
    const auto test = [&](double from, double to) {
      from = std::clamp(from, 0.0, 1.0);
      to = std::clamp(to, 0.0, 1.0);
      if (value((from + to) / 2.0) >= 0.0) result.push_back({from, to});
    };
    if (breaks_.count == 0) {
      test(0.0, 1.0);
      return result;
    }
    const double first = breaks_.t[0];
    const double last = breaks_.t[breaks_.count - 1];
    if (first >= 0.0) test(0.0, first);
    for (std::size_t i = 1; i < breaks_.count; ++i) {
      const bool is_outside = breaks_.t[i] < 0.0 || breaks_.t[i - 1] > 1.0;
      if (!is_outside) test(breaks_.t[i - 1], breaks_.t[i]);
    }
    if (last <= 1.0) test(last, 1.0);
    return result;
  }

  [[nodiscard]] double value(double t) const {
    double result = c_[0];
    for (std::size_t i = 1; i < size_; ++i) result = result * t + c_[i];
    return result;
  }

  std::array<double, baselines::most_zeros + 1> c_{};  ///< the highest power's first
  std::size_t size_ = 0;
  Breaks breaks_;
};

/// The intervals, in ascending order.
///
/// The coefficients (the highest power's first) are divided by the greatest magnitude among them;
/// leading ones that are exactly 0 are omitted, tiny ones are not. From degree 3 on there are no
/// intervals if the constant together with all positive contributions is negative. A quadratic a t²
/// has a division by zero, and of its zero only that time is an interval.
std::vector<TimeInterval> sign_intervals(std::span<const double> coefficients, WantedSign sign) {
  return SignSearch(coefficients, sign).run();
}

// ---- FPRF ---------------------------------------------------------------------------------------

/// The length of a product of edges below which they count as parallel, at any scale.
constexpr double parallel_product = 1e-8;

using baselines::LinearMotion, baselines::Polynomial, baselines::VectorPolynomial;
using Intervals = std::vector<TimeInterval>;

template <std::size_t Degree>
Intervals not_negative(const Polynomial<Degree>& polynomial) {
  return sign_intervals(descending(polynomial), WantedSign::not_negative);
}

/// The times with D(t) ≤ 0, at which the plane of e and g through 0 is within η of q.
Intervals near_plane(const LinearMotion& q, const LinearMotion& e, const LinearMotion& g,
                     double eta) {
  const VectorPolynomial<2> normal = cross(e, g);
  const Polynomial<3> f = dot(q, normal);
  const Polynomial<6> distance = f * f - (eta * eta) * squared_norm(normal);
  return sign_intervals(descending(distance), WantedSign::not_positive);
}

/// e(t) × g(t) as if it were linear: its value at t=0, and the product of the velocities for a
/// velocity.
LinearMotion linearised_normal(const LinearMotion& e, const LinearMotion& g) {
  const VectorPolynomial<2> normal = cross(e, g);
  LinearMotion result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result[axis] = {{normal[axis].c[0], normal[axis].c[2]}};
  }
  return result;
}

/// A polynomial that is ≥ 0 while p is on the face's side of the edge e from corner c, in the
/// face's plane; g is the other edge there.
Polynomial<3> edge_side(const LinearMotion& p, const LinearMotion& c, const LinearMotion& e,
                        const LinearMotion& g) {
  return dot(p - c, cross(linearised_normal(e, g), e));
}

/// A polynomial that is ≥ 0 while, along α, β's start is behind γ's: the nearest point of the line
/// β to the line α is not before β's start.
Polynomial<4> end_side(const LinearMotion& alpha, const LinearMotion& beta,
                       const LinearMotion& gamma) {
  return dot(beta, alpha) * dot(gamma, alpha) - dot(alpha, alpha) * dot(gamma, beta);
}

bool overlap(const TimeInterval& a, const TimeInterval& b) {
  return a.from <= b.to && b.from <= a.to;
}

/// The earliest choice of one interval of each list, overlapping pairwise and hence all, that does
/// not overlap an interval of `forbidden`: its greatest left end. None if there is no choice.
std::optional<double> earliest_overlap(std::span<const Intervals> lists, const Intervals& forbidden,
                                       const TimeInterval& so_far = {0.0, 1.0}) {
  if (lists.empty()) {
    const auto is_forbidden = [&](const TimeInterval& other) { return overlap(so_far, other); };
    return std::ranges::any_of(forbidden, is_forbidden) ? std::nullopt : std::optional(so_far.from);
  }
  std::optional<double> earliest;
  for (const TimeInterval& interval : lists.front()) {
    if (!overlap(interval, so_far)) continue;
    const auto time =
        earliest_overlap(lists.subspan(1), forbidden,
                         {std::max(so_far.from, interval.from), std::min(so_far.to, interval.to)});
    if (time && (!earliest || *time < *earliest)) earliest = time;
  }
  return earliest;
}

std::optional<double> vertex_face_time(const Query& query, double eta) {
  const auto [p, v1, v2, v3] = baselines::motions_of(query);
  std::array<Intervals, 4> lists;
  lists[0] = not_negative(edge_side(p, v1, v3 - v1, v2 - v1));
  if (lists[0].empty()) return std::nullopt;
  lists[1] = not_negative(edge_side(p, v2, v1 - v2, v3 - v2));
  if (lists[1].empty()) return std::nullopt;
  lists[2] = not_negative(edge_side(p, v3, v2 - v3, v1 - v3));
  if (lists[2].empty()) return std::nullopt;
  lists[3] = near_plane(p - v1, v2 - v1, v3 - v1, eta);
  return earliest_overlap(lists, {});
}

/// True if the edges are parallel at that time.
bool are_parallel(const Query& query, double t) {
  const Eigen::Vector3d a =
      baselines::position_at(query, 0, t) - baselines::position_at(query, 1, t);
  const Eigen::Vector3d b =
      baselines::position_at(query, 2, t) - baselines::position_at(query, 3, t);
  return a.cross(b).norm() < parallel_product;
}

std::optional<double> edge_edge_time(const Query& query, double eta) {
  const auto [a0, a1, b0, b1] = baselines::motions_of(query);
  std::array<Intervals, 5> lists;
  Intervals parallel;
  for (const TimeInterval& near : near_plane(a1 - b1, a1 - a0, b1 - b0, eta)) {
    (are_parallel(query, (near.from + near.to) / 2.0) ? parallel : lists[0]).push_back(near);
  }
  if (lists[0].empty()) return std::nullopt;
  lists[1] = not_negative(end_side(b1 - b0, a1 - a0, a0 - b0));
  lists[2] = not_negative(end_side(b1 - b0, a0 - a1, a1 - b0));
  lists[3] = not_negative(end_side(a1 - a0, b1 - b0, b0 - a0));
  lists[4] = not_negative(end_side(a1 - a0, b0 - b1, b1 - a0));
  return earliest_overlap(lists, parallel);
}

}  // namespace

Answer fprf(ContactKind kind, const Query& query, const TouchstonePluginOptions& options) {
  const double eta = options.min_separation;
  const auto time =
      kind == ContactKind::vertex_face ? vertex_face_time(query, eta) : edge_edge_time(query, eta);
  if (!time || *time > options.t_max) return {};
  return {TOUCHSTONE_YES, *time};
}

}  // namespace touchstone::verify::published
