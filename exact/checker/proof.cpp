#include "exact/checker/proof.hpp"

#include <algorithm>
#include <utility>

namespace touchstone::checker {
namespace {

std::size_t bits(const mpz_class& x) { return mpz_sizeinbase(x.get_mpz_t(), 2); }

/// The product with a multiple of the number's denominator.
mpz_class scaled(const mpq_class& x, const mpz_class& factor) {
  mpz_class result = factor / x.get_den() * x.get_num();
  if (bits(result) > max_scaled_bits) reject("numbers too large over their common denominator");
  return result;
}

// ---- Forms --------------------------------------------------------------------------------------

/// c_0 r^n + c_1 r^(n−1) s + … + c_n s^n, where r and s are
///   - 1 and t: a polynomial in the time t; or
///   - 1−u and u, for the point u of an interval's way from its start (0) to its end (1): then c_k
///     is a positive multiple of the k-th Bernstein coefficient.
using Form = std::vector<mpz_class>;

/// sum + a·b, or sum − a·b with mpz_submul: in place, for most of the checker's time is spent here.
Form add_product(Form sum, const Form& a, const Form& b, decltype(mpz_addmul) add = mpz_addmul) {
  sum.resize(std::max(sum.size(), a.size() + b.size() - 1));
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      add(sum[i + j].get_mpz_t(), a[i].get_mpz_t(), b[j].get_mpz_t());
    }
  }
  return sum;
}

Form operator*(const Form& a, const Form& b) { return add_product({}, a, b); }

/// The form with r and s exchanged, and then x s + y r in the place of s.
Form substitute(Form form, const mpz_class& x, const mpz_class& y) {
  std::ranges::reverse(form);
  for (std::size_t step = 1; step < form.size(); ++step) {
    for (std::size_t k = form.size() - 1; k >= step; --k) {
      mpz_addmul(form[k - 1].get_mpz_t(), form[k].get_mpz_t(), y.get_mpz_t());
    }
  }
  mpz_class power = 1;
  for (mpz_class& c : form) {
    c *= power;
    power *= x;
  }
  return form;
}

/// Does the polynomial g (of degree ≥ 1, its leading coefficient not 0) divide p over the
/// rationals? Long division, each step multiplied by g's leading coefficient. Everything divides 0.
bool divides(const Form& g, Form p) {
  for (; p.size() >= g.size(); p.pop_back()) {
    const mpz_class leading = p.back();
    const std::size_t shift = p.size() - g.size();
    for (mpz_class& x : p) x *= g.back();
    for (std::size_t k = 0; k < g.size(); ++k) p[shift + k] -= leading * g[k];
  }
  return std::ranges::all_of(p, [](const mpz_class& x) { return x == 0; });
}

// ---- Vectors ------------------------------------------------------------------------------------

using Vector = std::array<Form, 3>;

Vector operator-(Vector a, const Vector& b) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < a[axis].size(); ++k) a[axis][k] -= b[axis][k];
  }
  return a;
}

Vector operator*(Vector a, const Form& factor) {
  for (Form& x : a) x = x * factor;
  return a;
}

Form dot(const Vector& a, const Form& x, const Form& y, const Form& z) {
  return add_product(add_product(a[0] * x, a[1], y), a[2], z);
}
Form dot(const Vector& a, const Vector& b) { return dot(a, b[0], b[1], b[2]); }

Form cross(const Vector& a, const Vector& b, std::size_t axis) {
  const std::size_t next = (axis + 1) % 3, last = (axis + 2) % 3;
  return add_product(a[next] * b[last], a[last], b[next], mpz_submul);
}

Vector cross(const Vector& a, const Vector& b) {
  return {cross(a, b, 0), cross(a, b, 1), cross(a, b, 2)};
}

Vector unit(std::size_t axis) {
  Vector result{Form{0}, Form{0}, Form{0}};
  result[axis][0] = 1;
  return result;
}

// ---- Proofs -------------------------------------------------------------------------------------

/// The proof of one certificate.
class Proof {
 public:
  Proof(const Certificate& certificate, std::int64_t& work_bits_left)
      : certificate_(certificate), work_bits_left_(work_bits_left), line_(certificate.line) {}

  void verify() try {
    find_corners();
    if (certificate_.has_subintervals()) prove_no_contact();
    if (certificate_.claim != Claim::no_collision) prove_contact(certificate_.contact);
  } catch (const Rejection& rejection) {
    reject(rejection.reason, line_);
  }

 private:
  /// Brings the coordinates and the distance to integers: all of space is enlarged by one factor,
  /// which changes no sign below. The corners are polynomials of degree 1 in t.
  void find_corners() {
    mpz_class factor = certificate_.distance.get_den();
    for (const mpq_class& x : certificate_.coordinates) factor = lcm(factor, x.get_den());
    distance_ = scaled(certificate_.distance, factor);
    std::array<mpz_class, 24> x;
    for (std::size_t n = 0; n < 24; ++n) x[n] = scaled(certificate_.coordinates[n], factor);
    using Pairs = std::vector<std::array<std::size_t, 2>>;
    static const Pairs vertex_face{{0, 1}, {0, 2}, {0, 3}};
    static const Pairs edge_edge{{0, 2}, {1, 2}, {1, 3}, {0, 3}};
    for (const auto& [plus, minus] : certificate_.is_edge_edge ? edge_edge : vertex_face) {
      Vector& w = corners_.emplace_back();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t a = 3 * plus + axis, b = 3 * minus + axis;
        const mpz_class start = x[a] - x[b], end = x[12 + a] - x[12 + b];
        w[axis] = {start, end - start};
      }
    }
  }

  /// Goes to a part of the certificate.
  void enter(const Part& part) {
    line_ = part.line;
    denominator_ = lcm(part.from.get_den(), part.to.get_den());
    from_ = scaled(part.from, denominator_);
    length_ = scaled(part.to, denominator_) - from_;
  }

  /// A polynomial in t as a form in u and 1−u, for the part's interval: t = (from + length·u) /
  /// denominator, so r = denominator·(u + (1−u)) and s = from·(u + (1−u)) + length·u.
  [[nodiscard]] Form on_interval(Form p) const {
    return substitute(substitute(substitute(std::move(p), denominator_, 0), length_, from_), 1, 1);
  }

  /// Is a form in 1−u and u seen to be positive for all u ∈ [0,1]? It is if the first and the last
  /// coefficient, its values at 0 and 1, are positive and no other is negative; or else if it is so
  /// on both halves: u = (1+v)/2, where twice 1−u and u are 1−v and (1−v) + 2v, and u = (1−v)/2.
  bool is_positive(Form form, std::size_t bisections = 0) {
    for (const mpz_class& x : form) work_bits_left_ -= std::int64_t(bits(x));
    if (work_bits_left_ < 0) reject("the proof takes too much work");
    doubt_ = "a polynomial is not positive at a point";
    if (form.front() <= 0 || form.back() <= 0) return false;
    if (std::ranges::all_of(form, [](const mpz_class& x) { return x >= 0; })) return true;
    doubt_ = "a polynomial is not seen to be positive within 128 bisections";
    if (++bisections > max_bisections || !is_positive(substitute(form, 2, 1), bisections))
      return false;
    std::ranges::reverse(form);
    return is_positive(substitute(std::move(form), 2, 1), bisections);
  }

  /// Proves that a polynomial in t is positive in the part's interval.
  void prove_positive(Form p) {
    if (!is_positive(on_interval(std::move(p)))) reject(doubt_);
  }

  /// Proves that there is no contact in [0,lower]: the subintervals follow one another without a
  /// gap.
  void prove_no_contact() {
    if (certificate_.subintervals.empty()) reject("there is no subinterval");
    mpq_class reached = 0;
    for (const Subinterval& subinterval : certificate_.subintervals) {
      enter(subinterval);
      if (subinterval.from != reached) reject("the subinterval does not begin where it should");
      if (subinterval.from > subinterval.to) reject("the subinterval ends before it begins");
      prove_separation(subinterval);
      reached = subinterval.to;
    }
    if (reached != certificate_.lower) reject("the last subinterval does not end where it should");
  }

  /// The normal N = a×b of the polygon. N·w is the same for all corners: N is orthogonal to a and
  /// b, hence also to w_3 − w_0 = b − a.
  [[nodiscard]] Vector normal() const {
    return cross(corners_[1] - corners_[0], corners_[2] - corners_[0]);
  }

  [[nodiscard]] const Vector& next(std::size_t corner) const {
    return corners_[(corner + 1) % corners_.size()];
  }

  /// The direction of a subinterval's feature, but for its sign.
  [[nodiscard]] Vector direction(const Subinterval& subinterval) const {
    if (subinterval.feature == Feature::face) return normal();
    if (subinterval.feature == Feature::axis) return unit(subinterval.axis);
    const Vector& d = corners_[subinterval.corners[0]];
    if (subinterval.feature == Feature::vertex) return d;
    const Vector e = corners_[subinterval.corners[1]] - d;
    if (subinterval.feature == Feature::cross) return cross(unit(subinterval.axis), e);
    return d * dot(e, e) - e * dot(d, e);
  }

  /// D (σ·d) for every vector σ of signs. Those that are surely the same are left out.
  [[nodiscard]] std::vector<Form> reaches(const Vector& d) const {
    std::vector<Form> sums{Form{0}};
    for (const Form& x : d) {
      const bool is_zero = std::ranges::all_of(x, [](const mpz_class& c) { return c == 0; });
      if (is_zero || distance_ == 0) continue;
      for (std::size_t n = sums.size(); n-- > 0;) {
        sums.push_back(add_product(sums[n], x, {distance_}, mpz_submul));
        sums[n] = add_product(sums[n], x, {distance_});
      }
    }
    return sums;
  }

  /// value − D² |d|².
  [[nodiscard]] Form less_square(const Form& value, const Vector& d) const {
    return add_product(value, dot(d, d), {distance_ * distance_}, mpz_submul);
  }

  /// Proves d·w > D‖d‖ for all corners w, d the direction of the subinterval's feature, ‖d‖ its
  /// length or, for linf, the greatest of the σ·d.
  void prove_separation(const Subinterval& subinterval) {
    const Vector d = direction(subinterval) * Form{subinterval.is_negative ? -1 : 1};
    const std::size_t count = subinterval.feature == Feature::face ? 1 : corners_.size();
    const std::vector<Form> sums = certificate_.is_l2 ? std::vector<Form>{Form{0}} : reaches(d);
    for (std::size_t n = 0; n < count; ++n) {
      const Form value = dot(d, corners_[n]);
      for (const Form& sum : sums) prove_positive(add_product(value, sum, {-1}));
      if (certificate_.is_l2 && distance_ != 0) prove_positive(less_square(value * value, d));
    }
  }

  /// Proves that there is a contact in the interval of the claim: at any root of g in its own.
  void prove_contact(const Contact& contact) {
    enter(contact);
    if (contact.from < certificate_.lower || contact.to > certificate_.upper) {
      reject("the contact is not in the interval of the claim");
    }
    g_ = contact.is_root ? contact.g : Form{-contact.from.get_num(), contact.from.get_den()};
    if (contact.is_root && contact.from >= contact.to) reject("the root's interval is empty");
    const Form g = on_interval(g_);
    if (contact.is_root && sgn(g.front()) * sgn(g.back()) >= 0) {
      reject("the polynomial does not change its sign in the interval");
    }
    if (contact.place == Place::triangle) return prove_triangle(contact);
    if (contact.place == Place::segment) return prove_segment(contact);
    contact.place == Place::axes ? prove_axes() : prove_near(contact);
  }

  /// The sign of a polynomial at the time of the contact.
  int sign(Form p) {
    if (divides(g_, p)) return 0;
    const Form form = on_interval(std::move(p));
    const int sign = sgn(form.front());
    if (!is_positive(form * Form{sign})) reject(doubt_);
    return sign;
  }

  void prove_triangle(const Contact& contact) {
    const auto& [i, j, k] = contact.corners;
    const std::size_t axis = contact.axis;
    const Vector &a = corners_[i], &b = corners_[j], &c = corners_[k];
    const Vector weights{cross(b, c, axis), cross(c, a, axis), cross(a, b, axis)};
    const Form one{1};
    const int sum = sign(dot(weights, one, one, one));
    if (sum == 0) reject("the triangle's normal is 0 on this axis");
    // det(a,b,c), by its minors of this axis
    if (sign(dot(weights, a[axis], b[axis], c[axis])) != 0) {
      reject("the origin is not in the triangle's plane");
    }
    for (const Form& weight : weights) {
      if (sign(weight) * sum < 0) reject("the origin is not in the triangle");
    }
  }

  void prove_segment(const Contact& contact) {
    const Vector &a = corners_[contact.corners[0]], &b = corners_[contact.corners[1]];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (sign(cross(a, b, axis)) != 0) reject("the origin is not on the segment's line");
    }
    if (sign(dot(a, b)) > 0) reject("the origin is not on the segment");
  }

  /// Proves that a vertex, or the foot of the perpendicular on an edge or on the face, is in the
  /// polygon and within D of the origin.
  void prove_near(const Contact& contact) {
    const Vector &a = corners_[contact.corners[0]], &b = corners_[contact.corners[1]];
    Vector base = unit(0);  // its square is what that of the distance is divided by
    Form square = dot(a, a);
    bool is_inside = true;
    if (contact.place == Place::edge) {
      base = b - a;
      square = dot(cross(a, b), cross(a, b));
      is_inside = sign(dot(a, base)) <= 0 && sign(dot(b, base)) >= 0;
    } else if (contact.place == Place::face) {
      base = normal();
      square = dot(base, a) * dot(base, a);
      for (std::size_t n = 0; n < corners_.size(); ++n) {
        is_inside = is_inside && sign(dot(base, cross(corners_[n], next(n)))) >= 0;
      }
    }
    if (!is_inside) reject("the nearest point is not inside");
    if (sign(dot(base, base)) == 0) reject("the edge's or the face's direction is 0");
    if (sign(less_square(square, base)) > 0) reject("the place is farther than the distance");
  }

  /// Proves that no axis separates the polygon from the cube of the distance.
  void prove_axes() {
    if (certificate_.is_l2) reject("axes prove nothing of the distance in l2");
    std::vector<Vector> axes{normal(), unit(0), unit(1), unit(2)};
    for (std::size_t n = 0; n < 3 * corners_.size(); ++n) {
      axes.push_back(cross(unit(n % 3), next(n / 3) - corners_[n / 3]));
    }
    for (const Vector& axis : axes) {
      if (!is_reached(axis) || !is_reached(axis * Form{-1}))
        reject("an axis separates, or is not seen not to");
    }
  }

  /// Is d·w ≤ D‖d‖ seen for some corner w? For some σ is enough.
  bool is_reached(const Vector& d) {
    for (const Form& sum : reaches(d)) {
      for (const Vector& w : corners_) {
        const Form gap = add_product(sum, dot(d, w), {-1});
        if (divides(g_, gap) || is_positive(on_interval(gap))) return true;
      }
    }
    return false;
  }

  const Certificate& certificate_;
  std::int64_t& work_bits_left_;
  /// That of the part at hand.
  std::size_t line_;
  mpz_class distance_;
  std::vector<Vector> corners_;
  /// Why is_positive saw it not.
  const char* doubt_ = "";
  /// The interval of the part at hand: numerators of its start and its length, and their
  /// denominator.
  mpz_class from_, length_, denominator_;
  /// The polynomial whose root the time of the contact is.
  Form g_;
};

}  // namespace

void verify(const Certificate& certificate, std::int64_t& work_bits_left) {
  Proof(certificate, work_bits_left).verify();
}

}  // namespace touchstone::checker
