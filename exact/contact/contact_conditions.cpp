#include "exact/contact/contact_conditions.hpp"

#include <utility>

namespace touchstone::exact {
namespace {

/// Collects the conditions of a place while they are found to hold.
class Conditions {
 public:
  explicit Conditions(AlgebraicNumber& time) : time_(time) {}

  /// Adds the form to the conditions. \returns its sign at the time.
  template <AnyForm F>
  int sign(const F& form) {
    const int sign = sign_at(form, time_);
    add(form, sign);
    return sign;
  }

  template <AnyForm F>
  void add(const F& form, int sign) {
    // A polynomial that is zero throughout is divisible by all others.
    if (form.is_zero()) return;
    (sign == 0 ? zero_ : nonzero_).push_back(to_polynomial(form));
  }

  ContactConditions of(const ContactPlace& place) && {
    return {place, std::move(zero_), std::move(nonzero_)};
  }

 private:
  AlgebraicNumber& time_;
  std::vector<Polynomial> zero_, nonzero_;
};

using Found = std::optional<ContactConditions>;

// ---- The origin itself --------------------------------------------------------------------------

/// All triangles of the polygon have its normal (of half a parallelogram's length or the whole) and
/// its determinant.
template <class Order>
Found in_triangle(const MotionOf<Order>& motion, AlgebraicNumber& time,
                  const std::array<std::size_t, 3>& corners, std::size_t axis) {
  Conditions conditions(time);
  if (conditions.sign(determinant(motion)) != 0) return std::nullopt;
  const int orientation = conditions.sign(normal_component(motion, axis));
  for (std::size_t k = 0; k < 3; ++k) {
    const auto side = cross_component(motion, corners.at(k), corners.at((k + 1) % 3), axis);
    if (conditions.sign(side) * orientation < 0) return std::nullopt;
  }
  return std::move(conditions).of(TriangleContact{corners, axis});
}

template <class Order>
Found on_segment(const MotionOf<Order>& motion, AlgebraicNumber& time,
                 const std::array<std::size_t, 2>& corners) {
  Conditions conditions(time);
  const auto [i, j] = corners;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (conditions.sign(cross_component(motion, i, j, axis)) != 0) return std::nullopt;
  }
  if (conditions.sign(dot(motion, i, j)) > 0) return std::nullopt;
  return std::move(conditions).of(SegmentContact{corners});
}

// ---- l2 -----------------------------------------------------------------------------------------

/// d² times the form, in the degree of the values that it is compared with.
template <class Order, AnyForm F>
auto within(const MotionOf<Order>& motion, const F& form) {
  return form * (motion.reach() * motion.reach());
}

template <class Order>
Found contact_at_vertex(const MotionOf<Order>& motion, AlgebraicNumber& time, std::size_t corner) {
  Conditions conditions(time);
  const auto excess = dot(motion, corner, corner) - motion.reach() * motion.reach();
  if (conditions.sign(excess) > 0) return std::nullopt;
  return std::move(conditions).of(VertexContact{corner});
}

template <class Order>
Found contact_at_edge(const MotionOf<Order>& motion, AlgebraicNumber& time,
                      const std::array<std::size_t, 2>& corners) {
  Conditions conditions(time);
  const auto [i, j] = corners;
  const auto a_a = dot(motion, i, i), a_b = dot(motion, i, j), b_b = dot(motion, j, j);
  const auto from = a_b - a_a, to = b_b - a_b, length = to - from;
  if (conditions.sign(length) == 0 || conditions.sign(from) > 0 || conditions.sign(to) < 0) {
    return std::nullopt;
  }
  auto excess = a_a * b_b;  // |w_i × w_j|² by Lagrange's identity
  subtract_product(excess, a_b, a_b);
  if (conditions.sign(excess - within(motion, length)) > 0) return std::nullopt;
  return std::move(conditions).of(EdgeContact{corners});
}

template <class Order>
Found contact_at_face(const MotionOf<Order>& motion, AlgebraicNumber& time) {
  Conditions conditions(time);
  std::array<typename Order::template Form<2>, 3> normal;
  typename Order::template Form<4> length{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    normal.at(axis) = normal_component(motion, axis);
    add_product(length, normal.at(axis), normal.at(axis));
  }
  if (conditions.sign(length) == 0) return std::nullopt;
  for (std::size_t i = 0; i < motion.corner_count; ++i) {
    typename Order::template Form<4> side{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t next = (i + 1) % motion.corner_count;
      add_product(side, normal.at(axis), cross_component(motion, i, next, axis));
    }
    if (conditions.sign(side) < 0) return std::nullopt;
  }
  const auto det = determinant(motion);
  if (conditions.sign(det * det - within(motion, length)) > 0) return std::nullopt;
  return std::move(conditions).of(FaceContact{});
}

template <class Order>
Found contact_in_l2(const MotionOf<Order>& motion, AlgebraicNumber& time) {
  for (std::size_t i = 0; i < motion.corner_count; ++i) {
    if (Found found = contact_at_vertex(motion, time, i)) return found;
  }
  for (std::size_t i = 0; i < motion.corner_count; ++i) {
    if (Found found = contact_at_edge(motion, time, {i, (i + 1) % motion.corner_count}))
      return found;
  }
  return contact_at_face(motion, time);
}

// ---- linf ---------------------------------------------------------------------------------------

/// Collects for every axis a corner that is not above and one that is not below.
template <class Order>
class CubeContact {
 public:
  template <std::size_t n>
  using Form = typename Order::template Form<n>;

  CubeContact(const MotionOf<Order>& motion, AlgebraicNumber& time)
      : motion_(motion), time_(time), conditions_(time) {}

  Found find() {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::array<Form<0>, 3> direction{};
      direction.at(axis) = Form<0>{{Integer(1)}};
      if (!reaches_across(direction)) return std::nullopt;
    }
    const std::array normal{normal_component(motion_, 0), normal_component(motion_, 1),
                            normal_component(motion_, 2)};
    if (!reaches_across(normal)) return std::nullopt;
    // Opposite sides of a parallelogram are parallel.
    const std::size_t sides = motion_.kind == ContactKind::vertex_face ? 3 : 2;
    for (std::size_t i = 0; i < sides; ++i) {
      if (!reaches_across_side(i)) return std::nullopt;
    }
    return std::move(conditions_).of(AxesContact{});
  }

 private:
  /// The axes e_k × (w_j − w_i).
  bool reaches_across_side(std::size_t i) {
    const auto& from = motion_.corners.at(i);
    const auto& to = motion_.corners.at((i + 1) % motion_.corner_count);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t y = (axis + 1) % 3, z = (axis + 2) % 3;
      std::array<Form<1>, 3> direction{};
      direction.at(y) = from.at(z) - to.at(z);
      direction.at(z) = to.at(y) - from.at(y);
      if (!reaches_across(direction)) return false;
    }
    return true;
  }

  /// True if the polygon has corners on both sides of the planes that would separate it from the
  /// cube along an axis.
  template <AnyForm F>
  bool reaches_across(const std::array<F, 3>& direction) {
    F length{};
    for (const F& x : direction) sign_at(x, time_) < 0 ? length -= x : length += x;
    const auto reach = length * motion_.reach();
    const auto value = [&](std::size_t corner) {
      decltype(length * motion_.reach()) sum{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        add_product(sum, direction.at(axis), motion_.corners.at(corner).at(axis));
      }
      return sum;
    };
    return add_one_not_positive([&](std::size_t k) { return value(k) - reach; }) &&
           add_one_not_positive([&](std::size_t k) { return -value(k) - reach; });
  }

  /// A corner of one form, with a negative value if possible: that condition is weaker.
  template <class FormOf>
  bool add_one_not_positive(const FormOf& form_of) {
    std::optional<decltype(form_of(0))> zero;
    for (std::size_t k = 0; k < motion_.corner_count; ++k) {
      const auto form = form_of(k);
      const int sign = sign_at(form, time_);
      if (sign == 0) zero = form;
      if (sign >= 0) continue;
      conditions_.add(form, sign);
      return true;
    }
    if (zero) conditions_.add(*zero, 0);
    return zero.has_value();
  }

  const MotionOf<Order>& motion_;
  AlgebraicNumber& time_;
  Conditions conditions_;
};

}  // namespace

template <class Order>
std::optional<ContactConditions> find_contact(const MotionOf<Order>& motion,
                                              AlgebraicNumber& time) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (sign_at(normal_component(motion, axis), time) == 0) continue;
    for (std::size_t second = 1; second + 1 < motion.corner_count; ++second) {
      if (Found found = in_triangle(motion, time, {0, second, second + 1}, axis)) return found;
    }
    return std::nullopt;
  }
  for (std::size_t i = 0; i < motion.corner_count; ++i) {
    if (Found found = on_segment(motion, time, {i, (i + 1) % motion.corner_count})) return found;
  }
  return std::nullopt;
}

template <class Order>
std::optional<ContactConditions> find_near_contact(const MotionOf<Order>& motion,
                                                   AlgebraicNumber& time) {
  if (motion.norm == Norm::l2) return contact_in_l2(motion, time);
  return CubeContact(motion, time).find();
}

template std::optional<ContactConditions> find_contact(const MotionOf<Straight>&, AlgebraicNumber&);
template std::optional<ContactConditions> find_contact(const MotionOf<Curved>&, AlgebraicNumber&);
template std::optional<ContactConditions> find_near_contact(const MotionOf<Straight>&,
                                                            AlgebraicNumber&);
template std::optional<ContactConditions> find_near_contact(const MotionOf<Curved>&,
                                                            AlgebraicNumber&);

}  // namespace touchstone::exact
