#pragma once

/// \file
/// Arguments of Python as those of C++. The functions of the package `touchstone` have already made
/// arrays of the right type, shape and layout, and checked words (python/touchstone/_input.py).

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>

#include "touchstone/any_kind.hpp"

namespace touchstone::python {

namespace py = pybind11;

/// An array of doubles in C's order, never converted.
using Doubles = py::array_t<double, py::array::c_style>;
/// An array of 32-bit integers in C's order, never converted.
using Integers = py::array_t<std::int32_t, py::array::c_style>;

[[nodiscard]] inline std::string name_of(AnyKind kind) {
  std::string name(to_string(kind));
  std::ranges::replace(name, '-', '_');
  return name;
}

/// \throws std::invalid_argument for another text.
[[nodiscard]] inline AnyKind kind_from(std::string_view text) {
  for (std::size_t number = 0; number < AnyKind::count; ++number) {
    const AnyKind kind = AnyKind::with_number(static_cast<std::int64_t>(number)).value();
    if (text == name_of(kind)) return kind;
  }
  throw std::invalid_argument("there is no kind '" + std::string(text) + "'");
}

/// \throws std::invalid_argument for a distance that is negative or not finite.
[[nodiscard]] inline Separation separation_from(double distance, const std::string& norm) {
  const Separation separation{.distance = distance, .norm = norm_from_string(norm)};
  if (is_valid(separation)) return separation;
  throw std::invalid_argument("separation must be a finite number >= 0, not " +
                              std::to_string(distance));
}

/// The queries of an array, which must live on: of shape (N, 8, 3), on straight lines, or of shape
/// (N, k+1, 4, 3), or (N, k+1, 4, 4) with weights, on curves.
[[nodiscard]] inline AnyQueries queries_of(AnyKind kind, const Doubles& array) {
  const std::span<const double> numbers{array.data(), std::size_t(array.size())};
  if (array.ndim() == 3) return {{.kind = kind}, numbers};
  const auto degree = std::size_t(array.shape(1)) - 1;
  return {{.kind = kind, .degree = degree, .is_rational = array.shape(3) == 4}, numbers};
}

/// The same of a kind of contact. \throws std::invalid_argument for a cell.
[[nodiscard]] inline Queries contacts_of(std::string_view kind, const Doubles& array) {
  const AnyKind any = kind_from(kind);
  return queries_of(any, array).as(any.contact());
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

/// True if that coordinate of a point, or its weight (axis 3), has an effect.
[[nodiscard]] inline bool has_effect(AnyKind kind, std::size_t point, std::size_t axis) {
  if (!kind.is_cell()) return decided_point(kind.contact(), point) == point;
  const CellRecord& cell = record_of(kind.cell());
  return point < cell.point_count && (axis < cell.dimension || axis == 3);
}

/// \throws std::domain_error naming query i and the first of its numbers with an effect that is not
/// finite, or a weight that is not positive, by its place in its array: on straight lines of shape
/// (8, 3).
inline void require_valid(const AnyQueries& queries, std::size_t i) {
  const std::span<const double> row = queries.row(i);
  const std::size_t numbers = queries.numbers_of_point();
  for (std::size_t place = 0; place < row.size(); ++place) {
    const double x = row[place];
    const bool is_weight = place % numbers == 3;
    if (std::isfinite(x) && !(is_weight && x <= 0.0)) continue;
    const std::size_t point = place / numbers;
    if (!has_effect(queries.kind, point % moving_points, place % numbers)) continue;
    const std::string points =
        queries.is_straight()
            ? std::to_string(point)
            : std::to_string(point / moving_points) + ", " + std::to_string(point % moving_points);
    throw std::domain_error("query " + std::to_string(i) +
                            (is_weight ? ": weight [" : ": coordinate [") + points + ", " +
                            std::to_string(place % numbers) + "] is " +
                            (std::isnan(x)   ? "NaN"
                             : std::isinf(x) ? "infinite"
                                             : "not positive"));
  }
}

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
