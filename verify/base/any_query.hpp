#pragma once

/// \file
/// A query of any shape that owns its numbers and may outlive the array that it came from. A query
/// on straight lines needs no memory on the heap, which would make readers of arrays slower by a
/// third.

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "touchstone/any_kind.hpp"

namespace touchstone::verify::base {

class AnyQuery {
 public:
  /// All points at rest in the origin.
  AnyQuery() : AnyQuery(ContactKind::vertex_face, Query{}) {}
  AnyQuery(AnyKind kind, const Query& query) : shape_{.kind = kind}, straight_(query) {}
  AnyQuery(const AnyQueries& queries, std::size_t i) : AnyQuery(queries, queries.row(i)) {}
  /// \pre as many numbers as the shape has
  AnyQuery(const AnyShape& shape, std::span<const double> numbers) : shape_(shape) {
    if (shape.is_straight()) {
      std::copy_n(numbers.begin(), straight_.coordinates.size(), straight_.coordinates.begin());
    } else {
      curves_.assign(numbers.begin(), numbers.end());
    }
  }

  [[nodiscard]] const AnyShape& shape() const { return shape_; }
  [[nodiscard]] AnyKind kind() const { return shape_.kind; }
  [[nodiscard]] std::span<const double> numbers() const {
    if (shape_.is_straight()) return straight_.coordinates;
    return curves_;
  }
  [[nodiscard]] std::span<double> numbers() {
    if (shape_.is_straight()) return straight_.coordinates;
    return curves_;
  }
  /// An array of this query alone.
  [[nodiscard]] AnyQueries queries() const { return {shape_, numbers()}; }
  /// The query on straight lines. \pre shape().is_straight()
  [[nodiscard]] const Query& straight() const { return straight_; }

  friend bool operator==(const AnyQuery&, const AnyQuery&) = default;

 private:
  AnyShape shape_;
  Query straight_{};            ///< if it is
  std::vector<double> curves_;  ///< else
};

}  // namespace touchstone::verify::base
