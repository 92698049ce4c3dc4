#include "fast/step/bodies.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace touchstone::fast {

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
  for (const auto& [a, b] : groups.apart) {
    if (std::min(a, b) >= 0) continue;
    throw std::invalid_argument("step: a group of two that are apart is negative: " +
                                std::to_string(std::min(a, b)));
  }
  if (groups.apart.empty() && !can_collide_) return;
  of_vertices_.assign(vertices, 0);
  std::ranges::copy(of_vertices, of_vertices_.begin());
  for (const auto& [a, b] : groups.apart) apart_.push_back({std::min(a, b), std::max(a, b)});
  std::ranges::sort(apart_);
}

bool Bodies::meet(std::int32_t a, std::int32_t b) const {
  return !std::ranges::binary_search(apart_, std::array{std::min(a, b), std::max(a, b)});
}

bool Bodies::meet(std::span<const std::int32_t> vertices,
                  std::span<const std::int32_t> others) const {
  if (all_meet()) return true;
  const auto body = [this](std::int32_t vertex) {
    return of_vertices_[static_cast<std::size_t>(vertex)];
  };
  const auto can_collide = [&](std::int32_t a, std::int32_t b) {
    return (apart_.empty() || meet(body(a), body(b))) && (!can_collide_ || can_collide_(a, b));
  };
  return std::ranges::any_of(vertices, [&](std::int32_t a) {
    return std::ranges::any_of(others, [&](std::int32_t b) { return can_collide(a, b); });
  });
}

}  // namespace touchstone::fast
