#pragma once

/// \file
/// fast::Step for Python.

#include <pybind11/pybind11.h>

namespace touchstone::python {

/// Adds the class Step and the layouts of its results.
void define_step(pybind11::module_& m);

}  // namespace touchstone::python
