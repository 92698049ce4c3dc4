#include "fast/distance/filtered_distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "fast/distance/neighbouring_doubles.hpp"
#include "fast/distance/polygon_features.hpp"
#include "touchstone/filters/ball.hpp"

namespace touchstone::fast {
namespace {

using filters::Ball;

using BallPolygon = polygon::Polygon<Ball>;
using Guess = polygon::Polygon<double>;

double rounded(const Ball& x) { return x.center.high; }

// ---- The polygon --------------------------------------------------------------------------------

/// The exponent of the power of two by which coordinates are multiplied against overflow; empty if
/// not all products are exact.
std::optional<int> scaling(const Query& query) {
  constexpr int usual = 64, least_exponent = -900;
  double greatest = 0.0, least = std::numeric_limits<double>::infinity();
  for (const double x : query.coordinates) {
    const double size = std::abs(x);
    greatest = std::max(greatest, size);
    if (size > 0.0) least = std::min(least, size);
  }
  if (greatest == 0.0) return 0;
  const int exponent = std::ilogb(greatest);
  if (std::abs(exponent) <= usual) return 0;
  if (std::ilogb(least) - exponent < least_exponent) return std::nullopt;
  return -exponent;
}

/// The exact product x · 2^exponent.
double scaled(double x, int exponent) { return exponent == 0 ? x : std::ldexp(x, exponent); }

BallPolygon polygon_at(ContactKind kind, const Query& query, double t, int exponent) {
  const Ball weight_of_end(t), weight_of_start(filters::exact_difference(1.0, t));
  const auto at = [&](const Corner& corner, std::size_t axis) {
    const auto at_end = [&](std::size_t end) {
      return Ball(filters::exact_difference(scaled(query.at(end, corner.plus, axis), exponent),
                                            scaled(query.at(end, corner.minus, axis), exponent)));
    };
    if (t == 0.0) return at_end(0);
    if (t == 1.0) return at_end(1);
    return weight_of_start * at_end(0) + weight_of_end * at_end(1);
  };
  return polygon::polygon_of<Ball>(polygon::distinct_corners(kind, query), at);
}

Guess guess_of(const BallPolygon& p) {
  Guess result;
  result.count = p.count;
  for (std::size_t i = 0; i < p.count; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      result.corner[i][axis] = rounded(p.corner[i][axis]);
  }
  return result;
}

// ---- L2 -----------------------------------------------------------------------------------------

enum class FeatureKind : std::uint8_t { vertex, side, face };
struct FeatureName {
  FeatureKind kind = FeatureKind::vertex;
  std::size_t index = 0;
};

FeatureName nearest_feature(const Guess& p) {
  if (p.has_face()) {
    const auto face = polygon::face(p);
    const bool has_normal = face.square > polygon::square_of_thin_normal(p);
    const bool is_inside = std::ranges::all_of(std::span(face.turns).first(p.count),
                                               [](double x) { return x >= 0.0; });
    if (has_normal && is_inside) return {FeatureKind::face, 0};
  }
  FeatureName result;
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](FeatureName name, double square) {
    if (square >= least) return;
    least = square;
    result = name;
  };
  for (std::size_t i = 0; i < p.count; ++i) {
    consider({FeatureKind::vertex, i}, filters::dot(p.corner[i], p.corner[i]));
  }
  for (std::size_t i = 0; i < p.sides(); ++i) {
    const auto side = polygon::side(p, i);
    if (side.from < 0.0 && side.to > 0.0) consider({FeatureKind::side, i}, side.area / side.square);
  }
  return result;
}

/// A feature: its distance is the root of value / square. With its direction a, `others` are the
/// a·w_k of the corners that are not on the feature; `value` is that of the corners on it.
struct Feature {
  Ball value;
  Ball square;
  bool is_attained = false;  ///< true if certainly attained by a point of the polygon
  std::array<Ball, 3> others{};
  std::size_t count = 0;
};

/// \param with_others true to compute them
Feature feature(const BallPolygon& p, const FeatureName& name, bool with_others) {
  Feature result;
  if (name.kind == FeatureKind::face) {
    const auto face = polygon::face(p);
    result.value = face.height * face.height;
    result.square = face.square;
    result.is_attained = std::ranges::all_of(std::span(face.turns).first(p.count),
                                             [](const Ball& x) { return is_positive(x); });
    return result;
  }
  const std::size_t i = name.index;
  if (name.kind == FeatureKind::vertex) {
    result.value = filters::dot(p.corner[i], p.corner[i]);
    result.square = Ball(1.0);
    result.is_attained = true;
    for (std::size_t k = 0; with_others && k < p.count; ++k) {
      if (k != i) result.others[result.count++] = filters::dot(p.corner[i], p.corner[k]);
    }
    return result;
  }
  const auto side = polygon::side(p, i);
  result.value = side.area;
  result.square = side.square;
  result.is_attained = is_positive(-side.from) && is_positive(side.to);
  for (std::size_t k = 0; with_others && k < p.count; ++k) {
    if (k == i || k == p.next(i)) continue;
    result.others[result.count++] = filters::dot(side.m, filters::cross(p.corner[k], side.e));
  }
  return result;
}

/// Compares the distance with a double, in L2.
class EuclideanComparison {
 public:
  explicit EuclideanComparison(const BallPolygon& p)
      : polygon_(p), name_(nearest_feature(guess_of(p))), nearest_(feature(p, name_, true)) {}

  [[nodiscard]] double guess() const {
    return std::sqrt(rounded(nearest_.value) / rounded(nearest_.square));
  }

  [[nodiscard]] std::optional<int> operator()(double s) const {
    const Ball square = Ball(s) * Ball(s);
    if (is_beyond(square)) return 1;
    if (is_within(square)) return -1;
    return std::nullopt;
  }

 private:
  /// Theorem 2, with the direction of the nearest feature. A corner that is certainly at least as
  /// far along the direction as the feature needs no square.
  [[nodiscard]] bool is_beyond(const Ball& s_squared) const {
    const Ball threshold = s_squared * nearest_.square;
    if (!is_positive(nearest_.value - threshold)) return false;
    return std::ranges::all_of(
        std::span(nearest_.others).first(nearest_.count), [&](const Ball& other) {
          if (is_positive(other - nearest_.value)) return true;
          return is_positive(other) && is_positive(other * other - threshold * nearest_.value);
        });
  }

  /// Theorem 1.
  [[nodiscard]] bool is_within(const Ball& s_squared) const {
    const auto shows = [&](const Feature& feature) {
      return feature.is_attained && is_positive(s_squared * feature.square - feature.value);
    };
    if (nearest_.is_attained) return shows(nearest_);
    // The foot of the perpendicular is on the boundary of the feature, or was guessed wrongly.
    for (std::size_t i = 0; i < polygon_.sides(); ++i) {
      if (shows(feature(polygon_, {FeatureKind::side, i}, false))) return true;
    }
    for (std::size_t i = 0; i < polygon_.count; ++i) {
      if (shows(feature(polygon_, {FeatureKind::vertex, i}, false))) return true;
    }
    return false;
  }

  const BallPolygon& polygon_;
  FeatureName name_;
  Feature nearest_;
};

// ---- L∞ -----------------------------------------------------------------------------------------

/// Compares the distance with a double, in L∞.
class CubeComparison {
 public:
  explicit CubeComparison(const BallPolygon& p) : axes_(polygon::axes(p)) {
    for (std::size_t i = 0; i < axes_.count; ++i) {
      const auto& axis = axes_.items[i];
      if (!is_positive(axis.length)) continue;
      const auto [least, most] = std::ranges::minmax(values(axis), {}, rounded);
      const double gap = std::max(rounded(least), -rounded(most)) / rounded(axis.length);
      if (gap <= guess_) continue;
      guess_ = gap;
      widest_ = i;
    }
  }

  [[nodiscard]] double guess() const { return guess_; }

  /// Theorem 3. Differences of coordinates are often doubles, so the quotient of a coordinate axis
  /// may equal s.
  [[nodiscard]] std::optional<int> operator()(double s) const {
    const auto is_at_most = [](const Ball& a, const Ball& b) {
      return is_positive(b - a) || is_exact_zero(b - a);
    };
    const auto is_less = [](const Ball& a, const Ball& b) { return is_positive(b - a); };
    if (separates(widest_, s, is_less)) return 1;
    if (are_blocked(s, is_less)) return -1;
    if (separates(widest_, s, is_at_most) && are_blocked(s, is_at_most)) return 0;
    return std::nullopt;
  }

 private:
  using Axis = polygon::Axis<Ball>;
  static constexpr std::size_t coordinate_axes = 3;

  static std::span<const Ball> values(const Axis& axis) {
    return std::span(axis.values).first(axis.count);
  }

  /// s |a|₁.
  [[nodiscard]] Ball reach(std::size_t axis, double s) const {
    if (axis < coordinate_axes) return Ball(s);
    return Ball(s) * axes_.items[axis].length;
  }

  /// True if its quotient is certainly at least s.
  template <class IsLess>
  [[nodiscard]] bool separates(std::size_t axis, double s, const IsLess& is_less) const {
    const Ball far = reach(axis, s);
    const auto all = values(axes_.items[axis]);
    return std::ranges::all_of(all, [&](const Ball& x) { return is_less(far, x); }) ||
           std::ranges::all_of(all, [&](const Ball& x) { return is_less(x, -far); });
  }
  /// True if all quotients are certainly less than s, or at most s.
  template <class IsLess>
  [[nodiscard]] bool are_blocked(double s, const IsLess& is_less) const {
    for (std::size_t i = 0; i < axes_.count; ++i) {
      if (is_exact_zero(axes_.items[i].length)) continue;
      const Ball far = reach(i, s);
      const auto all = values(axes_.items[i]);
      if (std::ranges::none_of(all, [&](const Ball& x) { return is_less(x, far); })) return false;
      if (std::ranges::none_of(all, [&](const Ball& x) { return is_less(-far, x); })) return false;
    }
    return true;
  }

  polygon::AxisList<Ball> axes_;
  double guess_ = 0.0;
  std::size_t widest_ = 0;
};

}  // namespace

std::optional<Distance> filtered_distance(ContactKind kind, const Query& query, double t,
                                          Norm norm) {
  const std::optional<int> exponent = scaling(query);
  if (!exponent) return std::nullopt;
  const BallPolygon p = polygon_at(kind, query, t, *exponent);
  const auto found = [&](const auto& comparison) -> std::optional<Distance> {
    const double guess = comparison.guess();
    if (!(guess > 0.0)) return std::nullopt;
    return neighbouring_doubles(guess, comparison);
  };
  std::optional<Distance> result =
      norm == Norm::l2 ? found(EuclideanComparison(p)) : found(CubeComparison(p));
  if (!result || *exponent == 0) return result;
  // Neighbours remain neighbours unless they become subnormal or too great.
  constexpr int greatest_exponent = std::numeric_limits<double>::max_exponent - 2;
  constexpr int least_exponent = std::numeric_limits<double>::min_exponent;
  const int magnitude = std::ilogb(result->upper) - *exponent;
  if (magnitude < least_exponent || magnitude > greatest_exponent) return std::nullopt;
  return Distance{std::ldexp(result->lower, -*exponent), std::ldexp(result->upper, -*exponent)};
}

}  // namespace touchstone::fast
