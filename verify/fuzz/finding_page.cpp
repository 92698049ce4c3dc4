#include "verify/fuzz/finding_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <span>

#include "verify/fuzz/finding.hpp"
#include "verify/io/json.hpp"
#include "verify/io/output_file.hpp"
#include "verify/io/printable.hpp"
#include "verify/judge/fault.hpp"
#include "verify/judge/separation_inference.hpp"
#include "verify/solvers/plugin_method.hpp"

namespace touchstone::verify::fuzz {
namespace {

namespace fs = std::filesystem;
using base::AnyQuery;
using Json = nlohmann::json;

// ---- Templates: a value replaces each @NAME@ ----------------------------------------------------

constexpr std::string_view program_template = R"(@includes@
#include <cmath>
#include <cstdint>
#include <cstdio>

struct Answer {
  std::int32_t verdict;  // 0 no, 1 yes, 2 undecided, 3 error
  double toi_lower, toi_upper, tolerance;
};

int main(@parameters@) {
  const double x[@rows@][@columns@] = {  // @shape@: @places@
@points@
  };
  Answer answer{3, NAN, NAN, NAN};
@call@  std::printf("verdict %d, toi_lower %.17g, toi_upper %.17g\n", static_cast<int>(answer.verdict),
              answer.toi_lower, answer.toi_upper);
  std::puts("truth: @truth@");
  const bool is_wrong = @wrong@;
  return is_wrong ? 1 : 0;
}
)";

/// The parts of a program that differ by the interface that it calls.
struct Interface {
  std::string_view name;
  std::string_view method;  ///< the beginning of the names of methods with this public code
  std::string_view includes;
  std::string_view parameters;
  std::array<std::string_view, 2> functions;  ///< for each kind
  std::string_view call;
};

constexpr std::array<Interface, 3> interfaces{{
    {"plugin",
     {},
     R"(// c++ -std=c++17 FILE.cpp -ldl && ./a.out ./libsolver.so
#include <dlfcn.h>
)",
     "int argc, char** argv",
     {},
     R"(  struct Options {
    double tolerance;
    std::int64_t max_checks;
    double min_separation, t_max;
    std::int32_t norm;
  };
  const Options options{@tolerance@, @max_checks@, @min_separation@, @t_max@, @norm@};
  const std::int32_t kind = @kind@, degree = @degree@, is_rational = @is_rational@;
  void* const library = argc > 1 ? dlopen(argv[1], RTLD_NOW) : nullptr;
  const auto find = [&](const char* name) { return library ? dlsym(library, name) : nullptr; };
  void* const solve = find("touchstone_plugin_solve");
  void* const solve_curved = find("touchstone_plugin_solve_curved");
  if (solve != nullptr && degree == 1 && is_rational == 0) {
    using Solve = void(std::int32_t, const double*, const Options*, Answer*);
    reinterpret_cast<Solve*>(solve)(kind, x[0], &options, &answer);
  } else if (solve_curved != nullptr) {
    using Solve = void(std::int32_t, std::int32_t, std::int32_t, const double*, const Options*,
                       Answer*);
    reinterpret_cast<Solve*>(solve_curved)(kind, degree, is_rational, x[0], &options, &answer);
  } else {
    return 2;
  }
)"},
    {"ticcd",
     "tight_inclusion",
     "// Against github.com/Continuous-Collision-Detection/Tight-Inclusion.\n"
     "#include <tight_inclusion/ccd.hpp>\n",
     "",
     {"vertexFaceCCD", "edgeEdgeCCD"},
     R"(  const auto p = [&x](int i) { return ticcd::Vector3(x[i][0], x[i][1], x[i][2]); };
  ticcd::Scalar toi = 0, tolerance = 0;
  const bool collides = ticcd::@function@(p(0), p(1), p(2), p(3), p(4), p(5), p(6), p(7),
                              ticcd::Array3(-1, -1, -1), @min_separation@, toi, @tolerance@, @t_max@,
                              @max_iterations@, tolerance);
  answer = {collides ? 1 : 0, toi, NAN, tolerance};
)"},
    {"ipc-toolkit",
     "accd",
     "// Against github.com/ipc-sim/ipc-toolkit.\n"
     "#include <ipc/ccd/additive_ccd.hpp>\n",
     "",
     {"point_triangle_ccd", "edge_edge_ccd"},
     R"(  const auto p = [&x](int i) { return Eigen::Vector3d(x[i][0], x[i][1], x[i][2]); };
  double toi = 0;
  const bool collides = ipc::AdditiveCCD(@max_iterations@).@function@(
      p(0), p(1), p(2), p(3), p(4), p(5), p(6), p(7), toi, @min_separation@, @t_max@);
  answer = {collides ? 1 : 0, toi, NAN, NAN};
)"},
}};

constexpr std::string_view page_template = R"(# @method@ @phrase@

| | |
|---|---|
| answer | @detail@ |
| truth | @truth@ |
| query | @shape@, from t=0 to t=1 |
| asked with | tolerance @tolerance@, at most @max_checks@ checks, minimum separation @separation@ |
| times powers of two | @scales@ |
| findings of this sort | @count@ |

## The points

The same doubles twice, in decimal and in hexadecimal: @places@.

```
@decimal@
@hexadecimal@```

## See it

`@name@.cpp` needs nothing but the solver. It ends with 1 if the answer is wrong as above, and with 0 if it is not.

```cpp
@program@```

## Check the truth

@proof@
## Ask again

```sh
@command@```
)";

constexpr std::string_view proof_template =
    R"(This certificate (`@name@.cert`) proves the truth in integer arithmetic. `touchstone-check @name@.cert` checks it; that program is a few hundred lines, needs only GMP, and shares no code with the one that wrote the certificate.

```
@certificate@```
)";

using Values = std::map<std::string_view, std::string>;

/// The template with its values, which may contain @ themselves.
std::string filled(std::string_view text, const Values& values) {
  std::string result;
  for (std::size_t begin = text.find('@'); begin != std::string_view::npos;
       begin = text.find('@')) {
    const std::size_t end = text.find('@', begin + 1);
    result.append(text.substr(0, begin)) += values.at(text.substr(begin + 1, end - begin - 1));
    text.remove_prefix(end + 1);
  }
  return result.append(text);
}

// ---- Values -------------------------------------------------------------------------------------

std::string text_of(const Json& finding, const char* key) {
  return finding.at(key).get<std::string>();
}

AnyQuery query_of(const Json& finding) {
  const QueryShape shape{.kind = kind_from_string(text_of(finding, "kind")),
                         .degree = finding.at("degree").get<std::size_t>(),
                         .is_rational = finding.at("rational").get<bool>()};
  return {shape, finding.at("numbers").get<std::vector<double>>()};
}

std::string_view places(const QueryShape& shape) {
  if (shape.is_straight()) return "at t=0, then at t=1";
  return shape.is_rational ? "control points and weights, from t=0 to t=1"
                           : "control points, from t=0 to t=1";
}

/// A C++ expression that is true if the answer has the fault that was found.
std::string wrong_as_found(const Json& finding) {
  using enum judge::Fault;
  const Json& toi = finding.at("toi");
  const Json& error = finding.at("solver").at("time_error");
  const auto bound = [&](const char* of_toi) {
    return fmt::format("{}", toi.at(of_toi).get<double>());
  };
  const bool collides = finding.at("collides").get<bool>();
  std::string yes = "answer.verdict == 1", no = "answer.verdict == 0";
  switch (judge::fault_from_name(text_of(finding, "what")).value()) {
    case false_negative:
      return no;
    case false_positive:
    case beyond_tolerance:
      return yes;
    case asymmetry:  // Its simplest query may be answered wrongly in any way.
      if (text_of(finding.at("answer"), "verdict") != (collides ? "yes" : "no")) {
        return collides ? no : yes;
      }
      [[fallthrough]];
    case late_toi:
      return yes + " && answer.toi_lower" + (error.is_null() ? "" : " - " + error.dump()) + " > " +
             bound("lower");
    case early_toi_upper:
      return yes + " && answer.toi_" + (error.is_null() ? "upper" : "lower + " + error.dump()) +
             " < " + bound("upper");
    case no_verdict:
      return "answer.verdict == 3";
    case undecided:
      return "answer.verdict == 2";
    case not_finite:
      return "!std::isfinite(answer.toi_lower + answer.toi_upper) || answer.tolerance < 0";
    default:
      return "false";  // The call has returned.
  }
}

/// A line of code for each point.
std::string rows(const AnyQuery& query) {
  const std::size_t size = query.shape().numbers_of_point();
  std::vector<std::string> lines;
  for (std::size_t i = 0; i * size < query.numbers().size(); ++i) {
    lines.push_back(fmt::format("      {{{}}},  // {}",
                                fmt::join(query.numbers().subspan(i * size, size), ", "),
                                point_name(query.kind(), i % moving_points)));
  }
  return fmt::format("{}", fmt::join(lines, "\n"));
}

/// The values of a finding in pages and programs.
Values values_of(const Json& finding) {
  const AnyQuery query = query_of(finding);
  const QueryShape& shape = query.shape();
  const Json& solver = finding.at("solver");
  const auto checks = solver.at("max_checks").get<std::int64_t>();
  const Norm norm = norm_from_string(text_of(solver, "norm"));
  const auto number = [&](const char* key) {
    return fmt::format("{}", solver.at(key).get<double>());
  };
  return {{"truth", text_of(finding, "truth")},
          {"shape", to_text(shape)},
          {"places", std::string(places(shape))},
          {"tolerance", number("tolerance")},
          {"min_separation", number("min_separation")},
          {"t_max", number("t_max")},
          {"max_checks", std::to_string(checks)},
          {"max_iterations", std::to_string(checks > 0 ? checks : -1)},
          {"norm", std::to_string(static_cast<int>(norm))},
          {"kind", std::to_string(solvers::plugin_kind(shape.kind))},
          {"degree", std::to_string(shape.degree)},
          {"is_rational", std::to_string(shape.is_rational ? 1 : 0)},
          {"rows", std::to_string((shape.degree + 1) * moving_points)},
          {"columns", std::to_string(shape.numbers_of_point())},
          {"points", rows(query)},
          {"wrong", wrong_as_found(finding)}};
}

const Interface& interface_of(const Json& finding, std::string_view calls) {
  const Json& solver = finding.at("solver");
  const std::string method = text_of(solver, "method");
  const auto* const found = std::ranges::find_if(interfaces, [&](const Interface& interface) {
    if (!calls.empty()) return interface.name == calls;
    return solver.at("plugin").is_null() && !interface.method.empty() &&
           method.starts_with(interface.method);
  });
  const QueryShape shape = query_of(finding).shape();
  const bool is_usual = shape.is_straight() && !is_element(shape.kind);
  return found == interfaces.end() || !is_usual ? interfaces.front() : *found;
}

/// Texts from outside, such as the message of an exception, in a cell of a table.
std::string cell(const std::string& text) {
  std::string result = io::printable(text);
  std::ranges::replace(result, '|', '/');
  return result;
}

std::string as_page(const Json& finding, const Json& group, const std::string& name,
                    const std::string& program) {
  const AnyQuery query = query_of(finding);
  const Json& solver = finding.at("solver");
  const Separation separation{.distance = solver.at("min_separation").get<double>(),
                              .norm = norm_from_string(text_of(solver, "norm"))};
  const auto what = judge::fault_from_name(text_of(finding, "what")).value();
  const bool is_proved = !finding.at("certificate").is_null();
  Values values = values_of(finding);
  values.merge(Values{{"name", name},
                      {"program", program},
                      {"method", io::printable(text_of(finding, "method"))},
                      {"phrase", std::string(judge::to_phrase(what))},
                      {"detail", cell(text_of(finding, "detail"))},
                      {"separation", is_zero(separation) ? "0" : judge::to_text(separation)},
                      {"scales", text_of(finding, "scales")},
                      {"count", group.at("count").dump()},
                      {"decimal", as_points(query)},
                      {"hexadecimal", as_points(query, true)},
                      {"certificate", is_proved ? text_of(finding, "certificate") : ""},
                      {"command", text_of(finding, "command")}});
  values["proof"] = is_proved ? filled(proof_template, values)
                              : "The proof is beyond the limits of certificates.\n";
  return filled(page_template, values);
}

void write_file(const fs::path& path, std::string_view text) {
  io::OutputFile file(path);
  file.write(text);
  file.close();
}

}  // namespace

std::string as_program(const Json& finding, std::string_view calls) {
  const Interface& interface = interface_of(finding, calls);
  Values values = values_of(finding);
  values["includes"] = interface.includes;
  values["parameters"] = interface.parameters;
  values["function"] = interface.functions.at(values.at("kind") == "0" ? 0 : 1);
  values["call"] = filled(interface.call, values);
  return filled(program_template, values);
}

std::vector<fs::path> write_pages(const Json& report, std::string_view calls,
                                  const fs::path& folder) {
  fs::create_directories(folder);
  std::vector<fs::path> pages;
  for (const Json& group : report.at("groups")) {
    const Json& finding = report.at("findings").at(group.at("best").get<std::size_t>());
    const std::string name = fmt::format("{}-{}", pages.size() + 1, text_of(finding, "what"));
    const std::string program = as_program(finding, calls);
    pages.push_back(folder / (name + ".md"));
    write_file(pages.back(), as_page(finding, group, name, program));
    write_file(folder / (name + ".cpp"), program);
    if (finding.at("certificate").is_null()) continue;
    write_file(folder / (name + ".cert"), text_of(finding, "certificate"));
  }
  write_file(folder / "findings.json", io::json_document(report));
  return pages;
}

}  // namespace touchstone::verify::fuzz
