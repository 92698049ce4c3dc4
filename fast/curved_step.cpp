#include "touchstone/step.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "fast/certified/block.hpp"
#include "fast/platform/floating_point_state.hpp"
#include "fast/step/scene.hpp"
#include "touchstone/certified.hpp"

namespace touchstone::fast {
namespace {

/// The step from the least to the greatest corners of the boxes of control points.
Step step_of_boxes(const CurvedVertices& vertices, Mesh mesh, const StepOptions& options) {
  const std::size_t size = vertices.numbers_of_vertex(), stride = vertices.numbers_of_point();
  require_degree(vertices.degree);
  if (!mesh.tetrahedra.empty() || !mesh.plane_triangles.empty()) {
    throw std::invalid_argument("curved step: volumes are known on straight lines only");
  }
  if (vertices.numbers.size() % size != 0) {
    throw std::invalid_argument("curved step: the numbers are no whole vertices");
  }
  const StrictFloatingPoint strict;
  const std::size_t count = vertices.numbers.size() / size;
  std::vector<double> least, greatest;
  for (std::size_t vertex = 0; vertex < count; ++vertex) {
    const auto row = std::span(vertices.numbers).subspan(vertex * size, size);
    for (std::size_t i = 0; i < row.size(); ++i) {
      const bool is_weight = vertices.is_rational && i % stride == 3;
      if (std::isfinite(row[i]) && (!is_weight || row[i] > 0.0)) continue;
      throw std::domain_error("curved step: vertex " + std::to_string(vertex) +
                              " has a number that is not finite, or a weight that is not positive");
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double low = row[axis], high = row[axis];
      for (std::size_t i = axis; i < row.size(); i += stride) {
        low = std::min(low, row[i]);
        high = std::max(high, row[i]);
      }
      least.push_back(low);
      greatest.push_back(high);
    }
  }
  return {std::span<const double>(least), std::span<const double>(greatest), std::move(mesh),
          options};
}

}  // namespace

CurvedStep::CurvedStep(CurvedVertices vertices, Mesh mesh, const StepOptions& options)
    : vertices_(std::move(vertices)), boxes_(step_of_boxes(vertices_, std::move(mesh), options)) {}

void CurvedStep::for_each_collision(const std::atomic<double>& limit, const Take& take) const {
  const std::size_t size = vertices_.numbers_of_vertex(), stride = vertices_.numbers_of_point();
  const auto decide = [&](PairKind kind, std::span<const IndexPair> pairs,
                          const Separation& separation) {
    CertifiedOptions options = boxes_.options().solve;
    options.separation = separation;
    options.max_threads = 1;
    options.t_max = std::min(options.t_max, limit.load());
    if (options.t_max < 0.0) return;
    std::vector<double> numbers;
    numbers.reserve(pairs.size() * size * moving_points);
    for (const IndexPair& pair : pairs) {
      const auto of_pair = boxes_.vertices_of(kind, pair);
      for (std::size_t k = 0; k <= vertices_.degree; ++k) {
        for (const std::int32_t vertex : of_pair) {
          const auto place = static_cast<std::size_t>(vertex) * size + k * stride;
          const auto point = std::span(vertices_.numbers).subspan(place, stride);
          numbers.insert(numbers.end(), point.begin(), point.end());
        }
      }
    }
    std::vector<CertifiedResult> results(pairs.size());
    solve(Queries({.kind = Step::kind_of(kind),
                   .degree = vertices_.degree,
                   .is_rational = vertices_.is_rational},
                  numbers),
          results, options);
    for (std::size_t i = 0; i < results.size(); ++i) {
      if (results[i].verdict != Verdict::yes) continue;
      take(collision_of(kind, pairs[i], results[i]));
    }
  };
  boxes_.candidates([&](const StepCandidates& some) {
    std::map<double, std::vector<IndexPair>> of_distances;
    for (const IndexPair& pair : some.pairs) {
      of_distances[boxes_.separation_of(some.kind, pair).distance].push_back(pair);
    }
    for (const auto& [distance, pairs] : of_distances) {
      decide(some.kind, pairs,
             {.distance = distance, .norm = boxes_.options().solve.separation.norm});
    }
  });
}

std::vector<StepCollision> CurvedStep::collisions() const {
  std::vector<StepCollision> all;
  std::mutex mutex;
  for_each_collision(1.0, [&](const StepCollision& collision) {
    const std::scoped_lock lock(mutex);
    all.push_back(collision);
  });
  sort_by_pair(all);
  return all;
}

bool CurvedStep::is_free() const {
  std::atomic<double> limit = 1.0;
  for_each_collision(limit, [&](const StepCollision&) { limit = -1.0; });
  return limit > 0.0;
}

std::optional<StepImpact> CurvedStep::earliest() const {
  StepImpact impact{.toi_lower = 1.0, .toi_upper = 1.0, .pairs = {}};
  std::atomic<double> limit = 1.0;
  std::mutex mutex;
  for_each_collision(limit, [&](const StepCollision& collision) {
    const std::scoped_lock lock(mutex);
    impact.pairs.push_back(collision);
    if (collision.toi_upper > impact.toi_upper) return;
    impact.toi_upper = collision.toi_upper;
    limit = limit_after(collision.toi_upper, boxes_.options().solve.toi_tolerance);
  });
  if (impact.pairs.empty()) return std::nullopt;
  std::erase_if(impact.pairs, [&](const StepCollision& collision) {
    return collision.toi_lower > impact.toi_upper;
  });
  for (const StepCollision& collision : impact.pairs) {
    impact.toi_lower = std::min(impact.toi_lower, collision.toi_lower);
  }
  sort_by_pair(impact.pairs);
  return impact;
}

}  // namespace touchstone::fast
