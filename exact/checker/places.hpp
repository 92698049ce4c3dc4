#pragma once

/// \file
/// Where the vertices of a step are, in integers, and which primitives no axis keeps apart.
///
/// Space is enlarged by the power of two that brings all coordinates and the distance D just below 2^50.
/// A coordinate at the start and at the end of a stretch of time is then enclosed by integers, as is D.
/// Their sums and products below are exact.
///
/// **Theorem.** Let d be a vector of integers. If d·a > d·b + D‖d‖₁ for all vertices a of one primitive
/// and b of the other, at the start and at the end, then there is no contact on the way: for one sign
/// every ±d·w_i is above D‖d‖₁ ≥ D‖d‖* (checker.hpp) at both ends, and linear in between.
///
/// **Which pairs are met.** The boxes that the primitives sweep are sorted by their lower ends on an
/// axis. Two that are more than D apart on it, this axis keeps apart. Of any other two the one that
/// begins later is met behind the other, before the first that begins more than D behind its end.

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <vector>

#include "exact/checker/certificate.hpp"

namespace touchstone::checker {

/// A direction's components are below this.
inline constexpr std::int32_t max_direction = 1'024;

/// x y z at t=0, then at t=1.
using Motion = std::array<double, 6>;
/// The numbers of its vertices: a b c of a face, a b a of an edge, v v v of a vertex.
using Primitive = std::array<std::int32_t, 3>;
using Direction = std::array<std::int64_t, 3>;

/// Primitives by their numbers.
using Elements = std::map<std::int32_t, Primitive>;
using Element = Elements::value_type;

class Places {
 public:
  /// On the way from t=0 to t=end. \pre finite coordinates and D; D ≥ 0, 0 ≤ end ≤ 1
  Places(const std::vector<Motion>& vertices, double distance, const mpq_class& end) {
    double greatest = distance;
    for (const Motion& x : vertices) {
      for (const double c : x) greatest = std::max(greatest, std::abs(c));
    }
    int exponent = 0;  // greatest < 2^exponent
    std::frexp(greatest, &exponent);
    const auto enlarged = [shift = 50 - exponent](mpq_class x) {
      shift < 0 ? x >>= mp_bitcnt_t(-shift) : x <<= mp_bitcnt_t(shift);
      mpz_class result;
      mpz_fdiv_q(result.get_mpz_t(), x.get_num_mpz_t(), x.get_den_mpz_t());
      return result.get_si();
    };
    distance_ = -enlarged(-mpq_class(distance));
    for (const Motion& x : vertices) {
      Bounds& bounds = bounds_.emplace_back();
      for (std::size_t k = 0; k < 6; ++k) {
        const mpq_class start = x.at(k % 3), c = k < 3 ? start : start + end * (x.at(k) - start);
        bounds.lower[k] = enlarged(c);
        bounds.upper[k] = -enlarged(-c);
      }
    }
  }

  /// Does the direction keep a above b all the time?
  [[nodiscard]] bool is_above(const Primitive& a, const Primitive& b, const Direction& d) const {
    // No product exceeds 2^60, and no side of the comparison below reaches 2^63.
    const std::int64_t reach = distance_ * (std::abs(d[0]) + std::abs(d[1]) + std::abs(d[2]));
    // The least d·x at a time, 0 or 1; or −d·x.
    const auto least = [&](std::int32_t vertex, std::int64_t sign, std::size_t time) {
      const Bounds& x = bounds_[std::size_t(vertex)];
      std::int64_t sum = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        sum += sign * d[k] * (sign * d[k] < 0 ? x.upper : x.lower)[3 * time + k];
      }
      return sum;
    };
    for (std::size_t n = 0; n < 18; ++n) {
      const std::int64_t above = least(a[n % 3], 1, n / 9), below = least(b[n / 3 % 3], -1, n / 9);
      if (above <= reach - below) return false;
    }
    return true;
  }

  /// Calls take(a, b) for every a of `some` and b of `others` that no coordinate axis keeps apart; if
  /// both are the same list, for every two of it, the smaller number first.
  /// \param comparisons_left how often boxes may still be held against each other
  /// \throws Rejection if that is not often enough.
  template <class Take>
  void find_near(const Elements& some, const Elements& others, std::size_t axis,
                 std::int64_t& comparisons_left, const Take& take) const {
    const bool is_same = &some == &others;
    std::vector<Box> boxes;
    for (const Element& element : some) boxes.push_back(box_of(element, is_same));
    for (const Element& element : others) {
      if (!is_same) boxes.push_back(box_of(element, true));
    }
    const auto begin = [&](const Box& x) { return std::min(x.lower[axis], x.lower[axis + 3]); };
    std::ranges::sort(boxes, {}, begin);
    for (auto i = boxes.begin(); i != boxes.end(); ++i) {
      const std::int64_t end = std::max(i->upper[axis], i->upper[axis + 3]) + distance_;
      for (auto j = i + 1; j != boxes.end() && begin(*j) <= end; ++j) {
        if (--comparisons_left < 0) reject("the search for pairs takes too many comparisons");
        if (is_axis_between(*i, *j)) continue;
        const bool is_first = is_same ? i->element->first < j->element->first : j->is_other;
        const Box &a = is_first ? *i : *j, &b = is_first ? *j : *i;
        if (is_same || a.is_other != b.is_other) take(*a.element, *b.element);
      }
    }
  }

 private:
  /// Of x y z at the start, then at the end.
  using Integers = std::array<std::int64_t, 6>;
  struct Bounds {
    Integers lower, upper;
  };
  struct Box : Bounds {
    const Element* element;
    bool is_other;
  };

  [[nodiscard]] Box box_of(const Element& element, bool is_other) const {
    Box box{bounds_[std::size_t(element.second[0])], &element, is_other};
    for (std::size_t k = 0; k < 18; ++k) {
      const Bounds& bounds = bounds_[std::size_t(element.second[k / 6])];
      box.lower[k % 6] = std::min(box.lower[k % 6], bounds.lower[k % 6]);
      box.upper[k % 6] = std::max(box.upper[k % 6], bounds.upper[k % 6]);
    }
    return box;
  }

  /// Are the boxes more than D apart on an axis, at the start and at the end, in the same order?
  [[nodiscard]] bool is_axis_between(const Box& a, const Box& b) const {
    const auto is_below = [&](const Box& x, const Box& y, std::size_t k) {
      return x.upper[k] + distance_ < y.lower[k] && x.upper[k + 3] + distance_ < y.lower[k + 3];
    };
    for (std::size_t k = 0; k < 3; ++k) {
      if (is_below(a, b, k) || is_below(b, a, k)) return true;
    }
    return false;
  }

  std::vector<Bounds> bounds_;
  std::int64_t distance_ = 0;
};

}  // namespace touchstone::checker
