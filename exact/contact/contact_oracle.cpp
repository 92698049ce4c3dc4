#include "exact/contact/contact_oracle.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace touchstone::exact {
namespace {

/// The contact's (u,v) as forms with a common denominator that is positive at the time of contact.
template <class Order>
struct ContactForms {
  typename Order::template Form<2> u_numerator, v_numerator, denominator;
};

/// The sign rules of the theorem at given times. Polynomials are computed when they are first
/// needed.
template <class Order>
class ContainsOrigin {
 public:
  template <std::size_t n>
  using Form = typename Order::template Form<n>;
  using Contact = ContactForms<Order>;

  explicit ContainsOrigin(const MotionOf<Order>& motion) : motion_(motion) {}

  /// The place of the origin in conv{w_i(t)}; empty if it is outside. \pre det vanishes at t.
  std::optional<Contact> at(AlgebraicNumber& t) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int orientation = sign_at(normal(axis), t);
      if (orientation != 0) return in_polygon(t, axis, orientation);
    }
    return in_segment(t);
  }

  /// The polynomials, for motion in a common plane, between whose roots the answer does not change.
  std::vector<Polynomial> planar_polynomials() {
    std::vector<Polynomial> result;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (normal(axis).is_zero()) continue;
      result.push_back(to_polynomial(normal(axis)));
      for (std::size_t edge = 0; edge < edges(); ++edge) append(cross(edge, axis), result);
      return result;
    }
    for (std::size_t edge = 0; edge < edges(); ++edge) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (append(cross(edge, axis), result)) break;
      }
      append(dot(motion_, edge, next(edge)), result);
    }
    return result;
  }

 private:
  const Form<2>& normal(std::size_t axis) {
    auto& form = normals_.at(axis);
    if (!form) form = normal_component(motion_, axis);
    return *form;
  }
  /// Component `axis` of w_i × w_j, where corners i and j end an edge.
  const Form<2>& cross(std::size_t edge, std::size_t axis) {
    auto& form = crosses_.at(edge).at(axis);
    if (!form) form = cross_component(motion_, edge, next(edge), axis);
    return *form;
  }

  [[nodiscard]] std::size_t edges() const { return motion_.corner_count; }
  [[nodiscard]] std::size_t next(std::size_t corner) const { return (corner + 1) % edges(); }

  /// Appends the polynomial unless it vanishes identically; true if it was appended.
  static bool append(const Form<2>& form, std::vector<Polynomial>& result) {
    if (form.is_zero()) return false;
    result.push_back(to_polynomial(form));
    return true;
  }

  /// N_axis ≠ 0. Cramer's rule: u N = w_last × w_0 and v N = w_0 × w_1.
  std::optional<Contact> in_polygon(AlgebraicNumber& t, std::size_t axis, int orientation) {
    for (std::size_t edge = 0; edge < edges(); ++edge) {
      if (sign_at(cross(edge, axis), t) * orientation < 0) return std::nullopt;
    }
    const auto oriented = [&](const Form<2>& form) { return orientation > 0 ? form : -form; };
    return Contact{oriented(cross(edges() - 1, axis)), oriented(cross(0, axis)),
                   oriented(normal(axis))};
  }

  /// N = 0.
  std::optional<Contact> in_segment(AlgebraicNumber& t) {
    for (std::size_t edge = 0; edge < edges(); ++edge) {
      const auto vanishes = [&](std::size_t axis) { return sign_at(cross(edge, axis), t) == 0; };
      if (vanishes(0) && vanishes(1) && vanishes(2) &&
          sign_at(dot(motion_, edge, next(edge)), t) <= 0) {
        return on_segment(t, edge, next(edge));
      }
    }
    return std::nullopt;
  }

  /// 0 = (1−λ) w_i + λ w_j, hence λ = w_i,k / (w_i,k − w_j,k) for any axis k where they differ.
  [[nodiscard]] Contact on_segment(AlgebraicNumber& t, std::size_t i, std::size_t j) const {
    Form<1> numerator{}, denominator = motion_.denominator.form();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Form<1>& from = motion_.corners.at(i).at(axis);
      const Form<1> difference = from - motion_.corners.at(j).at(axis);
      const int sign = sign_at(difference, t);
      if (sign == 0) continue;
      numerator = sign > 0 ? from : -from;
      denominator = sign > 0 ? difference : -difference;
      break;
    }
    const auto between = [&](int at_i, int at_j) {
      const Form<1> start = multiple(denominator, at_i);
      return (start + multiple(numerator, at_j - at_i)) * motion_.denominator.form();
    };
    const Corner &from = corners(motion_.kind)[i], &to = corners(motion_.kind)[j];
    return {between(from.u, to.u), between(from.v, to.v), denominator * motion_.denominator.form()};
  }

  const MotionOf<Order>& motion_;
  std::array<std::optional<Form<2>>, 3> normals_;
  std::array<std::array<std::optional<Form<2>>, 3>, 4> crosses_;
};

/// The denominator times F(t,u,v), component `axis`, from the eight points.
template <class Order>
auto scaled_contact_function(const MotionOf<Order>& motion, const ContactForms<Order>& contact,
                             std::size_t axis) {
  const auto& [u, v, d] = contact;
  const auto point = [&](std::size_t i) -> const auto& { return motion.points.at(i).at(axis); };
  typename Order::template Form<3> value{};
  if (motion.kind == ContactKind::vertex_face) {
    add_product(value, d, point(0));
    subtract_product(value, d - u - v, point(1));
    subtract_product(value, u, point(2));
  } else {
    add_product(value, d - u, point(0));
    add_product(value, u, point(1));
    subtract_product(value, d - v, point(2));
  }
  subtract_product(value, v, point(3));
  return value;
}

/// Checks that F(toi,u,v) = 0 and that (u,v) is in the domain; a failure is a fault of the oracle.
template <class Order>
void check_contact(const MotionOf<Order>& motion, const ContactForms<Order>& contact,
                   AlgebraicNumber& toi) {
  const auto& [u, v, d] = contact;
  bool holds = sign_at(d, toi) > 0;
  const auto require_nonnegative = [&](const auto& form) {
    holds = holds && sign_at(form, toi) >= 0;
  };
  require_nonnegative(u);
  require_nonnegative(v);
  if (motion.kind == ContactKind::vertex_face) {
    require_nonnegative(d - u - v);
  } else {
    require_nonnegative(d - u);
    require_nonnegative(d - v);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto value = scaled_contact_function(motion, contact, axis);
    holds = holds && (value.is_zero() || toi.is_root_of(to_polynomial(value)));
  }
  if (!holds) throw std::logic_error("touchstone: the oracle found a contact where F is not zero");
}

/// A polynomial with the same roots in [0,1]: a corner is multiplied by the denominators of the
/// other points, so that products of corners have high powers of these, which make it slow to find
/// roots.
template <class Order>
Polynomial without_denominators(const MotionOf<Order>& motion, Polynomial p) {
  for (const Polynomial& factor : motion.denominator.factors()) {
    while (std::optional<Polynomial> rest = quotient_if_exact(p, factor)) p = *std::move(rest);
  }
  return p;
}

/// Candidates of motion in a common plane, in ascending order.
template <class Order>
std::vector<AlgebraicNumber> planar_candidates(const MotionOf<Order>& motion,
                                               ContainsOrigin<Order>& contains_origin) {
  std::vector<Polynomial> distinct;
  for (const Polynomial& p : contains_origin.planar_polynomials()) {
    Polynomial squarefree = squarefree_part(without_denominators(motion, p));
    if (std::ranges::find(distinct, squarefree) == distinct.end()) {
      distinct.push_back(std::move(squarefree));
    }
  }
  std::vector<AlgebraicNumber> candidates{AlgebraicNumber(0)};
  for (const Polynomial& p : distinct) {
    auto roots = roots_in_unit_interval(p);
    std::ranges::move(roots, std::back_inserter(candidates));
  }
  std::ranges::sort(candidates, [](const auto& a, const auto& b) { return a < b; });
  candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
  return candidates;
}

/// Candidate times in ascending order, among them the toi if the query collides.
template <class Order>
std::vector<AlgebraicNumber> candidates(const MotionOf<Order>& motion,
                                        ContainsOrigin<Order>& contains_origin) {
  const auto det = determinant(motion);
  const auto is_positive = [](const Integer& c) { return sgn(c) > 0; };
  const auto is_negative = [](const Integer& c) { return sgn(c) < 0; };
  if (std::ranges::all_of(det.c, is_positive) || std::ranges::all_of(det.c, is_negative)) return {};
  if (det.is_zero()) return planar_candidates(motion, contains_origin);
  return roots_in_unit_interval(without_denominators(motion, to_polynomial(det)));
}

}  // namespace

template <class Order>
Decision decide_contact(const MotionOf<Order>& motion) {
  ContainsOrigin<Order> contains_origin(motion);
  for (AlgebraicNumber& t : candidates(motion, contains_origin)) {
    const auto forms = contains_origin.at(t);
    if (!forms) continue;
    check_contact(motion, *forms, t);
    return {.toi = std::move(t),
            .contact = Contact{to_polynomial(forms->u_numerator), to_polynomial(forms->v_numerator),
                               to_polynomial(forms->denominator)}};
  }
  return {};
}

template Decision decide_contact(const MotionOf<Straight>& motion);
template Decision decide_contact(const MotionOf<Curved>& motion);

}  // namespace touchstone::exact
