#include "verify/fuzz/reproduce.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

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
  auto hash = static_cast<std::uint64_t>(found.kind);
  const auto add = [&](std::uint64_t bits) {
    hash = generate::mix(hash + bits + 0x9e3779b97f4a7c15ULL);
  };
  for (const double x : found.failing.query.coordinates) add(std::bit_cast<std::uint64_t>(x));
  add(std::bit_cast<std::uint64_t>(found.solver.options.separation.distance));
  add(static_cast<std::uint64_t>(found.solver.options.separation.norm));
  return fmt::format("{:08x}", hash >> 32U);
}

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

std::string as_points(Kind kind, const Query& query) {
  std::string result;
  for (std::size_t end = 0; end < 2; ++end) {
    for (std::size_t point = 0; point < moving_points; ++point) {
      const double x = query.at(end, point, 0), y = query.at(end, point, 1);
      const double z = query.at(end, point, 2);
      result += fmt::format("{:<3} at t={}  ({}, {}, {}) = ({}, {}, {})\n", point_name(kind, point),
                            end, x, y, z, hexadecimal(x), hexadecimal(y), hexadecimal(z));
    }
  }
  return result;
}

std::string as_short_points(Kind kind, const Query& query) {
  std::string result;
  for (std::size_t point = 0; point < moving_points; ++point) {
    const auto place = [&](std::size_t end) {
      return fmt::format("({}, {}, {})", query.at(end, point, 0), query.at(end, point, 1),
                         query.at(end, point, 2));
    };
    result += fmt::format("{:<3}  {} → {}\n", point_name(kind, point), place(0), place(1));
  }
  return result;
}

std::string as_csv(const Query& query, std::optional<bool> collides) {
  return data::csv_rows(query, collides);
}

Reproduction reproduction_of(const Finding& finding, const SolverCall& asked) {
  Reproduction result{.what = finding.what,
                      .kind = finding.kind,
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
  const std::string file = fmt::format("{}-{}.csv", fingerprint(found), to_string(found.kind));
  // Without more, a label is about contact itself.
  std::optional<bool> label;
  if (found.solver.options.separation.distance == 0.0) label = found.failing.collides;
  return fmt::format("cat > {0} <<'END'\n{1}END\ntouchstone certify {0} {2}\n", file,
                     as_csv(found.failing.query, label), options_as_words(found.solver));
}

}  // namespace touchstone::verify::fuzz
