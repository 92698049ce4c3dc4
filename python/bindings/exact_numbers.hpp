#pragma once

/// \file
/// Exact numbers for Python.

#include <pybind11/pybind11.h>

#include "touchstone/number.hpp"

namespace touchstone::python {

[[nodiscard]] inline pybind11::object to_python(const exact::Integer& number) {
  return pybind11::reinterpret_steal<pybind11::object>(
      PyLong_FromString(number.get_str(16).c_str(), nullptr, 16));
}

/// (numerator, denominator).
[[nodiscard]] inline pybind11::tuple to_python(const exact::Rational& number) {
  return pybind11::make_tuple(to_python(exact::Integer(number.get_num())),
                              to_python(exact::Integer(number.get_den())));
}

}  // namespace touchstone::python
