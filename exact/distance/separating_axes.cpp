#include "exact/distance/separating_axes.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <span>
#include <utility>

namespace touchstone::exact {
namespace {

using Coefficients = std::span<const Integer>;

bool is_positive(const Integer& x) { return sgn(x) > 0; }
bool is_negative(const Integer& x) { return sgn(x) < 0; }

/// The polynomials of features; products of corners are computed when first needed.
template <class Order>
class Values {
 public:
  template <std::size_t n>
  using Form = typename Order::template Form<n>;
  using Holds = std::function<bool(Coefficients, bool is_guard)>;

  explicit Values(const MotionOf<Order>& motion)
      : motion_(motion), reach_(motion.reach()), square_(reach_ * reach_) {}

  /// All features, the cheaper ones first.
  [[nodiscard]] std::vector<Feature> features() const {
    return motion_.norm == Norm::l2 ? l2_features() : linf_features();
  }

  /// True if the predicate holds for all forms of a feature. It is not called again after a
  /// failure.
  bool every(const Feature& feature, const Holds& holds) {
    switch (feature.sort) {
      case Feature::Sort::vertex:
        return every_of_vertex(feature.i, holds);
      case Feature::Sort::edge:
        return every_of_edge(feature.i, feature.j, holds);
      case Feature::Sort::positive_face:
        return every_of_face(face(), holds);
      case Feature::Sort::negative_face:
        return every_of_face(-face(), holds);
      case Feature::Sort::cross:
        return every_of_cross(feature, holds);
      default:
        return every_of_axis(feature, holds);
    }
  }

 private:
  using Sort = Feature::Sort;

  [[nodiscard]] std::size_t corners() const { return motion_.corner_count; }
  [[nodiscard]] bool is_apart() const { return sgn(motion_.distance) > 0; }

  [[nodiscard]] std::vector<Feature> l2_features() const {
    std::vector<Feature> result{{.sort = Sort::positive_face}, {.sort = Sort::negative_face}};
    for (std::size_t i = 0; i < corners(); ++i) result.push_back({.sort = Sort::vertex, .i = i});
    for (std::size_t i = 0; i < corners(); ++i) {
      result.push_back({.sort = Sort::edge, .i = i, .j = (i + 1) % corners()});
    }
    return result;
  }

  /// Opposite sides of a parallelogram are parallel: two are enough.
  [[nodiscard]] std::vector<Feature> linf_features() const {
    std::vector<Feature> result;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const Sort sort : {Sort::positive_axis, Sort::negative_axis}) {
        result.push_back({.sort = sort, .axis = axis});
      }
    }
    for (const Sort sort : {Sort::positive_face, Sort::negative_face}) {
      result.push_back({.sort = sort});
    }
    const std::size_t sides = motion_.kind == ContactKind::vertex_face ? 3 : 2;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < sides; ++i) {
        const std::size_t j = (i + 1) % corners();
        result.push_back({.sort = Sort::cross, .i = i, .j = j, .axis = axis});
        result.push_back({.sort = Sort::cross, .i = j, .j = i, .axis = axis});
      }
    }
    return result;
  }

  /// w_i · w_j.
  const Form<2>& product(std::size_t i, std::size_t j) {
    auto& form = products_.at(std::min(i, j)).at(std::max(i, j));
    if (!form) form = dot(motion_, i, j);
    return *form;
  }

  /// Component `axis` of w_i × w_j.
  Form<2> cross(std::size_t i, std::size_t j, std::size_t axis) {
    auto& form = crosses_.at(std::min(i, j)).at(std::max(i, j)).at(axis);
    if (!form) form = cross_component(motion_, std::min(i, j), std::max(i, j), axis);
    return i < j ? *form : -*form;
  }

  /// N·w_i, the same for all corners of the polygon.
  const Form<3>& face() {
    if (!face_) face_ = determinant(motion_);
    return *face_;
  }

  const std::array<Form<2>, 3>& normal() {
    if (!normal_) {
      normal_ = {normal_component(motion_, 0), normal_component(motion_, 1),
                 normal_component(motion_, 2)};
    }
    return *normal_;
  }

  // ---- l2 ---------------------------------------------------------------------------------------

  /// a·w > d|a|, from a·w and |a|².
  template <AnyForm Value, AnyForm Square>
  bool is_beyond(const Value& value, const Square& squared_length, const Holds& holds) {
    if (!holds(value.c, is_apart())) return false;
    if (!is_apart()) return true;
    auto difference = value * value;
    subtract_product(difference, squared_length, square_);
    return holds(difference.c, false);
  }

  bool every_of_vertex(std::size_t i, const Holds& holds) {
    if (!holds((product(i, i) - square_).c, false)) return false;
    for (std::size_t k = 0; k < corners(); ++k) {
      if (k != i && !is_beyond(product(i, k), product(i, i), holds)) return false;
    }
    return true;
  }

  /// The value is the same at both ends of the edge.
  bool every_of_edge(std::size_t i, std::size_t j, const Holds& holds) {
    const Form<2> from = product(i, j) - product(i, i);           // w_i·e
    const Form<2> length = product(j, j) - product(i, j) - from;  // |e|²
    const auto value = [&](std::size_t k) {
      Form<4> result = length * product(i, k);
      subtract_product(result, from, product(j, k) - product(i, k));
      return result;
    };
    const Form<4> at_edge = value(i);
    if (!holds((at_edge - length * square_).c, false)) return false;
    const Form<6> squared_length = is_apart() ? length * at_edge : Form<6>{};
    for (std::size_t k = 0; k < corners(); ++k) {
      if (k != i && k != j && !is_beyond(value(k), squared_length, holds)) return false;
    }
    return true;
  }

  bool every_of_face(const Form<3>& value, const Holds& holds) {
    if (motion_.norm == Norm::linf) return is_beyond_cube(value, normal(), holds);
    if (!is_apart()) return holds(value.c, false);
    Form<4> squared_length{};
    for (const Form<2>& x : normal()) add_product(squared_length, x, x);
    return is_beyond(value, squared_length, holds);
  }

  // ---- linf -------------------------------------------------------------------------------------

  /// a·w > d(σ·a) for all σ, from a·w and those components of a that may differ from zero. If the
  /// coefficients of a component have one sign, that sign is the strictest σ.
  template <AnyForm Value, AnyForm Component, std::size_t count>
  bool is_beyond_cube(const Value& value, const std::array<Component, count>& components,
                      const Holds& holds) {
    if (std::ranges::none_of(value.c, is_positive)) return false;
    std::vector<Value> sums{value};
    for (const Component& component : components) {
      if (!is_apart()) continue;
      const Value step = component * reach_;
      const bool never_positive = std::ranges::none_of(component.c, is_positive);
      const bool is_both = !never_positive && std::ranges::any_of(component.c, is_negative);
      const std::size_t size = sums.size();
      for (std::size_t n = 0; n < size; ++n) {
        if (is_both) sums.push_back(sums[n] + step);
        never_positive ? sums[n] += step : sums[n] -= step;
      }
    }
    return std::ranges::all_of(sums, [&](const Value& form) { return holds(form.c, false); });
  }

  bool every_of_axis(const Feature& feature, const Holds& holds) {
    for (std::size_t k = 0; k < corners(); ++k) {
      const Form<1>& x = motion_.corners.at(k).at(feature.axis);
      if (!holds(((feature.sort == Sort::positive_axis ? x : -x) - reach_).c, false)) return false;
    }
    return true;
  }

  /// a·w = ((w_j − w_i) × w)_axis: one value at the side, one at all corners opposite.
  bool every_of_cross(const Feature& feature, const Holds& holds) {
    const std::size_t i = feature.i, j = feature.j, axis = feature.axis;
    const auto component = [&](std::size_t k) {
      return motion_.corners.at(j).at(k % 3) - motion_.corners.at(i).at(k % 3);
    };
    const std::array components{component(axis + 1), component(axis + 2)};
    std::size_t opposite = 0;
    while (opposite == i || opposite == j) ++opposite;
    return is_beyond_cube(cross(j, i, axis), components, holds) &&
           is_beyond_cube(cross(j, opposite, axis) - cross(i, opposite, axis), components, holds);
  }

  const MotionOf<Order>& motion_;
  /// d and d² as forms.
  Form<1> reach_;
  Form<2> square_;
  std::array<std::array<std::optional<Form<2>>, 4>, 4> products_;
  std::array<std::array<std::array<std::optional<Form<2>>, 3>, 4>, 4> crosses_;
  std::optional<Form<3>> face_;
  std::optional<std::array<Form<2>, 3>> normal_;
};

}  // namespace

Separator::Separator(const Feature& feature, std::vector<Condition> conditions)
    : feature_(feature) {
  std::ranges::stable_sort(conditions, {}, [](const Condition& x) { return x.form.size(); });
  values_.reserve(conditions.size());
  for (Condition& x : conditions) values_.push_back({std::move(x), {}, {}});
}

const Polynomial& Separator::polynomial(std::size_t n) {
  Value& value = values_[n];
  if (!value.polynomial) value.polynomial = to_polynomial(value.condition.form);
  return *value.polynomial;
}

std::vector<AlgebraicNumber>& Separator::roots(std::size_t n) {
  Value& value = values_[n];
  if (!value.roots) {
    value.roots.emplace();
    if (!value.condition.is_guard) value.roots = roots_in_unit_interval(polynomial(n));
  }
  return *value.roots;
}

bool Separator::holds_at(AlgebraicNumber& t) {
  if (t.rational() == Rational(0)) {
    return std::ranges::all_of(values_,
                               [](const Value& value) { return sgn(value.condition.form[0]) > 0; });
  }
  for (std::size_t n = 0; n < size(); ++n) {
    if (t.sign_of(polynomial(n)) <= 0) return false;
  }
  return true;
}

/// True if one of its polynomials is negative at a point between t and the bound, close to the
/// bound. For most separators this avoids the isolation of roots.
bool Separator::is_over_before(const AlgebraicNumber& t, const AlgebraicNumber& bound) {
  const Rational point = bound.interval().lower;
  if (t >= point) return false;
  for (std::size_t n = 0; n < size(); ++n) {
    if (sign_at(polynomial(n), point) < 0) return true;
  }
  return false;
}

Separator::End Separator::end_after(AlgebraicNumber& t, std::optional<AlgebraicNumber>& bound) {
  static constexpr unsigned long close = 32;
  if (bound) bound->refine_to_level(close);
  if (bound && is_over_before(t, *bound)) return {.root = {}, .is_within_bound = true};
  End end;
  for (std::size_t n = 0; n < size(); ++n) {
    auto& all = roots(n);
    const auto root = std::ranges::find_if(all, [&](auto& x) { return compare(t, x) < 0; });
    if (root == all.end() || (end.root && compare(*end.root, *root) <= 0)) continue;
    end.root = *root;
    end.is_within_bound = bound && compare(*root, *bound) <= 0;
    if (end.is_within_bound) break;
  }
  return end;
}

std::optional<AlgebraicNumber> Separator::begin_before(AlgebraicNumber& t) {
  std::optional<AlgebraicNumber> begin;
  for (std::size_t n = 0; n < size(); ++n) {
    for (AlgebraicNumber& root : roots(n)) {
      if (compare(root, t) < 0 && (!begin || compare(*begin, root) < 0)) begin = root;
    }
  }
  return begin;
}

template <class Order>
std::vector<Separator> separators(const MotionOf<Order>& motion) {
  Values<Order> values(motion);
  std::vector<Separator> result;
  for (const Feature& feature : values.features()) {
    std::vector<Separator::Condition> conditions;
    const bool possible = values.every(feature, [&](Coefficients form, bool is_guard) {
      if (std::ranges::none_of(form, is_positive)) return false;
      if (!std::ranges::all_of(form, is_positive)) {
        conditions.push_back({{form.begin(), form.end()}, is_guard});
      }
      return true;
    });
    if (!possible) continue;
    Separator separator(feature, std::move(conditions));
    if (separator.is_trivial()) return {std::move(separator)};
    result.push_back(std::move(separator));
  }
  return result;
}

std::optional<Span> farthest(std::vector<Separator>& separators, AlgebraicNumber t) {
  std::optional<Span> best;
  for (Separator& separator : separators) {
    if (!separator.holds_at(t)) continue;
    std::optional<AlgebraicNumber> none;
    Separator::End end = separator.end_after(t, best ? best->end : none);
    if (end.is_within_bound) continue;
    best = {&separator, std::move(end.root)};
    if (!best->end) break;
  }
  return best;
}

template <class Order>
std::optional<AlgebraicNumber> end_of_separation(const MotionOf<Order>& motion) {
  std::vector<Separator> all = separators(motion);
  AlgebraicNumber t(0);
  while (std::optional<Span> span = farthest(all, t)) {
    if (!span->end) return std::nullopt;
    t = std::move(*span->end);
  }
  return t;
}

template std::vector<Separator> separators(const MotionOf<Straight>&);
template std::vector<Separator> separators(const MotionOf<Curved>&);
template std::optional<AlgebraicNumber> end_of_separation(const MotionOf<Straight>&);
template std::optional<AlgebraicNumber> end_of_separation(const MotionOf<Curved>&);

}  // namespace touchstone::exact
