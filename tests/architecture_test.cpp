/// \file
/// The rules of the project that a compiler does not check: which module may include which, that
/// every header has a test, how a header begins, and that a folder of verify is a namespace. Each
/// rule is a function of a path and a text. The same function reads the source tree and finds
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
#include <vector>

#include "tests/support/built_files.hpp"

namespace touchstone::tests::architecture_test {
namespace {

/// Files by their path from the project root, with '/' between the parts, and without the folders
/// of public headers: fast/include/touchstone/step.hpp is fast/step.hpp.
using Tree = std::map<std::string, std::string, std::less<>>;
using Words = std::vector<std::string>;

// ---- The table ----------------------------------------------------------------------------------

/// Paths of one layer, and what they may include besides the standard library. Texts are beginnings
/// of paths if they end with '/', and whole paths if not.
struct Layer {
  std::string_view from, targets;
};

/// What every folder of verify may include: the modules, packages (CGAL for exact predicates of
/// meshes at rest), and POSIX.
constexpr std::string_view rest =
    "exact/ exact/checker/ filters/ filters/derivation/ fast/ verify/plugin.h CGAL/ CLI/ Eigen/ "
    "fmt/ gmp.h gmpxx.h nlohmann/ oneapi/tbb/ zip.h zstd.h dlfcn.h fcntl.h poll.h sys/ time.h "
    "unistd.h";

/// A path obeys the longest line that fits it. Folders of verify include only those above them, so
/// that there are no circles.
constexpr auto layers = std::to_array<Layer>({
    {"exact/query.hpp", "exact/cxx20.hpp Eigen/"},
    {"exact/curved_query.hpp", "exact/query.hpp"},
    {"exact/", "exact/ CGAL/ Eigen/ gmp.h gmpxx.h mpfr.h"},
    // The checker shares no code with anything that decides queries.
    {"exact/checker/", "exact/checker/ gmp.h gmpxx.h"},
    // filters/ is two targets: what simulators include, which needs nothing, and the derivation of
    // the bounds, which runs Gappa by POSIX.
    {"filters/", "filters/"},
    {"filters/derivation/",
     "filters/ filters/derivation/ fmt/ gmp.h gmpxx.h mpfr.h signal.h spawn.h sys/ unistd.h"},
    // Vectors, the processor's floating-point control, and large pages.
    {"fast/",
     "fast/ filters/ exact/curved_query.hpp exact/query.hpp Eigen/ hwy/ arm_neon.h immintrin.h "
     "xmmintrin.h sys/mman.h"},
    {"fast/platform/", "fast/platform/ filters/ arm_neon.h immintrin.h sys/mman.h xmmintrin.h"},
    // All that needs oneTBB, which is optional.
    {"fast/platform/threads.hpp", "fast/platform/floating_point_state.hpp oneapi/tbb/"},
    // Each folder of fast includes those above it, and the headers named with it.
    {"fast/broad_phase/",
     "fast/broad_phase/ fast/platform/ fast/broad_phase.hpp fast/mesh.hpp filters/ arm_neon.h "
     "immintrin.h"},
    {"fast/tight_inclusion/",
     "fast/tight_inclusion/ fast/platform/ filters/ exact/query.hpp immintrin.h"},
    {"fast/certified/exact/",
     "fast/certified/exact/ exact/curved_query.hpp exact/query.hpp Eigen/"},
    {"fast/certified/fixed_point_vertices.hpp", "fast/platform/ fast/mesh.hpp"},
    {"fast/certified/kernel.hpp",
     "fast/certified/fixed_point_vertices.hpp fast/platform/ fast/mesh.hpp exact/query.hpp"},
    {"fast/certified/stages/",
     "fast/certified/stages/ fast/certified/fixed_point_vertices.hpp fast/certified/kernel.hpp "
     "filters/ exact/query.hpp"},
    {"fast/certified/curves/",
     "fast/certified/curves/ fast/certified/stages/ fast/certified/kernel.hpp filters/ "
     "exact/query.hpp"},
    {"fast/certified/",
     "fast/certified/ fast/platform/ fast/certified.hpp fast/mesh.hpp filters/ "
     "exact/curved_query.hpp exact/query.hpp immintrin.h"},
    {"fast/distance/",
     "fast/distance/ fast/certified/exact/ fast/platform/ fast/distance.hpp fast/kernels.hpp "
     "fast/step.hpp filters/ exact/query.hpp arm_neon.h immintrin.h"},
    {"fast/step/",
     "fast/step/ fast/broad_phase/ fast/certified/ fast/broad_phase.hpp fast/kernels.hpp "
     "fast/mesh.hpp fast/step.hpp"},
    {"adapters/", "adapters/ fast/ exact/query.hpp Eigen/"},
    {"adapters/ipc_toolkit.hpp", "fast/ exact/query.hpp ipc/ccd/narrow_phase_ccd.hpp"},
    {"adapters/tight_inclusion/logger.hpp", "spdlog/"},
    // Who includes a header in C needs no other header of ours.
    {"adapters/touchstone.h", "stddef.h stdint.h"},
    {"verify/plugin.h", "stdint.h"},
    // A new folder needs a line of its own.
    {"verify/", ""},
    {"verify/base/", "verify/base/ +"},
    {"verify/io/", "verify/io/ +"},
    {"verify/data/", "verify/data/ verify/base/ verify/io/ +"},
    {"verify/mesh/", "verify/mesh/ verify/data/ verify/io/ +"},
    {"verify/generate/", "verify/generate/ verify/base/ verify/data/ verify/io/ verify/mesh/ +"},
    // The published methods use packages that simulators do not need, and the rounding mode.
    {"verify/baselines/",
     "verify/baselines/ verify/generate/random.hpp fast/ filters/ gmpxx.h exact/curved_query.hpp "
     "exact/query.hpp Eigen/ boost/numeric/interval.hpp xmmintrin.h"},
    {"verify/judge/", "verify/judge/ verify/base/ verify/data/ verify/io/ +"},
    {"verify/solvers/",
     "verify/solvers/ verify/base/ verify/baselines/ verify/io/ verify/judge/ +"},
    // All that needs Linux.
    {"verify/solvers/linux/",
     "verify/solvers/ verify/io/ fcntl.h linux/ poll.h sched.h sys/ "
     "unistd.h"},
    {"verify/jobs/",
     "verify/jobs/ verify/base/ verify/baselines/ verify/data/ verify/io/ verify/judge/ "
     "verify/mesh/ verify/solvers/ +"},
    {"verify/fuzz/",
     "verify/fuzz/ verify/base/ verify/data/ verify/generate/ verify/io/ verify/judge/ "
     "verify/solvers/ +"},
    {"verify/stability/",
     "verify/stability/ verify/base/ verify/data/ verify/generate/ verify/jobs/ verify/judge/ "
     "verify/solvers/ +"},
    {"verify/report/",
     "verify/report/ verify/base/ verify/data/ verify/generate/ verify/io/ verify/jobs/ "
     "verify/judge/ verify/mesh/ verify/solvers/ verify/stability/ +"},
    {"verify/view/",
     "verify/view/ verify/base/ verify/data/ verify/io/ verify/jobs/ verify/judge/ verify/mesh/ "
     "verify/report/ verify/solvers/ +"},
    {"verify/playground/",
     "verify/judge/ verify/solvers/ verify/view/ fast/ nlohmann/ "
     "emscripten/emscripten.h"},
    {"verify/cli/",
     "verify/cli/ verify/base/ verify/data/ verify/fuzz/ verify/generate/ verify/io/ verify/jobs/ "
     "verify/judge/ verify/mesh/ verify/report/ verify/solvers/ verify/stability/ verify/view/ +"},
});

/// Parts of a module that only lines which name them include, not one for the whole module.
constexpr std::array<std::string_view, 2> closed_parts{"exact/checker/", "filters/derivation/"};

constexpr std::array<std::string_view, 5> modules{"exact", "filters", "fast", "adapters", "verify"};

/// Files of a folder that are exempt from a rule, with the reason.
struct Exception {
  std::string_view folder, names, reason;
};

/// Headers under an extension that this project does not use.
constexpr auto foreign_headers = std::to_array<Exception>({
    {"verify/", "plugin.h", "included by plugins, which may be written in C"},
    {"adapters/", "touchstone.h", "included by programs in C"},
    {"tests/adapters/tight_inclusion/public/spdlog/", "spdlog.h", "another library's name"},
});

/// Headers without a test file of their own.
constexpr auto headers_without_test = std::to_array<Exception>({
    {"adapters/tight_inclusion/", "config.hpp", "macros, tested in ccd_test.cpp"},
    {"exact/", "cxx20.hpp", "tested by compilation, in tests/CMakeLists.txt"},
    {"exact/", "exact.hpp", "an umbrella, included by tests/consumer"},
    {"exact/algebra/", "positivity.hpp", "tested in separation_intervals_test.cpp"},
    {"exact/contact/", "contact_conditions.hpp", "tested in certificate_test.cpp"},
    {"exact/contact/", "contact_oracle.hpp corner_motion.hpp",
     "tested in oracle_test.cpp and distance_oracle_test.cpp"},
    {"exact/distance/", "separating_axes.hpp", "tested in distance_oracle_test.cpp"},
    {"exact/rigid/", "rigid_place.hpp", "tested in rigid_motion_test.cpp"},
    {"fast/", "fast.hpp", "an umbrella, included by tests/consumer"},
    {"fast/", "kernels.hpp", "a choice of kernels, tested by the tests that choose them"},
    {"fast/", "method.hpp verdict.hpp", "without code"},
    {"fast/broad_phase/",
     "division_on_lanes.hpp search_on_lanes.hpp seeds.hpp words_one_by_one.hpp",
     "parts of the searches, tested through them"},
    {"fast/broad_phase/", "body_tree.hpp box_tree.hpp swept_box.hpp",
     "tested by all pairs one by one: search_test.cpp, broad_phase_test.cpp, step_test.cpp"},
    {"fast/certified/", "block.hpp curves.hpp kernel_on_lanes.hpp", "tested through the solver"},
    {"fast/certified/curves/", "contact_proof.hpp control_polygon.hpp stages.hpp",
     "tested in curved_parts_test.cpp and curved_test.cpp"},
    {"fast/certified/exact/", "curved_polygon.hpp", "tested in curved_parts_test.cpp"},
    {"fast/certified/exact/", "fixed_integer.hpp", "tested in big_integer_test.cpp"},
    {"fast/certified/exact/", "contact_conditions.hpp general_contact_decision.hpp polynomial.hpp",
     "parts of the exact stage, tested by deciders_test.cpp and real_root_test.cpp"},
    {"fast/certified/stages/",
     "axis.hpp bisection.hpp conservative_advancement.hpp crossing.hpp determinant.hpp "
     "direction.hpp distance_enclosure.hpp "
     "lanes.hpp moving_polygon.hpp moving_vectors.hpp only_zero.hpp orientation.hpp refinement.hpp "
     "single_precision.hpp",
     "parts of the kernels, tested through them"},
    {"fast/distance/",
     "exact_distance.hpp filter_kernel.hpp filter_on_lanes.hpp filtered_distance.hpp "
     "polygon_features.hpp",
     "stages of the distance, tested in distance_test.cpp"},
    {"fast/platform/",
     "avx2_doubles.hpp avx2_floats.hpp avx512_doubles.hpp avx512_floats.hpp avx_rows.hpp "
     "neon_doubles.hpp neon_floats.hpp scalar_doubles.hpp scalar_floats.hpp",
     "parts of the kernels, tested through them"},
    {"fast/platform/", "floating_point_state.hpp", "tested by floating_point_environment_test.cpp"},
    {"fast/step/", "bodies.hpp codimensional.hpp", "tested by step_test.cpp"},
    {"fast/tight_inclusion/", "box_kernel_on_lanes.hpp curved_box_kernel.hpp",
     "tested through the kernels, and in curved_test.cpp"},
    {"filters/", "strict_arithmetic.hpp", "tested by compilation, in tests/filters/CMakeLists.txt"},
    {"filters/", "error_bound.hpp", "tested in error_bounds_test.cpp"},
    {"filters/derivation/", "mpfr_number.hpp", "tested in worst_case_test.cpp"},
    {"verify/base/", "cores.hpp", "a call of oneTBB and a limit"},
    {"verify/baselines/",
     "closest_features.hpp exact_number.hpp moving_polynomials.hpp query_random.hpp "
     "upward_rounding.hpp verdicts.hpp",
     "parts of the methods, tested by their answers in baselines_test.cpp"},
    {"verify/cli/",
     "certificates_file.hpp commands.hpp curved_run.hpp files.hpp group_options.hpp help.hpp "
     "options.hpp solver_options.hpp sources.hpp version.hpp view_file.hpp",
     "tested by tests/transcripts"},
    {"verify/data/", "npy_header.hpp", "tested in npy_test.cpp"},
    {"verify/data/", "query_source.hpp", "an interface without code"},
    {"verify/fuzz/", "finding.hpp", "what the fuzzer hands out, without code"},
    {"verify/fuzz/",
     "coverage.hpp finding_page.hpp fuzz_report.hpp plainness.hpp scheduler.hpp signature.hpp",
     "tested by what the fuzzer finds, simplifies, groups and prints: fuzz_test.cpp, "
     "shrink_test.cpp, tests/transcripts"},
    {"verify/generate/", "curved_families.hpp", "tested in families_test.cpp"},
    {"verify/generate/",
     "coordinate_sampler.hpp draws.hpp family_builder.hpp grid.hpp passing_planes.hpp random.hpp",
     "parts of the families, tested through their queries"},
    {"verify/jobs/", "block_answers.hpp block_truth.hpp", "tested through certify and solve"},
    {"verify/jobs/", "work_time.hpp", "tested in step_bench_test.cpp"},
    {"verify/mesh/", "moving_mesh.hpp", "tested by tests/transcripts: candidates, step, bench"},
    {"verify/report/",
     "certify_report.hpp judgement_report.hpp stability_report.hpp step_report.hpp",
     "tested by tests/transcripts"},
    {"verify/report/",
     "figure.hpp figures.hpp findings.hpp measurement.hpp published.hpp results.hpp "
     "stability_figures.hpp",
     "tested by documents_test.cpp: docs/results.md and its picture are those of their data"},
    {"verify/stability/", "hard_curves.hpp", "tested in hardness_test.cpp"},
});

// ---- The rules ----------------------------------------------------------------------------------

Words words(std::string_view text) {
  std::istringstream in{std::string(text)};
  return {std::istream_iterator<std::string>(in), {}};
}

bool fits(std::string_view path, std::string_view pattern) {
  return pattern.ends_with('/') ? path.starts_with(pattern) : path == pattern;
}

bool is_header(std::string_view path) { return path.ends_with(".hpp") || path.ends_with(".h"); }

/// The line that a path obeys; null for a path of no module.
const Layer* layer_of(std::string_view path) {
  const Layer* longest = nullptr;
  for (const Layer& layer : layers) {
    if (fits(path, layer.from) && (!longest || layer.from.size() > longest->from.size())) {
      longest = &layer;
    }
  }
  return longest;
}

Words targets_of(const Layer& layer) {
  Words targets = words(layer.targets);
  if (targets.empty() || targets.back() != "+") return targets;
  targets.pop_back();
  std::ranges::copy(words(rest), std::back_inserter(targets));
  return targets;
}

/// The path without the folder of public headers, if it has one: include/touchstone/ in every
/// module, and others that stand for other libraries.
std::string tree_path(const std::string& path) {
  static const std::regex folder("include/(touchstone/filters|touchstone|tight_inclusion)/");
  return std::regex_replace(path, folder, "");
}

Tree read_source_tree() {
  const std::filesystem::path root = tests::source_folder();
  Tree tree;
  for (const std::string folder : {"exact", "filters", "fast", "adapters", "verify", "tests"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
      if (!entry.is_regular_file()) continue;
      std::ifstream stream(entry.path(), std::ios::binary);
      tree.emplace(entry.path().lexically_relative(root).generic_string(),
                   std::string(std::istreambuf_iterator<char>(stream), {}));
    }
  }
  return tree;
}

const Tree& source_tree() {
  static const Tree tree = [] {
    Tree result;
    for (auto& [path, text] : read_source_tree()) result.emplace(tree_path(path), text);
    return result;
  }();
  return tree;
}

/// The public headers: their paths in the tree, by the names under which they are included.
const Tree& public_headers() {
  static const Tree headers = [] {
    Tree result;
    for (const auto& [path, text] : read_source_tree()) {
      const std::size_t at = path.find("/include/");
      if (at == std::string::npos || !is_header(path) || path.starts_with("tests/")) continue;
      result.emplace(path.substr(at + std::string_view("/include/").size()), tree_path(path));
    }
    return result;
  }();
  return headers;
}

/// True if a file may include a name, between angle brackets or not.
bool is_permitted(std::string_view path, const std::string& name, bool angle) {
  if (angle && !name.empty() && name.find_first_of("/.") == std::string::npos) return true;
  const auto header = public_headers().find(name);
  const std::string& target = header != public_headers().end() ? header->second : name;
  const Layer* const layer = layer_of(path);
  if (name.find("..") != std::string::npos || layer == nullptr) return false;
  return std::ranges::any_of(targets_of(*layer), [&](const std::string& permitted) {
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

template <class Exceptions>
bool is_one_of(std::string_view path, const Exceptions& exceptions) {
  return std::ranges::any_of(exceptions, [&](const Exception& one) {
    return path.starts_with(one.folder) &&
           std::ranges::count(words(one.names), path.substr(one.folder.size())) == 1;
  });
}

std::string test_of(std::string_view header) {
  return "tests/" + std::string(header.substr(0, header.rfind('.'))) + "_test.cpp";
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
  Words result;
  const bool is_in_a_module = layer_of(path) != nullptr;
  // Manuals may show the includes of a user's program.
  if (is_in_a_module && !path.ends_with(".md")) result = forbidden_includes(path, text);
  if (is_in_a_module && is_header(path) && !is_one_of(path, headers_without_test) &&
      !tree.contains(test_of(path))) {
    result.emplace_back("no test");
  }
  if (is_header(path) && !text.starts_with("#pragma once\n")) {
    result.emplace_back("no #pragma once");
  }
  if (is_header(path) && text.find("\n/// \\file\n") == std::string::npos) {
    result.emplace_back("no \\file");
  }
  if (std::regex_match(path, foreign) && !is_one_of(path, foreign_headers)) {
    result.emplace_back("extension");
  }
  const std::string space = "\nnamespace " + namespace_of(path);
  if (!namespace_of(path).empty() && text.find(space + " {\n") == std::string::npos &&
      text.find(space + "::") == std::string::npos) {
    result.emplace_back("namespace");
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
  Words above;
  for (const Layer& layer : layers) {
    if (!layer.from.starts_with("verify/") || !layer.from.ends_with('/')) continue;
    above.emplace_back(layer.from);
    for (const std::string& target : words(layer.targets)) {
      if (!target.starts_with("verify/") || !target.ends_with('/')) continue;
      EXPECT_EQ(std::ranges::count(above, target), 1) << layer.from << " includes " << target;
      EXPECT_TRUE(std::ranges::any_of(source_tree(),
                                      [&](const auto& file) {
                                        return file.first.starts_with(layer.from) &&
                                               file.second.find("#include \"" + target) !=
                                                   std::string::npos;
                                      }))
          << layer.from << " need not include " << target;
    }
  }
}

TEST(SourceTree, NeedsItsExceptions) {
  for (const auto& [folder, names, reason] : headers_without_test) {
    for (const std::string& name : words(names)) {
      const std::string header = std::string(folder) + name;
      EXPECT_TRUE(source_tree().contains(header)) << header;
      EXPECT_FALSE(source_tree().contains(test_of(header))) << header;
    }
  }
  for (const auto& [folder, name, reason] : foreign_headers) {
    EXPECT_TRUE(source_tree().contains(std::string(folder) + std::string(name))) << name;
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

/// A file, and whether each of these includes of it is forbidden.
struct Planted {
  std::string_view path;
  bool is_forbidden;
  Words includes;
};

TEST(PlantedFault, OfAnIncludeIsFoundAndNoOther) {
  const std::vector<Planted> all{
      {"exact/oracle.cpp", true, {R"("fast/solver.hpp")", R"("exact/checker/checker.hpp")"}},
      {"exact/query.hpp", true, {"<CGAL/Polynomial.h>"}},
      {"exact/query.hpp", false, {"<Eigen/Core>", "<span>"}},
      {"exact/checker/proof.cpp", true, {R"("exact/query.hpp")"}},
      {"exact/checker/proof.cpp", false, {R"("exact/checker/proof.hpp")", "<gmpxx.h>"}},
      {"filters/bound.hpp",
       true,
       {R"("tests/support/random.hpp")", R"("filters/derivation/a.hpp")"}},
      {"filters/derivation/a.cpp", false, {R"("filters/derivation/a.hpp")", "<mpfr.h>"}},
      {"fast/solver.cpp", true, {R"("filters/derivation/a.hpp")", "<oneapi/tbb/parallel_for.h>"}},
      {"fast/deep/er.hpp", true, {R"("exact/query.hpp.in")"}},
      {"fast/solver.cpp", false, {R"("exact/query.hpp")", "<Eigen/Core>"}},
      {"fast/platform/threads.hpp", false, {"<oneapi/tbb/info.h>"}},
      // A header of the system, another of a permitted package, and one of a file's own line.
      {"verify/jobs/dataset.cpp", true, {"<stdio.h>"}},
      {"verify/baselines/solver.cpp", true, {"<boost/multiprecision/cpp_int.hpp>"}},
      {"verify/plugin.h", true, {R"("verify/data/query_source.hpp")"}},
      // The folders of verify: against their order, and a folder without a line.
      {"verify/io/csv.cpp", true, {R"("verify/data/dataset.hpp")", "<linux/seccomp.h>"}},
      {"verify/judge/judge.cpp", true, {R"("verify/solvers/solver.hpp")"}},
      {"verify/stability/new.cpp", true, {R"("verify/fuzz/fuzz.hpp")"}},
      {"verify/unknown/new.cpp", true, {R"("verify/io/csv.hpp")"}},
      {"verify/jobs/prove.cpp", false, {R"("exact/checker/checker.hpp")"}},
      {"verify/solvers/linux/a.cpp", false, {"<linux/seccomp.h>"}}};
  for (const auto& [path, is_forbidden, includes] : all) {
    for (const std::string& include : includes) {
      const Words found = forbidden_includes(path, "#include " + include + "\n");
      EXPECT_EQ(found.size(), is_forbidden ? 1U : 0U) << path << ": " << include;
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
      {"exact/old.cpp", "int x;\n", ""},
      {"tests/exact/old_test.cpp", "", ""},
      {"tests/support/random.hpp", head, ""},
      {"verify/unknown/a.cpp",
       "#include \"verify/io/csv.hpp\"\nnamespace touchstone::verify::unknown {\n",
       "1: verify/io/csv.hpp"},
      {"verify/io/er.hpp", head + "\nnamespace touchstone::verify::io {\n", "no test"},
      {"tests/verify/er_test.cpp", "", ""},
      {"verify/plugin.h", head, "no test"},
      {"verify/data/query_source.hpp", head + "\nnamespace touchstone::verify::data {\n", ""},
      {"tests/a.hpp", "// Comment\n#pragma once\n\n/// \\file\n", "no #pragma once"},
      {"tests/b.hpp", "#pragma once\n\n// Names no \\file.\n", "no \\file"},
      {"tests/c.hpp", "", "no #pragma once, no \\file"},
      {"verify/io/a.cpp", "\nnamespace touchstone::verify::io {\n", ""},
      {"verify/io/b.cpp", "\nnamespace touchstone::verify {\n", "namespace"},
      {"verify/data/c.cpp", "\nnamespace touchstone::verify::io {\n", "namespace"},
      {"verify/baselines/d.cpp", "\nnamespace touchstone::baselines {\n", ""},
      {"verify/report/page/page.js", "", ""},
      {"verify/cli/main.cpp", "", ""},
      {"fast/b.cc", "", "extension"},
      {"tests/hidden.h", head, "extension"},
      {"verify/plugin.c", "", "extension"},
      {"exact/CMakeLists.txt", "", ""}};
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
