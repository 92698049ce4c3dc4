#include "verify/fuzz/aligned_roundings.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "verify/generate/draws.hpp"

namespace touchstone::verify::fuzz {
namespace {

namespace draws = generate::draws;
using generate::Random;

/// Coordinates of the axis are in [1,2), as whole numbers of their unit in the last place; the time
/// is n/64, and exact values then are whole numbers of 64ths of that unit.
constexpr std::int64_t parts = 64;

/// One coordinate of a moving point, in units.
struct Track {
  std::int64_t start = 0;
  std::int64_t end = 0;

  /// The position at n/64, in 64ths.
  [[nodiscard]] std::int64_t at(std::int64_t n) const { return (parts - n) * start + n * end; }

  /// The error of the value that solvers compute, in 64ths, upward.
  [[nodiscard]] std::int64_t error(std::int64_t n) const {
    const double t = static_cast<double>(n) / parts;
    const auto a = static_cast<double>(start), b = static_cast<double>(end);
    return parts * static_cast<std::int64_t>(a * (1.0 - t) + b * t) - at(n);
  }
};

/// A track close to `about` that is at `place` at n/64, up to a unit, and whose computed value is
/// nearly a unit above or below.
std::optional<Track> aligned_track(const Track& about, std::int64_t n, std::int64_t place,
                                   bool upward, Random& random) {
  constexpr int tries = 4000;
  constexpr std::int64_t least_error = 56;
  for (int i = 0; i < tries; ++i) {
    Track track{.start = about.start + random.between(0, 4095)};
    track.end = (place - (parts - n) * track.start) / n + random.between(0, 1);
    const std::int64_t error = track.error(n);
    if ((upward ? error : -error) >= least_error) return track;
  }
  return std::nullopt;
}

/// The deciding parts: the axis with the roundings, and the place of the contact.
struct RoundingPlan {
  std::array<Track, moving_points> tracks;
  std::int64_t n = 0;
  double speed = 0.0;  ///< of edge a on that axis; edge b rests but for its last bits
  double u = 0.0, v = 0.0;
};

/// The number of units by which edge a is below edge b at n/64, at the contact's u and v.
constexpr double lag = 0.1;

/// The parameter on edge a of the point at v on edge b.
double crossing(const RoundingPlan& plan) {
  std::array<double, moving_points> away{};
  for (std::size_t i = 0; i < away.size(); ++i) {
    const std::int64_t distance = plan.tracks.at(i).at(plan.n) - plan.tracks[2].at(plan.n);
    away.at(i) = static_cast<double>(distance) / parts;
  }
  return (plan.v * away[3] - lag - away[0]) / (away[1] - away[0]);
}

std::optional<RoundingPlan> draw_plan(Random& random) {
  RoundingPlan plan{.tracks = {},
                    .n = random.coin() ? 33 : 31,
                    .speed = draws::power_of_two(-static_cast<int>(random.between(7, 10)))};
  const auto units = [](double x) { return static_cast<std::int64_t>(x * 0x1p52); };
  const double middle = random.uniform(1.05, 1.06), c = static_cast<double>(plan.n) / parts;
  const Track moving{units(middle - c * plan.speed), units(middle + (1.0 - c) * plan.speed)};
  const Track resting{units(middle), units(middle)};
  for (std::size_t i = 0; i < moving_points; ++i) {
    const bool is_of_a = i < 2;
    const std::int64_t place = parts * (units(middle) + 2048 + random.between(-2, 2));
    const auto track = aligned_track(is_of_a ? moving : resting, plan.n, place, is_of_a, random);
    if (!track) return std::nullopt;
    plan.tracks.at(i) = *track;
  }
  for (int i = 0; i < 16; ++i) {
    plan.v = random.uniform(0.05, 0.95);
    plan.u = crossing(plan);
    if (plan.u > 0.05 && plan.u < 0.95) return plan;
  }
  return std::nullopt;
}

void put_tracks(Query& query, std::size_t axis, const RoundingPlan& plan) {
  for (std::size_t point = 0; point < moving_points; ++point) {
    query.at(0, point, axis) = static_cast<double>(plan.tracks.at(point).start) * 0x1p-52;
    query.at(1, point, axis) = static_cast<double>(plan.tracks.at(point).end) * 0x1p-52;
  }
}

/// On this axis the edges meet exactly at that time, and earlier they are beyond rounding: on it no
/// box that ends at n/64 has a contact.
void put_clock(Query& query, std::size_t axis, const RoundingPlan& plan) {
  const double c = static_cast<double>(plan.n) / parts, late = lag * 0x1p-52 / plan.speed;
  for (std::size_t point = 0; point < moving_points; ++point) {
    const bool is_of_a = point < 2;
    query.at(0, point, axis) = is_of_a ? 1.0 - (c + late) : 1.0;
    query.at(1, point, axis) = is_of_a ? 2.0 - (c + late) : 1.0;
  }
}

/// Random coordinates on the third axis, except one, for which F is 0 there.
void put_crossing(Query& query, std::size_t axis, const RoundingPlan& plan, Random& random) {
  const double t = static_cast<double>(plan.n) / parts;
  const std::array<double, moving_points> weights{1.0 - plan.u, plan.u, plan.v - 1.0, -plan.v};
  const double scale = draws::power_of_two(static_cast<int>(random.between(-3, 3)));
  double sum = 0.0;
  for (std::size_t point = 0; point < moving_points; ++point) {
    for (std::size_t end = 0; end < 2; ++end) {
      const double x = random.uniform(-scale, scale);
      query.at(end, point, axis) = x;
      sum += weights.at(point) * (end == 0 ? 1.0 - t : t) * x;
    }
  }
  query.at(0, 0, axis) -= sum / (weights[0] * (1.0 - t));
}

/// Plans take long to find, and a few are enough.
const std::vector<RoundingPlan>& plans() {
  static const std::vector<RoundingPlan> all = [] {
    constexpr std::size_t count = 32;
    Random random(1);
    std::vector<RoundingPlan> found;
    while (found.size() < count) {
      if (const auto plan = draw_plan(random)) found.push_back(*plan);
    }
    return found;
  }();
  return all;
}

}  // namespace

Query aligned_contact(Random& random) {
  const RoundingPlan& plan = plans()[draws::below(random, plans().size())];
  Query query{};
  const std::size_t axis = draws::below(random, 3);
  put_tracks(query, axis, plan);
  put_clock(query, (axis + 1) % 3, plan);
  put_crossing(query, (axis + 2) % 3, plan, random);
  const double scale = draws::power_of_two(static_cast<int>(random.between(-20, 20)));
  draws::multiply(query, {scale, scale, scale});
  return query;
}

}  // namespace touchstone::verify::fuzz
