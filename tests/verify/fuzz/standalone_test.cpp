#include "verify/fuzz/standalone.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/queries.hpp"
#include "tests/support/tool_test.hpp"
#include "tests/verify/data/dataset_fixture.hpp"

// Tests that compile the golden files as users do: standalone_plugin.cpp as a program, the other
// two against declarations of the public interfaces (public/).

namespace touchstone::verify::fuzz::standalone_test {
namespace {

/// A vertex that falls through a triangle, with contact at t = 1/3.
Reproduction miss() {
  return {.what = judge::Fault::false_negative,
          .failing = {.query = {Kind::vertex_face, tests::over_triangle(1, 1, 1, -2).query},
                      .answer = {.verdict = fast::Verdict::no},
                      .collides = true,
                      .toi = {{0.33333333333333331, 0.33333333333333337}},
                      .truth = "collision after 0.3333333333333333 and before 0.33333333333333337"},
          .solver = {.method = "mine",
                     .plugin = "/tmp/mine.so",
                     .options = {.tolerance = 1e-6, .max_checks = 1000}}};
}

Reproduction miss_of_edges() {
  Reproduction result = miss();
  result.failing.query = {Kind::edge_edge, tests::over_edge(0.5, 0.25, 0.1, -0.1).query};
  result.failing.truth = "collision at 0.5";
  return result;
}

/// The file after its first line, which turns formatting off.
std::string golden(const std::string& name) {
  const std::string text =
      data::test::contents(tests::source_folder() + "/tests/verify/fuzz/" + name);
  return text.substr(text.find('\n') + 1);
}

TEST(AsMain, IsTheProgramThatIsCompiledHere) {
  EXPECT_EQ(as_main(miss(), CallInterface::plugin), golden("standalone_plugin.cpp"));
  EXPECT_EQ(as_main(miss_of_edges(), CallInterface::ticcd), golden("standalone_ticcd.cpp"));
  EXPECT_EQ(as_main(miss_of_edges(), CallInterface::ipc_toolkit),
            golden("standalone_ipc_toolkit.cpp"));
}

TEST(AsMain, EndsWithOneForTheFinding) {
  const auto has = [](judge::Fault what, const std::string& part) {
    Reproduction found = miss();
    found.what = what;
    EXPECT_NE(as_main(found, CallInterface::plugin).find(part), std::string::npos)
        << to_string(what) << '\n'
        << as_main(found, CallInterface::plugin);
  };
  has(judge::Fault::false_negative, "return answer.verdict == 0 ? 1 : 0;");
  has(judge::Fault::false_positive, "return answer.verdict == 1 ? 1 : 0;");
  has(judge::Fault::beyond_tolerance, "return answer.verdict == 1 ? 1 : 0;");
  has(judge::Fault::asymmetry, "return answer.verdict == 0 ? 1 : 0;");
  has(judge::Fault::late_toi,
      "return answer.verdict == 1 && answer.toi_lower > 0.3333333333333333 ? 1 : 0;");
  has(judge::Fault::early_toi_upper,
      "return answer.verdict == 1 && answer.toi_upper < 0.33333333333333337 ? 1 : 0;");
  has(judge::Fault::no_verdict, "return answer.verdict == 3 ? 1 : 0;");
  has(judge::Fault::undecided, "return answer.verdict == 2 ? 1 : 0;");
  has(judge::Fault::crash, "  return 0;\n");
}

/// By the interface of plugins, whatever is asked for; by that for curves also about a straight
/// query, if the plugin has no other.
TEST(AsMain, AsksPluginsAboutCurves) {
  const auto has = [](const Reproduction& found, const std::string& part) {
    const std::string text = as_main(found, CallInterface::ticcd);
    EXPECT_NE(text.find(part), std::string::npos) << part << '\n' << text;
  };
  Reproduction found = miss();
  const QueryShape shape{.kind = Kind::edge_edge, .degree = 2, .is_rational = true};
  found.failing.query = {shape, std::vector<double>(shape.numbers_of_query(), 1.5)};
  has(found, "const double x[12][4] = {  // control points and weights, from t=0 to t=1\n");
  has(found, "      {1.5, 1.5, 1.5, 1.5},  // eb1\n");
  has(found, "dlsym(library, \"touchstone_plugin_solve_curved\")");
  has(found, "(solve)(1, 2, 1, x[0], &options, &answer);  // edge-edge, rational, degree 2\n");
  found.failing.query = miss().failing.query;
  found.solver.terms.most_degree = greatest_degree;
  const std::string text = as_main(found, CallInterface::plugin);
  EXPECT_NE(text.find("if (solve == nullptr && solve_curved == nullptr) return 2;"),
            std::string::npos);
  EXPECT_NE(text.find("if (solve != nullptr) reinterpret_cast<Solve*>(solve)(0, x[0],"),
            std::string::npos);
  EXPECT_NE(text.find("if (solve == nullptr) reinterpret_cast<SolveCurved*>(solve_curved)(0, 1, 0, "
                      "x[0],"),
            std::string::npos);
}

TEST(CallInterface, HasANameAndFollowsFromTheSolver) {
  for (const CallInterface interface :
       {CallInterface::plugin, CallInterface::ticcd, CallInterface::ipc_toolkit}) {
    EXPECT_EQ(call_interface_from_string(to_string(interface)), interface);
  }
  EXPECT_FALSE(call_interface_from_string("none"));
  EXPECT_EQ(usual_interface({.method = "tight_inclusion_released"}), CallInterface::ticcd);
  EXPECT_EQ(usual_interface({.method = "accd"}), CallInterface::ipc_toolkit);
  EXPECT_EQ(usual_interface({.method = "rp"}), CallInterface::plugin);
  EXPECT_EQ(usual_interface({.method = "accd", .plugin = "/tmp/a.so"}), CallInterface::plugin);
}

class Standalone : public tests::ToolTest {};

/// The program runs with a plugin that always says yes, which misses no collision, and without one.
TEST_F(Standalone, AsksAPlugin) {
  const std::filesystem::path beside = tests::plugin_library("always_yes");
  const std::string program = (beside.parent_path() / "standalone_plugin").string();
  const tests::Outcome right =
      finish(start({tests::plugin_library("always_yes")}, to_file, program));
  EXPECT_EQ(right.status, 0) << right.out << right.err;
  EXPECT_TRUE(tests::contains(right.out, "verdict 1, ")) << right.out;
  EXPECT_TRUE(tests::contains(right.out, "truth: collision after 0.33")) << right.out;
  const tests::Outcome wrong =
      finish(start({tests::plugin_library("always_no")}, to_file, program));
  EXPECT_EQ(wrong.status, 1) << wrong.out << wrong.err;
  EXPECT_TRUE(tests::contains(wrong.out, "verdict 0, ")) << wrong.out;
  EXPECT_EQ(finish(start({}, to_file, program)).status, 2);
  EXPECT_EQ(finish(start({path("none.so")}, to_file, program)).status, 2);
}

/// The program is linked with our adapter, which is right.
TEST_F(Standalone, AsksThroughTheInterfaceOfTightInclusion) {
  const std::filesystem::path folder =
      std::filesystem::path(tests::plugin_library("always_yes")).parent_path();
  const tests::Outcome right = finish(start({}, to_file, (folder / "standalone_ticcd").string()));
  EXPECT_EQ(right.status, 0) << right.out << right.err;
  EXPECT_TRUE(tests::contains(right.out, "yes, toi 0.49999999999")) << right.out;
}

}  // namespace
}  // namespace touchstone::verify::fuzz::standalone_test
