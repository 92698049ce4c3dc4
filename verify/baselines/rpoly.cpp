#include "verify/baselines/rpoly.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace touchstone::baselines {
namespace {

// The constants of the published program, with single precision's range, as the released methods
// have them.
constexpr double unit_error = 2.22e-16;
constexpr double greatest_number = 3.4e38;
constexpr double smallest_number = 1.2e-38;
constexpr double scaling_base = 2.0;
constexpr int no_shift_steps = 5;
constexpr int shifts_per_zero = 20;
constexpr int steps_per_shift = 20;
constexpr int quadratic_steps = 20;
constexpr int real_steps = 10;

using Coefficients = std::array<double, most_zeros + 1>;

struct Pair {
  Zero smaller;
  Zero larger;
};

/// The zeros of a x² + b x + c, without cancellation and overflow. With a = 0 the one zero is the
/// smaller.
Pair quadratic_zeros(double a, double b, double c) {
  if (a == 0.0) return {{b != 0.0 ? -c / b : 0.0, 0.0}, {0.0, 0.0}};
  if (c == 0.0) return {{0.0, 0.0}, {-b / a, 0.0}};
  const double half = b / 2.0;
  double sign = 1.0;  // of the discriminant
  double root = 0.0;  // of its magnitude
  if (std::abs(half) < std::abs(c)) {
    const double e = half * (half / std::abs(c)) - (c < 0.0 ? -a : a);
    sign = e;
    root = std::sqrt(std::abs(e)) * std::sqrt(std::abs(c));
  } else {
    const double e = 1.0 - (a / half) * (c / half);
    sign = e;
    root = std::sqrt(std::abs(e)) * std::abs(half);
  }
  if (sign < 0.0) {
    const double re = -half / a;
    const double im = std::abs(root / a);
    return {{re, im}, {re, -im}};
  }
  const double larger = (half >= 0.0 ? -half - root : root - half) / a;
  return {{larger != 0.0 ? (c / larger) / a : 0.0, 0.0}, {larger, 0.0}};
}

/// Finds zeros of P one or two at a time.
class ZeroFinder {
 public:
  explicit ZeroFinder(std::span<const double> coefficients) : degree_(coefficients.size() - 1) {
    std::ranges::copy(coefficients, p_.begin());
  }

  Zeros run() {
    while (degree_ > 0 && p_[degree_] == 0.0) {
      add({0.0, 0.0});
      --degree_;
    }
    while (degree_ > 2) {
      if (!find_next()) return zeros_;
    }
    if (degree_ == 1) add({-p_[1] / p_[0], 0.0});
    if (degree_ == 2) {
      const Pair pair = quadratic_zeros(p_[0], p_[1], p_[2]);
      add(pair.smaller);
      add(pair.larger);
    }
    return zeros_;
  }

 private:
  /// The relation of K to the quadratic divisor: it decides which of two formulas is stable.
  enum class Scaling { by_c, by_d, almost_factor };
  /// Outcome of an iteration for a real zero.
  enum class RealEnd { converged, failed, near_double_zero };

  /// The state of stage 2 when a sequence of approximations settles.
  struct Settled {
    bool linear;
    bool quadratic;
    bool linear_first;
    double s;       ///< guess of the real zero
    double ui, vi;  ///< guess of the quadratic factor x² + u x + v
  };

  void add(Zero zero) { zeros_.zero[zeros_.count++] = zero; }

  /// Finds a zero or a pair and divides it off. False if none converges.
  bool find_next() {
    scale();
    const double modulus = least_modulus();
    no_shift();
    const Coefficients start = k_;
    for (int shift = 1; shift <= shifts_per_zero; ++shift) {
      turn();
      sr_ = modulus * direction_.re;
      u_ = -2.0 * sr_;
      // Not its square, the product of the zeros, as in the published program; this agrees with the
      // public methods' counts of false negatives.
      v_ = modulus;
      if (fixed_shift(steps_per_shift * shift)) {
        deflate();
        return true;
      }
      k_ = start;
    }
    return false;
  }

  /// Turns the direction of the fixed shifts by 94°.
  void turn() {
    static const double angle = 94.0 * std::acos(-1.0) / 180.0;
    static const double cosine = std::cos(angle);
    static const double sine = std::sin(angle);
    direction_ = {cosine * direction_.re - sine * direction_.im,
                  sine * direction_.re + cosine * direction_.im};
  }

  void deflate() {
    const std::size_t found = pair_found_ ? 2 : 1;
    add(found_.smaller);
    if (pair_found_) add(found_.larger);
    degree_ -= found;
    std::copy_n(qp_.begin(), degree_ + 1, p_.begin());
  }

  /// Multiplies P by a power of the base, so that small coefficients do not underflow.
  void scale() {
    double greatest = 0.0;
    double smallest = greatest_number;
    for (std::size_t i = 0; i <= degree_; ++i) {
      const double magnitude = std::abs(p_[i]);
      greatest = std::max(greatest, magnitude);
      if (magnitude != 0.0) smallest = std::min(smallest, magnitude);
    }
    double factor = (smallest_number / unit_error) / smallest;
    const bool is_needed = factor > 1.0 ? greatest_number / factor >= greatest : greatest >= 10.0;
    if (!is_needed) return;
    if (factor == 0.0) factor = smallest_number;
    factor = std::pow(scaling_base, std::floor(std::log(factor) / std::log(scaling_base) + 0.5));
    if (factor == 1.0) return;
    for (std::size_t i = 0; i <= degree_; ++i) p_[i] *= factor;
  }

  /// A lower bound of the moduli of P's zeros: the positive zero of the polynomial with the moduli
  /// of P's coefficients, the last one negated (Cauchy), to two digits by Newton's method.
  [[nodiscard]] double least_modulus() const {
    Coefficients moduli{};
    for (std::size_t i = 0; i <= degree_; ++i) moduli[i] = std::abs(p_[i]);
    moduli[degree_] = -moduli[degree_];
    const auto n = static_cast<double>(degree_);
    double x = std::exp((std::log(-moduli[degree_]) - std::log(moduli[0])) / n);
    if (moduli[degree_ - 1] != 0.0) x = std::min(x, -moduli[degree_] / moduli[degree_ - 1]);
    // Down by tenths while it is above the zero.
    const auto value = [&](double at) {
      double f = moduli[0];
      for (std::size_t i = 1; i <= degree_; ++i) f = f * at + moduli[i];
      return f;
    };
    while (value(0.1 * x) > 0.0) x *= 0.1;
    for (double dx = x; std::abs(dx / x) > 0.005; x -= dx) {
      double f = moduli[0];
      double df = f;
      for (std::size_t i = 1; i < degree_; ++i) {
        f = f * x + moduli[i];
        df = df * x + f;
      }
      f = f * x + moduli[degree_];
      dx = f / df;
    }
    return x;
  }

  /// Stage 1: K begins as the derivative of P; divided by x it favours the small zeros.
  void no_shift() {
    const auto n = static_cast<double>(degree_);
    k_[0] = p_[0];
    for (std::size_t i = 1; i < degree_; ++i) {
      k_[i] = static_cast<double>(degree_ - i) * p_[i] / n;
    }
    const double last = p_[degree_];
    const double threshold = std::abs(p_[degree_ - 1]) * unit_error * 10.0;
    bool last_is_zero = k_[degree_ - 1] == 0.0;
    for (int step = 0; step < no_shift_steps; ++step) {
      if (last_is_zero) {
        std::copy_backward(k_.begin(), k_.begin() + static_cast<std::ptrdiff_t>(degree_ - 1),
                           k_.begin() + static_cast<std::ptrdiff_t>(degree_));
        k_[0] = 0.0;
        last_is_zero = k_[degree_ - 1] == 0.0;
        continue;
      }
      const double t = -last / k_[degree_ - 1];
      for (std::size_t j = degree_ - 1; j > 0; --j) k_[j] = t * k_[j - 1] + p_[j];
      k_[0] = p_[0];
      last_is_zero = std::abs(k_[degree_ - 1]) <= threshold;
    }
  }

  /// Stage 2: at most this number of steps with the divisor x² + u x + v fixed, until guesses
  /// settle and an iteration from them converges.
  bool fixed_shift(int steps) {
    linear_limit_ = 0.25;
    quadratic_limit_ = 0.25;
    double last_s = sr_;
    double last_v = v_;
    double last_linear_change = 1.0;
    double last_quadratic_change = 1.0;
    divide_p();
    divide_k();
    for (int step = 1; step <= steps; ++step) {
      next_k();
      divide_k();
      const auto [ui, vi] = guess_quadratic();
      const double s = k_[degree_ - 1] != 0.0 ? -p_[degree_] / k_[degree_ - 1] : 0.0;
      double linear_change = 1.0;
      double quadratic_change = 1.0;
      if (step > 1 && scaling_ != Scaling::almost_factor) {
        if (vi != 0.0) quadratic_change = std::abs((vi - last_v) / vi);
        if (s != 0.0) linear_change = std::abs((s - last_s) / s);
        const double quadratic = quadratic_change < last_quadratic_change
                                     ? quadratic_change * last_quadratic_change
                                     : 1.0;
        const double linear =
            linear_change < last_linear_change ? linear_change * last_linear_change : 1.0;
        Settled settled{.linear = linear < linear_limit_,
                        .quadratic = quadratic < quadratic_limit_,
                        .linear_first = false,
                        .s = s,
                        .ui = ui,
                        .vi = vi};
        settled.linear_first = settled.linear && (!settled.quadratic || linear < quadratic);
        if ((settled.linear || settled.quadratic) && iterate(settled)) return true;
      }
      last_v = vi;
      last_s = s;
      last_quadratic_change = quadratic_change;
      last_linear_change = linear_change;
    }
    return false;
  }

  /// Stage 3: tries the sequences that have settled, the more promising first. If none converges,
  /// stage 2 continues with a stricter criterion.
  bool iterate(Settled guess) {
    const Coefficients saved_k = k_;
    const double saved_u = u_;
    const double saved_v = v_;
    bool tried_linear = false;
    bool tried_quadratic = false;
    bool linear_next = guess.linear_first;
    for (;;) {
      if (linear_next) {
        const RealEnd end = iterate_real(guess.s);
        if (end == RealEnd::converged) return true;
        tried_linear = true;
        linear_limit_ *= 0.25;
        linear_next = false;
        if (end == RealEnd::near_double_zero) {
          guess.ui = -2.0 * guess.s;
          guess.vi = guess.s * guess.s;
          continue;
        }
      } else {
        if (iterate_quadratic(guess.ui, guess.vi)) return true;
        tried_quadratic = true;
        quadratic_limit_ *= 0.25;
        if (!tried_linear && guess.linear) {
          k_ = saved_k;
          linear_next = true;
          continue;
        }
      }
      k_ = saved_k;
      u_ = saved_u;
      v_ = saved_v;
      if (guess.quadratic && !tried_quadratic) continue;
      divide_p();
      divide_k();
      return false;
    }
  }

  /// Iterates the quadratic factor x² + u x + v by variable shifts.
  bool iterate_quadratic(double u, double v) {
    u_ = u;
    v_ = v;
    bool tried_cluster = false;
    double relative_step = 0.0;
    double last_value = 0.0;
    for (int step = 0;;) {
      const Pair pair = quadratic_zeros(1.0, u_, v_);
      // Two real zeros of quite different moduli are for the linear iteration.
      if (std::abs(std::abs(pair.smaller.re) - std::abs(pair.larger.re)) >
          0.01 * std::abs(pair.larger.re)) {
        return false;
      }
      divide_p();
      const double value = std::abs(a_ - pair.smaller.re * b_) + std::abs(pair.smaller.im * b_);
      if (value <= 20.0 * value_error(pair.smaller.re)) {
        found_ = pair;
        pair_found_ = true;
        return true;
      }
      if (++step > quadratic_steps) return false;
      if (step >= 2 && relative_step <= 0.01 && value >= last_value && !tried_cluster) {
        step_off_cluster(relative_step);
        tried_cluster = true;
        step = 0;
      }
      last_value = value;
      divide_k();
      next_k();
      divide_k();
      const auto [ui, vi] = guess_quadratic();
      if (vi == 0.0) return false;
      relative_step = std::abs((vi - v_) / vi);
      u_ = ui;
      v_ = vi;
    }
  }

  /// A bound on the rounding error of P's value at the zeros of the divisor.
  [[nodiscard]] double value_error(double re) const {
    const double modulus = std::sqrt(std::abs(v_));
    const double t = -re * b_;
    double e = 2.0 * std::abs(qp_[0]);
    for (std::size_t i = 1; i < degree_; ++i) e = e * modulus + std::abs(qp_[i]);
    e = e * modulus + std::abs(a_ + t);
    return (9.0 * e - 7.0 * (std::abs(a_ + t) + std::abs(b_) * modulus) + 2.0 * std::abs(t)) *
           unit_error;
  }

  /// A cluster of zeros stalls the iteration: steps aside, and takes five steps with that divisor
  /// fixed.
  void step_off_cluster(double relative_step) {
    const double aside = std::sqrt(std::max(relative_step, unit_error));
    u_ -= u_ * aside;
    v_ += v_ * aside;
    divide_p();
    for (int i = 0; i < 5; ++i) {
      divide_k();
      next_k();
    }
  }

  /// Iterates a real zero by variable shifts. If it stalls near an apparent double zero, s is its
  /// place.
  RealEnd iterate_real(double& s) {
    double x = s;
    double t = 0.0;
    double last_value = 0.0;
    for (int step = 0;;) {
      const double value = divide_linear(p_, degree_, x, qp_);
      const double magnitude = std::abs(value);
      double e = 0.5 * std::abs(qp_[0]);
      for (std::size_t i = 1; i <= degree_; ++i) e = e * std::abs(x) + std::abs(qp_[i]);
      if (magnitude <= 20.0 * unit_error * (2.0 * e - magnitude)) {
        found_.smaller = {x, 0.0};
        pair_found_ = false;
        return RealEnd::converged;
      }
      if (++step > real_steps) return RealEnd::failed;
      if (step >= 2 && std::abs(t) <= 0.001 * std::abs(x - t) && magnitude > last_value) {
        s = x;
        return RealEnd::near_double_zero;
      }
      last_value = magnitude;
      t = next_k_linear(x, value);
      x += t;
    }
  }

  /// The next K for the divisor with the zero x, where P has this value; returns the step to the
  /// next x.
  double next_k_linear(double x, double value) {
    const auto is_significant = [&](double k) {
      return std::abs(k) > std::abs(k_[degree_ - 1]) * 10.0 * unit_error;
    };
    const double k = divide_linear(k_, degree_ - 1, x, qk_);
    if (is_significant(k)) {
      const double t = -value / k;
      k_[0] = qp_[0];
      for (std::size_t i = 1; i < degree_; ++i) k_[i] = t * qk_[i - 1] + qp_[i];
    } else {
      k_[0] = 0.0;
      for (std::size_t i = 1; i < degree_; ++i) k_[i] = qk_[i - 1];
    }
    double next = k_[0];
    for (std::size_t i = 1; i < degree_; ++i) next = next * x + k_[i];
    return is_significant(next) ? -value / next : 0.0;
  }

  /// Horner's rule: the quotient by (x − zero), with the value at x behind it.
  static double divide_linear(const Coefficients& polynomial, std::size_t degree, double x,
                              Coefficients& quotient) {
    quotient[0] = polynomial[0];
    for (std::size_t i = 1; i <= degree; ++i) {
      quotient[i] = quotient[i - 1] * x + polynomial[i];
    }
    return quotient[degree];
  }

  /// Divides by x² + u x + v: the remainder is b (x + u) + a.
  void divide(const Coefficients& polynomial, std::size_t degree, Coefficients& quotient, double& a,
              double& b) const {
    b = polynomial[0];
    quotient[0] = b;
    a = polynomial[1] - u_ * b;
    quotient[1] = a;
    for (std::size_t i = 2; i <= degree; ++i) {
      const double c = polynomial[i] - u_ * a - v_ * b;
      quotient[i] = c;
      b = std::exchange(a, c);
    }
  }

  void divide_p() { divide(p_, degree_, qp_, a_, b_); }

  /// Divides K, and prepares the terms of the next K and the next guess.
  void divide_k() {
    double c = 0.0;
    double d = 0.0;
    divide(k_, degree_ - 1, qk_, c, d);
    c_ = c;
    d_ = d;
    if (std::abs(c) <= std::abs(k_[degree_ - 1]) * 100.0 * unit_error &&
        std::abs(d) <= std::abs(k_[degree_ - 2]) * 100.0 * unit_error) {
      scaling_ = Scaling::almost_factor;
    } else if (std::abs(d) >= std::abs(c)) {
      scaling_ = Scaling::by_d;
      e_ = a_ / d;
      f_ = c / d;
      g_ = u_ * b_;
      h_ = v_ * b_;
      a3_ = (a_ + g_) * e_ + h_ * (b_ / d);
      a1_ = b_ * f_ - a_;
      a7_ = (f_ + u_) * a_ + h_;
    } else {
      scaling_ = Scaling::by_c;
      e_ = a_ / c;
      f_ = d / c;
      g_ = u_ * e_;
      h_ = v_ * b_;
      a3_ = a_ * e_ + (h_ / c + g_) * b_;
      a1_ = b_ - a_ * (d / c);
      a7_ = a_ + g_ * d + h_ * f_;
    }
  }

  /// The next K for the quadratic divisor.
  void next_k() {
    if (scaling_ == Scaling::almost_factor) {
      k_[0] = 0.0;
      k_[1] = 0.0;
      for (std::size_t i = 2; i < degree_; ++i) k_[i] = qk_[i - 2];
      return;
    }
    const double reference = scaling_ == Scaling::by_c ? b_ : a_;
    // A divisor close to zero is omitted, because K is only needed up to a factor.
    const bool is_significant = std::abs(a1_) > std::abs(reference) * unit_error * 10.0;
    if (is_significant) {
      a7_ /= a1_;
      a3_ /= a1_;
    }
    const double weight = is_significant ? 1.0 : 0.0;
    k_[0] = weight * qp_[0];
    k_[1] = weight * qp_[1] - a7_ * qp_[0];
    for (std::size_t i = 2; i < degree_; ++i) {
      k_[i] = a3_ * qk_[i - 2] - a7_ * qp_[i - 1] + weight * qp_[i];
    }
  }

  /// The quadratic factor of P that K suggests, as (u, v); zeros if none.
  [[nodiscard]] std::pair<double, double> guess_quadratic() const {
    if (scaling_ == Scaling::almost_factor) return {0.0, 0.0};
    const bool by_d = scaling_ == Scaling::by_d;
    const double a4 = by_d ? (a_ + g_) * f_ + h_ : a_ + u_ * b_ + h_ * f_;
    const double a5 = by_d ? (f_ + u_) * c_ + v_ * d_ : c_ + (u_ + v_ * f_) * d_;
    const double b1 = -k_[degree_ - 1] / p_[degree_];
    const double b2 = -(k_[degree_ - 2] + b1 * p_[degree_ - 1]) / p_[degree_];
    const double c1 = v_ * b2 * a1_;
    const double c2 = b1 * a7_;
    const double c3 = b1 * b1 * a3_;
    const double c4 = c1 - c2 - c3;
    const double scale = a5 + b1 * a4 - c4;
    if (scale == 0.0) return {0.0, 0.0};
    return {u_ - (u_ * (c3 + c2) + v_ * (b1 * a1_ + b2 * a7_)) / scale, v_ * (1.0 + c4 / scale)};
  }

  std::size_t degree_;
  Coefficients p_{};   ///< the polynomial, divided by the zeros found
  Coefficients k_{};   ///< the polynomial beside it, of one degree less
  Coefficients qp_{};  ///< quotients of both by the divisor
  Coefficients qk_{};
  Zero direction_{std::sqrt(0.5), -std::sqrt(0.5)};
  double sr_ = 0.0;           ///< real part of the fixed shift
  double u_ = 0.0, v_ = 0.0;  ///< the divisor x² + u x + v
  double a_ = 0.0, b_ = 0.0;  ///< remainder of P
  double c_ = 0.0, d_ = 0.0;  ///< remainder of K
  Scaling scaling_ = Scaling::by_c;
  double e_ = 0.0, f_ = 0.0, g_ = 0.0, h_ = 0.0;  ///< ratios, scaled in one of two ways
  double a1_ = 0.0, a3_ = 0.0, a7_ = 0.0;         ///< weights of the next K
  double linear_limit_ = 0.25;                    ///< changes below these count as settled
  double quadratic_limit_ = 0.25;
  bool pair_found_ = false;
  Pair found_{};
  Zeros zeros_;
};

}  // namespace

Zeros zeros_of(std::span<const double> coefficients) {
  if (coefficients.empty() || coefficients.size() > most_zeros + 1) {
    throw std::invalid_argument("a polynomial of this degree is not taken");
  }
  if (coefficients.front() == 0.0) return {};
  return ZeroFinder(coefficients).run();
}

}  // namespace touchstone::baselines
