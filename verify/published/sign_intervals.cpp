#include "verify/published/sign_intervals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "verify/baselines/moving_polynomials.hpp"
#include "verify/baselines/rpoly.hpp"

namespace touchstone::verify::published {
namespace {

/// Real parts of zeros, ascending.
struct Breaks {
  std::array<double, baselines::most_zeros> t;
  std::size_t count = 0;

  void add(double value) { t[count++] = value; }
  void sort() { std::sort(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(count)); }
};

/// A polynomial that must not be negative.
class SignSearch {
 public:
  SignSearch(std::span<const double> coefficients, WantedSign sign) {
    double greatest = 0.0;
    for (const double c : coefficients) greatest = std::max(greatest, std::abs(c));
    const double scale = greatest == 0.0 ? 1.0 : greatest;
    for (const double c : coefficients) {
      c_[size_++] = sign == WantedSign::not_negative ? c / scale : -c / scale;
    }
    const auto left = baselines::without_leading_zeros({c_.data(), size_});
    std::copy(left.begin(), left.end(), c_.begin());
    size_ = left.size();
  }

  [[nodiscard]] std::vector<TimeInterval> run() {
    if (size_ <= 1) {
      if (size_ == 0 || c_[0] >= 0.0) return {{0.0, 1.0}};
      return {};
    }
    if (size_ > 3 && is_hopeless()) return {};
    find_breaks();
    return intervals();
  }

 private:
  /// True if the constant with all positive contributions is still negative.
  [[nodiscard]] bool is_hopeless() const {
    double greatest = c_[size_ - 1];
    for (std::size_t i = 0; i + 1 < size_; ++i) greatest += std::max(c_[i], 0.0);
    return greatest < 0.0;
  }

  void find_breaks() {
    if (size_ == 2) {
      breaks_.add(-c_[1] / c_[0]);
    } else if (size_ == 3) {
      const double discriminant = c_[1] * c_[1] - 4.0 * c_[0] * c_[2];
      if (discriminant < 0.0) return;
      const double q = -0.5 * (c_[1] + std::copysign(std::sqrt(discriminant), c_[1]));
      const double first = q / c_[0];
      const double second = c_[2] / q;
      // In this order a NaN, which is neither, stays behind the other.
      breaks_.add(second < first ? second : first);
      breaks_.add(second < first ? first : second);
    } else {
      for (const baselines::Zero& zero : baselines::zeros_of({c_.data(), size_}))
        breaks_.add(zero.re);
      breaks_.sort();
    }
  }

  [[nodiscard]] std::vector<TimeInterval> intervals() const {
    std::vector<TimeInterval> result;
    const auto test = [&](double from, double to) {
      from = std::clamp(from, 0.0, 1.0);
      to = std::clamp(to, 0.0, 1.0);
      if (value((from + to) / 2.0) >= 0.0) result.push_back({from, to});
    };
    if (breaks_.count == 0) {
      test(0.0, 1.0);
      return result;
    }
    const double first = breaks_.t[0];
    const double last = breaks_.t[breaks_.count - 1];
    if (first >= 0.0) test(0.0, first);
    for (std::size_t i = 1; i < breaks_.count; ++i) {
      const bool is_outside = breaks_.t[i] < 0.0 || breaks_.t[i - 1] > 1.0;
      if (!is_outside) test(breaks_.t[i - 1], breaks_.t[i]);
    }
    if (last <= 1.0) test(last, 1.0);
    return result;
  }

  [[nodiscard]] double value(double t) const {
    double result = c_[0];
    for (std::size_t i = 1; i < size_; ++i) result = result * t + c_[i];
    return result;
  }

  std::array<double, baselines::most_zeros + 1> c_{};  ///< the highest power's first
  std::size_t size_ = 0;
  Breaks breaks_;
};

}  // namespace

std::vector<TimeInterval> sign_intervals(std::span<const double> coefficients, WantedSign sign) {
  return SignSearch(coefficients, sign).run();
}

}  // namespace touchstone::verify::published
