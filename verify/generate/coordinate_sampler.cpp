#include "verify/generate/coordinate_sampler.hpp"

#include <cmath>
#include <limits>

namespace touchstone::verify::generate {

using exact::Rational;

namespace {

constexpr double few_bit_step = 0x1p-4;
constexpr double full_grid_step = 0x1p-48;

double draw_scale(Recipe& recipe) {
  const auto exponent = static_cast<int>(recipe.random.between(-10, 9));
  return std::ldexp(recipe.full ? 1.0 + recipe.random.unit() : 1.0, exponent);
}

std::array<double, 3> draw_scales(Recipe& recipe) {
  const double common = draw_scale(recipe);
  if (recipe.random.coin()) return {common, common, common};
  return {draw_scale(recipe), draw_scale(recipe), draw_scale(recipe)};
}

double draw_multiple(Random& random, const Zone& zone, double step) {
  const auto low = static_cast<std::int64_t>(std::ceil(zone.low / step));
  const auto high = static_cast<std::int64_t>(std::floor(zone.high / step));
  return static_cast<double>(random.between(low, high)) * step;
}

}  // namespace

std::optional<Rational> meeting_time(const Line& a, const Line& b) {
  const Rational start = Rational(a.start) - Rational(b.start);
  const Rational end = Rational(a.end) - Rational(b.end);
  if (start == end || sgn(start) * sgn(end) > 0) return std::nullopt;
  return Rational(start / (start - end));
}

Line scaled(const Line& line, int exponent) {
  return {std::ldexp(line.start, exponent), std::ldexp(line.end, exponent)};
}

Line line_of(const Query& query, std::size_t point, std::size_t axis) {
  return {query.at(0, point, axis), query.at(1, point, axis)};
}

void set(Query& query, std::size_t point, std::size_t axis, const Line& line) {
  query.at(0, point, axis) = line.start;
  query.at(1, point, axis) = line.end;
}

Sampler::Sampler(Recipe& recipe) : recipe_(&recipe), scales_(draw_scales(recipe)) {}

Sampler::Sampler(Recipe& recipe, const std::array<double, 3>& scales)
    : recipe_(&recipe), scales_(scales) {}

Sampler Sampler::on_grid(Recipe& recipe) {
  Sampler sampler(recipe, {1.0, 1.0, 1.0});
  sampler.on_grid_ = true;
  return sampler;
}

double Sampler::draw(std::size_t axis, const Zone& zone) {
  const double scale = scales_.at(axis);
  if (!recipe_->full) return draw_multiple(random(), zone, few_bit_step) * scale;
  if (on_grid_) return draw_multiple(random(), zone, full_grid_step);
  const double units = zone.low + (zone.high - zone.low) * random().unit();
  return units * scale;
}

Line Sampler::within(std::size_t axis, const Zone& zone) { return from_to(axis, zone, zone); }

Line Sampler::from_to(std::size_t axis, const Zone& start, const Zone& end) {
  const double first = draw(axis, start);
  return {first, draw(axis, end)};
}

double Sampler::nudged(double value, int steps) const {
  if (on_grid_) return value + steps * (recipe_->full ? full_grid_step : few_bit_step);
  const double toward = steps > 0 ? std::numeric_limits<double>::infinity()
                                  : -std::numeric_limits<double>::infinity();
  for (int i = 0; i < std::abs(steps); ++i) value = std::nextafter(value, toward);
  return value;
}

Line Sampler::nudged(const Line& line, int steps) const {
  return {nudged(line.start, steps), nudged(line.end, steps)};
}

}  // namespace touchstone::verify::generate
