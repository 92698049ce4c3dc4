#include "fast/certified/exact/distance_decision.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <utility>
#include <vector>

#include "fast/certified/exact/real_root.hpp"

namespace touchstone::fast::exact_stage {
namespace {

using Vector = std::array<Fraction, 3>;

Vector cross_product(const Vector& a, const Vector& b) {
  return {cross(a, b, 0), cross(a, b, 1), cross(a, b, 2)};
}

Fraction constant(const BigInteger& x) { return {{x}, {}, nullptr}; }

// ---- Separators ---------------------------------------------------------------------------------

/// Signs of the spreads of a separator; 0 if unknown.
using Signs = std::array<int, 3>;

/// A direction's forms: every value minus every signed sum of the spreads. If the signs of the
/// spreads are known, the sum of their magnitudes is the greatest. For l2 there are no spreads, and
/// the values are the forms.
struct Separator {
  std::vector<Polynomial> values;
  std::vector<Polynomial> spreads;

  [[nodiscard]] Polynomial form(std::size_t value, const Signs& signs) const {
    Polynomial result = values[value];
    for (std::size_t i = 0; i < spreads.size(); ++i) {
      if (signs[i] < 0) {
        result += spreads[i];
      } else {
        result -= spreads[i];
      }
    }
    return result;
  }

  [[nodiscard]] Signs signs_between(const Dyadic& from, const Dyadic& to) const {
    Signs signs{};
    for (std::size_t i = 0; i < spreads.size(); ++i) {
      signs[i] = weak_sign_between(spreads[i], from, to);
    }
    return signs;
  }
};

/// Both directions of an axis.
void add_both(std::vector<Separator>& to, Separator separator) {
  Separator opposite = separator;
  for (Polynomial& value : opposite.values) value = -std::move(value);
  to.push_back(std::move(separator));
  to.push_back(std::move(opposite));
}

/// A side of the polygon, from a corner to the next one.
struct Side {
  Vector e;     ///< w_j − w_i
  Vector area;  ///< w_i × w_j = w_i × e
};

/// The polygon and the distance.
class Setting {
 public:
  Setting(const MovingPoints& points, ScaledDistance d)
      : points_(points), corners_(touchstone::corners(points.kind)), distance_(std::move(d)) {
    for (const Corner& corner : corners_) corners.push_back(between(corner.minus, corner.plus));
  }

  [[nodiscard]] ContactKind kind() const { return points_.kind; }
  [[nodiscard]] std::size_t next(std::size_t corner) const { return (corner + 1) % corners.size(); }

  [[nodiscard]] Side side(std::size_t i) const {
    const Corner &from = corners_[i], &to = corners_[next(i)];
    if (from.plus == to.plus) {
      return {between(to.minus, from.minus), area(from.minus, to.minus, from.plus)};
    }
    return {between(from.plus, to.plus), area(from.plus, to.plus, from.minus)};
  }

  /// (w_1 − w_0) × (w_last − w_0), which is e × f for all neighbouring sides e and f.
  [[nodiscard]] Vector normal() const {
    if (kind() == ContactKind::vertex_face) return area(2, 3, 1);
    return cross_product(between(0, 1), between(3, 2));
  }

  /// normal · w_i, the same for every corner: six times the volume of the tetrahedron of the
  /// points.
  [[nodiscard]] Fraction determinant(const Vector& normal) const {
    if (have_one_denominator({0, 1, 2, 3})) return dot(normal, corners[0]);
    const auto [p, q, r, s] = kind() == ContactKind::vertex_face
                                  ? std::array<std::size_t, 4>{1, 2, 3, 0}
                                  : std::array<std::size_t, 4>{1, 0, 2, 3};
    return dot(area(p, q, r), at(s)) - dot(at(p), cross_product(at(q), at(r)));
  }

  /// value − d · spread, times 2^exponent.
  [[nodiscard]] Polynomial beyond(const Fraction& value, const Fraction& spread) const {
    return ((value << distance_.exponent) - spread * distance_.numerator).numerator;
  }
  /// value − d² · square, times 2^(2 exponent).
  [[nodiscard]] Polynomial squarely_beyond(const Fraction& value, const Fraction& square) const {
    return ((value << 2 * distance_.exponent) -
            square * (distance_.numerator * distance_.numerator))
        .numerator;
  }

  /// The axis for linf with these components and products with the corners that differ.
  [[nodiscard]] Separator cube_separator(const std::vector<Fraction>& components,
                                         std::vector<Fraction> products) const {
    std::vector<Fraction> all = std::move(products);
    const auto values = static_cast<std::ptrdiff_t>(all.size());
    for (Fraction& product : all) product = std::move(product) << distance_.exponent;
    for (const Fraction& component : components) {
      if (!is_zero(component.numerator)) all.push_back(component * distance_.numerator);
    }
    std::vector<Polynomial> forms = common_numerators(std::move(all));
    Separator result;
    result.values.assign(forms.begin(), forms.begin() + values);
    result.spreads.assign(forms.begin() + values, forms.end());
    return result;
  }

  std::vector<Vector> corners;  // in cyclic order

 private:
  [[nodiscard]] const Vector& at(std::size_t point) const { return points_.points[point]; }
  [[nodiscard]] Vector between(std::size_t from, std::size_t to) const { return at(to) - at(from); }

  [[nodiscard]] bool have_one_denominator(std::initializer_list<std::size_t> points) const {
    return std::ranges::all_of(
        points, [&](std::size_t i) { return at(i)[0].powers == at(*points.begin())[0].powers; });
  }

  /// (a − c) × (b − c), with each denominator once.
  [[nodiscard]] Vector area(std::size_t a, std::size_t b, std::size_t c) const {
    if (have_one_denominator({a, b, c})) return cross_product(between(c, a), between(c, b));
    Vector sum = cross_product(at(a), at(b));
    sum += cross_product(at(b), at(c));
    return sum += cross_product(at(c), at(a));
  }

  const MovingPoints& points_;
  std::span<const Corner> corners_;
  ScaledDistance distance_;
};

/// ±e_c, for both norms.
std::vector<Separator> axes(const Setting& setting) {
  std::vector<Separator> result;
  const Fraction one = constant(1);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Separator separator, opposite;
    for (const Vector& corner : setting.corners) {
      separator.values.push_back(setting.beyond(corner[axis], one));
      opposite.values.push_back(setting.beyond(-corner[axis], one));
    }
    result.push_back(std::move(separator));
    result.push_back(std::move(opposite));
  }
  return result;
}

/// ±N and ±(e_c × e). Opposite sides of a parallelogram have one direction, and a·w is the same at
/// both ends of a side and at both of the opposite one: w·(e_c × e) = (e × w)_c, and for the other
/// corners it is that plus N_c.
std::vector<Separator> cube_separators(const Setting& setting) {
  std::vector<Separator> result;
  const Vector normal = setting.normal();
  const std::size_t sides = setting.kind() == ContactKind::vertex_face ? 3 : 2;
  for (std::size_t i = 0; i < sides; ++i) {
    const auto [e, area] = setting.side(i);
    for (std::size_t c = 0; c < 3; ++c) {
      add_both(result, setting.cube_separator({e[(c + 1) % 3], e[(c + 2) % 3]},
                                              {-area[c], normal[c] - area[c]}));
    }
  }
  add_both(result, setting.cube_separator({normal[0], normal[1], normal[2]},
                                          {setting.determinant(normal)}));
  return result;
}

/// The parts of the separators for l2.
class BallParts {
 public:
  explicit BallParts(const Setting& setting) : size_(setting.corners.size()) {
    const auto& w = setting.corners;
    for (std::size_t i = 0; i < size_; ++i) {
      for (std::size_t k = 0; k < size_; ++k) {
        products_.push_back(k < i ? product(k, i) : dot(w[i], w[k]));
      }
    }
    normal = setting.normal();
    for (std::size_t i = 0; i < size_; ++i) {
      vertices_beyond.push_back(setting.squarely_beyond(product(i, i), constant(1)));
      const auto [e, area] = setting.side(i);
      SideForms& s = sides.emplace_back();
      s.square = dot(e, e);
      s.area = dot(area, area);
      s.inward = dot(normal, area);
      s.beyond = setting.squarely_beyond(s.area, s.square);
    }
  }

  /// w_i·w_k
  [[nodiscard]] const Fraction& product(std::size_t i, std::size_t k) const {
    return products_[i * size_ + k];
  }

  /// A side, with its direction a.
  struct SideForms {
    Fraction square;    ///< |e|²
    Fraction area;      ///< C = a·w_i = a·w_j
    Fraction inward;    ///< C − a·w_k = N·(w_i × e) for the other corners
    Polynomial beyond;  ///< C − d²|e|²
  };

  Vector normal;
  std::vector<SideForms> sides;
  std::vector<Polynomial> vertices_beyond;  ///< |w_i|² − d²

 private:
  std::size_t size_;
  std::vector<Fraction> products_;
};

/// The vertices and sides with low forms, and the face.
std::vector<Separator> low_ball_separators(const Setting& setting, const BallParts& parts) {
  std::vector<Separator> result;
  for (std::size_t i = 0; i < setting.corners.size(); ++i) {
    const auto& s = parts.sides[i];
    result.push_back({{s.beyond, (-s.inward).numerator}, {}});
    Separator vertex{{parts.vertices_beyond[i]}, {}};
    for (std::size_t k = 0; k < setting.corners.size(); ++k) {
      if (k != i) vertex.values.push_back((parts.product(i, k) - parts.product(i, i)).numerator);
    }
    result.push_back(std::move(vertex));
  }
  const Fraction det = setting.determinant(parts.normal);
  const Polynomial face = setting.squarely_beyond(det * det, dot(parts.normal, parts.normal));
  result.push_back({{det.numerator, face}, {}});
  result.push_back({{(-det).numerator, face}, {}});
  return result;
}

/// The vertices and sides of theorem 1 whose first forms are positive at the time.
std::vector<Separator> ball_separators_at(Instant& now, const Setting& setting,
                                          const BallParts& parts) {
  std::vector<Separator> result;
  for (std::size_t i = 0; i < setting.corners.size(); ++i) {
    const auto& s = parts.sides[i];
    if (now.sign_of(s.beyond) > 0) {
      const Fraction other = s.area - s.inward;
      result.push_back(
          {{s.beyond, other.numerator, setting.squarely_beyond(other * other, s.square * s.area)},
           {}});
    }
    if (now.sign_of(parts.vertices_beyond[i]) <= 0) continue;
    Separator vertex{{parts.vertices_beyond[i]}, {}};
    for (std::size_t k = 0; k < setting.corners.size(); ++k) {
      if (k == i) continue;
      const Fraction& product = parts.product(i, k);
      vertex.values.push_back(product.numerator);
      vertex.values.push_back(setting.squarely_beyond(product * product, parts.product(i, i)));
    }
    result.push_back(std::move(vertex));
  }
  return result;
}

// ---- The walk -----------------------------------------------------------------------------------

/// True if all forms pass the test. If the signs are known, only the least form is tested,
/// otherwise the forms with all signs.
template <class Test>
bool all_forms(const Separator& separator, std::size_t value, Signs signs, Test&& test) {
  for (std::size_t i = 0; i < separator.spreads.size(); ++i) {
    if (signs[i] != 0) continue;
    signs[i] = -1;
    if (!all_forms(separator, value, signs, test)) return false;
    signs[i] = 1;
  }
  return test(separator.form(value, signs));
}

/// True if every form is positive. Every value is the mean of forms, so values are tested first.
bool holds(const Separator& separator, Instant& at) {
  const auto is_positive = [&](const Polynomial& form) { return at.sign_of(form) > 0; };
  if (!std::ranges::all_of(separator.values, is_positive)) return false;
  if (separator.spreads.empty()) return true;
  const Signs signs = separator.signs_between(at.lower(), at.upper());
  for (std::size_t value = 0; value < separator.values.size(); ++value) {
    if (!all_forms(separator, value, signs, is_positive)) return false;
  }
  return true;
}

/// The end of the time in which a separator holds; empty if it is beyond the end.
using End = std::optional<Instant>;

/// Makes `end` the first root of the form between `from` and the end, if that is earlier.
void shorten(End& end, Instant& from, const Dyadic& t_end, const Polynomial& form) {
  // The sign is computed first: this narrows the end, up to which the form is examined.
  if (end && end->sign_of(form) > 0 && is_positive_between(form, from.upper(), end->lower()))
    return;
  End root = first_root_after(from, t_end, form);
  if (root) root->narrow();
  if (root && (!end || compare(*root, *end) < 0)) end = std::move(root);
}

/// The first root of the forms of a separator that holds at `from`. The forms that are least at the
/// beginning are examined first; up to the time that they give, most signs are known and no others
/// are needed.
End end_of(const Separator& separator, Instant& from, const Dyadic& t_end) {
  End end;
  const Signs first = separator.signs_between(from.lower(), from.upper());
  for (std::size_t value = 0; value < separator.values.size(); ++value) {
    shorten(end, from, t_end, separator.form(value, first));
  }
  const Signs signs = separator.signs_between(from.lower(), end ? end->upper() : t_end);
  const auto known =
      static_cast<std::size_t>(std::ranges::count_if(signs, [](int sign) { return sign != 0; }));
  if (signs == first && known == separator.spreads.size()) return end;
  for (std::size_t value = 0; value < separator.values.size(); ++value) {
    static_cast<void>(all_forms(separator, value, signs, [&](const Polynomial& form) {
      shorten(end, from, t_end, form);
      return true;
    }));
  }
  return end;
}

/// The result of the separators that hold at a time.
struct Reach {
  bool separated = false;  ///< true if one holds
  End end;                 ///< the end of one that holds long
};

Reach reach(const std::vector<Separator>& separators, Instant& from, const Dyadic& t_end) {
  Reach result;
  for (const Separator& separator : separators) {
    if (result.end) {
      Instant sure(result.end->lower());
      if (!holds(separator, sure)) continue;
    }
    if (!holds(separator, from)) continue;
    End end = end_of(separator, from, t_end);
    if (!end) return {true, {}};
    // The order of two ends that are this close is irrelevant.
    if (!result.end || compare(end->lower(), result.end->lower()) > 0) result.end = std::move(end);
    result.separated = true;
  }
  return result;
}

/// The first time not later than `latest` at which `reach_from(t, latest)` finds no separator.
template <class ReachFrom>
End walk(ReachFrom&& reach_from, std::uint64_t latest) {
  const Dyadic t_end = dyadic_of(latest);
  Instant now(Dyadic{0, 0});
  for (;;) {
    Reach found = reach_from(now, t_end);
    if (!found.separated) return now;
    if (!found.end) return std::nullopt;
    static_cast<void>(found.end->is_above(latest));  // so that its bounds are not
    now = std::move(*found.end);
  }
}

/// The separators of both norms and those of one, which are made when the former do not suffice.
class Separators {
 public:
  Separators(const Setting& setting, Norm norm)
      : setting_(setting), norm_(norm), axes_(axes(setting)) {}

  [[nodiscard]] Reach reach_from(Instant& now, const Dyadic& t_end) {
    Reach found = reach(axes_, now, t_end);
    if (found.separated) return found;
    if (norm_ == Norm::linf) {
      if (others_.empty()) others_ = cube_separators(setting_);
      return reach(others_, now, t_end);
    }
    if (!parts_) {
      parts_.emplace(setting_);
      others_ = low_ball_separators(setting_, *parts_);
    }
    found = reach(others_, now, t_end);
    if (found.separated) return found;
    return reach(ball_separators_at(now, setting_, *parts_), now, t_end);
  }

 private:
  const Setting& setting_;
  Norm norm_;
  std::vector<Separator> axes_, others_;
  std::optional<BallParts> parts_;
};

End first_instant(const Setting& setting, Norm norm, std::uint64_t latest) {
  Separators separators(setting, norm);
  return walk([&](Instant& now, const Dyadic& t_end) { return separators.reach_from(now, t_end); },
              latest);
}

}  // namespace

ScaledDistance scaled_distance(double distance, int unit) {
  const BinaryFraction d = odd_fraction(distance);
  const int exponent = d.exponent - unit;
  return {BigInteger(d.numerator) << std::max(exponent, 0), std::max(-exponent, 0)};
}

std::optional<BitInterval> first_approach(const MovingPoints& points,
                                          const ScaledDistance& distance, Norm norm,
                                          std::uint64_t latest, std::uint64_t step) {
  End end = first_instant(Setting(points, distance), norm, latest);
  if (!end) return std::nullopt;
  if (compare(end->upper(), {0, 0}) == 0) return BitInterval{bits_of_zero, bits_of_zero};
  const auto is_above = [&](std::uint64_t bits) { return end->is_above(bits); };
  const BitInterval found = enclose(end->guess(), step, is_above);
  // A step is not small compared with a subnormal time.
  if (found.upper >= bits_of_least_normal) return found;
  return enclose(std::bit_cast<double>(found.upper), 1, is_above);
}

std::optional<BitInterval> first_approach(const Motion<BigInteger>& motion,
                                          const ScaledDistance& distance, Norm norm,
                                          std::uint64_t latest, std::uint64_t step) {
  const auto vector_of = [](const MovingVector<BigInteger>& v) {
    Vector result;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      result[axis].numerator.assign(v[axis].begin(), v[axis].end());
    }
    return result;
  };
  // Points with the differences r, p and q.
  const auto &r = motion.r, &p = motion.p, &q = motion.q;
  const Vector origin = vector_of(MovingVector<BigInteger>{});
  MovingPoints points{.kind = motion.kind,
                      .points = {vector_of(r), origin, vector_of(p), vector_of(q)}};
  if (motion.kind == ContactKind::edge_edge) {
    points.points = {vector_of(r), vector_of(r - p), origin, vector_of(q)};
  }
  return first_approach(points, distance, norm, latest, step);
}

}  // namespace touchstone::fast::exact_stage
