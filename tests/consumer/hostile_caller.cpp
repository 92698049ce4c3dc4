// A caller compiled with -ffast-math, which takes every number for finite, and with macros that
// bear names of the standard library: answers and checks are those of every caller.

#include <gmpxx.h>
#include <Eigen/Core>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#define min(a, b) ((a) < (b) ? (a) : (b))
#define max(a, b) ((a) > (b) ? (a) : (b))

#include <tight_inclusion/ccd.hpp>
#include <touchstone/exact.hpp>
#include <touchstone/fast.hpp>
#include <touchstone/query.hpp>

namespace {

using namespace touchstone;

constexpr std::uint64_t sign = 1ULL << 63U, least = 1, greatest = 0x7FEF'FFFF'FFFF'FFFF,
                        infinity = 0x7FF0'0000'0000'0000, nan = 0x7FF8'0000'0000'0000;

/// A double that the compiler does not know.
double from_bits(std::uint64_t bits) {
  volatile std::uint64_t hidden = bits;
  return std::bit_cast<double>(std::uint64_t{hidden});
}

bool is_finite_with(std::uint64_t bits) {
  Query query{};
  query.coordinates.back() = from_bits(bits);
  return is_finite(query);
}

bool is_valid_at(std::uint64_t bits) { return is_valid(Separation{.distance = from_bits(bits)}); }

bool knows_numbers() {
  return is_finite_with(0) && is_finite_with(least) && is_finite_with(greatest) &&
         is_finite_with(sign | greatest) && !is_finite_with(infinity) &&
         !is_finite_with(sign | infinity) && !is_finite_with(nan) && !is_finite_with(sign | nan) &&
         is_valid_at(0) && is_valid_at(sign) && is_valid_at(least) && is_valid_at(greatest) &&
         !is_valid_at(sign | least) && !is_valid_at(infinity) && !is_valid_at(nan);
}

/// A vertex falls through a resting triangle.
fast::CertifiedResult falls(std::uint64_t one, std::uint64_t minus_two, std::uint64_t four) {
  const double a = from_bits(one), b = from_bits(minus_two), c = from_bits(four);
  return fast::solve(ContactKind::vertex_face, {{a, a, a, 0, 0, 0, c, 0, 0, 0, c, 0,  //
                                                 a, a, b, 0, 0, 0, c, 0, 0, 0, c, 0}});
}

bool is_a_third(const fast::CertifiedResult& result) {
  return result.verdict == fast::Verdict::yes && result.toi_lower < 0.33333333334 &&
         result.toi_upper > 0.33333333333;
}

bool gets_right_answers() {
  const auto usual = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  return is_a_third(falls(usual(1.0), usual(-2.0), usual(4.0))) &&
         is_a_third(falls(least, sign | 2, 4)) &&  // the same with subnormals
         falls(nan, usual(-2.0), usual(4.0)).verdict == fast::Verdict::error;
}

}  // namespace

int main() {
  const bool right = knows_numbers() && gets_right_answers();
  std::printf("hostile caller: %s\n", right ? "right" : "wrong");
  return right ? 0 : 1;
}
