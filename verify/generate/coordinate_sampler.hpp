#pragma once

/// \file
/// Coordinates drawn from zones, with few bits or with full significands.
///
/// Constructions are written in units of the scene, where everything lies within ±3.25: "the side
/// at x in [−0.5, 0.5], the vertex at x in [1, 3]". The sampler multiplies each axis by a separate
/// scale and rounds. Rounding is monotone and the zones are far apart against the roundings, so
/// strict orders between zones survive; where two coordinates must be equal, the construction uses
/// the one double twice. Truth is always derived from the doubles, never from the units.

#include <array>
#include <cstddef>
#include <optional>

#include "touchstone/number.hpp"
#include "touchstone/query.hpp"
#include "verify/generate/family_builder.hpp"

namespace touchstone::verify::generate {

/// One coordinate of a moving point: its values at t=0 and at t=1.
struct Line {
  double start;
  double end;
};

/// A zone of the scene, in units.
struct Zone {
  double low;
  double high;
};

/// All of the scene, its middle, and the zones below and above that.
inline constexpr Zone anywhere{-3.0, 3.0};
inline constexpr Zone centre{-0.5, 0.5};
inline constexpr Zone lower_zone{-3.0, -1.0};
inline constexpr Zone upper_zone{1.0, 3.0};

/// The t at which two lines are equal, exactly, if there is exactly one in [0,1].
[[nodiscard]] std::optional<exact::Rational> meeting_time(const Line& a, const Line& b);

/// The line times 2^exponent, which must be exact.
[[nodiscard]] Line scaled(const Line& line, int exponent);

/// One coordinate of a point.
[[nodiscard]] Line line_of(const Query& query, std::size_t point, std::size_t axis);

/// Sets one coordinate of a point at both ends.
void set(Query& query, std::size_t point, std::size_t axis, const Line& line);

/// Draws coordinates for one query.
class Sampler {
 public:
  /// Few bits: sixteenths times a power of two. Full: 53 random bits times a scale that is no power
  /// of two, different for the axes in half of the queries.
  explicit Sampler(Recipe& recipe);

  /// The same with given scales.
  Sampler(Recipe& recipe, const std::array<double, 3>& scales);

  /// All coordinates are multiples of one power of two, 2^-48 (full) or 1/16 (few bits), so that
  /// sums and differences below 32 in magnitude are exact. The scale is 1.
  [[nodiscard]] static Sampler on_grid(Recipe& recipe);

  /// A coordinate in the zone.
  [[nodiscard]] double draw(std::size_t axis, const Zone& zone);
  /// A coordinate that moves between two points of the zone.
  [[nodiscard]] Line within(std::size_t axis, const Zone& zone);
  /// A coordinate that moves from one zone to another.
  [[nodiscard]] Line from_to(std::size_t axis, const Zone& start, const Zone& end);

  /// Neighbour in the given number of smallest steps, upward if positive: a unit in the last place
  /// (on the grid: of the grid).
  [[nodiscard]] double nudged(double value, int steps) const;
  [[nodiscard]] Line nudged(const Line& line, int steps) const;

  /// The recipe's random numbers.
  [[nodiscard]] Random& random() { return recipe_->random; }

 private:
  Recipe* recipe_;
  std::array<double, 3> scales_;
  bool on_grid_ = false;
};

}  // namespace touchstone::verify::generate
