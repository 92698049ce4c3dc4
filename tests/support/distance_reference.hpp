#pragma once

/// \file
/// A second decision of minimum separation, for tests: every candidate is evaluated
/// (docs/theory.md, section 3.6).
///
/// At the time of impact the distance is d or the time is 0. So a polynomial of the conditions is
/// zero there: their roots in [0,1] and 0 are tried in turn, and the least at which the conditions
/// hold is the answer. It shares only polynomials and algebraic numbers with the oracle. Slow.

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tests/support/queries.hpp"
#include "tests/support/root_count.hpp"
#include "touchstone/algebraic_number.hpp"
#include "touchstone/polynomial.hpp"

namespace touchstone::tests {

/// Decides one query of integer coordinates times 2^-10, with a distance of that kind.
class DistanceReference {
 public:
  using Number = exact::AlgebraicNumber;
  using Polynomial = exact::Polynomial;
  using Vector = std::array<Polynomial, 3>;

  DistanceReference(PosedQuery posed, double distance) : distance_(integer(distance)) {
    for (double& x : posed.query.coordinates) x = std::ldexp(x, 10);
    w_ = root_count::moving_corners(posed);
    normal_ = cross(minus(w_[1], w_[0]), minus(w_[2], w_[0]));
  }

  /// The time of impact, if there is one.
  [[nodiscard]] std::optional<Number> toi(Norm norm) {
    candidates_.clear();
    norm == Norm::l2 ? list_l2() : list_linf();
    const auto holds = [&](Number& t) { return norm == Norm::l2 ? holds_l2(t) : holds_linf(t); };
    Number start(0);
    if (holds(start)) return start;
    std::optional<Number> first;
    for (const Polynomial& p : candidates_) {
      for (Number& t : exact::roots_in_unit_interval(p)) {
        if (first && t >= *first) break;
        if (holds(t)) first = t;
      }
    }
    return first;
  }

 private:
  static constexpr auto& cross = root_count::cross;
  static constexpr auto& dot = root_count::dot;
  static constexpr auto& minus = root_count::minus;

  static exact::Integer integer(double x) { return exact::Rational(std::ldexp(x, 10)).get_num(); }
  static Polynomial constant(const exact::Integer& x) { return Polynomial(x); }

  void candidate(const Polynomial& p) {
    if (p.degree() > 0) candidates_.insert(exact::squarefree_part(p));
  }

  [[nodiscard]] Polynomial excess(const Polynomial& square, const Vector& base) const {
    return square - constant(distance_ * distance_) * dot(base, base);
  }

  // ---- l2: vertices, all segments between two corners, the face ---------------------------------

  struct Pair {
    Polynomial length, from, to, excess;
  };
  [[nodiscard]] Pair pair(std::size_t i, std::size_t j) const {
    const Vector e = minus(w_[j], w_[i]), moment = cross(w_[i], w_[j]);
    return {dot(e, e), dot(w_[i], e), dot(w_[j], e), excess(dot(moment, moment), e)};
  }
  [[nodiscard]] Polynomial vertex(std::size_t i) const {
    return dot(w_[i], w_[i]) - constant(distance_ * distance_);
  }
  [[nodiscard]] Polynomial side(std::size_t i) const {
    return dot(normal_, cross(w_[i], w_[(i + 1) % w_.size()]));
  }
  [[nodiscard]] Polynomial face() const {
    const Polynomial det = dot(normal_, w_[0]);
    return excess(det * det, normal_);
  }

  void list_l2() {
    for (std::size_t i = 0; i < w_.size(); ++i) {
      candidate(vertex(i));
      candidate(side(i));
      for (std::size_t j = 0; j < i; ++j) {
        for (const Polynomial& p : {pair(i, j).from, pair(i, j).to, pair(i, j).excess})
          candidate(p);
      }
    }
    candidate(face());
  }

  bool holds_l2(Number& t) const {
    for (std::size_t i = 0; i < w_.size(); ++i) {
      if (t.sign_of(vertex(i)) <= 0) return true;
      for (std::size_t j = 0; j < i; ++j) {
        const Pair p = pair(i, j);
        if (t.sign_of(p.length) > 0 && t.sign_of(p.from) <= 0 && t.sign_of(p.to) >= 0 &&
            t.sign_of(p.excess) <= 0) {
          return true;
        }
      }
    }
    if (t.sign_of(dot(normal_, normal_)) == 0 || t.sign_of(face()) > 0) return false;
    for (std::size_t i = 0; i < w_.size(); ++i) {
      if (t.sign_of(side(i)) < 0) return false;
    }
    return true;
  }

  // ---- linf: axes -------------------------------------------------------------------------------

  [[nodiscard]] std::vector<Vector> axes() const {
    std::vector<Vector> result{normal_};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Vector unit;
      unit.at(axis) = constant(1);
      result.push_back(unit);
      for (std::size_t i = 0; i < w_.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) result.push_back(cross(unit, minus(w_[j], w_[i])));
      }
    }
    return result;
  }

  void list_linf() {
    for (const Vector& a : axes()) {
      for (const Polynomial& x : a) candidate(x);
      for (const Vector& w : w_) {
        for (unsigned signs = 0; signs < 8; ++signs) {
          Polynomial p = dot(a, w);
          for (std::size_t axis = 0; axis < 3; ++axis) {
            const Polynomial step = constant(distance_) * a.at(axis);
            p = (signs >> axis) % 2 == 0 ? p - step : p + step;
          }
          candidate(p);
        }
      }
    }
  }

  bool holds_linf(Number& t) const {
    for (const Vector& a : axes()) {
      Polynomial reach;
      for (const Polynomial& x : a) reach = t.sign_of(x) < 0 ? reach - x : reach + x;
      reach = constant(distance_) * reach;
      bool not_above = false, not_below = false;
      for (const Vector& w : w_) {
        const Polynomial value = dot(a, w);
        not_above = not_above || t.sign_of(value - reach) <= 0;
        not_below = not_below || t.sign_of(value + reach) >= 0;
      }
      if (!not_above || !not_below) return false;
    }
    return true;
  }

  struct Order {
    bool operator()(const Polynomial& p, const Polynomial& q) const {
      return p.coefficients() < q.coefficients();
    }
  };

  exact::Integer distance_;
  std::vector<Vector> w_;
  Vector normal_;
  std::set<Polynomial, Order> candidates_;
};

}  // namespace touchstone::tests
