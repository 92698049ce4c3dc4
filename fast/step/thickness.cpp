#include "fast/step/thickness.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

namespace touchstone::fast {
namespace {

std::array<std::int32_t, 2> ordered(const std::array<std::int32_t, 2>& groups) {
  return {std::min(groups[0], groups[1]), std::max(groups[0], groups[1])};
}

/// \throws std::invalid_argument unless a radius or a distance is finite and not negative.
void require_length(double x, const std::string& name) {
  if (std::isfinite(x) && x >= 0.0) return;
  throw std::invalid_argument("step: " + name + " must be finite and not negative");
}

/// \throws std::invalid_argument unless each of the groups that a rule names is that of a vertex.
void require_vertices_in(std::set<std::int32_t> groups, std::span<const std::int32_t> of_vertices,
                         const std::string& rule) {
  if (of_vertices.empty()) groups.erase(0);
  for (std::size_t i = 0; i < of_vertices.size() && !groups.empty(); ++i) {
    groups.erase(of_vertices[i]);
  }
  if (groups.empty()) return;
  throw std::invalid_argument("step: " + rule + " names group " + std::to_string(*groups.begin()) +
                              ", but no vertex is in it");
}

}  // namespace

Bodies::Bodies(std::size_t vertices, const CollisionGroups& groups,
               std::function<bool(std::int32_t, std::int32_t)> can_collide)
    : can_collide_(std::move(can_collide)) {
  const std::span<const std::int32_t> of_vertices = groups.of_vertices;
  if (!of_vertices.empty() && of_vertices.size() != vertices) {
    throw std::invalid_argument("step: there are groups of " + std::to_string(of_vertices.size()) +
                                " vertices, but " + std::to_string(vertices) + " vertices");
  }
  for (std::size_t i = 0; i < of_vertices.size(); ++i) {
    if (of_vertices[i] < 0) {
      throw std::invalid_argument("step: the group of vertex " + std::to_string(i) +
                                  " is negative");
    }
  }
  std::set<std::int32_t> apart;
  for (const auto& two : groups.apart) apart.insert(two.begin(), two.end());
  require_vertices_in(std::move(apart), of_vertices, "apart");
  take_thickness(groups);
  if (groups.apart.empty() && !can_collide_ && !has_thickness()) return;
  of_vertices_.assign(vertices, 0);
  std::ranges::copy(of_vertices, of_vertices_.begin());
  for (const auto& two : groups.apart) apart_.push_back(ordered(two));
  std::ranges::sort(apart_);
  if (radii_.empty()) return;
  for (const std::int32_t body : of_vertices_) radii_of_vertices_.push_back(radius(body));
}

void Bodies::take_thickness(const CollisionGroups& groups) {
  const std::span<const double> radii = groups.radii;
  const std::int32_t last = groups.of_vertices.empty() ? 0 : std::ranges::max(groups.of_vertices);
  if (!radii.empty() && std::cmp_greater_equal(last, radii.size())) {
    throw std::invalid_argument("step: there are radii of " + std::to_string(radii.size()) +
                                " groups, but vertices in group " + std::to_string(last));
  }
  for (std::size_t i = 0; i < radii.size(); ++i) {
    require_length(radii[i], "the radius of group " + std::to_string(i));
  }
  std::set<std::int32_t> separated;
  for (const auto& [two, distance] : groups.separations) {
    const auto [a, b] = ordered(two);
    require_length(distance,
                   "the separation of groups " + std::to_string(a) + " and " + std::to_string(b));
    separations_.push_back({{a, b}, distance});
    separated.insert({a, b});
  }
  require_vertices_in(std::move(separated), groups.of_vertices, "separations");
  std::ranges::sort(separations_, {}, &GroupSeparation::groups);
  const auto again =
      std::ranges::adjacent_find(separations_, std::ranges::equal_to(), &GroupSeparation::groups);
  if (again != separations_.end()) {
    throw std::invalid_argument("step: groups " + std::to_string(again->groups[0]) + " and " +
                                std::to_string(again->groups[1]) + " have two separations");
  }
  if (std::ranges::any_of(radii, [](double radius) { return radius > 0.0; })) {
    radii_.assign(radii.begin(), radii.end());
  }
  // Far from overflow in all sums of distances.
  if (!(greatest_thickness() <= 0x1p1000)) {
    throw std::invalid_argument("step: the separations of groups must be at most 2^1000");
  }
}

double Bodies::thickness(std::int32_t a, std::int32_t b) const {
  const auto two = ordered({a, b});
  const auto listed = std::ranges::lower_bound(separations_, two, {}, &GroupSeparation::groups);
  if (listed != separations_.end() && listed->groups == two) return listed->distance;
  return radius(a) + radius(b);
}

double Bodies::greatest_radius(std::span<const std::int32_t> vertices) const {
  double result = 0.0;
  for (const std::int32_t vertex : vertices) {
    result = std::max(result, radii_of_vertices_[static_cast<std::size_t>(vertex)]);
  }
  return result;
}

double Bodies::thickness(std::span<const std::int32_t> vertices,
                         std::span<const std::int32_t> others) const {
  if (separations_.empty()) return greatest_radius(vertices) + greatest_radius(others);
  double result = 0.0;
  for (const std::int32_t a : vertices) {
    for (const std::int32_t b : others) result = std::max(result, thickness(body(a), body(b)));
  }
  return result;
}

double Bodies::greatest_thickness() const {
  double result = radii_.empty() ? 0.0 : 2.0 * std::ranges::max(radii_);
  for (const GroupSeparation& one : separations_) result = std::max(result, one.distance);
  return result;
}

std::vector<double> Bodies::reaches() const {
  // Half of the greatest separation of a body.
  std::map<std::int32_t, double> halves;
  for (const auto& [two, distance] : separations_) {
    // (One of the two is rounded up.)
    const double half = std::max(distance / 2.0, distance - distance / 2.0);
    for (const std::int32_t one : two) halves[one] = std::max(halves[one], half);
  }
  std::vector<double> result;
  if (!has_thickness()) return result;
  result.reserve(of_vertices_.size());
  for (const std::int32_t body : of_vertices_) {
    const auto half = halves.find(body);
    result.push_back(std::max(radius(body), half == halves.end() ? 0.0 : half->second));
  }
  return result;
}

bool Bodies::meet(std::int32_t a, std::int32_t b) const {
  return !std::ranges::binary_search(apart_, std::array{std::min(a, b), std::max(a, b)});
}

bool Bodies::meet(std::span<const std::int32_t> vertices,
                  std::span<const std::int32_t> others) const {
  if (all_meet()) return true;
  const auto can_collide = [&](std::int32_t a, std::int32_t b) {
    return (apart_.empty() || meet(body(a), body(b))) && (!can_collide_ || can_collide_(a, b));
  };
  return std::ranges::any_of(vertices, [&](std::int32_t a) {
    return std::ranges::any_of(others, [&](std::int32_t b) { return can_collide(a, b); });
  });
}

}  // namespace touchstone::fast
