#include "fast/certified/exact/distance_decision.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <utility>
#include <vector>

#include "fast/certified/exact/real_root.hpp"

namespace touchstone::fast::exact_stage {
namespace {

using Vector = std::array<Polynomial, 3>;

Vector vector_of(const MovingVector<BigInteger>& v) {
  return {Polynomial(v[0].begin(), v[0].end()), Polynomial(v[1].begin(), v[1].end()),
          Polynomial(v[2].begin(), v[2].end())};
}

Vector cross_product(const Vector& a, const Vector& b) {
  const auto component = [&](std::size_t i, std::size_t j) { return a[i] * b[j] - a[j] * b[i]; };
  return {component(1, 2), component(2, 0), component(0, 1)};
}

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

/// The parts of the separators.
struct Setting {
  Setting(const MovingPolygon& polygon, const ScaledDistance& d)
      : kind(polygon.kind),
        corners(polygon.corners),
        normal(cross_product(corners[1] - corners[0], corners.back() - corners[0])),
        determinant(dot(normal, corners[0])),
        reach(polygon.denominator * d.numerator),
        squared_reach(reach * reach),
        exponent(d.exponent) {}

  [[nodiscard]] std::size_t next(std::size_t corner) const { return (corner + 1) % corners.size(); }

  /// value − d² · square, times the denominator's square and 2^(2 exponent).
  [[nodiscard]] Polynomial beyond(const Polynomial& value, const Polynomial& square) const {
    return (value << 2 * exponent) - square * squared_reach;
  }

  Kind kind;
  std::vector<Vector> corners;  // in cyclic order
  Vector normal;
  Polynomial determinant;  // normal · corner, for every corner
  Polynomial reach;        // the distance times the denominator, times 2^-exponent
  Polynomial squared_reach;
  long exponent;
};

/// The axis a for linf, with its products with the corners that differ.
Separator cube_separator(const Setting& setting, const Vector& axis,
                         const std::vector<Polynomial>& products) {
  Separator result;
  for (const Polynomial& product : products) result.values.push_back(product << setting.exponent);
  for (const Polynomial& component : axis) {
    if (is_zero(component)) continue;
    result.spreads.push_back(component * setting.reach);
  }
  return result;
}

/// ±e_c, for both norms.
void add_axes(const Setting& setting, std::vector<Separator>& to) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const bool negative : {false, true}) {
      Separator separator;
      for (const Vector& corner : setting.corners) {
        const Polynomial product = corner[axis] << setting.exponent;
        separator.values.push_back((negative ? -product : product) - setting.reach);
      }
      to.push_back(std::move(separator));
    }
  }
}

/// ±N and ±(e_c × e). Opposite sides of a parallelogram have one direction, and a·w is the same at
/// both ends of a side and at both of the opposite one.
std::vector<Separator> cube_separators(const Setting& setting) {
  std::vector<Separator> result;
  add_axes(setting, result);
  const std::size_t sides = setting.kind == Kind::vertex_face ? 3 : 2;
  for (std::size_t i = 0; i < sides; ++i) {
    const std::size_t j = setting.next(i), k = setting.next(j);
    const Vector e = setting.corners[j] - setting.corners[i];
    for (std::size_t c = 0; c < 3; ++c) {
      Vector axis;
      axis[c] = Polynomial(e[c].size());
      axis[(c + 1) % 3] = -e[(c + 2) % 3];
      axis[(c + 2) % 3] = e[(c + 1) % 3];
      add_both(result,
               cube_separator(setting, axis,
                              {dot(axis, setting.corners[i]), dot(axis, setting.corners[k])}));
    }
  }
  add_both(result, cube_separator(setting, setting.normal, {setting.determinant}));
  return result;
}

/// w_i·w_k, the terms of the directions of vertices and sides.
class Gram {
 public:
  explicit Gram(const std::vector<Vector>& w) : size_(w.size()), products_(size_ * size_) {
    for (std::size_t i = 0; i < size_; ++i) {
      for (std::size_t k = 0; k <= i; ++k) {
        products_[i * size_ + k] = products_[k * size_ + i] = dot(w[i], w[k]);
      }
    }
  }

  [[nodiscard]] const Polynomial& operator()(std::size_t i, std::size_t k) const {
    return products_[i * size_ + k];
  }

 private:
  std::size_t size_;
  std::vector<Polynomial> products_;
};

/// A side: |e|², C, a·w_k for the other corners (the same for both of a parallelogram), and
/// C − d²|e|².
struct Side {
  Polynomial square, area, other, beyond;
};

Side side(const Setting& setting, const Gram& gram, std::size_t i) {
  const std::size_t j = setting.next(i), k = setting.next(j);
  const Polynomial from = gram(i, j) - gram(i, i), to = gram(j, j) - gram(i, j);  // w_i·e, w_j·e
  Polynomial square = to - from;
  Polynomial area = gram(i, i) * gram(j, j) - gram(i, j) * gram(i, j);
  Polynomial other = square * gram(i, k) - from * (gram(j, k) - gram(i, k));
  Polynomial beyond = setting.beyond(area, square);
  return {std::move(square), std::move(area), std::move(other), std::move(beyond)};
}

/// The parts of the separators for l2.
struct BallParts {
  explicit BallParts(const Setting& setting) : gram(setting.corners) {
    for (std::size_t i = 0; i < setting.corners.size(); ++i) {
      sides.push_back(side(setting, gram, i));
      vertices_beyond.push_back(setting.beyond(gram(i, i), {1}));
    }
  }

  Gram gram;
  std::vector<Side> sides;
  std::vector<Polynomial> vertices_beyond;  // |w_i|² − d²
};

/// The coordinate axes, the vertices and sides with low forms, and the face.
std::vector<Separator> low_ball_separators(const Setting& setting, const BallParts& parts) {
  std::vector<Separator> result;
  add_axes(setting, result);
  for (std::size_t i = 0; i < setting.corners.size(); ++i) {
    const Side& s = parts.sides[i];
    result.push_back({{s.beyond, s.other - s.area}, {}});
    Separator vertex{{parts.vertices_beyond[i]}, {}};
    for (std::size_t k = 0; k < setting.corners.size(); ++k) {
      if (k != i) vertex.values.push_back(parts.gram(i, k) - parts.gram(i, i));
    }
    result.push_back(std::move(vertex));
  }
  const Polynomial &det = setting.determinant, square = dot(setting.normal, setting.normal);
  const Polynomial face = setting.beyond(det * det, square);
  result.push_back({{det, face}, {}});
  result.push_back({{-det, face}, {}});
  return result;
}

/// The vertices and sides of theorem 1 whose first forms are positive at the time.
std::vector<Separator> ball_separators_at(Instant& now, const Setting& setting,
                                          const BallParts& parts) {
  std::vector<Separator> result;
  for (std::size_t i = 0; i < setting.corners.size(); ++i) {
    const Side& s = parts.sides[i];
    if (now.sign_of(s.beyond) > 0) {
      result.push_back(
          {{s.beyond, s.other, setting.beyond(s.other * s.other, s.square * s.area)}, {}});
    }
    if (now.sign_of(parts.vertices_beyond[i]) <= 0) continue;
    Separator vertex{{parts.vertices_beyond[i]}, {}};
    for (std::size_t k = 0; k < setting.corners.size(); ++k) {
      if (k == i) continue;
      const Polynomial& product = parts.gram(i, k);
      vertex.values.push_back(product);
      vertex.values.push_back(setting.beyond(product * product, parts.gram(i, i)));
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

End first_instant(const Setting& setting, Norm norm, std::uint64_t latest) {
  if (norm == Norm::linf) {
    const auto separators = cube_separators(setting);
    return walk([&](Instant& now, const Dyadic& t_end) { return reach(separators, now, t_end); },
                latest);
  }
  const BallParts parts(setting);
  const auto low = low_ball_separators(setting, parts);
  return walk(
      [&](Instant& now, const Dyadic& t_end) {
        Reach found = reach(low, now, t_end);
        if (found.separated) return found;
        return reach(ball_separators_at(now, setting, parts), now, t_end);
      },
      latest);
}

}  // namespace

ScaledDistance scaled_distance(double distance, int unit) {
  const BinaryFraction d = odd_fraction(distance);
  const int exponent = d.exponent - unit;
  return {BigInteger(d.numerator) << std::max(exponent, 0), std::max(-exponent, 0)};
}

std::optional<BitInterval> first_approach(const MovingPolygon& polygon,
                                          const ScaledDistance& distance, Norm norm,
                                          std::uint64_t latest, std::uint64_t step) {
  End end = first_instant(Setting(polygon, distance), norm, latest);
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
  MovingPolygon polygon{.kind = motion.kind, .corners = {}, .denominator = {1, 1}};
  for (const auto& corner : moving_corners(motion)) polygon.corners.push_back(vector_of(corner.w));
  return first_approach(polygon, distance, norm, latest, step);
}

}  // namespace touchstone::fast::exact_stage
