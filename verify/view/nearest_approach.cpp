#include "verify/view/nearest_approach.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

#include "touchstone/oracle.hpp"

namespace touchstone::verify::view {
namespace {

/// Doubles that are not negative are in the order of their bits.
std::uint64_t bits_of(double distance) { return std::bit_cast<std::uint64_t>(distance); }
double distance_of(std::uint64_t bits) { return std::bit_cast<double>(bits); }

exact::Decision at_distance(Kind kind, const Query& query, std::uint64_t bits) {
  return exact::decide(kind, query, {.distance = distance_of(bits), .norm = Norm::l2});
}

/// A first guess, which need not be close: the length of a corner at t = 0.
double guess(Kind kind, const Query& query) {
  const Corner& corner = corners(kind).front();
  const double length = (query.point(0, corner.plus) - query.point(0, corner.minus)).stableNorm();
  return std::min(length, std::numeric_limits<double>::max());
}

}  // namespace

std::optional<NearestApproach> nearest_approach(Kind kind, const Query& query) {
  if (exact::decide(kind, query).collides()) return std::nullopt;
  std::uint64_t above = 0;
  std::uint64_t at_most = bits_of(std::numeric_limits<double>::max());
  exact::Decision verdict = at_distance(kind, query, at_most);
  if (!verdict.collides()) return std::nullopt;
  const auto ask = [&](std::uint64_t bits) {
    exact::Decision answer = at_distance(kind, query, bits);
    if (!answer.collides()) {
      above = bits;
      return;
    }
    at_most = bits;
    verdict = std::move(answer);
  };
  // The search goes from the guess in steps that double, so that few decisions are about distances
  // far from the result.
  const std::uint64_t start = bits_of(guess(kind, query));
  static constexpr std::uint64_t factor_of_two = std::uint64_t{1} << 52U;
  for (std::uint64_t step = 1; above == 0; step *= 2) {
    const std::uint64_t down = step * factor_of_two;
    if (start <= down) break;
    ask(start - down);
  }
  while (at_most - above > 1) ask(above + (at_most - above) / 2);
  return NearestApproach{
      .above = distance_of(above), .at_most = distance_of(at_most), .time = *verdict.toi};
}

}  // namespace touchstone::verify::view
