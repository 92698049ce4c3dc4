#pragma once

/// \file
/// A step of a scene whose vertices move on Bézier curves: the earliest impact, all collisions, or
/// whether it is free.
///
/// The pairs that can collide are those of touchstone/step.hpp: its theorem is about the geometry
/// at one time. A vertex stays in the box around its control points, so a primitive stays in the
/// box around those of its vertices; the candidates are the pairs of primitives whose boxes are
/// within the separation. They are decided exactly (touchstone/certified.hpp).
///
/// A CurvedStep never changes; all of its functions are thread-safe.

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "touchstone/certified.hpp"
#include "touchstone/step.hpp"

namespace touchstone::fast {

/// The motion of the vertices, by reference.
struct CurvedVertices {
  std::size_t degree = 1;
  /// Weights follow the coordinates of each control point.
  bool is_rational = false;
  /// The control points of each vertex from t=0 to t=1: an array of shape (n, degree + 1, 3), or
  /// (n, degree + 1, 4) with weights.
  std::span<const double> numbers = {};

  [[nodiscard]] std::size_t numbers_of_point() const { return is_rational ? 4 : 3; }
  [[nodiscard]] std::size_t numbers_of_vertex() const { return (degree + 1) * numbers_of_point(); }
};

class CurvedStep {
 public:
  /// Keeps references to the vertices and the elements.
  /// \throws std::invalid_argument for a degree above greatest_degree, numbers that are no whole
  /// vertices, or invalid options; std::domain_error naming the first vertex with a coordinate that
  /// is not finite or a weight that is not positive and finite; otherwise as Step.
  CurvedStep(const CurvedVertices& vertices, const MeshElements& elements,
             const StepOptions& options = {});

  /// The earliest impact; nullopt if there is no collision.
  [[nodiscard]] std::optional<StepImpact> earliest() const;
  /// All collisions, by kinds, then by numbers.
  [[nodiscard]] std::vector<StepCollision> collisions() const;
  [[nodiscard]] bool is_free() const;

  /// The step from the least to the greatest corners of the vertices' boxes, whose candidates are
  /// those of this step.
  [[nodiscard]] const Step& boxes() const { return boxes_; }

 private:
  using Take = std::function<void(const StepCollision&)>;
  /// Calls take, in several threads, for all collisions at times up to limit, until that is
  /// negative.
  void for_each_collision(const std::atomic<double>& limit, const Take& take) const;

  CurvedVertices vertices_;
  Step boxes_;
};

}  // namespace touchstone::fast
