/// \file
/// The rules of the project that a compiler does not check: which module may include which, that
/// every header has a test, how a header begins, and that a folder of verify is a namespace. Each
/// rule is a function of paths and texts. The same function reads the source tree and finds planted
/// faults.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/built_files.hpp"

namespace touchstone::tests::architecture_test {
namespace {

/// Files by their path from the project root, with '/' between the parts, and without the folders
/// of public headers: fast/include/touchstone/step.hpp is fast/step.hpp.
using Tree = std::map<std::string, std::string, std::less<>>;
using Violations = std::vector<std::string>;

/// A permission to include. Both texts are beginnings of paths if they end with '/', and whole
/// paths if not. The standard library is allowed everywhere and not listed.
struct Permission {
  std::string_view from;
  std::string_view target;
};

/// A file obeys the lines of the longest `from` that fits its path.
///
/// filters/ is two targets: the expressions and their bounds, which simulators include and which
/// need nothing, and the derivation of the bounds.
constexpr auto permissions = std::to_array<Permission>({
    {"exact/curved_query.hpp", "exact/query.hpp"},
    {"exact/query.hpp", "Eigen/"},

    {"exact/", "exact/"},
    {"exact/", "CGAL/"},
    {"exact/", "Eigen/"},
    {"exact/", "gmp.h"},
    {"exact/", "gmpxx.h"},
    {"exact/", "mpfr.h"},

    // The checker shares no code with anything that decides queries.
    {"exact/checker/", "exact/checker/"},
    {"exact/checker/", "gmp.h"},
    {"exact/checker/", "gmpxx.h"},

    {"filters/", "filters/"},

    {"filters/derivation/", "filters/"},
    {"filters/derivation/", "filters/derivation/"},
    {"filters/derivation/", "fmt/"},
    {"filters/derivation/", "gmp.h"},
    {"filters/derivation/", "gmpxx.h"},
    {"filters/derivation/", "mpfr.h"},
    // POSIX, to run Gappa.
    {"filters/derivation/", "signal.h"},
    {"filters/derivation/", "spawn.h"},
    {"filters/derivation/", "sys/"},
    {"filters/derivation/", "unistd.h"},

    {"fast/", "fast/"},
    {"fast/", "filters/"},
    {"fast/", "exact/curved_query.hpp"},
    {"fast/", "exact/query.hpp"},
    {"fast/", "Eigen/"},
    // Vectors, and the processor's floating-point control.
    {"fast/", "hwy/"},
    {"fast/", "arm_neon.h"},
    {"fast/", "immintrin.h"},
    {"fast/", "xmmintrin.h"},
    // Large pages.
    {"fast/", "sys/mman.h"},

    // Everything that needs oneTBB, which is optional.
    {"fast/platform/threads.hpp", "fast/platform/floating_point_state.hpp"},
    {"fast/platform/threads.hpp", "oneapi/tbb/"},

    {"adapters/", "adapters/"},
    {"adapters/", "fast/"},
    {"adapters/", "exact/query.hpp"},
    {"adapters/", "Eigen/"},
    {"adapters/ipc_toolkit.hpp", "fast/"},
    {"adapters/ipc_toolkit.hpp", "exact/query.hpp"},
    {"adapters/ipc_toolkit.hpp", "ipc/ccd/narrow_phase_ccd.hpp"},

    {"adapters/tight_inclusion/logger.hpp", "spdlog/"},

    // C programs that include this header need no other header of ours.
    {"adapters/touchstone.h", "stddef.h"},
    {"adapters/touchstone.h", "stdint.h"},

    // The published methods use packages that simulators do not need.
    {"verify/baselines/", "verify/baselines/"},
    {"verify/baselines/", "verify/generate/random.hpp"},
    {"verify/baselines/", "fast/"},
    {"verify/baselines/", "filters/"},
    {"verify/baselines/", "gmpxx.h"},
    {"verify/baselines/", "exact/curved_query.hpp"},
    {"verify/baselines/", "exact/query.hpp"},
    {"verify/baselines/", "Eigen/"},
    {"verify/baselines/", "boost/numeric/interval.hpp"},
    // The rounding mode of one thread.
    {"verify/baselines/", "xmmintrin.h"},

    {"verify/", "exact/"},
    {"verify/", "exact/checker/"},
    {"verify/", "filters/"},
    {"verify/", "filters/derivation/"},
    {"verify/", "fast/"},
    {"verify/", "verify/"},
    // Exact predicates of meshes at rest.
    {"verify/", "CGAL/"},
    {"verify/", "CLI/"},
    {"verify/", "Eigen/"},
    {"verify/", "fmt/"},
    {"verify/", "gmp.h"},
    {"verify/", "gmpxx.h"},
    {"verify/", "nlohmann/"},
    {"verify/", "oneapi/tbb/"},
    {"verify/", "zip.h"},
    {"verify/", "zstd.h"},
    // POSIX: files, memory maps, terminals, clocks, processes, shared libraries.
    {"verify/", "dlfcn.h"},
    {"verify/", "fcntl.h"},
    {"verify/", "poll.h"},
    {"verify/", "sys/"},
    {"verify/", "time.h"},
    {"verify/", "unistd.h"},

    // Everything that needs Linux.
    {"verify/playground/", "emscripten/emscripten.h"},
    {"verify/playground/", "fast/"},
    {"verify/playground/", "nlohmann/"},
    {"verify/playground/", "verify/"},
    {"verify/solvers/linux/", "verify/"},
    {"verify/solvers/linux/", "fcntl.h"},
    {"verify/solvers/linux/", "linux/"},
    {"verify/solvers/linux/", "poll.h"},
    {"verify/solvers/linux/", "sched.h"},
    {"verify/solvers/linux/", "spawn.h"},
    {"verify/solvers/linux/", "sys/"},
    {"verify/solvers/linux/", "unistd.h"},

    // Plugins that include this header need no other header of ours.
    {"verify/plugin.h", "stdint.h"},
});

/// The folders of verify, and the folders that each may include besides itself: only folders above
/// it, so that there are no circles. All permissions of verify above hold as well.
struct Layer {
  std::string_view folder;
  std::vector<std::string_view> includes;
};

const std::vector<Layer>& verify_layers() {
  static const std::vector<Layer> layers{
      {"base", {}},
      {"io", {}},
      {"data", {"io"}},
      {"mesh", {"data", "io"}},
      {"generate", {"data", "io", "mesh"}},
      {"baselines", {"generate"}},
      {"judge", {"base", "data", "io"}},
      {"solvers", {"base", "baselines", "io", "judge"}},
      {"jobs", {"base", "baselines", "data", "io", "judge", "mesh", "solvers"}},
      {"fuzz", {"base", "data", "generate", "io", "judge", "solvers"}},
      {"stability", {"base", "data", "generate", "jobs", "judge", "solvers"}},
      {"report",
       {"base", "data", "generate", "io", "jobs", "judge", "mesh", "solvers", "stability"}},
      {"view", {"data", "io", "jobs", "judge", "mesh", "report", "solvers"}},
      {"playground", {"judge", "solvers", "view"}},
      {"cli",
       {"base", "data", "fuzz", "generate", "io", "jobs", "judge", "mesh", "report", "solvers",
        "stability", "view"}},
  };
  return layers;
}

/// A file that is exempt from a rule, with the reason.
struct Exception {
  std::string_view header;
  std::string_view reason;
};

/// Headers under an extension that this project does not use.
constexpr auto foreign_headers = std::to_array<Exception>({
    {"verify/plugin.h", "included by plugins, which may be written in C"},
    {"adapters/touchstone.h", "included by programs in C"},
    {"tests/adapters/tight_inclusion/public/spdlog/spdlog.h",
     "stands for another library's header, under its name"},
});

/// Headers without a test file of their own.
constexpr auto headers_without_test = std::to_array<Exception>({
    {"filters/strict_arithmetic.hpp", "tested by compilation, in tests/filters/CMakeLists.txt"},
    {"exact/cxx20.hpp", "tested by compilation, in tests/CMakeLists.txt"},
    {"exact/contact/contact_oracle.hpp", "tested through the oracle, in oracle_test.cpp"},
    {"verify/data/query_source.hpp", "an interface without code"},
    {"exact/exact.hpp", "an umbrella, included by tests/consumer"},
    {"fast/fast.hpp", "an umbrella, included by tests/consumer"},
    {"fast/kernels.hpp", "a choice of kernels, tested by the tests that choose them"},
    {"fast/method.hpp", "an interface without code"},
    {"fast/verdict.hpp", "an enumeration without code"},
    {"fast/broad_phase/search_on_lanes.hpp", "a part of the searches, tested through them"},
    {"fast/broad_phase/division_on_lanes.hpp", "a part of the searches, tested through them"},
    {"fast/broad_phase/seeds.hpp", "what they divide, tested through them"},
    {"fast/platform/avx2_doubles.hpp", "a part of the kernels, tested through them"},
    {"fast/platform/avx2_floats.hpp", "a part of the kernels, tested through them"},
    {"fast/platform/avx512_doubles.hpp", "a part of the kernels, tested through them"},
    {"fast/platform/avx512_floats.hpp", "a part of the kernels, tested through them"},
    {"fast/platform/avx_rows.hpp", "a part of the kernels, tested through them"},
    {"fast/platform/neon_doubles.hpp", "a part of the kernels, tested through them"},
    {"fast/platform/neon_floats.hpp", "a part of the kernels, tested through them"},
    {"fast/platform/scalar_doubles.hpp", "a part of the kernels, tested through them"},
    {"fast/platform/scalar_floats.hpp", "a part of the kernels, tested through them"},
    {"fast/broad_phase/words_one_by_one.hpp", "a part of the searches, tested through them"},
    {"fast/certified/block.hpp", "a part of the solver, tested through it"},
    {"fast/certified/exact/curved_polygon.hpp", "tested in curved_parts_test.cpp"},
    {"fast/curved/contact_proof.hpp", "tested in curved_parts_test.cpp"},
    {"fast/curved/control_polygon.hpp", "tested in curved_parts_test.cpp"},
    {"fast/curved/curved_block.hpp", "tested in curved_test.cpp"},
    {"fast/curved/curved_stages.hpp", "tested in curved_parts_test.cpp"},
    {"verify/baselines/curved_methods.hpp", "tested in certify_curves_test.cpp"},
    {"verify/generate/curved_families.hpp", "tested in certify_curves_test.cpp"},
    {"verify/solvers/curved_answers.hpp", "tested in fuzz_curves_test.cpp"},
    {"verify/cli/curved_run.hpp", "tested in commands_test.cpp"},
    {"fast/distance/exact_distance.hpp", "a stage of the distance, tested in distance_test.cpp"},
    {"fast/distance/filter_kernel.hpp", "a stage of the distance, tested in distance_test.cpp"},
    {"fast/distance/filter_on_lanes.hpp", "a part of the kernels, tested through them"},
    {"fast/distance/filtered_distance.hpp", "a stage of the distance, tested in distance_test.cpp"},
    {"fast/distance/polygon_features.hpp", "a part of both stages, tested through them"},
    {"fast/certified/kernel_on_lanes.hpp", "a part of the kernels, tested through them"},
    {"fast/certified/stages/axis.hpp", "a part of the kernels, tested through them"},
    {"fast/certified/stages/bisection.hpp", "a part of the kernels, tested through them"},
    {"fast/certified/stages/crossing.hpp", "a part of the kernels, tested through them"},
    {"fast/certified/stages/determinant.hpp", "a part of the kernels, tested through them"},
    {"fast/certified/stages/direction.hpp", "a part of the kernels, tested through them"},
    {"fast/certified/stages/distance_enclosure.hpp", "a part of the kernels, tested through them"},
    {"fast/certified/stages/lanes.hpp", "a part of the kernels, tested through them"},
    {"fast/certified/stages/moving_polygon.hpp", "a part of the kernels, tested through them"},
    {"fast/certified/stages/moving_vectors.hpp", "a part of the kernels, tested through them"},
    {"fast/certified/stages/only_zero.hpp", "a part of the kernels, tested through them"},
    {"fast/certified/stages/orientation.hpp", "a part of the kernels, tested through them"},
    {"fast/certified/stages/refinement.hpp", "a part of the kernels, tested through them"},
    {"fast/certified/stages/single_precision.hpp", "a part of the kernels, tested through them"},
    {"fast/tight_inclusion/box_kernel_on_lanes.hpp", "a part of the kernels, tested through them"},
    {"fast/tight_inclusion/curved_box_kernel.hpp", "tested in curved_test.cpp"},
    {"adapters/tight_inclusion/config.hpp", "macros, tested in ccd_test.cpp"},
    {"verify/cli/certificates_file.hpp", "tested through the commands that use it"},
    {"verify/cli/group_options.hpp", "tested through the commands that use it"},
    {"verify/cli/options.hpp", "tested through the commands that use it"},
    {"verify/cli/view_file.hpp", "tested through the commands that use it"},
    {"verify/generate/draws.hpp", "a part of the generators, tested through their queries"},
    {"verify/jobs/block_answers.hpp", "a part of certify and solve, tested through them"},
    {"verify/jobs/block_truth.hpp", "a part of certify, tested through it"},
    {"verify/fuzz/finding.hpp", "what the fuzzer hands out, without code"},
    {"verify/generate/draws.hpp", "a part of the generators, tested through their queries"},
    {"verify/generate/grid.hpp", "a part of the families, tested through their queries"},
    {"verify/generate/passing_planes.hpp", "a part of the families, tested through their queries"},
    {"verify/generate/random.hpp", "a part of the families, tested through their queries"},
    {"verify/generate/family_builder.hpp", "a part of the families, tested through their queries"},
    {"verify/generate/coordinate_sampler.hpp",
     "a part of the families, tested through their queries"},
});

/// Parts of a module that only permissions which name them include, not one for the whole module.
constexpr std::array<std::string_view, 2> closed_parts{"exact/checker/", "filters/derivation/"};

constexpr std::array<std::string_view, 5> modules{"exact", "filters", "fast", "adapters", "verify"};

// ---- The rules ----------------------------------------------------------------------------------

bool fits(std::string_view path, std::string_view pattern) {
  return pattern.ends_with('/') ? path.starts_with(pattern) : path == pattern;
}

bool is_header(std::string_view path) { return path.ends_with(".hpp") || path.ends_with(".h"); }

/// The longest `from` that fits the path; empty if there is no permission for it.
std::string_view rule_for(std::string_view path) {
  std::string_view longest;
  for (const auto& [from, target] : permissions) {
    if (fits(path, from) && from.size() > longest.size()) longest = from;
  }
  return longest;
}

/// An include: the name between the brackets or quotes; empty if there are neither.
struct Include {
  std::string name;
  bool angle = false;
};

bool is_standard_library(const Include& include) {
  return include.angle && !include.name.empty() &&
         include.name.find_first_of("/.") == std::string::npos;
}

const std::map<std::string, std::string, std::less<>>& public_headers();

/// The path in the tree of an included file.
std::string included_path(const Include& include) {
  const auto header = public_headers().find(include.name);
  return header != public_headers().end() ? header->second : include.name;
}

bool is_permitted(std::string_view path, const Include& include) {
  if (is_standard_library(include)) return true;
  if (include.name.find("..") != std::string::npos) return false;
  const std::string target = included_path(include);
  const std::string_view rule = rule_for(path);
  return std::ranges::any_of(permissions, [&](const Permission& permission) {
    const bool is_closed = std::ranges::any_of(closed_parts, [&](std::string_view part) {
      return target.starts_with(part) && !permission.target.starts_with(part);
    });
    return !is_closed && permission.from == rule && fits(target, permission.target);
  });
}

/// The folder of verify that a path is in; empty for other paths.
std::string_view verify_folder(std::string_view path) {
  constexpr std::string_view verify = "verify/";
  if (!path.starts_with(verify)) return {};
  path.remove_prefix(verify.size());
  return path.substr(0, path.find('/') == std::string_view::npos ? 0 : path.find('/'));
}

/// True if the include obeys verify_layers().
bool is_in_layers(std::string_view path, const Include& include) {
  const std::string_view from = verify_folder(path), target = verify_folder(include.name);
  if (from.empty() || target.empty() || from == target) return true;
  const auto layer = std::ranges::find(verify_layers(), from, &Layer::folder);
  return layer != verify_layers().end() && std::ranges::count(layer->includes, target) != 0;
}

std::string_view without_leading_space(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
  return text;
}

/// Takes the preprocessor's directive from the front of a line; empty for other lines.
std::string_view take_directive(std::string_view& line) {
  line = without_leading_space(line);
  if (!line.starts_with('#')) return {};
  line = without_leading_space(line.substr(1));
  const auto is_word = [](char c) {
    return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_';
  };
  std::size_t length = 0;
  while (length < line.size() && is_word(line[length])) ++length;
  const std::string_view word = line.substr(0, length);
  line = without_leading_space(line.substr(word.size()));
  return word;
}

/// Parses the text after #include.
Include parse_target(std::string_view text) {
  if (!text.starts_with('<') && !text.starts_with('"')) return {};
  const bool angle = text.front() == '<';
  const std::size_t end = text.find(angle ? '>' : '"', 1);
  if (end == std::string_view::npos) return {};
  return {.name = std::string(text.substr(1, end - 1)), .angle = angle};
}

/// Every include of a file that its module may not make, as "path:line: name".
Violations forbidden_includes(const std::string& path, std::string_view text) {
  Violations result;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::string_view directive = take_directive(line);
    const bool extension = directive == "include_next" || directive == "import";
    if (directive != "include" && !extension) continue;
    const Include include = parse_target(line);
    if (extension || !is_permitted(path, include) || !is_in_layers(path, include)) {
      std::string violation = path;
      violation.append(":").append(std::to_string(number)).append(": ").append(include.name);
      result.push_back(std::move(violation));
    }
  }
  return result;
}

std::string test_of(std::string_view header) {
  std::string result = "tests/";
  result.append(header.substr(0, header.rfind('.'))).append("_test.cpp");
  return result;
}

template <class Exceptions>
bool is_one_of(std::string_view header, const Exceptions& exceptions) {
  return std::ranges::any_of(
      exceptions, [&](const Exception& exception) { return exception.header == header; });
}

bool is_in_a_module(std::string_view path) { return !rule_for(path).empty(); }

/// The headers of the modules that have neither a test file nor an exemption.
Violations untested_headers(const Tree& tree) {
  Violations result;
  for (const auto& [path, text] : tree) {
    if (!is_in_a_module(path) || !is_header(path) || is_one_of(path, headers_without_test)) {
      continue;
    }
    if (!tree.contains(test_of(path))) result.push_back(path);
  }
  return result;
}

/// The headers, of modules and tests, that do not begin as the rule says.
Violations malformed_headers(const Tree& tree) {
  Violations result;
  for (const auto& [path, text] : tree) {
    if (!is_header(path)) continue;
    if (!text.starts_with("#pragma once\n")) result.push_back(path + ": no #pragma once");
    if (text.find("\n/// \\file\n") == std::string::npos) result.push_back(path + ": no \\file");
  }
  return result;
}

/// C or C++ under an extension that this project does not use.
Violations foreign_extensions(const Tree& tree) {
  static constexpr std::array<std::string_view, 12> foreign{
      ".h", ".hh", ".hxx", ".c", ".cc", ".cxx", ".inc", ".inl", ".ipp", ".ixx", ".tpp", ".cppm"};
  Violations result;
  for (const auto& file : tree) {
    const std::string& path = file.first;
    if (is_one_of(path, foreign_headers)) continue;
    if (std::ranges::any_of(foreign, [&](auto extension) { return path.ends_with(extension); }))
      result.push_back(path);
  }
  return result;
}

/// The namespace of a source of verify: that of its folder; empty for other files, and for the
/// program itself.
std::string namespace_of(std::string_view path) {
  if (!path.starts_with("verify/") || path == "verify/cli/main.cpp") return "";
  if (!is_header(path) && !path.ends_with(".cpp")) return "";
  const std::string_view inside = path.substr(std::string_view("verify/").size());
  const std::size_t slash = inside.find('/');
  if (slash == std::string_view::npos) return "";
  const std::string folder(inside.substr(0, slash));
  return folder == "baselines" ? "touchstone::baselines" : "touchstone::verify::" + folder;
}

/// The sources of verify that are not in the namespace of their folder, or in one inside it.
Violations foreign_namespaces(const Tree& tree) {
  Violations result;
  for (const auto& [path, text] : tree) {
    const std::string expected = namespace_of(path);
    if (expected.empty()) continue;
    const bool is_there = text.find("\nnamespace " + expected + " {\n") != std::string::npos ||
                          text.find("\nnamespace " + expected + "::") != std::string::npos;
    if (!is_there) result.push_back(path);
  }
  return result;
}

// ---- The source tree ----------------------------------------------------------------------------

std::string read(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// The folders of public headers: include/touchstone/ in every module, and others that stand for
/// other libraries.
constexpr std::array<std::string_view, 3> public_folders{
    "include/touchstone/filters/", "include/touchstone/", "include/tight_inclusion/"};

/// The path without the folder of public headers, if it has one.
std::string tree_path(std::string path) {
  for (const std::string_view folder : public_folders) {
    const std::size_t at = path.find(folder);
    if (at != std::string::npos) return path.erase(at, folder.size());
  }
  return path;
}

Tree read_source_tree() {
  const std::filesystem::path root = tests::source_folder();
  std::vector<std::string> folders(modules.begin(), modules.end());
  folders.emplace_back("tests");
  Tree tree;
  for (const std::string& folder : folders) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
      if (!entry.is_regular_file()) continue;
      tree.emplace(tree_path(entry.path().lexically_relative(root).generic_string()),
                   read(entry.path()));
    }
  }
  return tree;
}

const Tree& source_tree() {
  static const Tree tree = read_source_tree();
  return tree;
}

/// The public headers: their paths in the tree, by the names under which they are included.
std::map<std::string, std::string, std::less<>> read_public_headers() {
  const std::filesystem::path root = tests::source_folder();
  std::map<std::string, std::string, std::less<>> result;
  for (const std::string_view module : modules) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / module)) {
      const std::string path = entry.path().lexically_relative(root).generic_string();
      const std::size_t at = path.find("/include/");
      if (at == std::string::npos || !is_header(path) || !is_in_a_module(path)) continue;
      result.emplace(path.substr(at + std::string_view("/include/").size()), tree_path(path));
    }
  }
  return result;
}

const std::map<std::string, std::string, std::less<>>& public_headers() {
  static const auto headers = read_public_headers();
  return headers;
}

TEST(SourceTree, HasAHeaderInEveryModule) {
  for (const std::string_view module : modules) {
    EXPECT_TRUE(std::ranges::any_of(source_tree(), [&](const auto& file) {
      return file.first.starts_with(std::string(module) + "/") && is_header(file.first);
    })) << module;
  }
  EXPECT_TRUE(source_tree().contains("exact/query.hpp"));
  EXPECT_TRUE(source_tree().contains("tests/architecture_test.cpp"));
}

TEST(SourceTree, ModulesIncludeOnlyWhatTheyMay) {
  for (const auto& [path, text] : source_tree()) {
    // Manuals may show the includes of a user's program.
    if (is_in_a_module(path) && !path.ends_with(".md")) {
      EXPECT_EQ(forbidden_includes(path, text), Violations{}) << path;
    }
  }
}

/// The includes obey the layers, and each permission of a layer is used.
TEST(SourceTree, FoldersOfVerifyAreInLayers) {
  std::vector<std::string_view> above;
  for (const auto& [folder, includes] : verify_layers()) {
    for (const std::string_view target : includes) {
      EXPECT_EQ(std::ranges::count(above, target), 1) << folder << " includes " << target;
      const std::string include = "#include \"verify/" + std::string(target) + "/";
      const std::string inside = "verify/" + std::string(folder) + "/";
      EXPECT_TRUE(std::ranges::any_of(source_tree(),
                                      [&](const auto& file) {
                                        return file.first.starts_with(inside) &&
                                               file.second.find(include) != std::string::npos;
                                      }))
          << folder << " need not include " << target;
    }
    above.push_back(folder);
  }
}

TEST(SourceTree, EveryHeaderHasATest) { EXPECT_EQ(untested_headers(source_tree()), Violations{}); }

TEST(SourceTree, ExceptionsAreNeeded) {
  for (const auto& [header, reason] : headers_without_test) {
    EXPECT_TRUE(source_tree().contains(header)) << header;
    EXPECT_FALSE(source_tree().contains(test_of(header))) << header;
    EXPECT_FALSE(reason.empty()) << header;
  }
  for (const auto& [header, reason] : foreign_headers) {
    EXPECT_TRUE(source_tree().contains(header)) << header;
    EXPECT_FALSE(reason.empty()) << header;
  }
}

TEST(SourceTree, EveryHeaderBeginsWithPragmaOnceAndItsIdea) {
  EXPECT_EQ(malformed_headers(source_tree()), Violations{});
}

TEST(SourceTree, EveryFolderOfVerifyIsANamespace) {
  EXPECT_EQ(foreign_namespaces(source_tree()), Violations{});
}

TEST(SourceTree, HasNoSourceOfAnotherExtension) {
  EXPECT_EQ(foreign_extensions(source_tree()), Violations{});
}

/// The C headers can be included alone or together: their types in common are the same text.
TEST(SourceTree, CHeadersHaveTheirTypesInCommon) {
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

struct Planted {
  std::string path;
  std::string_view text;
};

TEST(PlantedFault, EachForbiddenIncludeIsFound) {
  const std::vector<Planted> faults{
      // Another module, a package of another module, a header of the system, the tests.
      {"exact/oracle.cpp", "#include \"fast/solver.hpp\"\n"},
      {"fast/solver.cpp", "#include <gmpxx.h>\n"},
      {"verify/dataset.cpp", "#include <stdio.h>\n"},
      {"filters/bound.hpp", "#include \"tests/support/random.hpp\"\n"},
      // A longer path than the permitted one, and another header of a permitted package.
      {"fast/deep/er.hpp", "#include \"exact/query.hpp.in\"\n"},
      {"verify/baselines/solver.cpp", "#include <boost/multiprecision/cpp_int.hpp>\n"},
      // Files and folders with their own permissions have no others, and alone have them.
      {"fast/step.cpp", "#include <oneapi/tbb/parallel_for.h>\n"},
      {"verify/io/terminal.cpp", "#include <linux/seccomp.h>\n"},
      {"exact/query.hpp", "#include <CGAL/Polynomial.h>\n"},
      {"verify/plugin.h", "#include \"verify/data/query_source.hpp\"\n"},
      {"exact/checker/proof.cpp", "#include \"exact/query.hpp\"\n"},
      // The folders of verify: an include against their order, a generator of another folder, a
      // folder without a rule.
      {"verify/io/csv.cpp", "#include \"verify/data/dataset.hpp\"\n"},
      {"verify/judge/judge.cpp", "#include \"verify/solvers/solver.hpp\"\n"},
      {"verify/stability/new.cpp", "#include \"verify/fuzz/fuzz.hpp\"\n"},
      {"verify/unknown/new.cpp", "#include \"verify/io/csv.hpp\"\n"},
      // A closed part, included by its own module and by another.
      {"exact/oracle.cpp", "#include \"exact/checker/checker.hpp\"\n"},
      {"filters/bound.hpp", "#include \"filters/derivation/rounding_model.hpp\"\n"},
      {"fast/solver.cpp", "#include \"filters/derivation/rounding_model.hpp\"\n"},
  };
  for (const auto& [path, text] : faults) {
    EXPECT_EQ(forbidden_includes(path, text).size(), 1U) << path << ": " << text;
  }
}

TEST(PlantedFault, NoSpellingHidesAnInclude) {
  for (const std::string_view text :
       {"#include<gmpxx.h>", "  #include <gmpxx.h>", "#\tinclude <gmpxx.h>",
        "# include \"gmpxx.h\" // why", "#include \"fast/../exact/oracle.hpp\"",
        "#include \"../exact/oracle.hpp\"", "#include \"solver.hpp\"", "#include \"vector\"",
        "#include ORACLE", "#include <vector", "#include", "#include_next <vector>",
        "#import <vector>", "#include <>"}) {
    EXPECT_EQ(forbidden_includes("fast/solver.cpp", text).size(), 1U) << text;
  }
}

TEST(PlantedFault, IsReportedWithItsLine) {
  static constexpr std::string_view text =
      "#include \"fast/solver.hpp\"\n\n#include <vector>\n#include <gmp.h>\nint x;\n"
      "#include \"exact/oracle.hpp\"";
  EXPECT_EQ(forbidden_includes("fast/solver.cpp", text),
            (Violations{"fast/solver.cpp:4: gmp.h", "fast/solver.cpp:6: exact/oracle.hpp"}));
}

TEST(PlantedFault, PermittedIncludesAreNotFaults) {
  const std::vector<Planted> files{
      {"exact/query.hpp", "#include <Eigen/Core>\n#include <span>\n"},
      {"exact/checker/proof.cpp", "#include \"exact/checker/proof.hpp\"\n#include <gmpxx.h>\n"},
      {"filters/derivation/model.cpp",
       "#include \"filters/derivation/model.hpp\"\n#include <mpfr.h>\n"},
      {"verify/jobs/prove.cpp", "#include \"exact/checker/checker.hpp\"\n"},
      {"fast/solver.cpp", "#include \"exact/query.hpp\"\n#include <Eigen/Core>\n"},
      {"fast/platform/threads.hpp", "#include <oneapi/tbb/info.h>\n"},
      {"verify/solvers/linux/a.cpp", "#include <linux/seccomp.h>\n"},
      {"fast/solver.cpp", "// #include <gmp.h>\nint included;\n#define X \"#include <gmp.h>\"\n"},
  };
  for (const auto& [path, text] : files) {
    EXPECT_EQ(forbidden_includes(path, text), Violations{}) << path;
  }
}

TEST(PlantedFault, AHeaderWithoutATestIsFound) {
  const Tree tree{{"exact/new.hpp", ""},
                  {"exact/old.hpp", ""},
                  {"exact/old.cpp", ""},
                  {"exact/lonely.cpp", ""},
                  {"tests/exact/old_test.cpp", ""},
                  {"verify/deep/er.hpp", ""},
                  {"verify/plain.h", ""},
                  {"verify/plugin.h", ""},
                  {"tests/verify/plugin_test.cpp", ""},
                  {"tests/verify/er_test.cpp", ""},
                  {"tests/support/random.hpp", ""},
                  {"verify/data/query_source.hpp", ""}};
  EXPECT_EQ(untested_headers(tree),
            (Violations{"exact/new.hpp", "verify/deep/er.hpp", "verify/plain.h"}));
}

TEST(PlantedFault, AMalformedHeaderIsFound) {
  const Tree tree{{"exact/good.hpp", "#pragma once\n\n/// \\file\n/// Idea.\n"},
                  {"fast/late.hpp", "// Comment\n#pragma once\n\n/// \\file\n"},
                  {"fast/mute.hpp", "#pragma once\n\n// Names no \\file.\n"},
                  {"fast/plain.cpp", "int x;\n"},
                  {"verify/plugin.h", "#ifndef PLUGIN\n\n/// \\file\n"},
                  {"tests/support/bare.hpp", ""}};
  EXPECT_EQ(malformed_headers(tree),
            (Violations{"fast/late.hpp: no #pragma once", "fast/mute.hpp: no \\file",
                        "tests/support/bare.hpp: no #pragma once",
                        "tests/support/bare.hpp: no \\file", "verify/plugin.h: no #pragma once"}));
}

TEST(PlantedFault, ASourceInAnotherNamespaceIsFound) {
  const Tree tree{{"verify/io/a.cpp", "\nnamespace touchstone::verify::io {\n"},
                  {"verify/io/b.hpp", "\nnamespace touchstone::verify {\n"},
                  {"verify/data/c.cpp", "\nnamespace touchstone::verify::io {\n"},
                  {"verify/baselines/d.cpp", "\nnamespace touchstone::baselines {\n"},
                  {"verify/report/page/page.js", ""},
                  {"verify/cli/main.cpp", ""},
                  {"verify/plugin.h", ""},
                  {"fast/e.cpp", ""}};
  EXPECT_EQ(foreign_namespaces(tree), (Violations{"verify/data/c.cpp", "verify/io/b.hpp"}));
}

TEST(PlantedFault, ASourceOfAnotherExtensionIsFound) {
  const Tree tree{{"exact/a.hpp", ""},     {"exact/a.cpp", ""},     {"exact/CMakeLists.txt", ""},
                  {"fast/hidden.h", ""},   {"fast/b.cc", ""},       {"tests/data.csv", ""},
                  {"verify/plugin.h", ""}, {"verify/plugin.c", ""}, {"fast/plugin.h", ""}};
  EXPECT_EQ(foreign_extensions(tree),
            (Violations{"fast/b.cc", "fast/hidden.h", "fast/plugin.h", "verify/plugin.c"}));
}

}  // namespace
}  // namespace touchstone::tests::architecture_test
