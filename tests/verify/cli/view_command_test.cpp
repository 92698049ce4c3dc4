// The command touchstone view (verify/cli/view_command.cpp), as users run it.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/tool_test.hpp"

namespace touchstone::verify::cli::view_command_test {
namespace {

using tests::contains;

const std::string falling = "1 1 1 0 0 0 4 0 0 0 4 0  1 1 -2 0 0 0 4 0 0 0 4 0";

/// The same as a row of a dataset; the vertex ends at `end`.
std::string row(const std::string& end) {
  const std::string triangle = "0,1,0,1,0,1\n4,1,0,1,0,1\n0,1,4,1,0,1\n";
  return "1,1,1,1,1,1\n" + triangle + "1,1,1,1," + end + ",1\n" + triangle;
}

class ViewCommand : public tests::ToolTest {
 protected:
  /// The queries of the page.
  [[nodiscard]] nlohmann::json queries(const std::string& name) const {
    const std::string page = read(name);
    const std::string start = R"(<script type="application/json" id="queries">)";
    const std::size_t from = page.find(start);
    if (from == std::string::npos) return {};
    const std::size_t first = from + start.size();
    return nlohmann::json::parse(page.substr(first, page.find("</script>", first) - first));
  }
  [[nodiscard]] tests::Outcome view(std::vector<std::string> words) const {
    words.insert(words.begin(), "view");
    words.insert(words.end(), {"--out", path("page.html")});
    return run(words);
  }
};

TEST_F(ViewCommand, AQueryOfTheCommandLine) {
  const tests::Outcome outcome = view({"--kind", "vertex-face", "--points", falling});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, path("page.html") + "\n");
  const nlohmann::json page = queries("page.html");
  ASSERT_EQ(page.size(), 1U);
  EXPECT_EQ(page[0].at("truth").at("toi").at("exact"), "1/3");
  ASSERT_EQ(page[0].at("answers").size(), 2U) << "those that promise something";
  EXPECT_EQ(page[0].at("answers")[0].at("solver"), "certified");
}

TEST_F(ViewCommand, RowsFindingsAndCertificatesByThoseWhoAreNamed) {
  const std::string data = write("vertex-face.csv", row("-2") + row("-3") + row("2"));
  ASSERT_EQ(run({"prove", data, "--out", path("proofs.cert")}).status, 0);
  const tests::Outcome outcome =
      view({data, path("proofs.cert"), "--index", "1", "--index", "2", "--method", "accd",
            "--plugin", tests::plugin_library("always_yes")});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json page = queries("page.html");
  ASSERT_EQ(page.size(), 4U);
  EXPECT_EQ(page[0].at("label"), data + ":1");
  EXPECT_EQ(page[0].at("coordinates"), page[2].at("coordinates"));
  EXPECT_EQ(page[2].at("certificate").at("given"), true);
  EXPECT_EQ(page[2].at("certificate").at("accepted"), true);
  for (const nlohmann::json& query : page) {
    ASSERT_EQ(query.at("answers").size(), 2U);
    EXPECT_EQ(query.at("answers")[0].at("solver"), "accd");
    EXPECT_EQ(query.at("answers")[1].at("verdict"), "yes");
  }
  EXPECT_EQ(page[1].at("answers")[1].at("faults"), nlohmann::json::array({"false positive"}));
}

TEST_F(ViewCommand, AFindingOfTheFuzzerComesWithItsAnswer) {
  ASSERT_EQ(run({"fuzz", "--method", "msrf", "--only", "false_negative", "--most-findings", "1",
                 "--seconds", "60", "--json", path("found.json"), "--view", path("found.html")})
                .status,
            1);
  const tests::Outcome outcome = view({path("found.json")});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json page = queries("page.html");
  ASSERT_EQ(page.size(), 1U);
  EXPECT_EQ(page[0].at("truth").at("collides"), true);
  const nlohmann::json& recorded = page[0].at("answers").at(0);
  EXPECT_EQ(recorded.at("solver"), "msrf");
  EXPECT_EQ(recorded.at("recorded"), true);
  EXPECT_EQ(recorded.at("faults"), nlohmann::json::array({"false negative"}));
  const nlohmann::json of_fuzz = queries("found.html");
  ASSERT_EQ(of_fuzz.size(), 1U) << "fuzz has written the same page";
  EXPECT_EQ(of_fuzz[0].at("coordinates"), page[0].at("coordinates"));
  EXPECT_EQ(of_fuzz[0].at("label"), "finding 0, false_negative of msrf");
  EXPECT_EQ(of_fuzz[0].at("answers").at(1).at("solver"), "certified");
}

TEST_F(ViewCommand, AStepWithItsFirstPairs) {
  const std::string triangle = "v 0 0 0\nv 4 0 0\nv 0 4 0\n";
  const std::string before = write("0.obj", triangle + "v 1 1 1\nf 1 2 3\np 4\n");
  const std::string after = write("1.obj", triangle + "v 1 1 -2\nf 1 2 3\np 4\n");
  const tests::Outcome outcome = view({"--step", before, after});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json page = queries("page.html");
  ASSERT_EQ(page.size(), 1U);
  EXPECT_EQ(page[0].at("label"), "0.obj to 1.obj: vertex 3, face 0");
  EXPECT_EQ(page[0].at("truth").at("toi").at("exact"), "1/3");
  EXPECT_TRUE(contains(read("page.html"), R"("name":"vertex 3, face 0")"));
}

TEST_F(ViewCommand, AtASeparationOfTheUser) {
  const tests::Outcome outcome = view(
      {"--kind", "vertex-face", "--points", falling, "--min-separation", "0.5", "--norm", "l2"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json page = queries("page.html");
  EXPECT_EQ(page.at(0).at("min_separation"), "0x1p-1");
  EXPECT_EQ(page.at(0).at("truth").at("toi").at("exact"), "1/6");
}

TEST_F(ViewCommand, BadInputLeavesNoPage) {
  const std::string data = write("vertex-face.csv", row("-2"));
  const auto error_of = [&](const std::vector<std::string>& words) {
    const tests::Outcome outcome = view(words);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(read("page.html"), "");
    return outcome.err;
  };
  EXPECT_TRUE(contains(error_of({}), "no query: name a file, --points or --step"));
  EXPECT_TRUE(contains(error_of({"--points", falling}), "--points needs --kind"));
  EXPECT_TRUE(contains(error_of({"--points", "1 2", "--kind", "edge-edge"}),
                       "2 numbers, not the 24 of a query"));
  EXPECT_TRUE(contains(error_of({data, "--index", "7"}), "there is no query 7; it has 1"));
  EXPECT_TRUE(contains(error_of({path("missing.csv")}), "missing.csv"));
  EXPECT_EQ(run({"view", data, "--out", data}).status, 2);
  EXPECT_EQ(read("vertex-face.csv"), row("-2")) << "an input is no output";
}

}  // namespace
}  // namespace touchstone::verify::cli::view_command_test
