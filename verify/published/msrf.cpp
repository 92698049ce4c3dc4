// MSRF: the minimum-separation root finder ([harmon2011], [lu2019]; as compared by
// [wang2021]).
//
// At a first contact within h the distance of two features is h. For each pair of features that is
// a polynomial equation: degree 6 for a vertex and the face or two edges (f(t)² = h²‖n(t)‖²), 4
// for a vertex and the line of an edge, 2 for two vertices. The real zeros in [0,1] are
// candidates; at each, the points are moved there and the distance of the primitives is computed
// (closest_features.hpp). The earliest with a square s of |s| ≤ h² + 0.1 h is the impact. For two
// edges only the lines' equation is solved. All computations are in double precision, without
// error bounds.
//
// h is the minimum separation, or 1e-8 if that is 0, as in the
// benchmark's harness. It is Euclidean.
//
// **Promise.** None.
//
// **Known defects.**
//   - s is a squared length and 0.1 h a length: the reach is √(h² + 0.1 h), 3.2e-5 for h = 1e-8,
//     in any unit. A pass within it is a false positive.
//   - For h → 0 the zeros of degree 6 are nearly double, and are computed as complex pairs, which
//     are not candidates: false negatives. (Of triangles of random vertices with a collision in
//     the middle at t=1/2, nearly all are missed at h = 1e-100, about one in twenty at 1e-8,
//     hardly any at 1e-2. The printed query H is missed for h ≤ 1e-16.)
//   - Pairs within h from the start have no zero, and are missed; so is motion in a plane at that
//     distance.
//   - The candidates of two edges are only those of their lines: contacts of ends, and parallel or
//     collinear edges, are false negatives.
//   - One of the quick tests for a polynomial of degree 6 without a zero omits its coefficients
//     from t⁴ on: false negatives. Another takes coefficients that are all 0 or positive for a
//     polynomial without a zero in [0,1], though t = 0 may be one: contact at the start is missed.
//   - The time is a rounded zero, which at times is later than the contact; callers use it as a
//     safe time, and it is reported as toi_lower.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "verify/baselines/method_support.hpp"
#include "verify/baselines/moving_polynomials.hpp"
#include "verify/baselines/rpoly.hpp"
#include "verify/published/published.hpp"

namespace touchstone::verify::published {
namespace {

using baselines::LinearMotion, baselines::Polynomial, baselines::VectorPolynomial;

/// The value of h if no separation is requested.
constexpr double default_separation = 1e-8;

/// The quick tests before the polynomial of degree 6 is solved: true if it has no zero in [0,1] by
/// its coefficients, the constant first; sometimes wrong, as above.
bool rules_out_zeros(std::span<const double, 7> c) {
  const auto is_negative = [](double x) { return x < 0.0; };
  if (std::ranges::none_of(c, is_negative) || std::ranges::all_of(c, is_negative)) return true;
  const auto magnitude_from = [&](std::size_t first) {
    double sum = 0.0;
    for (std::size_t i = first; i < c.size(); ++i) sum += std::abs(c[i]);
    return sum;
  };
  if (std::abs(c[0]) > magnitude_from(1)) return true;
  double slope = 0.0;
  for (std::size_t i = 2; i < c.size(); ++i) slope += static_cast<double>(i) * std::abs(c[i]);
  if (c[0] * c[1] < 0.0 && std::abs(c[1]) > slope && c[0] * (c[0] + c[1] + c[2] + c[3]) > 0.0) {
    return true;
  }
  double sum = c[0];
  for (std::size_t m = 1; m < c.size() - 1 && c[0] * c[m] > 0.0; ++m) {
    sum += c[m];
    if (std::abs(sum) > magnitude_from(m + 1)) return true;
  }
  return false;
}

/// Candidate times, in the order of discovery.
class CandidateTimes {
 public:
  /// Adds the zeros in [0,1] that were computed as real.
  template <std::size_t Degree>
  void add_zeros(const Polynomial<Degree>& polynomial) {
    const auto coefficients = descending(polynomial);
    const auto left = baselines::without_leading_zeros(coefficients);
    if (left.empty()) return;
    for (const baselines::Zero& zero : baselines::zeros_of(left)) {
      if (zero.im == 0.0 && zero.re >= 0.0 && zero.re <= 1.0) times_.push_back(zero.re);
    }
  }

  /// Adds those of the squared distance of q and the plane of e and g, less h² (times what e × g is
  /// squared).
  void add_plane(const LinearMotion& q, const LinearMotion& e, const LinearMotion& g, double h) {
    const VectorPolynomial<2> normal = cross(e, g);
    const Polynomial<3> f = dot(q, normal);
    const Polynomial<6> distance = f * f - (h * h) * squared_norm(normal);
    if (!rules_out_zeros(distance.c)) add_zeros(distance);
  }

  [[nodiscard]] const std::vector<double>& times() const { return times_; }

 private:
  std::vector<double> times_;
};

CandidateTimes vertex_face_candidates(const Query& query, double h) {
  const auto [p, v1, v2, v3] = baselines::motions_of(query);
  CandidateTimes candidates;
  candidates.add_plane(p - v1, v2 - v1, v3 - v1, h);
  const std::array<LinearMotion, 3> face{v1, v2, v3};
  const Polynomial<0> square{{h * h}};
  for (std::size_t i = 0; i < 3; ++i) {
    const LinearMotion to_vertex = p - face[i];
    const LinearMotion edge = face[(i + 1) % 3] - face[i];
    candidates.add_zeros(squared_norm(to_vertex) - square);
    candidates.add_zeros(squared_norm(cross(to_vertex, edge)) - square * squared_norm(edge));
  }
  return candidates;
}

CandidateTimes edge_edge_candidates(const Query& query, double h) {
  const auto [a0, a1, b0, b1] = baselines::motions_of(query);
  CandidateTimes candidates;
  candidates.add_plane(b1 - a0, a1 - a0, b1 - b0, h);
  return candidates;
}

}  // namespace

Answer msrf(ContactKind kind, const Query& query, const TouchstonePluginOptions& options) {
  const double h = options.min_separation > 0.0 ? options.min_separation : default_separation;
  const CandidateTimes candidates = kind == ContactKind::vertex_face
                                        ? vertex_face_candidates(query, h)
                                        : edge_edge_candidates(query, h);
  constexpr double never = 2.0;
  double earliest = never;
  for (const double t : candidates.times()) {
    const double s = baselines::squared_distance_at(kind, query, t);
    if (t < earliest && std::abs(s) <= h * h + 0.1 * h) earliest = t;
  }
  if (earliest == never || earliest > options.t_max) return {};
  return {TOUCHSTONE_YES, earliest};
}

}  // namespace touchstone::verify::published
