#include "verify/fuzz/standalone.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include "verify/io/printable.hpp"

namespace touchstone::verify::fuzz {
namespace {

constexpr std::array<std::string_view, 3> interface_names{"plugin", "ticcd", "ipc-toolkit"};

/// What the program knows the answer by.
struct Names {
  std::string_view is_yes;
  std::string_view is_no;
  std::string_view lower;
};

/// Is the answer wrong as it was found to be? An expression.
std::string wrong_as_found(const Reproduction& found, const Names& names) {
  const FailingCase& failing = found.failing;
  switch (found.what) {
    case judge::Fault::false_negative:
      return std::string(names.is_no);
    case judge::Fault::false_positive:
    case judge::Fault::beyond_tolerance:
      return std::string(names.is_yes);
    case judge::Fault::asymmetry:
      return std::string(failing.collides ? names.is_no : names.is_yes);
    case judge::Fault::late_toi:
      return fmt::format("{} && {}{} > {}", names.is_yes, names.lower,
                         found.solver.terms.times == fast::Times::estimates
                             ? fmt::format(" - {}", found.solver.terms.time_error)
                             : "",
                         failing.toi->lower);
    default:
      return {};
  }
}

/// Those that only a plugin's answer has.
std::string wrong_as_found_of_plugin(const Reproduction& found) {
  static constexpr Names names{
      .is_yes = "answer.verdict == 1", .is_no = "answer.verdict == 0", .lower = "answer.toi_lower"};
  switch (found.what) {
    case judge::Fault::early_toi_upper:
      return found.solver.terms.times == fast::Times::estimates
                 ? fmt::format("{} && answer.toi_lower + {} < {}", names.is_yes,
                               found.solver.terms.time_error, found.failing.toi->upper)
                 : fmt::format("{} && answer.toi_upper < {}", names.is_yes,
                               found.failing.toi->upper);
    case judge::Fault::no_verdict:
      return "answer.verdict == 3";
    case judge::Fault::undecided:
      return "answer.verdict == 2";
    case judge::Fault::not_finite:
      return "!(std::isfinite(answer.toi_lower) && std::isfinite(answer.toi_upper))";
    default:
      return wrong_as_found(found, names);
  }
}

std::string points(const Reproduction& found) {
  const AnyQuery& query = found.failing.query;
  const QueryShape& shape = query.shape();
  const std::size_t count = (shape.degree + 1) * moving_points, size = shape.numbers_of_point();
  std::string result =
      fmt::format("  const double x[{}][{}] = {{  // {}\n", count, size,
                  shape.is_straight() ? "at t=0, then at t=1"
                  : shape.is_rational ? "control points and weights, from t=0 to t=1"
                                      : "control points, from t=0 to t=1");
  for (std::size_t i = 0; i < count; ++i) {
    result += fmt::format("      {{{}}},  // {}\n",
                          fmt::join(query.numbers().subspan(i * size, size), ", "),
                          point_name(shape.kind, i % moving_points));
  }
  return result + "  };\n";
}

std::string last_line(const std::string& condition) {
  return condition.empty() ? "  return 0;\n}\n"
                           : fmt::format("  return {} ? 1 : 0;\n}}\n", condition);
}

std::string plugin_main(const Reproduction& found) {
  const fast::MethodOptions& options = found.solver.options;
  std::string result =
      "// c++ -std=c++17 FILE.cpp -ldl && ./a.out ./libsolver.so\n"
      "#include <dlfcn.h>\n\n#include <cmath>\n#include <cstdint>\n#include <cstdio>\n\n"
      "struct Options {\n  double tolerance;\n  std::int64_t max_checks;\n"
      "  double min_separation, t_max;\n  std::int32_t norm;\n};\n"
      "struct Answer {\n  std::int32_t verdict;  // 0 no, 1 yes, 2 undecided, 3 error\n"
      "  double toi_lower, toi_upper, tolerance;\n};\n\nint main(int, char** argv) {\n";
  result += points(found);
  const QueryShape& shape = found.failing.query.shape();
  const bool is_straight = shape.is_straight();
  const std::string_view of_curves = "touchstone_plugin_solve_curved";
  result += fmt::format(
      "  void* const library = argv[1] ? dlopen(argv[1], RTLD_NOW) : nullptr;\n"
      "  void* const solve = library ? dlsym(library, \"{}\") : nullptr;\n",
      is_straight ? "touchstone_plugin_solve" : of_curves);
  // A plugin for curves alone is asked about lines as curves of degree 1.
  const fast::Terms& terms = found.solver.terms;
  const bool is_curve_at_last = is_straight && terms.least_degree <= terms.most_degree;
  if (is_curve_at_last) {
    result += fmt::format(
        "  void* const solve_curved = library ? dlsym(library, \"{}\") : nullptr;\n", of_curves);
  }
  result += fmt::format("  if (solve == nullptr{}) return 2;\n",
                        is_curve_at_last ? " && solve_curved == nullptr" : "");
  result += fmt::format("  const Options options{{{}, {}, {}, {}, {}}};\n", options.tolerance,
                        options.max_checks, options.separation.distance, options.t_max,
                        static_cast<int>(options.separation.norm));
  result += "  Answer answer{3, NAN, NAN, NAN};\n";
  const auto kind = static_cast<int>(shape.kind);
  if (is_straight) {
    result += fmt::format(
        "  using Solve = void(std::int32_t, const double*, const Options*, Answer*);\n"
        "  {}reinterpret_cast<Solve*>(solve)({}, x[0], &options, &answer);  // {}\n",
        is_curve_at_last ? "if (solve != nullptr) " : "", kind, to_string(shape.kind));
  }
  if (!is_straight || is_curve_at_last) {
    result += fmt::format(
        "  using SolveCurved = void(std::int32_t, std::int32_t, std::int32_t, const double*,\n"
        "                           const Options*, Answer*);\n"
        "  {}reinterpret_cast<SolveCurved*>({})({}, {}, {}, x[0], &options, &answer);  // {}\n",
        is_curve_at_last ? "if (solve == nullptr) " : "",
        is_curve_at_last ? "solve_curved" : "solve", kind, shape.degree, shape.is_rational ? 1 : 0,
        to_text(shape));
  }
  result += fmt::format(
      "  std::printf(\"verdict %d, toi_lower %.17g, toi_upper %.17g; truth: {}\\n\", "
      "answer.verdict,\n              answer.toi_lower, answer.toi_upper);\n",
      found.failing.truth);
  return result + last_line(wrong_as_found_of_plugin(found));
}

constexpr Names of_public_code{.is_yes = "collides", .is_no = "!collides", .lower = "toi"};

std::string printing(const Reproduction& found) {
  return fmt::format(
             "  std::printf(\"%s, toi %.17g; truth: {}\\n\", collides ? \"yes\" : \"no\", toi);\n",
             found.failing.truth) +
         last_line(wrong_as_found(found, of_public_code));
}

constexpr std::string_view all_points = "p(0), p(1), p(2), p(3), p(4), p(5), p(6), p(7)";

std::string ticcd_main(const Reproduction& found) {
  const fast::MethodOptions& options = found.solver.options;
  std::string result =
      "// Against github.com/Continuous-Collision-Detection/Tight-Inclusion.\n"
      "#include <tight_inclusion/ccd.hpp>\n\n#include <cstdio>\n\nint main() {\n";
  result += points(found);
  result +=
      "  const auto p = [&x](int i) { return ticcd::Vector3(x[i][0], x[i][1], x[i][2]); };\n"
      "  ticcd::Scalar toi = 0, tolerance = 0;\n";
  result += fmt::format(
      "  const bool collides = ticcd::{}({},\n"
      "                              ticcd::Array3(-1, -1, -1), {}, toi, {}, {}, {}, tolerance);\n",
      found.failing.query.kind() == Kind::vertex_face ? "vertexFaceCCD" : "edgeEdgeCCD", all_points,
      options.separation.distance, options.tolerance, options.t_max,
      options.max_checks > 0 ? options.max_checks : -1);
  return result + printing(found);
}

std::string ipc_toolkit_main(const Reproduction& found) {
  const fast::MethodOptions& options = found.solver.options;
  std::string result =
      "// Against github.com/ipc-sim/ipc-toolkit.\n"
      "#include <ipc/ccd/additive_ccd.hpp>\n\n#include <cstdio>\n\nint main() {\n";
  result += points(found);
  result +=
      "  const auto p = [&x](int i) { return Eigen::Vector3d(x[i][0], x[i][1], x[i][2]); };\n"
      "  double toi = 0;\n";
  result += fmt::format(
      "  const bool collides = ipc::AdditiveCCD({}).{}(\n      {}, toi, {}, {});\n",
      options.max_checks > 0 ? options.max_checks : -1,
      found.failing.query.kind() == Kind::vertex_face ? "point_triangle_ccd" : "edge_edge_ccd",
      all_points, options.separation.distance, options.t_max);
  return result + printing(found);
}

}  // namespace

std::string_view to_string(CallInterface interface) {
  return interface_names.at(static_cast<std::size_t>(interface));
}

std::optional<CallInterface> call_interface_from_string(std::string_view name) {
  const auto* const found = std::ranges::find(interface_names, name);
  if (found == interface_names.end()) return std::nullopt;
  return static_cast<CallInterface>(found - interface_names.begin());
}

CallInterface usual_interface(const SolverCall& solver) {
  if (!solver.plugin.empty()) return CallInterface::plugin;
  if (solver.method.starts_with("tight_inclusion")) return CallInterface::ticcd;
  return solver.method == "accd" ? CallInterface::ipc_toolkit : CallInterface::plugin;
}

std::string as_main(const Reproduction& found, CallInterface interface) {
  if (!found.failing.query.shape().is_straight()) return plugin_main(found);
  switch (interface) {
    case CallInterface::ticcd:
      return ticcd_main(found);
    case CallInterface::ipc_toolkit:
      return ipc_toolkit_main(found);
    default:
      return plugin_main(found);
  }
}

}  // namespace touchstone::verify::fuzz
