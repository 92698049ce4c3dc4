/// \file
/// touchstone._fast: the certified solver, Tight-Inclusion and distances of batches, and steps.
/// Needs touchstone::fast alone. The package `touchstone` says what the functions mean; arrays are
/// as arguments.hpp says, and each function returns the number of queries that it has done.

#include <pybind11/pybind11.h>

#include <array>
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
#include "touchstone/tight_inclusion.hpp"

namespace touchstone::python {
namespace {

/// Queries a block: some hundred microseconds as a rule, and below a second for the slowest
/// queries.
constexpr std::size_t certified_block = 2048;
constexpr std::size_t search_block = 4;

std::size_t certified(const std::string& kind_name, const Doubles& array, py::array results,
                      double separation, const std::string& norm, double toi_tolerance,
                      double t_max, int threads, const py::object& progress) {
  const Queries queries = queries_of(kind_from(kind_name), array);
  const auto items = items_of<fast::CertifiedResult>(results, queries.size());
  const fast::CertifiedOptions options{.toi_tolerance = toi_tolerance,
                                       .t_max = t_max,
                                       .separation = separation_from(separation, norm),
                                       .max_threads = 1};
  fast::solve(queries.part(0, 0), {}, options);  // checks the options of no query too
  return in_blocks(queries.size(), certified_block, threads, progress,
                   [&](std::size_t first, std::size_t count) {
                     const auto part = items.subspan(first, count);
                     fast::solve(queries.part(first, count), part, options);
                     for (std::size_t i = 0; i < count; ++i) {
                       if (part[i].verdict == fast::Verdict::error) {
                         require_valid(queries, first + i);
                       }
                     }
                   });
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

/// The part of fast::TightInclusionResult that its users look at.
struct TightInclusionItem {
  bool collides;
  double toi;
  double tolerance;
  std::int64_t checks;
};

std::size_t tight_inclusion(const std::string& kind_name, const Doubles& array, py::array results,
                            double separation, const std::string& norm, double tolerance,
                            std::int64_t max_checks, double t_max, int threads,
                            const py::object& progress) {
  const Queries queries = queries_of(kind_from(kind_name), array);
  const auto items = items_of<TightInclusionItem>(results, queries.size());
  const fast::TightInclusionOptions options{.tolerance = tolerance,
                                            .max_checks = max_checks,
                                            .separation = separation_from(separation, norm),
                                            .t_max = t_max};
  fast::tight_inclusion(queries.part(0, 0), {}, options);  // checks them
  return in_blocks(
      queries.size(), search_block, threads, progress, [&](std::size_t first, std::size_t count) {
        std::array<fast::TightInclusionResult, search_block> found;
        fast::tight_inclusion(queries.part(first, count), std::span(found).first(count), options);
        for (std::size_t i = 0; i < count; ++i) {
          const fast::TightInclusionResult& result = found[i];
          if (result.verdict == fast::Verdict::error) {
            require_valid(queries, first + i);
          }
          items[first + i] = {.collides = result.verdict == fast::Verdict::yes,
                              .toi = result.toi,
                              .tolerance = result.tolerance,
                              .checks = result.checks};
        }
      });
}

py::dict tight_inclusion_layout() {
  using Item = TightInclusionItem;
  return Layout(sizeof(Item))
      .add("collides", "?", offsetof(Item, collides))
      .add("toi", "f8", offsetof(Item, toi))
      .add("tolerance", "f8", offsetof(Item, tolerance))
      .add("checks", "i8", offsetof(Item, checks))
      .dict();
}

std::size_t distance(const std::string& kind_name, const Doubles& array, py::array results,
                     double t, const std::string& norm, int threads, const py::object& progress) {
  const Kind kind = kind_from(kind_name);
  const Queries queries = queries_of(kind, array);
  const auto items = items_of<fast::Distance>(results, queries.size());
  const Norm of_distance = separation_from(0.0, norm).norm;
  fast::distances(kind, {}, t, of_distance, {}, 1);  // checks the time
  return in_blocks(queries.size(), search_block, threads, progress,
                   [&](std::size_t first, std::size_t count) {
                     for (std::size_t i = first; i < first + count; ++i) require_valid(queries, i);
                     fast::distances(kind, queries.part(first, count).straight(), t, of_distance,
                                     items.subspan(first, count), 1);
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
  m.def("tight_inclusion", tight_inclusion, arg("kind"), arg("queries").noconvert(),
        arg("results").noconvert(), arg("separation"), arg("norm"), arg("tolerance"),
        arg("max_checks"), arg("t_max"), arg("threads"), arg("progress"));
  m.def("distance", distance, arg("kind"), arg("queries").noconvert(), arg("results").noconvert(),
        arg("t"), arg("norm"), arg("threads"), arg("progress"));
  m.def("certified_layout", certified_layout);
  m.def("tight_inclusion_layout", tight_inclusion_layout);
  m.def("distance_layout", distance_layout);
  m.def("instruction_set", instruction_set);
  define_step(m);
}

}  // namespace touchstone::python
