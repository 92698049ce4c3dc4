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

/// sum + a·b: in place, for most of the checker's time is spent here.
Form add_product(Form sum, const Form& a, const Form& b) {
  sum.resize(std::max(sum.size(), a.size() + b.size() - 1));
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      mpz_addmul(sum[i + j].get_mpz_t(), a[i].get_mpz_t(), b[j].get_mpz_t());
    }
  }
  return sum;
}

/// sum − a·b.
Form subtract_product(Form sum, const Form& a, const Form& b) {
  sum.resize(std::max(sum.size(), a.size() + b.size() - 1));
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      mpz_submul(sum[i + j].get_mpz_t(), a[i].get_mpz_t(), b[j].get_mpz_t());
    }
  }
  return sum;
}

Form operator*(const Form& a, const Form& b) { return add_product({}, a, b); }

Form operator-(Form a, const Form& b) { return add_product(std::move(a), b, {-1}); }

bool is_zero(const Form& form) {
  return std::ranges::all_of(form, [](const mpz_class& x) { return x == 0; });
}

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

/// True if the polynomial g (of degree ≥ 1, its leading coefficient not 0) divides p over the
/// rationals. Long division, each step multiplied by g's leading coefficient.
bool divides(const Form& g, Form p) {
  for (; p.size() >= g.size(); p.pop_back()) {
    const mpz_class leading = p.back();
    const std::size_t shift = p.size() - g.size();
    for (mpz_class& x : p) x *= g.back();
    for (std::size_t k = 0; k < g.size(); ++k) p[shift + k] -= leading * g[k];
  }
  return is_zero(p);
}

// ---- Vectors ------------------------------------------------------------------------------------

using FormVector = std::array<Form, 3>;

FormVector operator-(FormVector a, const FormVector& b) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    a[axis].resize(std::max(a[axis].size(), b[axis].size()));
    for (std::size_t k = 0; k < b[axis].size(); ++k) a[axis][k] -= b[axis][k];
  }
  return a;
}

FormVector operator*(FormVector a, const Form& factor) {
  for (Form& x : a) x = x * factor;
  return a;
}

Form dot(const FormVector& a, const FormVector& b) {
  const Form sum = add_product(a[0] * b[0], a[1], b[1]);
  return add_product(sum, a[2], b[2]);
}

Form cross(const FormVector& a, const FormVector& b, std::size_t axis) {
  const std::size_t next = (axis + 1) % 3;
  const std::size_t last = (axis + 2) % 3;
  return subtract_product(a[next] * b[last], a[last], b[next]);
}

FormVector cross(const FormVector& a, const FormVector& b) {
  return {cross(a, b, 0), cross(a, b, 1), cross(a, b, 2)};
}

FormVector unit(std::size_t axis) {
  FormVector result{Form{0}, Form{0}, Form{0}};
  result[axis][0] = 1;
  return result;
}

// ---- Curves -------------------------------------------------------------------------------------

/// Σ b_k c_k (1−t)^(n−k) t^k with b the binomials of n, as a polynomial in t.
Form bernstein_polynomial(Form c) {
  mpz_class binomial = 1;
  const auto degree = static_cast<unsigned long>(c.size() - 1);
  for (unsigned long k = 1; k < degree; ++k) {
    binomial = binomial * (degree - k + 1) / k;
    c[k] *= binomial;
  }
  Form p = substitute(std::move(c), 1, -1);  // r = t and s = 1, until they are exchanged
  std::ranges::reverse(p);
  return p;
}

/// Makes the factor a multiple of the numbers' denominators.
void include_denominators(mpz_class& factor, const std::vector<mpq_class>& numbers) {
  for (const mpq_class& x : numbers) factor = lcm(factor, x.get_den());
}

/// A multiple of the curve's denominator, positive on [0,1].
Form denominator_of(const Curve& curve) {
  if (curve.weights.empty()) return {1};
  mpz_class factor = 1;
  include_denominators(factor, curve.weights);
  Form weights;
  for (const mpq_class& weight : curve.weights) weights.push_back(scaled(weight, factor));
  return bernstein_polynomial(std::move(weights));
}

/// `factor` times the curve's position times its denominator.
FormVector numerator_of(const Curve& curve, const mpz_class& factor) {
  mpz_class weight_factor = 1;
  include_denominators(weight_factor, curve.weights);
  FormVector result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Form c;
    c.reserve(curve.control.size());
    for (const Point& point : curve.control) c.push_back(scaled(point[axis], factor));
    for (std::size_t k = 0; k < curve.weights.size(); ++k) {
      c[k] *= scaled(curve.weights[k], weight_factor);
    }
    result[axis] = bernstein_polynomial(std::move(c));
  }
  return result;
}

// ---- Proofs -------------------------------------------------------------------------------------

/// The corners of a query, each the difference of two of its points: their numbers.
using Differences = std::vector<std::pair<std::size_t, std::size_t>>;
const Differences vertex_face_corners{{0, 1}, {0, 2}, {0, 3}};
const Differences edge_edge_corners{{0, 2}, {1, 2}, {1, 3}, {0, 3}};

/// The proof of one certificate.
class Proof {
 public:
  Proof(const Certificate& certificate, std::int64_t& work_bits_left)
      : certificate_(certificate), work_bits_left_(work_bits_left), line_(certificate.line) {}

  void verify() try {
    find_corners();
    if (certificate_.has_subintervals()) prove_no_contact();
    if (certificate_.has_contact()) prove_contact(certificate_.contact);
  } catch (const Rejection& rejection) {
    reject(rejection.reason, line_);
  }

 private:
  /// Makes the corners and the distance polynomials in t with integer coefficients. At each time
  /// all of space is enlarged by one factor, which changes no sign below: a common denominator of
  /// the coordinates, times the product of the denominators of all points, equal ones once.
  void find_corners() {
    const auto& [kind, curves] = certificate_.query;
    mpz_class factor = certificate_.separation.distance.get_den();
    std::array<Form, 4> own;
    std::vector<Form> denominators;
    for (std::size_t i = 0; i < curves.size(); ++i) {
      for (const Point& point : curves[i].control) {
        for (const mpq_class& x : point) factor = lcm(factor, x.get_den());
      }
      own[i] = denominator_of(curves[i]);
      if (std::ranges::find(denominators, own[i]) == denominators.end()) {
        denominators.push_back(own[i]);
      }
    }
    reach_ = {scaled(certificate_.separation.distance, factor)};
    for (const Form& denominator : denominators) reach_ = reach_ * denominator;
    std::array<FormVector, 4> points;
    for (std::size_t i = 0; i < curves.size(); ++i) {
      points[i] = numerator_of(curves[i], factor);
      for (const Form& denominator : denominators) {
        if (denominator != own[i]) points[i] = points[i] * denominator;
      }
    }
    for (const auto& [a, b] : kind == Kind::edge_edge ? edge_edge_corners : vertex_face_corners) {
      corners_.push_back(points[a] - points[b]);
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
    Form form = substitute(std::move(p), denominator_, 0);
    form = substitute(std::move(form), length_, from_);
    return substitute(std::move(form), 1, 1);
  }

  /// True if a form in 1−u and u is proved positive for all u ∈ [0,1]: the first and the last
  /// coefficient, its values at 0 and 1, are positive and no other is negative; or the same holds
  /// on both halves: u = (1+v)/2, where twice 1−u and u are 1−v and (1−v) + 2v, and u = (1−v)/2.
  bool is_positive(Form form, std::size_t bisections = 0) {
    for (const mpz_class& x : form) work_bits_left_ -= static_cast<std::int64_t>(bits(x));
    if (work_bits_left_ < 0) reject("the proof takes too much work");
    doubt_ = "a polynomial is not positive at a point";
    if (form.front() <= 0 || form.back() <= 0) return false;
    if (std::ranges::all_of(form, [](const mpz_class& x) { return x >= 0; })) return true;
    doubt_ = "a polynomial is not seen to be positive within 128 bisections";
    if (bisections == max_bisections) return false;
    if (!is_positive(substitute(form, 2, 1), bisections + 1)) return false;
    std::ranges::reverse(form);
    return is_positive(substitute(std::move(form), 2, 1), bisections + 1);
  }

  /// Proves that a polynomial in t is positive in the part's interval.
  void prove_positive(Form p) {
    if (!is_positive(on_interval(std::move(p)))) reject(doubt_);
  }

  // ---- No contact ----

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
  [[nodiscard]] FormVector normal() const {
    return cross(corners_[1] - corners_[0], corners_[2] - corners_[0]);
  }

  [[nodiscard]] bool is_tetrahedron() const { return certificate_.query.kind == Kind::tetrahedron; }

  /// The next corner in cyclic order.
  [[nodiscard]] const FormVector& next(std::size_t corner) const {
    return corners_[(corner + 1) % corners_.size()];
  }

  /// The direction of a subinterval's feature, but for its sign.
  [[nodiscard]] FormVector direction(const Subinterval& subinterval) const {
    const FormVector& w = corners_[subinterval.corners[0]];
    const FormVector& other = corners_[subinterval.corners[1]];
    if (subinterval.feature == Feature::vertex) return w;
    if (subinterval.feature == Feature::face) return normal();
    if (subinterval.feature == Feature::axis) return unit(subinterval.axis);
    const FormVector e = other - w;
    if (subinterval.feature == Feature::cross) return cross(unit(subinterval.axis), e);
    // The part of w that is perpendicular to e, times |e|².
    return w * dot(e, e) - e * dot(w, e);
  }

  /// D (σ·d) for every vector σ of signs, without those that are surely equal; the greatest is
  /// D‖d‖* in linf. (D is enlarged as the corners are.)
  [[nodiscard]] std::vector<Form> reaches(const FormVector& d) const {
    std::vector<Form> sums{Form{0}};
    if (certificate_.separation.distance == 0) return sums;
    for (const Form& x : d) {
      if (is_zero(x)) continue;
      std::vector<Form> longer;
      for (const Form& sum : sums) {
        longer.push_back(add_product(sum, x, reach_));
        longer.push_back(subtract_product(sum, x, reach_));
      }
      sums = std::move(longer);
    }
    return sums;
  }

  /// value − D² |d|².
  [[nodiscard]] Form less_square(const Form& value, const FormVector& d) const {
    return subtract_product(value, dot(d, d), reach_ * reach_);
  }

  /// Six times the volume of a tetrahedron, enlarged: −det(w_0,w_1,w_2) = −N·w_0.
  [[nodiscard]] Form volume() const { return dot(normal(), corners_[0]) * Form{-1}; }

  /// Proves d·w > D‖d‖* for all corners w, d the direction of the subinterval's feature; or that
  /// the volume is positive.
  void prove_separation(const Subinterval& subinterval) {
    if (is_tetrahedron()) return prove_positive(volume());
    const FormVector d = direction(subinterval) * Form{subinterval.is_negative ? -1 : 1};
    const bool is_l2 = certificate_.separation.is_l2;
    const std::vector<Form> sums = is_l2 ? std::vector<Form>{Form{0}} : reaches(d);
    for (const FormVector& w : corners_) {
      const Form value = dot(d, w);
      for (const Form& sum : sums) prove_positive(value - sum);
      if (is_l2 && certificate_.separation.distance != 0)
        prove_positive(less_square(value * value, d));
      // N·w is the same for all corners.
      if (subinterval.feature == Feature::face) return;
    }
  }

  // ---- A contact ----

  /// Proves that there is a contact in the interval of the claim, at any root of g in g's interval.
  void prove_contact(const Contact& contact) {
    enter(contact);
    if (contact.from < certificate_.lower || contact.to > certificate_.upper) {
      reject("the contact is not in the interval of the claim");
    }
    find_time(contact);
    if (is_tetrahedron()) {
      if (sign(volume()) > 0) reject("the volume is positive");
      return;
    }
    if (contact.place == Place::vertex) prove_vertex(contact);
    if (contact.place == Place::segment) prove_segment(contact);
    if (contact.place == Place::triangle) prove_triangle(contact);
    if (contact.place == Place::edge) prove_edge(contact);
    if (contact.place == Place::face) prove_face();
    if (contact.place == Place::axes) prove_axes();
  }

  /// Finds the polynomial whose root the time of the contact is, and proves that there is one.
  void find_time(const Contact& contact) {
    if (!contact.is_root) {
      g_ = {-contact.from.get_num(), contact.from.get_den()};
      return;
    }
    g_ = contact.g;
    if (contact.from >= contact.to) reject("the root's interval is empty");
    const Form g = on_interval(g_);
    if (sgn(g.front()) * sgn(g.back()) >= 0) {
      reject("the polynomial does not change its sign in the interval");
    }
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
    const FormVector& a = corners_[contact.corners[0]];
    const FormVector& b = corners_[contact.corners[1]];
    const FormVector& c = corners_[contact.corners[2]];
    const std::size_t axis = contact.axis;
    const FormVector weights{cross(b, c, axis), cross(c, a, axis), cross(a, b, axis)};
    const FormVector ones{Form{1}, Form{1}, Form{1}};
    const int sign_of_sum = sign(dot(weights, ones));
    if (sign_of_sum == 0) reject("the triangle's normal is 0 on this axis");
    // det(a,b,c), by its minors of this axis
    if (sign(dot(weights, {a[axis], b[axis], c[axis]})) != 0) {
      reject("the origin is not in the triangle's plane");
    }
    for (const Form& weight : weights) {
      if (sign(weight) * sign_of_sum < 0) reject("the origin is not in the triangle");
    }
  }

  void prove_segment(const Contact& contact) {
    const FormVector& a = corners_[contact.corners[0]];
    const FormVector& b = corners_[contact.corners[1]];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (sign(cross(a, b, axis)) != 0) reject("the origin is not on the segment's line");
    }
    if (sign(dot(a, b)) > 0) reject("the origin is not on the segment");
  }

  /// Proves |w| ≤ D.
  void prove_vertex(const Contact& contact) {
    const FormVector& w = corners_[contact.corners[0]];
    prove_near(dot(w, w), unit(0));
  }

  /// Proves that the foot of the perpendicular from the origin on the edge's line is on the edge
  /// and within D.
  void prove_edge(const Contact& contact) {
    const FormVector& a = corners_[contact.corners[0]];
    const FormVector& b = corners_[contact.corners[1]];
    const FormVector e = b - a;
    if (sign(dot(a, e)) > 0 || sign(dot(b, e)) < 0) reject("the nearest point is not inside");
    const FormVector product = cross(a, b);
    prove_near(dot(product, product), e);
  }

  /// Proves that the foot of the perpendicular from the origin on the face's plane is in the face
  /// and within D.
  void prove_face() {
    const FormVector n = normal();
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const Form inwards = dot(n, cross(corners_[i], next(i)));
      if (sign(inwards) < 0) reject("the nearest point is not inside");
    }
    const Form height = dot(n, corners_[0]);
    prove_near(height * height, n);
  }

  /// Proves square ≤ D² |base|², where base is not 0.
  void prove_near(const Form& square, const FormVector& base) {
    if (sign(dot(base, base)) == 0) reject("the edge's or the face's direction is 0");
    if (sign(less_square(square, base)) > 0) reject("the place is farther than the distance");
  }

  /// Proves that no axis separates the polygon from the cube of the distance.
  void prove_axes() {
    if (certificate_.separation.is_l2) reject("axes prove nothing of the distance in l2");
    std::vector<FormVector> axes{normal(), unit(0), unit(1), unit(2)};
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const FormVector side = next(i) - corners_[i];
      for (std::size_t axis = 0; axis < 3; ++axis) axes.push_back(cross(unit(axis), side));
    }
    for (const FormVector& axis : axes) {
      if (!is_reached(axis) || !is_reached(axis * Form{-1})) {
        reject("an axis separates, or is not seen not to");
      }
    }
  }

  /// True if d·w ≤ D‖d‖* is proved for some corner w; one σ is enough.
  bool is_reached(const FormVector& d) {
    for (const Form& sum : reaches(d)) {
      for (const FormVector& w : corners_) {
        const Form gap = sum - dot(d, w);
        if (divides(g_, gap) || is_positive(on_interval(gap))) return true;
      }
    }
    return false;
  }

  const Certificate& certificate_;
  std::int64_t& work_bits_left_;
  /// The line of the current part.
  std::size_t line_;
  /// D, enlarged as the corners are.
  Form reach_;
  std::vector<FormVector> corners_;
  /// The reason why is_positive failed.
  const char* doubt_ = "";
  /// The interval of the current part: numerators of start and length, and their denominator.
  mpz_class from_;
  mpz_class length_;
  mpz_class denominator_;
  /// The polynomial whose root the time of the contact is.
  Form g_;
};

}  // namespace

void verify(const Certificate& certificate, std::int64_t& work_bits_left) {
  Proof(certificate, work_bits_left).verify();
}

}  // namespace touchstone::checker
