/// \file
/// touchstone._fast: answers about batches of queries and of cells, and steps.
/// Needs touchstone::fast alone. The package `touchstone` says what the functions mean; arrays are
/// as arguments.hpp says, and each function returns the number of queries that it has done.

#include <pybind11/pybind11.h>

#include <cstddef>
#include <span>
#include <string>

#include "fast/certified/kernel.hpp"
#include "fast/platform/instruction_set.hpp"
#include "python/bindings/arguments.hpp"
#include "python/bindings/blocks.hpp"
#include "python/bindings/step.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/contacts.hpp"
#include "touchstone/inversion.hpp"
#include "touchstone/tight_inclusion.hpp"

namespace touchstone::python {
namespace {

/// Queries a block: some hundred microseconds as a rule, and below a second for the slowest
/// queries.
constexpr std::size_t certified_block = 2048;
constexpr std::size_t search_block = 4;

/// Answers `queries` in `results` by calls of solve(part, items of the part), also for no query,
/// which checks the options.
template <class Item, class Kind, class Solve>
std::size_t solve_blocks(const Batch<Kind>& queries, py::array& results, std::size_t block,
                         int threads, const py::object& progress, const Solve& solve) {
  const auto items = items_of<Item>(results, queries.size());
  solve(queries.part(0, 0), std::span<Item>());
  return in_blocks(queries.size(), block, threads, progress,
                   [&](std::size_t first, std::size_t count) {
                     const auto part = items.subspan(first, count);
                     solve(queries.part(first, count), part);
                     for (std::size_t i = 0; i < count; ++i) {
                       if (part[i].verdict == fast::Verdict::error) {
                         require_valid(queries, first + i);
                       }
                     }
                   });
}

std::size_t certified(const std::string& kind, const Doubles& array, py::array results,
                      double separation, const std::string& norm, double toi_tolerance,
                      double t_max, int threads, const py::object& progress) {
  const fast::CertifiedOptions options{.toi_tolerance = toi_tolerance,
                                       .t_max = t_max,
                                       .separation = separation_from(separation, norm),
                                       .max_threads = 1};
  return solve_blocks<fast::CertifiedResult>(
      contacts_of(kind, array), results, certified_block, threads, progress,
      [&](const Queries& part, auto items) { fast::solve(part, items, options); });
}

py::dict certified_layout() {
  using Result = fast::CertifiedResult;
  return Layout(sizeof(Result))
      .add("collides", "?", offsetof(Result, verdict))
      .add("exact", "?", offsetof(Result, is_exact))
      .add("toi_lower", "f8", offsetof(Result, toi_lower))
      .add("toi_upper", "f8", offsetof(Result, toi_upper))
      .add("u", "f8", offsetof(Result, u))
      .add("v", "f8", offsetof(Result, v))
      .dict();
}

std::size_t inversions(const std::string& kind, const Doubles& array, py::array results,
                       double toi_tolerance, double t_max, int threads,
                       const py::object& progress) {
  const CellKind of_cells = kind_from(kind).cell();
  const fast::InversionOptions options{
      .toi_tolerance = toi_tolerance, .t_max = t_max, .max_threads = 1};
  return solve_blocks<fast::Inversion>(
      queries_of(of_cells, array).as(of_cells), results, certified_block, threads, progress,
      [&](const Cells& part, auto items) { fast::inversions(part, items, options); });
}

py::dict inversion_layout() {
  using Result = fast::Inversion;
  return Layout(sizeof(Result))
      .add("inverts", "?", offsetof(Result, verdict))
      .add("is_exact", "?", offsetof(Result, is_exact))
      .add("start", "i1", offsetof(Result, start))
      .add("toi_lower", "f8", offsetof(Result, toi_lower))
      .add("toi_upper", "f8", offsetof(Result, toi_upper))
      .dict();
}

std::size_t tight_inclusion(const std::string& kind, const Doubles& array, py::array results,
                            double separation, const std::string& norm, double tolerance,
                            std::int64_t max_checks, double t_max, int threads,
                            const py::object& progress) {
  const fast::TightInclusionOptions options{.tolerance = tolerance,
                                            .max_checks = max_checks,
                                            .separation = separation_from(separation, norm),
                                            .t_max = t_max};
  return solve_blocks<fast::TightInclusionResult>(
      contacts_of(kind, array), results, search_block, threads, progress,
      [&](const Queries& part, auto items) { fast::tight_inclusion(part, items, options); });
}

py::dict tight_inclusion_layout() {
  using Item = fast::TightInclusionResult;
  return Layout(sizeof(Item))
      .add("collides", "?", offsetof(Item, verdict))
      .add("toi", "f8", offsetof(Item, toi))
      .add("tolerance", "f8", offsetof(Item, tolerance))
      .add("checks", "i8", offsetof(Item, checks))
      .dict();
}

std::size_t distance(const std::string& kind, const Doubles& array, py::array results, double t,
                     const std::string& norm, int threads, const py::object& progress) {
  const Queries queries = contacts_of(kind, array);
  const auto items = items_of<fast::Distance>(results, queries.size());
  const Norm of_distance = separation_from(0.0, norm).norm;
  fast::distances(queries.kind, {}, t, of_distance, {}, 1);  // checks the time
  return in_blocks(queries.size(), search_block, threads, progress,
                   [&](std::size_t first, std::size_t count) {
                     for (std::size_t i = first; i < first + count; ++i) require_valid(queries, i);
                     fast::distances(queries.kind, queries.part(first, count).straight(), t,
                                     of_distance, items.subspan(first, count), 1);
                   });
}

py::dict distance_layout() {
  return Layout(sizeof(fast::Distance))
      .add("lower", "f8", offsetof(fast::Distance, lower))
      .add("upper", "f8", offsetof(fast::Distance, upper))
      .dict();
}

std::string instruction_set() {
  return std::string(to_string(fast::certified_kernels().back()->instructions));
}

}  // namespace

PYBIND11_MODULE(_fast, m) {
  using py::arg;
  m.def("certified", certified, arg("kind"), arg("queries").noconvert(), arg("results").noconvert(),
        arg("separation"), arg("norm"), arg("toi_tolerance"), arg("t_max"), arg("threads"),
        arg("progress"));
  m.def("inversions", inversions, arg("kind"), arg("cells").noconvert(), arg("results").noconvert(),
        arg("toi_tolerance"), arg("t_max"), arg("threads"), arg("progress"));
  m.def("tight_inclusion", tight_inclusion, arg("kind"), arg("queries").noconvert(),
        arg("results").noconvert(), arg("separation"), arg("norm"), arg("tolerance"),
        arg("max_checks"), arg("t_max"), arg("threads"), arg("progress"));
  m.def("distance", distance, arg("kind"), arg("queries").noconvert(), arg("results").noconvert(),
        arg("t"), arg("norm"), arg("threads"), arg("progress"));
  m.def("certified_layout", certified_layout);
  m.def("inversion_layout", inversion_layout);
  m.def("tight_inclusion_layout", tight_inclusion_layout);
  m.def("distance_layout", distance_layout);
  m.def("instruction_set", instruction_set);
  define_step(m);
}

}  // namespace touchstone::python
