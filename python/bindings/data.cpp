/// \file
/// touchstone._data: datasets, by the readers and writers of the command line tool, and the
/// built-in set, by its families.

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "python/bindings/arguments.hpp"
#include "python/bindings/background.hpp"
#include "python/bindings/exact_numbers.hpp"
#include "verify/data/csv_dataset.hpp"
#include "verify/data/dataset.hpp"
#include "verify/data/npy.hpp"
#include "verify/generate/families.hpp"
#include "verify/io/dataset_error.hpp"
#include "verify/io/printable.hpp"

namespace touchstone::python {
namespace {

using verify::io::DatasetError;

/// The queries of a file in memory.
struct Dataset {
  AnyShape shape = {};
  std::vector<double> numbers{};
  std::vector<std::uint8_t> labels{};  ///< none, or one for each query
  std::vector<std::pair<std::uint64_t, exact::Rational>> times{};
};

Dataset read_until(verify::data::QuerySource& source, const std::atomic<bool>& stop) {
  Dataset result{.shape = source.shape()};
  while (auto record = stop ? std::nullopt : source.next()) {
    const auto numbers = record->query.numbers();
    result.numbers.insert(result.numbers.end(), numbers.begin(), numbers.end());
    if (record->collides) result.labels.push_back(*record->collides ? 1 : 0);
    if (record->toi) result.times.emplace_back(record->index, *std::move(record->toi));
  }
  return result;
}

/// An array of their memory, of shape (N, 8, 3), or (N, degree + 1, 4, 3 or 4) on curves.
py::array array_of(const AnyShape& shape, std::vector<double> all) {
  auto owned = std::make_unique<std::vector<double>>(std::move(all));
  std::vector<py::ssize_t> extents{
      static_cast<py::ssize_t>(owned->size() / shape.numbers_of_query())};
  if (shape.is_straight()) {
    extents.insert(extents.end(), {8, 3});
  } else {
    extents.insert(extents.end(), {static_cast<py::ssize_t>(shape.degree) + 1, 4,
                                   static_cast<py::ssize_t>(shape.numbers_of_point())});
  }
  const double* const numbers = owned->data();
  const py::capsule owner(owned.release(),
                          [](void* memory) { delete static_cast<std::vector<double>*>(memory); });
  return py::array_t<double>(extents, numbers, owner);
}

/// The kind, the queries, their labels or None, and (query, (numerator, denominator)) for each
/// time.
py::tuple parts_of(Dataset found) {
  py::object labels = py::none();
  if (!found.labels.empty()) {
    labels = py::array_t<std::uint8_t>(static_cast<py::ssize_t>(found.labels.size()),
                                       found.labels.data());
  }
  py::list times;
  for (const auto& [query, time] : found.times)
    times.append(py::make_tuple(query, to_python(time)));
  return py::make_tuple(name_of(found.shape.kind), array_of(found.shape, std::move(found.numbers)),
                        labels, times);
}

py::tuple read(const std::string& path, const std::optional<std::string>& kind, bool round) {
  verify::data::DatasetOptions options{.round = round};
  if (kind) options.kind = kind_from(*kind);
  std::atomic<bool> stop = false;
  return parts_of(in_background(
      [&] { return read_until(*verify::data::open_dataset(path, options), stop); }, stop));
}

// ---- The built-in set ---------------------------------------------------------------------------

/// The families about contact, or a separation, and about inversion.
std::vector<verify::generate::Family> families_about(const Separation& separation) {
  return verify::generate::families(separation, std::vector<std::string>{"1"});
}

/// The names of all, with those on curves.
py::list families() {
  auto all = families_about({});
  std::ranges::copy(verify::generate::curved_families(), std::back_inserter(all));
  py::list names;
  for (const auto& family : all) names.append(std::string(family.name));
  return names;
}

/// (name, what read() returns) of each family that has the kind, in the order of names. The truth
/// is left out where it is about another separation.
py::list generate(const std::string& kind_name, const std::optional<std::string>& name,
                  std::uint64_t seed, std::uint64_t count, double distance,
                  const std::string& norm) {
  const AnyKind kind = kind_from(kind_name);
  const Separation separation = separation_from(distance, norm);
  if (!is_zero(separation)) static_cast<void>(kind.contact());  // throws for a cell
  auto chosen =
      name ? std::vector{verify::generate::family_from_name(*name)} : families_about(separation);
  std::ranges::sort(chosen, {}, &verify::generate::Family::name);
  std::atomic<bool> stop = false;
  py::list result;
  for (const auto& family : chosen) {
    if (!verify::generate::supports(family, kind)) continue;
    const auto source = verify::generate::open_family(family, kind, seed, count, separation);
    Dataset found = in_background([&] { return read_until(*source, stop); }, stop);
    const Separation recorded = source->recorded_separation();
    if (recorded != separation && !(is_zero(recorded) && is_zero(separation))) {
      found.labels.clear();
      found.times.clear();
    }
    result.append(py::make_tuple(source->name(), parts_of(std::move(found))));
  }
  return result;
}

// ---- Writing ------------------------------------------------------------------------------------

using Labels = py::array_t<bool, py::array::c_style>;

/// A file that read() reads: .csv, with labels if there are any, or .npy.
void write(const std::string& path, const std::string& kind, const Doubles& array,
           const std::optional<Labels>& labels) {
  const std::filesystem::path file(path);
  const bool is_npy = file.extension() == ".npy";
  if (!is_npy && file.extension() != ".csv") {
    throw std::invalid_argument(path + ": the name must end in .csv or .npy");
  }
  const AnyQueries queries = queries_of(kind_from(kind), array);
  for (std::size_t i = 0; i < queries.size(); ++i) require_valid(queries.as(AnyKind()), i);
  if (labels && (labels->ndim() != 1 || std::size_t(labels->size()) != queries.size())) {
    throw std::invalid_argument(path + ": there must be as many labels as queries");
  }
  const bool* const collides = labels ? labels->data() : nullptr;
  std::atomic<bool> stop = false;
  const auto write_with = [&](auto& writer, const auto& write_query) {
    for (std::size_t i = 0; i < queries.size() && !stop; ++i) write_query(i);
    if (!stop) writer.close();
  };
  const auto write_all = [&] {
    if (is_npy) {
      verify::data::NpyWriter writer(file, queries);
      write_with(writer, [&](std::size_t i) { writer.write(queries.row(i)); });
    } else {
      verify::data::CsvWriter writer(file);
      write_with(writer, [&](std::size_t i) {
        writer.write({queries, i}, collides ? std::optional(collides[i]) : std::nullopt);
      });
    }
    return true;
  };
  static_cast<void>(in_background(write_all, stop));
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
  m.def("families", families);
  m.def("generate", generate, arg("kind"), arg("family"), arg("seed"), arg("count"),
        arg("separation"), arg("norm"));
  m.def("read", read, arg("path"), arg("kind"), arg("round"));
  m.def("write", write, arg("path"), arg("kind"), arg("queries").noconvert(),
        arg("labels").noconvert());
  m.def(
      "kind_of",
      [](const std::string& path) { return name_of(verify::data::kind_from_path(path)); },
      arg("path"));
}

}  // namespace touchstone::python
