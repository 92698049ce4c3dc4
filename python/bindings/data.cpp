/// \file
/// touchstone._data: datasets, by the readers of the command line tool.

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "python/bindings/arguments.hpp"
#include "python/bindings/background.hpp"
#include "python/bindings/exact_numbers.hpp"
#include "verify/data/dataset.hpp"
#include "verify/io/dataset_error.hpp"
#include "verify/io/printable.hpp"

namespace touchstone::python {
namespace {

using verify::io::DatasetError;

/// The queries of a file in memory.
struct Dataset {
  Kind kind = Kind::vertex_face;
  std::vector<Query> queries{};
  std::vector<std::uint8_t> labels{};  ///< none, or one for each query
  std::vector<std::pair<std::uint64_t, exact::Rational>> times{};
};

Dataset read_until(const std::string& path, const verify::data::DatasetOptions& options,
                   const std::atomic<bool>& stop) {
  const auto source = verify::data::open_dataset(path, options);
  Dataset result{.kind = source->kind()};
  while (auto record = stop ? std::nullopt : source->next()) {
    result.queries.push_back(record->query);
    if (record->collides) result.labels.push_back(*record->collides ? 1 : 0);
    if (record->toi) result.times.emplace_back(record->index, *std::move(record->toi));
  }
  return result;
}

/// An array of shape (N, 8, 3) of their memory.
py::array array_of(std::vector<Query> queries) {
  auto owned = std::make_unique<std::vector<Query>>(std::move(queries));
  const std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(owned->size()), 8, 3};
  const auto* const numbers = reinterpret_cast<const double*>(owned->data());
  const py::capsule owner(owned.release(),
                          [](void* all) { delete static_cast<std::vector<Query>*>(all); });
  return py::array_t<double>(shape, numbers, owner);
}

/// The kind, the queries, their labels or None, and (query, (numerator, denominator)) for each
/// time.
py::tuple read(const std::string& path, const std::optional<std::string>& kind, bool round) {
  verify::data::DatasetOptions options{.round = round};
  if (kind) options.kind = kind_from(*kind);
  std::atomic<bool> stop = false;
  Dataset found = in_background([&] { return read_until(path, options, stop); }, stop);
  py::object labels = py::none();
  if (!found.labels.empty()) {
    labels = py::array_t<std::uint8_t>(static_cast<py::ssize_t>(found.labels.size()),
                                       found.labels.data());
  }
  py::list times;
  for (const auto& [query, time] : found.times)
    times.append(py::make_tuple(query, to_python(time)));
  return py::make_tuple(name_of(found.kind), array_of(std::move(found.queries)), labels, times);
}

}  // namespace

PYBIND11_MODULE(_data, m) {
  using py::arg;
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(std::move(thrown));
    } catch (const DatasetError& error) {
      PyErr_SetString(PyExc_ValueError, verify::io::printable(error.what()).c_str());
    }
  });
  m.def("read", read, arg("path"), arg("kind"), arg("round"));
  m.def(
      "kind_of",
      [](const std::string& path) { return name_of(verify::data::kind_from_path(path)); },
      arg("path"));
}

}  // namespace touchstone::python
