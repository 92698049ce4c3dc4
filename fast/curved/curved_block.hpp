#pragma once

/// \file
/// A block of queries on curves for the kernels (fast/certified/kernel.hpp; the stages:
/// curved_stages.hpp).

#include <cstddef>
#include <cstdint>

#include "touchstone/curved_query.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast::curved {

/// The least degree that is enough for all queries with a control polygon.
inline constexpr std::size_t greatest_corner_degree = greatest_degree;

/// The form of the control polygons of queries. With more than one denominator,
/// 2 · degree ≤ greatest_corner_degree.
enum class Denominators : std::uint8_t {
  one,   ///< the weights of all points are equal, or there are none
  two,   ///< those of each primitive are
  four,  ///< each point has its own; for distance 0
};
inline constexpr std::size_t denominators_count = 3;

/// Queries of an array, at most kernel_block.
struct Block {
  Kind kind = Kind::vertex_face;
  std::size_t degree = 1;
  bool is_rational = false;
  const double* numbers = nullptr;  ///< as CurvedQueries::numbers, of the block's first query
  std::size_t count = 0;
  Separation separation = {};
  /// As CertifiedOptions::toi_tolerance, at least least_kernel_tolerance.
  double toi_tolerance = 1e-12;
  double t_limit = 1.0;  ///< contacts after this time may or may not be found

  [[nodiscard]] std::size_t numbers_of_query() const {
    return (degree + 1) * moving_points * (is_rational ? 4 : 3);
  }
};

}  // namespace touchstone::fast::curved
