#include "verify/fuzz/reproduce.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "verify/data/csv_dataset.hpp"
#include "verify/generate/random.hpp"
#include "verify/io/printable.hpp"
#include "verify/judge/terms.hpp"

namespace touchstone::verify::fuzz {
namespace {

/// As C++ reads it too.
std::string hexadecimal(double x) { return fmt::format("{:a}", x); }

/// Tells apart the reproductions of one method.
std::string fingerprint(const Reproduction& found) {
  const QueryShape& shape = found.failing.query.shape();
  auto hash = static_cast<std::uint64_t>(shape.kind);
  const auto add = [&](std::uint64_t bits) {
    hash = generate::mix(hash + bits + 0x9e3779b97f4a7c15ULL);
  };
  if (!shape.is_straight()) add(2 * shape.degree + (shape.is_rational ? 1 : 0));
  for (const double x : found.failing.query.numbers()) add(std::bit_cast<std::uint64_t>(x));
  add(std::bit_cast<std::uint64_t>(found.solver.options.separation.distance));
  add(static_cast<std::uint64_t>(found.solver.options.separation.norm));
  return fmt::format("{:08x}", hash >> 32U);
}

/// "(0, 0.5, 1)", and a weight: "(0, 0.5, 1; 2)".
template <class Text>
std::string tuple(std::span<const double> point, const Text& text) {
  std::string result = "(" + text(point[0]) + ", " + text(point[1]) + ", " + text(point[2]);
  return result + (point.size() > 3 ? "; " + text(point[3]) : "") + ")";
}

std::string decimal(double x) { return fmt::format("{}", x); }

double gibibytes(const solvers::ChildLimits& limits) {
  constexpr int bits = 30;
  return std::ldexp(static_cast<double>(limits.memory_bytes), -bits);
}

/// The options of the command line that ask for what the solver was asked for.
std::string options_as_words(const SolverCall& solver) {
  const fast::MethodOptions& options = solver.options;
  std::string words = solver.plugin.empty()
                          ? fmt::format("--method {}", solver.method)
                          : fmt::format("--plugin {}", io::shell_word(solver.plugin.string()));
  words += fmt::format(" --tolerance {} --max-checks {} --min-separation {} --norm {}",
                       options.tolerance, std::max<std::int64_t>(options.max_checks, 0),
                       options.separation.distance, to_string(options.separation.norm));
  words += fmt::format(" --query-limit {}", solver.query_limit_seconds);
  if (solver.limits.memory_bytes != solvers::ChildLimits{}.memory_bytes) {
    words += fmt::format(" --memory-limit {}", gibibytes(solver.limits));
  }
  if (solver.limits.may_fork) words += " --allow-processes";
  if (!solver.plugin.empty()) words += judge::as_options(solver.terms);
  return solver.promise == fast::Promise::exact ? words + " --exact" : words;
}

}  // namespace

std::string_view point_name(Kind kind, std::size_t point) {
  static constexpr std::array<std::string_view, moving_points> of_face{"v", "f0", "f1", "f2"};
  static constexpr std::array<std::string_view, moving_points> of_edges{"ea0", "ea1", "eb0", "eb1"};
  return kind == Kind::vertex_face ? of_face.at(point) : of_edges.at(point);
}

std::string as_points(const AnyQuery& query) {
  const QueryShape& shape = query.shape();
  const std::size_t size = shape.numbers_of_point();
  const std::string_view place = shape.is_straight() ? "at t=" : "control point ";
  std::string result;
  for (std::size_t i = 0; i < (shape.degree + 1) * moving_points; ++i) {
    const auto point = query.numbers().subspan(i * size, size);
    result += fmt::format("{:<3} {}{}  {} = {}\n", point_name(shape.kind, i % moving_points), place,
                          i / moving_points, tuple(point, decimal), tuple(point, hexadecimal));
  }
  return result;
}

std::string as_short_points(const AnyQuery& query) {
  const QueryShape& shape = query.shape();
  const std::size_t size = shape.numbers_of_point();
  std::string result;
  for (std::size_t point = 0; point < moving_points; ++point) {
    std::string places;
    for (std::size_t j = 0; j <= shape.degree; ++j) {
      places += (j == 0 ? "" : " → ") +
                tuple(query.numbers().subspan((moving_points * j + point) * size, size), decimal);
    }
    result += fmt::format("{:<3}  {}\n", point_name(shape.kind, point), places);
  }
  return result;
}

Reproduction reproduction_of(const Finding& finding, const SolverCall& asked) {
  Reproduction result{.what = finding.what,
                      .failing = finding.simplest,
                      .missing = finding.missing,
                      .solver = asked};
  if (finding.method != asked.method) {
    result.solver.method = finding.method;
    result.solver.plugin.clear();
    result.solver.terms = {};
    result.solver.promise = fast::Promise::exact;
  }
  return result;
}

std::string as_command(const Reproduction& found) {
  const std::string file =
      fmt::format("{}-{}.csv", fingerprint(found), to_string(found.failing.query.kind()));
  // Without more, a label is about contact itself.
  std::optional<bool> label;
  if (found.solver.options.separation.distance == 0.0) label = found.failing.collides;
  return fmt::format("cat > {0} <<'END'\n{1}END\ntouchstone certify {0} {2}\n", file,
                     data::csv_rows(found.failing.query, label), options_as_words(found.solver));
}

}  // namespace touchstone::verify::fuzz
