#include "verify/jobs/memory_pass.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace touchstone::verify::jobs {
namespace {

using Bits = std::uint64_t;

/// Words that are read together.
constexpr std::size_t lanes = 24;
using Lanes = std::array<Bits, lanes>;

/// The number of places that are read in parallel: the processor prefetches each of them, which
/// uses memory better than one place (a quarter less time; eight are no better than four).
constexpr std::size_t places = 4;

[[gnu::always_inline]] inline void read(const std::byte* from, std::size_t size, Lanes& sums) {
  Lanes block{};
  std::memcpy(block.data(), from, size);
  for (std::size_t i = 0; i < lanes; ++i) sums[i] ^= block[i];
}

[[gnu::always_inline]] inline Bits read_all(std::span<const std::byte> bytes) {
  Lanes sums{};
  const std::size_t step = bytes.size() / sizeof(Lanes) / places;
  const std::byte* const first = bytes.data();
  for (std::size_t i = 0; i < step; ++i) {
    for (std::size_t place = 0; place < places; ++place) {
      read(first + (place * step + i) * sizeof(Lanes), sizeof(Lanes), sums);
    }
  }
  for (std::span<const std::byte> rest = bytes.subspan(places * step * sizeof(Lanes));
       !rest.empty();) {
    const std::size_t size = std::min(rest.size(), sizeof(Lanes));
    read(rest.data(), size, sums);
    rest = rest.subspan(size);
  }
  Bits all = 0;
  for (const Bits sum : sums) all ^= sum;
  return all;
}

Bits read_all_as_built(std::span<const std::byte> bytes) { return read_all(bytes); }

#if defined(__x86_64__)
[[gnu::target("avx2")]] Bits read_all_avx2(std::span<const std::byte> bytes) {
  return read_all(bytes);
}
#endif

using Reader = Bits (*)(std::span<const std::byte>);

Reader best_reader() {
#if defined(__x86_64__)
  if (static_cast<bool>(__builtin_cpu_supports("avx2"))) return read_all_avx2;
#endif
  return read_all_as_built;
}

}  // namespace

std::uint64_t memory_pass(std::span<const std::byte> bytes) {
  static const Reader reader = best_reader();
  return reader(bytes);
}

}  // namespace touchstone::verify::jobs
