// Methods for curves that others use, for comparison (docs/methods.md, section 3). All compute in
// doubles without error bounds, and find a time of contact or none; the tolerance is 1e-6.
//
// - *subdivision* (the nonlinear detection of github.com/ipc-sim/ipc-toolkit, in words): a piece is
//   replaced by the chords of its points, from which they deviate by at most n(n−1)/8 times the
//   greatest second difference of the control points. If the chords do not come within the sum of
//   the greatest deviations of both primitives, the piece is free; if that sum is within the
//   tolerance they collide; else it is halved. With `largest_deviation` the greater of the two
//   takes the place of the sum.
// - *sampling*: the distance at 101 times is compared with the tolerance.
// - *advancement* (as FCL and DART do): t grows by the distance over the greatest relative speed of
//   the control points until the distance is within the tolerance (yes), t is above 1 (no), or
//   after 10,000 steps (yes).
//
// **Promise.** None.
//
// **Known defects.** Near misses within the tolerance are false positives. With `largest_deviation`
// two primitives that bulge towards each other are missed. Sampling misses fast and short contacts,
// or tells them late. Advancement takes all its steps in grazing motion.

#include "verify/baselines/baselines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "touchstone/certified.hpp"
#include "touchstone/contacts.hpp"
#include "touchstone/curved_query.hpp"
#include "verify/baselines/method_support.hpp"

namespace touchstone::baselines {
namespace {

using Point = std::array<double, 3>;
/// The control points of the four points.
using Curves = std::array<std::vector<Point>, moving_points>;

constexpr double tolerance = 1e-6;
constexpr int most_pieces = 100'000;
constexpr int samples = 100;
constexpr int most_advances = 10'000;

Curves curves_of(const Queries& queries, std::size_t i) {
  Curves curves;
  const CurvedQuery query = to_curved(queries, i);
  for (std::size_t point = 0; point < moving_points; ++point) curves[point] = query[point].control;
  return curves;
}

Point mix(const Point& a, const Point& b, double t) {
  return {a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t};
}

double length(const Point& a, const Point& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Both parts of a curve, divided at t.
std::array<std::vector<Point>, 2> divided(std::vector<Point> row, double t) {
  std::array<std::vector<Point>, 2> parts;
  for (; !row.empty(); row.pop_back()) {
    parts[0].push_back(row.front());
    parts[1].push_back(row.back());
    for (std::size_t k = 0; k + 1 < row.size(); ++k) row[k] = mix(row[k], row[k + 1], t);
  }
  std::ranges::reverse(parts[1]);
  return parts;
}

std::size_t second_primitive(ContactKind kind) { return kind == ContactKind::vertex_face ? 1 : 2; }

// ---- Subdivision --------------------------------------------------------------------------------

/// A bound of the distance from the chord at the same time: n (n−1)/8 times the greatest second
/// difference of the control points, since |x''| is at most n (n−1) times that.
double deviation(const std::vector<Point>& curve) {
  double greatest = 0.0;
  for (std::size_t k = 0; k + 2 < curve.size(); ++k) {
    greatest = std::max(greatest, 2.0 * length(curve[k + 1], mix(curve[k], curve[k + 2], 0.5)));
  }
  const auto n = static_cast<double>(curve.size() - 1);
  return n * (n - 1.0) / 8.0 * greatest;
}

struct Piece {
  Curves curves;
  double begin;
  double length;
};

template <bool takes_sum>
std::optional<double> subdivide(const Queries& queries, std::size_t i) {
  std::vector<Piece> pieces{{curves_of(queries, i), 0.0, 1.0}};
  for (int count = 0; !pieces.empty(); ++count) {
    const Piece piece = std::move(pieces.back());
    pieces.pop_back();
    if (count == most_pieces) return piece.begin;
    std::array<double, 2> deviations{};
    Query chords{};
    for (std::size_t point = 0; point < moving_points; ++point) {
      const auto& curve = piece.curves[point];
      double& greatest = deviations[point < second_primitive(queries.kind) ? 0 : 1];
      greatest = std::max(greatest, deviation(curve));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        chords.at(0, point, axis) = curve.front()[axis];
        chords.at(1, point, axis) = curve.back()[axis];
      }
    }
    const double reach =
        takes_sum ? deviations[0] + deviations[1] : std::max(deviations[0], deviations[1]);
    const fast::CertifiedResult found =
        fast::solve(queries.kind, chords,
                    {.separation = {.distance = reach, .norm = Norm::l2}, .max_threads = 1});
    if (found.verdict == fast::Verdict::no) continue;
    if (reach <= tolerance) return piece.begin + piece.length * found.toi_lower;
    std::array<Piece, 2> halves{Piece{{}, piece.begin, piece.length / 2},
                                Piece{{}, piece.begin + piece.length / 2, piece.length / 2}};
    for (std::size_t point = 0; point < moving_points; ++point) {
      const auto parts = divided(piece.curves[point], 0.5);
      for (std::size_t half = 0; half < 2; ++half) halves[half].curves[point] = parts[half];
    }
    pieces.push_back(std::move(halves[1]));
    pieces.push_back(std::move(halves[0]));
  }
  return std::nullopt;
}

// ---- Distances at times -------------------------------------------------------------------------

double distance_at(ContactKind kind, const Curves& curves, double t) {
  Query rest{};
  for (std::size_t point = 0; point < moving_points; ++point) {
    const Point place = divided(curves[point], t)[0].back();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      rest.at(0, point, axis) = rest.at(1, point, axis) = place[axis];
    }
  }
  return fast::distance(kind, rest, 0.0).lower;
}

std::optional<double> sample(const Queries& queries, std::size_t i) {
  const Curves curves = curves_of(queries, i);
  for (int k = 0; k <= samples; ++k) {
    const double t = static_cast<double>(k) / samples;
    if (distance_at(queries.kind, curves, t) <= tolerance) return t;
  }
  return std::nullopt;
}

/// The greatest relative speed: n times the greatest step between control points, of each
/// primitive.
double greatest_speed(ContactKind kind, const Curves& curves) {
  std::array<double, 2> speeds{};
  for (std::size_t point = 0; point < moving_points; ++point) {
    double& greatest = speeds[point < second_primitive(kind) ? 0 : 1];
    const auto& curve = curves[point];
    for (std::size_t k = 0; k + 1 < curve.size(); ++k) {
      greatest = std::max(greatest,
                          static_cast<double>(curve.size() - 1) * length(curve[k], curve[k + 1]));
    }
  }
  return speeds[0] + speeds[1];
}

std::optional<double> advance(const Queries& queries, std::size_t i) {
  const Curves curves = curves_of(queries, i);
  const double speed = greatest_speed(queries.kind, curves);
  double t = 0.0;
  for (int step = 0; step < most_advances && t <= 1.0; ++step) {
    const double distance = distance_at(queries.kind, curves, t);
    if (distance <= tolerance) return t;
    t += distance / speed;
  }
  if (t <= 1.0) return t;
  return std::nullopt;
}

/// The time of contact of query i; nothing if it finds none.
using Find = std::optional<double>(const Queries& queries, std::size_t i);

template <Find find>
std::unique_ptr<fast::Method> curved_method(std::string_view name,
                                            std::string_view variant_of = {}) {
  return baseline_method(
      {.name = name,
       .terms = {.straight = false, .most_degree = greatest_degree},
       .variant_of = variant_of},
      [](const AnyQueries& all, std::size_t i, const fast::MethodOptions& options) {
        const std::optional<double> t = find(all.as(all.kind.contact()), i);
        if (!t || *t > options.t_max) return fast::Answer{.verdict = fast::Verdict::no};
        return fast::Answer{.verdict = fast::Verdict::yes, .toi_lower = *t};
      });
}

}  // namespace

std::unique_ptr<fast::Method> subdivision_method() {
  return curved_method<subdivide<true>>("subdivision");
}

std::unique_ptr<fast::Method> subdivision_largest_deviation_method() {
  return curved_method<subdivide<false>>("subdivision_largest_deviation", "subdivision");
}

std::unique_ptr<fast::Method> sampling_method() { return curved_method<sample>("sampling"); }

std::unique_ptr<fast::Method> advancement_method() { return curved_method<advance>("advancement"); }

}  // namespace touchstone::baselines
