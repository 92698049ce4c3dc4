/// \file
/// The rules of the project that a compiler does not check: which module may include which, that
/// a test includes every header, how a header begins, and that a folder of verify is a namespace.
/// Each rule is a function of a path and a text. The same function reads the source tree and finds
/// planted faults.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/support/built_files.hpp"

namespace touchstone::tests::architecture_test {
namespace {

/// Files by their path from the project root, with '/' between the parts, and without the folders
/// of public headers: fast/include/touchstone/step.hpp is fast/step.hpp.
using Tree = std::map<std::string, std::string, std::less<>>;
using Words = std::vector<std::string>;

// ---- The tables ---------------------------------------------------------------------------------

/// What a layer may include besides the standard library: lines "LAYER: TARGETS". Texts are
/// beginnings of paths if they end with '/', and whole paths if not. A path obeys the longest line
/// that fits it. Folders of verify include only those above them, so that there are no circles; a
/// new one needs a line of its own. REST is the line of that name.
constexpr std::string_view layer_lines = R"(
  exact/query.hpp: exact/cxx20.hpp Eigen/
  exact/curved_query.hpp: exact/query.hpp
  exact/cell.hpp: exact/curved_query.hpp exact/query.hpp
  exact/any_kind.hpp: exact/cell.hpp exact/query.hpp
  exact/: exact/ CGAL/ Eigen/ gmp.h gmpxx.h
// Certificates of scenes join the searches of fast, the proofs of the oracle, and what the checker
// says of arguments; nothing of these three includes them.
  exact/scene/: exact/ exact/checker/ exact/scene/ fast/ Eigen/
// The checker shares no code with anything that decides queries.
  exact/checker/: exact/checker/ gmp.h gmpxx.h
// filters/ is two targets: what simulators include, which needs nothing, and the derivation of the
// bounds, which runs Gappa by POSIX.
  filters/: filters/
  filters/derivation/: filters/ filters/derivation/ fmt/ gmp.h gmpxx.h signal.h spawn.h sys/ unistd.h
// Vectors, the processor's floating-point control, and large pages; oneTBB is optional.
  fast/: fast/ filters/ exact/any_kind.hpp exact/cell.hpp exact/curved_query.hpp exact/query.hpp Eigen/ arm_neon.h immintrin.h xmmintrin.h sys/mman.h
  fast/platform/: fast/platform/ filters/ arm_neon.h immintrin.h sys/mman.h xmmintrin.h
  fast/platform/threads.hpp: fast/platform/floating_point_state.hpp oneapi/tbb/
// Each folder of fast includes those above it, and the headers named with it.
  fast/broad_phase/: fast/broad_phase/ fast/platform/ fast/broad_phase.hpp fast/mesh.hpp filters/ arm_neon.h immintrin.h
  fast/tight_inclusion/: fast/tight_inclusion/ fast/platform/ filters/ exact/query.hpp immintrin.h
  fast/certified/exact/: fast/certified/exact/ exact/curved_query.hpp exact/query.hpp Eigen/
  fast/certified/fixed_point_vertices.hpp: fast/platform/ fast/mesh.hpp
  fast/certified/kernel.hpp: fast/certified/fixed_point_vertices.hpp fast/platform/ fast/mesh.hpp exact/cell.hpp exact/query.hpp
  fast/certified/stages/: fast/certified/stages/ fast/certified/fixed_point_vertices.hpp fast/certified/kernel.hpp filters/ exact/query.hpp
  fast/certified/curves/: fast/certified/curves/ fast/certified/stages/ fast/certified/kernel.hpp fast/platform/ filters/ exact/query.hpp
  fast/certified/: fast/cells/stages.hpp fast/certified/ fast/platform/ fast/certified.hpp fast/mesh.hpp filters/ exact/curved_query.hpp exact/query.hpp immintrin.h
  fast/cells/: fast/cells/ fast/certified/ fast/inversion.hpp
  fast/cells/stages.hpp: fast/certified/stages/
  fast/distance/: fast/distance/ fast/certified/exact/ fast/platform/ fast/contacts.hpp fast/kernels.hpp fast/step.hpp filters/ exact/query.hpp Eigen/ arm_neon.h immintrin.h
  fast/intersections/: fast/intersections/ fast/broad_phase/ fast/certified/exact/ fast/distance/ fast/platform/ fast/mesh.hpp fast/intersections.hpp filters/ immintrin.h
  fast/step/: fast/step/ fast/broad_phase/ fast/cells/ fast/certified/ fast/platform/ fast/broad_phase.hpp fast/candidates.hpp fast/contacts.hpp fast/kernels.hpp fast/mesh.hpp fast/step.hpp exact/cell.hpp
  adapters/: adapters/ fast/ exact/any_kind.hpp exact/query.hpp Eigen/
  adapters/ipc_toolkit.hpp: fast/ exact/query.hpp ipc/ccd/narrow_phase_ccd.hpp
  adapters/ipc_toolkit_step.hpp: adapters/ipc_toolkit.hpp fast/ exact/query.hpp ipc/collision_mesh.hpp
  adapters/tight_inclusion/logger.hpp: spdlog/
// The adapters as plugins of the tool.
  adapters/by_the_call/: adapters/ verify/plugin.h
// Who includes a header in C needs no other header of ours.
  adapters/touchstone.h: stddef.h stdint.h string.h
  verify/plugin.h: stdint.h
// The modules, packages, and POSIX.
  REST: exact/ exact/checker/ exact/scene/ filters/ fast/ verify/plugin.h Eigen/ fmt/ gmp.h gmpxx.h nlohmann/ oneapi/tbb/ zip.h zstd.h dlfcn.h fcntl.h poll.h sys/ time.h unistd.h
  verify/:
  verify/base/: verify/base/ REST
  verify/io/: verify/io/ REST
  verify/data/: verify/data/ verify/base/ verify/io/ REST
  verify/mesh/: verify/mesh/ verify/data/ verify/io/ REST
  verify/generate/: verify/generate/ verify/data/ verify/io/ verify/mesh/ REST
  verify/baselines/: verify/baselines/ fast/ filters/ exact/any_kind.hpp exact/cell.hpp exact/curved_query.hpp exact/query.hpp Eigen/
// Plugins: they use packages that simulators do not need, and the rounding mode.
  verify/published/: verify/published/ verify/baselines/ verify/generate/random_stream.hpp verify/plugin.h fast/ filters/ gmpxx.h exact/query.hpp Eigen/ xmmintrin.h
  verify/judge/: verify/judge/ verify/base/ verify/data/ verify/io/ REST
  verify/solvers/: verify/solvers/ verify/base/ verify/baselines/ verify/published/ verify/io/ verify/judge/ REST
// All that needs Linux.
  verify/solvers/child_process.cpp: verify/solvers/ verify/io/ fcntl.h linux/ poll.h sched.h sys/ unistd.h
  verify/jobs/: verify/jobs/ verify/base/ verify/data/ verify/io/ verify/judge/ verify/mesh/ verify/solvers/ REST
  verify/fuzz/: verify/fuzz/ verify/base/ verify/data/ verify/generate/ verify/io/ verify/judge/ verify/solvers/ REST
  verify/report/: verify/report/ verify/io/ verify/jobs/ verify/judge/ verify/mesh/ verify/solvers/ REST
  verify/view/: verify/view/ verify/base/ verify/data/ verify/io/ verify/jobs/ verify/judge/ verify/mesh/ verify/report/ verify/solvers/ REST
  verify/playground/: verify/base/ verify/judge/ verify/solvers/ verify/view/ fast/ nlohmann/ emscripten/emscripten.h
  verify/cli/: verify/cli/ verify/data/ verify/fuzz/ verify/generate/ verify/io/ verify/jobs/ verify/judge/ verify/mesh/ verify/report/ verify/solvers/ verify/view/ REST
// The parser takes longer to compile than most commands.
  verify/cli/option_table.cpp: verify/cli/ verify/data/ verify/generate/ verify/io/ verify/judge/ verify/report/ verify/solvers/ REST CLI/
)";

/// Parts of a module that only lines which name them include, not one for the whole module.
constexpr std::array<std::string_view, 3> closed_parts{"exact/checker/", "exact/scene/",
                                                       "filters/derivation/"};

/// Headers under an extension that this project does not use: plugins and callers may be written in
/// C, and one header has another library's name. Lines "FOLDER: NAMES".
constexpr std::string_view foreign_headers = R"(
  verify/: plugin.h
  adapters/: touchstone.h
  tests/adapters/tight_inclusion/public/spdlog/: spdlog.h
)";

/// Headers that no test includes, in the same form, below what tests them.
constexpr std::string_view headers_without_test = R"(
// Compilation: tests/CMakeLists.txt, tests/filters/CMakeLists.txt, tests/consumer. No code.
  exact/: cxx20.hpp exact.hpp
  fast/: fast.hpp tight_inclusion_variant.hpp
  filters/: strict_arithmetic.hpp
  verify/data/: query_source.hpp
// The oracle, the certificates and their checker.
  exact/algebra/: positivity.hpp
  exact/checker/: proof.hpp scene.hpp
  exact/contact/: contact_conditions.hpp contact_oracle.hpp
  exact/distance/: separating_axes.hpp
  exact/scene/: scene_text.hpp
// The kernels, which take the same queries in the same tests; the deciders; distances, steps, and the
// search for pairs, against all pairs one by one; intersections, beside rational arithmetic.
  fast/broad_phase/: body_tree.hpp box_tree.hpp division_on_lanes.hpp search_on_lanes.hpp seeds.hpp swept_box.hpp words_one_by_one.hpp
  fast/cells/: stages.hpp
  fast/certified/: curves.hpp kernel_on_lanes.hpp
  fast/certified/curves/: contact_proof.hpp control_polygon.hpp
  fast/certified/exact/: contact_conditions.hpp distance_decision.hpp enclosing_doubles.hpp fraction.hpp polynomial.hpp real_root.hpp
  fast/certified/stages/: axis.hpp bisection.hpp conservative_advancement.hpp crossing.hpp determinant.hpp direction.hpp distance_enclosure.hpp lanes.hpp moving_polygon.hpp moving_vectors.hpp only_zero.hpp orientation.hpp refinement.hpp single_precision.hpp
  fast/distance/: filter_on_lanes.hpp polygon_features.hpp
  fast/intersections/: filter_on_lanes.hpp orientation.hpp pair_filter.hpp pair_order.hpp pair_order_avx2.hpp triangle_contacts.hpp
  fast/platform/: floating_point_state.hpp lanes.hpp lanes_avx2.hpp lanes_avx512.hpp lanes_neon.hpp
  fast/step/: codimensional.hpp thickness.hpp
  fast/tight_inclusion/: box_kernel_on_lanes.hpp curved_box_kernel.hpp lane_by_lane.hpp
  adapters/tight_inclusion/: config.hpp
// The answers of the methods; the queries of the families; files and child processes, tables, certify, solve.
  verify/base/: any_query.hpp cores.hpp
  verify/baselines/: closest_features.hpp method_support.hpp moving_polynomials.hpp
  verify/published/: error_bounded.hpp exact_number.hpp interval_search.hpp planar_overlap.hpp published.hpp upward_interval.hpp
  verify/fuzz/: fuzz_report.hpp
  verify/generate/: coordinate_sampler.hpp curved_families.hpp draws.hpp grid.hpp offset.hpp passing_planes.hpp
  verify/io/: descriptor.hpp text_table.hpp
  verify/jobs/: prove.hpp work_time.hpp
  verify/judge/: fault.hpp
  verify/solvers/: child_process.hpp published.hpp
// tests/transcripts.
  verify/cli/: files.hpp options.hpp result_files.hpp sharded_run.hpp solver_options.hpp sources.hpp
  verify/report/: bench_report.hpp certify_report.hpp judgement_report.hpp step_report.hpp
)";

/// A line of a table.
struct Line {
  std::string name;
  Words words;
};

std::vector<Line> lines_of(std::string_view table) {
  std::vector<Line> lines;
  std::istringstream in{std::string(table)};
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line.starts_with("//")) continue;
    std::istringstream words(line.substr(line.find(':') + 1));
    lines.push_back(
        {line.substr(2, line.find(':') - 2), {std::istream_iterator<std::string>(words), {}}});
  }
  return lines;
}

const std::vector<Line>& layers() {
  static const std::vector<Line> all = [] {
    std::vector<Line> lines = lines_of(layer_lines);
    const Words rest = std::ranges::find(lines, "REST", &Line::name)->words;
    for (auto& [name, words] : lines) {
      if (std::erase(words, "REST") != 0) std::ranges::copy(rest, std::back_inserter(words));
    }
    return lines;
  }();
  return all;
}

/// The headers of a table of headers.
const Words& headers_of(std::string_view table) {
  static std::map<std::string_view, Words> known;
  Words& headers = known[table];
  if (!headers.empty()) return headers;
  for (const auto& [folder, names] : lines_of(table)) {
    for (const std::string& name : names) headers.push_back(folder + name);
  }
  return headers;
}

bool holds(const Words& words, std::string_view word) {
  return std::ranges::find(words, word) != words.end();
}

// ---- The rules ----------------------------------------------------------------------------------

bool fits(std::string_view path, std::string_view pattern) {
  return pattern.ends_with('/') ? path.starts_with(pattern) : path == pattern;
}

bool is_header(std::string_view path) { return path.ends_with(".hpp") || path.ends_with(".h"); }

/// The line that a path obeys; null for a path of no module.
const Line* layer_of(std::string_view path) {
  const Line* longest = nullptr;
  for (const Line& layer : layers()) {
    if (fits(path, layer.name) && (!longest || layer.name.size() > longest->name.size())) {
      longest = &layer;
    }
  }
  return longest;
}

/// The path without the folder of public headers, if it has one: include/touchstone/ in every
/// module, and others that stand for other libraries.
std::string tree_path(const std::string& path) {
  static const std::regex folder("include/(touchstone/filters|touchstone|tight_inclusion)/");
  return std::regex_replace(path, folder, "");
}

/// The source tree, and the paths in it of the public headers by the names under which they are
/// included.
struct Sources {
  Tree files, public_headers;
};

const Sources& sources() {
  static const Sources all = [] {
    const std::filesystem::path root = tests::source_folder();
    Sources result;
    for (const std::string folder : {"exact", "filters", "fast", "adapters", "verify", "tests"}) {
      for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
        if (!entry.is_regular_file()) continue;
        std::ifstream stream(entry.path(), std::ios::binary);
        const std::string path = entry.path().lexically_relative(root).generic_string();
        const std::string in_tree = tree_path(path);
        result.files.emplace(in_tree, std::string(std::istreambuf_iterator<char>(stream), {}));
        const std::size_t at = path.find("/include/");
        if (at == std::string::npos || !is_header(path) || folder == "tests") continue;
        result.public_headers.emplace(path.substr(at + 9), in_tree);
      }
    }
    return result;
  }();
  return all;
}

const Tree& source_tree() { return sources().files; }

/// True if a file may include a name, between angle brackets or not.
bool is_permitted(std::string_view path, const std::string& name, bool angle) {
  if (angle && !name.empty() && name.find_first_of("/.") == std::string::npos) return true;
  const auto header = sources().public_headers.find(name);
  const std::string& target = header != sources().public_headers.end() ? header->second : name;
  const Line* const layer = layer_of(path);
  if (name.find("..") != std::string::npos || layer == nullptr) return false;
  return std::ranges::any_of(layer->words, [&](const std::string& permitted) {
    return fits(target, permitted) &&
           std::ranges::none_of(closed_parts, [&](std::string_view part) {
             return target.starts_with(part) && !permitted.starts_with(part);
           });
  });
}

/// Every include of a file that it may not make, as "line: name".
Words forbidden_includes(std::string_view path, const std::string& text) {
  static const std::regex directive(R"([ \t]*#[ \t]*(include_next|include|import)\b[ \t]*(.*))");
  static const std::regex target(R"x((?:<([^>]*)>|"([^"]*)").*)x");
  Words result;
  std::istringstream in(text);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    std::smatch found, name;
    if (line.find('#') == std::string::npos || !std::regex_match(line, found, directive)) continue;
    const std::string included = found[2];
    const bool is_named = std::regex_match(included, name, target);
    const std::string named = is_named ? name[1].str() + name[2].str() : "";
    if (found[1] == "include" && is_permitted(path, named, is_named && name[1].matched)) continue;
    result.push_back(std::to_string(number) + ": " + named);
  }
  return result;
}

/// True if a test includes the header.
bool has_test(const Tree& tree, const std::string& header) {
  Words includes{"#include \"" + header};
  for (const auto& [name, path] : sources().public_headers) {
    if (path != header) continue;
    includes.insert(includes.end(), {"#include \"" + name, "#include <" + name});
  }
  return std::ranges::any_of(tree, [&](const auto& file) {
    const auto& [path, text] = file;
    return path.ends_with("_test.cpp") && std::ranges::any_of(includes, [&](const auto& include) {
             return text.find(include) != std::string::npos;
           });
  });
}

/// The namespace of a source of verify: that of its folder; empty for other files, and for the
/// program itself.
std::string namespace_of(const std::string& path) {
  static const std::regex inside(R"(verify/(\w+)/.*\.(hpp|h|cpp))");
  std::smatch folder;
  if (path == "verify/cli/main.cpp" || !std::regex_match(path, folder, inside)) return "";
  return folder[1] == "baselines" ? "touchstone::baselines"
                                  : "touchstone::verify::" + folder[1].str();
}

/// What is wrong with a file of the tree; empty if nothing is.
Words violations(const std::string& path, const std::string& text, const Tree& tree) {
  static const std::regex foreign(R"(.*\.(h|hh|hxx|c|cc|cxx|inc|inl|ipp|ixx|tpp|cppm))");
  const bool is_in_a_module = layer_of(path) != nullptr;
  const std::string space = namespace_of(path);
  const auto has = [&](const std::string& part) { return text.find(part) != std::string::npos; };
  const std::vector<std::pair<std::string, bool>> faults{
      {"no test", is_in_a_module && is_header(path) && !has_test(tree, path) &&
                      !holds(headers_of(headers_without_test), path)},
      {"no #pragma once", is_header(path) && !text.starts_with("#pragma once\n")},
      {"no \\file", is_header(path) && !has("\n/// \\file\n")},
      {"extension", std::regex_match(path, foreign) && !holds(headers_of(foreign_headers), path)},
      {"namespace", !space.empty() && !has("\nnamespace " + space + " {\n") &&
                        !has("\nnamespace " + space + "::")}};
  Words result;
  // Manuals may show the includes of a user's program.
  if (is_in_a_module && !path.ends_with(".md")) result = forbidden_includes(path, text);
  for (const auto& [fault, is_there] : faults) {
    if (is_there) result.push_back(fault);
  }
  return result;
}

// ---- The source tree ----------------------------------------------------------------------------

TEST(SourceTree, ObeysTheRules) {
  for (const auto& [path, text] : source_tree()) {
    EXPECT_EQ(violations(path, text, source_tree()), Words{}) << path;
  }
  EXPECT_TRUE(source_tree().contains("exact/query.hpp"));
  EXPECT_TRUE(source_tree().contains("tests/architecture_test.cpp"));
}

/// Folders of verify come after those that they include, and include them.
TEST(SourceTree, HasNoCircleAmongTheFoldersOfVerify) {
  const auto is_folder = [](const std::string& path) {
    return path.starts_with("verify/") && path.ends_with('/');
  };
  Words above;
  for (const auto& [folder, targets] : layers()) {
    if (!is_folder(folder)) continue;
    above.push_back(folder);
    for (const std::string& target : targets) {
      if (!is_folder(target)) continue;
      EXPECT_TRUE(holds(above, target)) << folder << " includes " << target;
      EXPECT_TRUE(std::ranges::any_of(source_tree(),
                                      [&](const auto& file) {
                                        return file.first.starts_with(folder) &&
                                               file.second.find("#include \"" + target) !=
                                                   std::string::npos;
                                      }))
          << folder << " need not include " << target;
    }
  }
}

TEST(SourceTree, NeedsItsExceptions) {
  for (const std::string& header : headers_of(headers_without_test)) {
    EXPECT_TRUE(source_tree().contains(header)) << header;
    EXPECT_FALSE(has_test(source_tree(), header)) << header;
  }
  for (const std::string& header : headers_of(foreign_headers)) {
    EXPECT_TRUE(source_tree().contains(header)) << header;
  }
}

/// The C headers can be included alone or together: their types in common are the same text.
TEST(SourceTree, HasTheTypesThatCHeadersHaveInCommon) {
  const auto types_of = [](std::string_view header) {
    const std::string& text = source_tree().find(header)->second;
    const std::size_t first = text.find("#ifndef TOUCHSTONE_TYPES\n");
    const std::size_t end = text.find("#endif  // TOUCHSTONE_TYPES\n", first);
    return end == std::string::npos ? std::string() : text.substr(first, end - first);
  };
  EXPECT_EQ(types_of("verify/plugin.h"), types_of("adapters/touchstone.h"));
  EXPECT_NE(types_of("verify/plugin.h").find("TOUCHSTONE_VERTEX_FACE"), std::string::npos);
}

// ---- Planted faults -----------------------------------------------------------------------------

/// Files and includes, "PATH: INCLUDES" with quotes left out around paths of this project: against
/// the layers, against the order of the folders of verify, and in a folder without a line; a header
/// of the system, another of a permitted package, one of a file's own line.
constexpr std::string_view forbidden = R"(
  exact/oracle.cpp: fast/solver.hpp exact/checker/checker.hpp exact/scene/scene_text.hpp
  exact/query.hpp: <CGAL/Polynomial.h>
  exact/checker/proof.cpp: exact/query.hpp
  filters/bound.hpp: tests/support/random.hpp filters/derivation/a.hpp
  fast/solver.cpp: filters/derivation/a.hpp <oneapi/tbb/parallel_for.h>
  fast/deep/er.hpp: exact/query.hpp.in
  verify/jobs/dataset.cpp: <stdio.h>
  verify/baselines/solver.cpp: <boost/multiprecision/cpp_int.hpp>
  verify/plugin.h: verify/data/query_source.hpp
  verify/io/csv.cpp: verify/data/dataset.hpp <linux/seccomp.h>
  verify/judge/judge.cpp: verify/solvers/solver.hpp
  verify/report/new.cpp: verify/fuzz/fuzz.hpp
  verify/unknown/new.cpp: verify/io/csv.hpp
  verify/cli/view_command.cpp: <CLI/CLI.hpp> filters/derivation/a.hpp
)";
TEST(PlantedFault, OfAnIncludeIsFound) {
  for (const auto& [path, includes] : lines_of(forbidden)) {
    for (const std::string& name : includes) {
      const std::string quoted = name.starts_with('<') ? name : '"' + name + '"';
      EXPECT_EQ(forbidden_includes(path, "#include " + quoted + "\n").size(), 1U)
          << path << ": " << name;
    }
  }
}

TEST(PlantedFault, IsHiddenByNoSpelling) {
  for (const std::string text :
       {"#include<gmpxx.h>", "  #include <gmpxx.h>", "#\tinclude <gmpxx.h>",
        "# include \"gmpxx.h\" // why", "#include \"fast/../exact/oracle.hpp\"",
        "#include \"../exact/oracle.hpp\"", "#include \"solver.hpp\"", "#include \"vector\"",
        "#include ORACLE", "#include <vector", "#include", "#include_next <vector>",
        "#import <vector>", "#include <>"}) {
    EXPECT_EQ(forbidden_includes("fast/solver.cpp", text).size(), 1U) << text;
  }
  EXPECT_EQ(
      forbidden_includes(
          "fast/solver.cpp",
          "#include \"fast/solver.hpp\"\n\n// #include <a.h>\n#define X \"#include <b.h>\"\n"
          "int included;\n#include <vector>\n#include <gmp.h>\n#include \"exact/oracle.hpp\""),
      (Words{"7: gmp.h", "8: exact/oracle.hpp"}));
}

/// A file, its text, and what is wrong with it.
struct PlantedFile {
  std::string path, text, wrong;
};

TEST(PlantedFault, OfAFileIsFoundAndNoOther) {
  const std::string head = "#pragma once\n\n/// \\file\n/// Idea.\n";
  const std::vector<PlantedFile> all{
      {"exact/new.hpp", head, "no test"},
      {"exact/old.hpp", head, ""},
      {"tests/exact/other_test.cpp", "#include \"exact/old.hpp\"\n", ""},
      {"verify/unknown/a.cpp",
       "#include \"verify/io/csv.hpp\"\nnamespace touchstone::verify::unknown {\n",
       "1: verify/io/csv.hpp"},
      {"verify/plugin.h", head, "no test"},
      {"verify/data/query_source.hpp", head + "\nnamespace touchstone::verify::data {\n", ""},
      {"tests/a.hpp", "// Comment\n#pragma once\n\n/// \\file\n", "no #pragma once"},
      {"tests/b.hpp", "#pragma once\n\n// Names no \\file.\n", "no \\file"},
      {"verify/io/b.cpp", "\nnamespace touchstone::verify {\n", "namespace"},
      {"verify/data/c.cpp", "\nnamespace touchstone::verify::io {\n", "namespace"},
      {"verify/baselines/d.cpp", "\nnamespace touchstone::baselines {\n", ""},
      {"verify/cli/main.cpp", "", ""},
      {"fast/b.cc", "", "extension"},
      {"tests/hidden.h", head, "extension"}};
  Tree tree;
  for (const auto& [path, text, wrong] : all) tree.emplace(path, text);
  for (const auto& [path, text, wrong] : all) {
    std::string found;
    for (const std::string& one : violations(path, text, tree)) {
      found += (found.empty() ? "" : ", ") + one;
    }
    EXPECT_EQ(found, wrong) << path;
  }
}

}  // namespace
}  // namespace touchstone::tests::architecture_test
