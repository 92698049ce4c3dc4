#pragma once

/// \file
/// Queries on curves in files.
///
/// - `.npy`: float64 or float32, of shape (N, K+1, 4, 3): the control points from t=0
/// to
///   t=1 of the four points; (N, K+1, 4, 4) with weights last; (N, 8, 3) is of degree 1.
/// - `.csv`: the first line is `degree,K` or `rational,K`; then 4 (K+1) rows a query, x, y and z
/// and,
///   of a rational one, the weight, in the same order. Each number is a decimal number or, all of
///   them, a numerator and a denominator; what is no double is an error.

#include <filesystem>
#include <vector>

#include "touchstone/curved_query.hpp"

namespace touchstone::verify::data {

struct CurvedQueryFile {
  std::size_t degree = 1;
  bool is_rational = false;
  std::vector<double> numbers;

  /// By reference to this object.
  [[nodiscard]] CurvedQueries queries() const { return {degree, is_rational, numbers}; }
};

/// Does the file begin as one of queries on curves: an array of four extents, or a line `degree,`
/// or `rational,`? An array of shape (N, 8, 3) does not, nor does what cannot be read.
[[nodiscard]] bool is_curved_query_file(const std::filesystem::path& file);

/// \throws io::DatasetError, which names the file and the line or the query, for anything else, and
/// for numbers that are not finite and weights that are not positive.
[[nodiscard]] CurvedQueryFile read_curved_queries(const std::filesystem::path& file);

}  // namespace touchstone::verify::data
