#include "verify/jobs/memory_pass.hpp"

#include <array>
#include <bit>
#include <cstddef>

namespace touchstone::verify::jobs {
namespace {

using Bits = std::uint64_t;

constexpr std::size_t lanes = 3 * query_points;

/// Places that are read at the same time: the processor fetches ahead of each of them, which keeps
/// more of memory busy than one place does (a quarter of the time less than with one; eight are no
/// better than four).
constexpr std::size_t places = 4;

[[gnu::always_inline]] inline void read(const Query& query, std::array<Bits, lanes>& sums) {
  for (std::size_t i = 0; i < lanes; ++i) sums[i] ^= std::bit_cast<Bits>(query.coordinates[i]);
}

[[gnu::always_inline]] inline Bits read_all(std::span<const Query> queries) {
  std::array<Bits, lanes> sums{};
  const std::size_t step = queries.size() / places;
  const Query* const first = queries.data();
  for (std::size_t i = 0; i < step; ++i) {
    for (std::size_t place = 0; place < places; ++place) read(first[place * step + i], sums);
  }
  for (const Query& query : queries.subspan(places * step)) read(query, sums);
  Bits all = 0;
  for (const Bits sum : sums) all ^= sum;
  return all;
}

Bits read_all_as_built(std::span<const Query> queries) { return read_all(queries); }

#if defined(__x86_64__)
[[gnu::target("avx2")]] Bits read_all_avx2(std::span<const Query> queries) {
  return read_all(queries);
}
#endif

using Reader = Bits (*)(std::span<const Query>);

Reader best_reader() {
#if defined(__x86_64__)
  if (static_cast<bool>(__builtin_cpu_supports("avx2"))) return read_all_avx2;
#endif
  return read_all_as_built;
}

}  // namespace

std::uint64_t memory_pass(std::span<const Query> queries) {
  static const Reader reader = best_reader();
  return reader(queries);
}

}  // namespace touchstone::verify::jobs
