#pragma once

/// \file
/// Random numbers that are the same on every machine, unlike those of std:: distributions,
/// for generated queries, methods with random directions, and tests.

#include <cstdint>
#include <string_view>

namespace touchstone::verify::generate {

/// Bijective mixing of 64 bits: the output function of splitmix64 [steele2014].
[[nodiscard]] constexpr std::uint64_t mix(std::uint64_t x) {
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31U);
}

/// A 64-bit hash of a text (FNV-1a).
[[nodiscard]] constexpr std::uint64_t hash(std::string_view text) {
  std::uint64_t value = 0xcbf29ce484222325ULL;
  for (const char c : text) {
    value = (value ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  }
  return value;
}

/// splitmix64: number n of the stream is mix(seed + (n+1)·golden ratio).
class Random {
 public:
  static constexpr std::uint64_t golden_ratio = 0x9e3779b97f4a7c15ULL;

  /// The stream of this seed. Streams of different seeds are unrelated once the seed is mixed.
  explicit constexpr Random(std::uint64_t seed) : state_(seed) {}

  /// 64 uniform bits.
  constexpr std::uint64_t bits() {
    state_ += golden_ratio;
    return mix(state_);
  }

  /// A uniform integer in [low, high]; the bias is below (high − low) / 2^64.
  constexpr std::int64_t between(std::int64_t low, std::int64_t high) {
    const auto size = static_cast<std::uint64_t>(high - low) + 1;
    return low + static_cast<std::int64_t>(bits() % size);
  }

  /// An integer in [low, high] or its negative: magnitude bounded from both sides.
  constexpr std::int64_t of_either_sign(std::int64_t low, std::int64_t high) {
    const std::int64_t magnitude = between(low, high);
    return coin() ? magnitude : -magnitude;
  }

  /// A uniform multiple of 2^-53 in [0, 1).
  constexpr double unit() { return static_cast<double>(bits() >> 11U) * 0x1p-53; }

  /// A uniform multiple of 2^-53 times the width, in [low, high).
  constexpr double uniform(double low = 0.0, double high = 1.0) {
    return low + (high - low) * unit();
  }

  /// True half of the time.
  constexpr bool coin() { return (bits() >> 63U) != 0; }

 private:
  std::uint64_t state_;
};

}  // namespace touchstone::verify::generate
