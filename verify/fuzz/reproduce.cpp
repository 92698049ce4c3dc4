#include "verify/fuzz/reproduce.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "verify/data/csv_dataset.hpp"
#include "verify/fuzz/recheck.hpp"
#include "verify/generate/random.hpp"
#include "verify/io/printable.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::verify::fuzz {
namespace {

/// As C++ reads it too.
std::string hexadecimal(double x) { return fmt::format("{:a}", x); }

/// As an identifier: what is not a letter or a digit becomes an underscore, several become one.
std::string identifier(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const bool is_word = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (is_word) {
      result += c;
    } else if (!result.empty() && result.back() != '_') {
      result += '_';
    }
  }
  return result;
}

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

std::string coordinates_as_code(Kind kind, const Query& query) {
  std::string result;
  for (std::size_t end = 0; end < 2; ++end) {
    for (std::size_t point = 0; point < moving_points; ++point) {
      result +=
          fmt::format("      {}, {}, {},  // {} at t={}: ({}, {}, {})\n",
                      hexadecimal(query.at(end, point, 0)), hexadecimal(query.at(end, point, 1)),
                      hexadecimal(query.at(end, point, 2)), point_name(kind, point), end,
                      query.at(end, point, 0), query.at(end, point, 1), query.at(end, point, 2));
    }
  }
  return result;
}

std::string_view enumerator(Kind kind) {
  return kind == Kind::vertex_face ? "Kind::vertex_face" : "Kind::edge_edge";
}

std::string options_as_code(const fast::MethodOptions& options) {
  return fmt::format(
      "      .tolerance = {},  // {}\n      .max_checks = {},\n"
      "      .separation = {{.distance = {},  // {}\n                     .norm = Norm::{}}},\n    "
      "  .t_max = {},  // {}\n",
      hexadecimal(options.tolerance), options.tolerance, options.max_checks,
      hexadecimal(options.separation.distance), options.separation.distance,
      to_string(options.separation.norm), hexadecimal(options.t_max), options.t_max);
}

/// The call in the test.
std::string call_as_code(const SolverCall& solver) {
  if (solver.plugin.empty()) {
    return fmt::format("expect_no_fault(verify::solvers::find_method({}));",
                       io::cpp_literal(solver.method));
  }
  return fmt::format("expect_no_fault(*verify::solvers::load_plugin({}));",
                     io::cpp_literal(solver.plugin.string()));
}

/// Of a yes, numbers that it must have: those without which it was found to be wrong.
std::string numbers_as_code(const Reproduction& found) {
  const fast::Answer& answer = found.failing.answer;
  std::string result;
  if (found.missing.lower || std::isinf(answer.toi_lower)) {
    result += "  EXPECT_TRUE(std::isfinite(answer.toi_lower));\n";
  }
  if (found.missing.upper || std::isinf(answer.toi_upper)) {
    result += "  EXPECT_TRUE(std::isfinite(answer.toi_upper));\n";
  }
  if (answer.tolerance < 0.0) result += "  EXPECT_FALSE(answer.tolerance < 0.0);\n";
  return result;
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
  return solver.promise == fast::Promise::exact ? words + " --exact" : words;
}

constexpr std::string_view includes =
    "// Written by touchstone.\n// clang-format off\n#include <gtest/gtest.h>\n"
    R"(
#include <cmath>

#include "exact/oracle.hpp"
#include "exact/query.hpp"
#include "fast/method.hpp"
#include "verify/judge/claimed_distance.hpp"
#include "verify/judge/ground_truth.hpp"
#include "verify/judge/judgement.hpp"
#include "verify/solvers/plugin.hpp"
#include "verify/solvers/registry.hpp"
)";

constexpr std::string_view judging = R"(
/// Asks the method and holds its answer against the oracle, and against what the method is held to.
void expect_no_fault(const fast::Method& method) {
  fast::Answer answer;
  method.solve(kind, {&query, 1}, {&answer, 1}, options);
  const exact::Verdict truth = exact::decide(kind, query, separation);
  EXPECT_EQ(truth.collides(), collides);
  verify::judge::Judgement judgement;
  judgement.add(verify::judge::truth_of(0, truth), answer);
  if (answer.verdict == fast::Verdict::yes) {
    const Separation near =
        verify::judge::claimed_distance(method.info().filter, kind, query, answer, separation);
    EXPECT_TRUE(!is_valid(near) || exact::decide(kind, query, near).collides());
  }
  for (const verify::judge::WrongAnswer& wrong : judgement.wrong_answers) {
    EXPECT_FALSE(verify::judge::breaks(wrong.fault, promise))
        << verify::judge::to_string(wrong.fault) << ": " << wrong.answer << ", but " << wrong.truth;
  }
)";

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
    result.solver.promise = fast::Promise::exact;
  }
  return result;
}

std::string as_cpp_test(const Reproduction& found) {
  const std::string_view what = to_string(found.what);
  const std::string name =
      identifier(fmt::format("{}_{}_{}", found.solver.method, what, fingerprint(found)));
  std::string result(includes);
  const std::string space = fmt::format("touchstone::reproduction_{}", fingerprint(found));
  result += fmt::format("\nnamespace {} {{\n\n", space);
  result += fmt::format("// {}: {}. The primitives {}.\n", io::printable(found.solver.method), what,
                        found.failing.collides ? "collide" : "do not collide");
  if (found.what == judge::Fault::hang) result += "// Run it with a limit of time.\n";
  result += fmt::format("constexpr Kind kind = {};\n", enumerator(found.kind));
  result += fmt::format("constexpr fast::MethodOptions options{{\n{}}};\n",
                        options_as_code(found.solver.options));
  result += "constexpr Separation separation = options.separation;\n";
  result += fmt::format("constexpr fast::Promise promise = fast::Promise::{};\n",
                        solvers::to_string(found.solver.promise));
  result += fmt::format("constexpr bool collides = {};\n", found.failing.collides);
  result += fmt::format("constexpr Query query{{{{\n{}}}}};\n",
                        coordinates_as_code(found.kind, found.failing.query));
  result += judging;
  result += numbers_as_code(found);
  result +=
      fmt::format("}}\n\nTEST(Reproduction, {}) {{\n  {}\n}}\n", name, call_as_code(found.solver));
  result += fmt::format("\n}}  // namespace {}\n", space);
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
