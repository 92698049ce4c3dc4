#pragma once

/// \file
/// A query of any shape that owns its numbers, for what outlives the array that it came from.

#include <stdexcept>
#include <utility>
#include <vector>

#include "touchstone/query.hpp"

namespace touchstone::verify::base {

class AnyQuery {
 public:
  /// All points at rest in the origin.
  AnyQuery() : AnyQuery(Kind::vertex_face, Query{}) {}
  AnyQuery(Kind kind, const Query& query)
      : shape_{.kind = kind}, numbers_(query.coordinates.begin(), query.coordinates.end()) {}
  AnyQuery(const Queries& queries, std::size_t i)
      : shape_(queries), numbers_(queries.row(i).begin(), queries.row(i).end()) {}
  /// \pre as many numbers as the shape has
  AnyQuery(const QueryShape& shape, std::vector<double> numbers)
      : shape_(shape), numbers_(std::move(numbers)) {}

  [[nodiscard]] const QueryShape& shape() const { return shape_; }
  [[nodiscard]] Kind kind() const { return shape_.kind; }
  [[nodiscard]] std::span<const double> numbers() const { return numbers_; }
  [[nodiscard]] std::span<double> numbers() { return numbers_; }
  /// As the only one of an array.
  [[nodiscard]] Queries queries() const { return {shape_, numbers_}; }
  /// On straight lines. \pre shape().is_straight()
  [[nodiscard]] const Query& straight() const { return queries().straight().front(); }

  friend bool operator==(const AnyQuery&, const AnyQuery&) = default;

 private:
  QueryShape shape_;
  std::vector<double> numbers_;
};

}  // namespace touchstone::verify::base
