#pragma once

/// \file
/// Arguments of Python as those of C++. The functions of the package `touchstone` have already made
/// arrays of the right type and layout; what arrives here is only checked.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "touchstone/curved_query.hpp"
#include "touchstone/query.hpp"

namespace touchstone::python {

namespace py = pybind11;

/// An array of doubles in C's order, never converted.
using Doubles = py::array_t<double, py::array::c_style>;
/// An array of 32-bit integers in C's order, never converted.
using Integers = py::array_t<std::int32_t, py::array::c_style>;

/// \throws std::invalid_argument for another text.
[[nodiscard]] inline Kind kind_from(std::string_view text) {
  if (text == "vertex_face") return Kind::vertex_face;
  if (text == "edge_edge") return Kind::edge_edge;
  throw std::invalid_argument("kind must be 'vertex_face' or 'edge_edge', not '" +
                              std::string(text) + "'");
}

[[nodiscard]] inline const char* name_of(Kind kind) {
  return kind == Kind::vertex_face ? "vertex_face" : "edge_edge";
}

/// \throws std::invalid_argument for another norm, or a distance that is negative or not finite.
[[nodiscard]] inline Separation separation_from(double distance, const std::string& norm) {
  if (norm != "linf" && norm != "l2") {
    throw std::invalid_argument("norm must be 'linf' or 'l2', not '" + norm + "'");
  }
  const Separation separation{.distance = distance, .norm = norm_from_string(norm)};
  if (is_valid(separation)) return separation;
  throw std::invalid_argument("separation must be a finite number >= 0, not " +
                              std::to_string(distance));
}

/// The queries of an array of shape (N, 8, 3), which must live on.
[[nodiscard]] inline std::span<const Query> queries_of(const Doubles& array) {
  if (array.ndim() != 3 || array.shape(1) != 8 || array.shape(2) != 3) {
    throw std::invalid_argument("queries must have the shape (N, 8, 3)");
  }
  // An array of doubles in this order is an array of queries (touchstone/query.hpp).
  return {reinterpret_cast<const Query*>(array.data()), std::size_t(array.shape(0))};
}

/// The items of a structured array that the caller has made for results, an item each.
template <class Item>
[[nodiscard]] std::span<Item> items_of(py::array& array, std::size_t count) {
  if (array.ndim() != 1 || std::size_t(array.shape(0)) != count ||
      std::size_t(array.itemsize()) != sizeof(Item) ||
      (count > 1 && std::size_t(array.strides(0)) != sizeof(Item))) {
    throw std::invalid_argument("results need an array of their own layout, an item a query");
  }
  return {static_cast<Item*>(array.mutable_data()), count};
}

/// \throws std::domain_error naming the query and the place of its first coordinate that is not
/// finite.
[[noreturn]] inline void reject_coordinates(std::span<const Query> queries, std::size_t number) {
  const auto& coordinates = queries[number].coordinates;
  const auto found = std::ranges::find_if(coordinates, [](double x) { return !std::isfinite(x); });
  const auto place = std::size_t(found - coordinates.begin());
  throw std::domain_error("query " + std::to_string(number) + ": coordinate [" +
                          std::to_string(place / 3) + ", " + std::to_string(place % 3) + "] is " +
                          (std::isnan(*found) ? "NaN" : "infinite"));
}

/// The queries of an array, which must live on: of shape (N, 8, 3), on straight lines, or of shape
/// (N, K+1, 4, 3), or (N, K+1, 4, 4) with weights, on curves.
class Batch {
 public:
  explicit Batch(const Doubles& array) : is_curved_(array.ndim() == 4) {
    if (!is_curved_) {
      lines_ = queries_of(array);
      return;
    }
    if (array.shape(1) == 0 || array.shape(2) != 4 || array.shape(3) < 3 || array.shape(3) > 4) {
      throw std::invalid_argument(
          "curves must have the shape (N, k + 1, 4, 3) or (N, k + 1, 4, 4)");
    }
    curves_ = {.degree = std::size_t(array.shape(1)) - 1,
               .is_rational = array.shape(3) == 4,
               .numbers = {array.data(), std::size_t(array.size())}};
    if (curves_.degree > greatest_degree) {
      throw std::invalid_argument("the degree of a curve is at most " +
                                  std::to_string(greatest_degree) + ", not " +
                                  std::to_string(curves_.degree));
    }
  }

  [[nodiscard]] std::size_t size() const { return is_curved_ ? curves_.size() : lines_.size(); }

  /// Returns take(queries) for some of the queries, a span or CurvedQueries.
  template <class Take>
  decltype(auto) with_some(std::size_t first, std::size_t count, const Take& take) const {
    if (!is_curved_) return take(lines_.subspan(first, count));
    CurvedQueries some = curves_;
    const std::size_t size = curves_.numbers_of_query();
    some.numbers = some.numbers.subspan(first * size, count * size);
    return take(some);
  }
  /// Returns take(query), a Query or a CurvedQuery.
  template <class Take>
  decltype(auto) with(std::size_t i, const Take& take) const {
    return is_curved_ ? take(curves_.query(i)) : take(lines_[i]);
  }

  /// \throws std::domain_error naming a query with a number that is not finite or a weight that is
  /// not positive.
  void require_valid(std::size_t i) const {
    if (!is_curved_) {
      if (!is_finite(lines_[i])) reject_coordinates(lines_, i);
      return;
    }
    const std::span<const double> row = curves_.row(i);
    const std::size_t numbers = curves_.numbers_of_point();
    for (std::size_t place = 0; place < row.size(); ++place) {
      const double x = row[place];
      const bool is_weight = place % numbers == 3;
      if (std::isfinite(x) && !(is_weight && x <= 0.0)) continue;
      throw std::domain_error("query " + std::to_string(i) +
                              (is_weight ? ": weight [" : ": coordinate [") +
                              std::to_string(place / (moving_points * numbers)) + ", " +
                              std::to_string(place / numbers % moving_points) + ", " +
                              std::to_string(place % numbers) + "] is " +
                              (std::isnan(x)   ? "NaN"
                               : std::isinf(x) ? "infinite"
                                               : "not positive"));
    }
  }

 private:
  bool is_curved_;
  std::span<const Query> lines_;
  CurvedQueries curves_;
};

/// The layout of results as numpy.dtype takes it: names, formats, offsets, itemsize.
class Layout {
 public:
  explicit Layout(std::size_t size) { layout_["itemsize"] = size; }
  Layout& add(const char* name, const char* format, std::size_t offset) {
    names_.append(name);
    formats_.append(format);
    offsets_.append(offset);
    return *this;
  }
  [[nodiscard]] py::dict dict() {
    layout_["names"] = names_;
    layout_["formats"] = formats_;
    layout_["offsets"] = offsets_;
    return layout_;
  }

 private:
  py::dict layout_;
  py::list names_, formats_, offsets_;
};

}  // namespace touchstone::python
