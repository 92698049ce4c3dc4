// Tests of `touchstone view` (verify/cli/view_command.cpp) that run the tool.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/tool_test.hpp"

namespace touchstone::verify::cli::view_command_test {
namespace {

using tests::contains;

const std::string falling = "1 1 1 0 0 0 4 0 0 0 4 0  1 1 -2 0 0 0 4 0 0 0 4 0";

/// The falling vertex as a row of a dataset; it ends at `end`.
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

TEST_F(ViewCommand, LabelsAndNotesOfJsonAreShown) {
  const std::string file = write("examples.json", R"([{"label": "falling", "note": "a note",
    "kind": "vertex-face", "coordinates": [1,1,1, 0,0,0, 4,0,0, 0,4,0, 1,1,-2, 0,0,0, 4,0,0, 0,4,0]}])");
  ASSERT_EQ(view({file}).status, 0);
  EXPECT_EQ(queries("page.html").at(0).at("label"), "falling");
  EXPECT_EQ(queries("page.html").at(0).at("notes"), nlohmann::json::array({"a note"}));
}

TEST_F(ViewCommand, ALivePageHasItsSolversAndMayRunThem) {
  const std::vector<std::string> words{"--kind", "vertex-face", "--points", falling};
  ASSERT_EQ(view(words).status, 0);
  EXPECT_EQ(read("page.html").find("wasm-unsafe-eval"), std::string::npos);
  std::vector<std::string> live = words;
  live.insert(live.end(), {"--live", write("solvers.js", "const mark = 4711;")});
  ASSERT_EQ(view(live).status, 0);
  EXPECT_NE(read("page.html").find("const mark = 4711;"), std::string::npos);
  EXPECT_NE(read("page.html").find("'wasm-unsafe-eval'"), std::string::npos);
  live.back() = path("missing.js");
  EXPECT_EQ(view(live).status, 2);
  EXPECT_NE(read("err").find("missing.js"), std::string::npos);
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
  EXPECT_EQ(page[1].at("answers")[1].at("faults"),
            nlohmann::json::array({"false positive", "beyond tolerance"}));
  EXPECT_EQ(page[1].at("answers")[1].at("breaks_promise"), true)
      << "it claims contact, and they stay 1 apart";
}

TEST_F(ViewCommand, QueriesOnCurvesAndTheirCertificates) {
  const auto curve = [](const std::string& height) {
    const std::string triangle = "0,0,0\n4,0,0\n0,4,0\n";
    return "1,1,1\n" + triangle + "1,1," + height + "\n" + triangle + "1,1,1\n" + triangle;
  };
  const std::string data = write("vertex-face.csv", "degree,2\n" + curve("-1") + curve("0"));
  ASSERT_EQ(run({"curved", data, "--proof", path("proofs.cert")}).status, 0);
  const tests::Outcome outcome = view({data, path("proofs.cert")});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json page = queries("page.html");
  ASSERT_EQ(page.size(), 4U);
  EXPECT_EQ(page[0].at("label"), data + ":0");
  EXPECT_EQ(page[0].at("control"), page[2].at("control"));
  EXPECT_EQ(page[0].at("truth").at("toi").at("exact"), "1/2");
  EXPECT_EQ(page[3].at("truth").at("collides"), false);
  EXPECT_EQ(page[3].at("certificate").at("given"), true);
  for (const nlohmann::json& query : page) {
    EXPECT_EQ(query.at("certificate").at("accepted"), true);
    EXPECT_EQ(query.at("notes"), nlohmann::json::array());
    ASSERT_EQ(query.at("answers").size(), 2U) << "these alone take curves";
    EXPECT_EQ(query.at("answers")[0].at("solver"), "certified");
    EXPECT_EQ(query.at("answers")[0].at("faults"), nlohmann::json::array());
    EXPECT_EQ(query.at("answers")[1].at("solver"), "tight_inclusion");
    EXPECT_EQ(query.at("answers")[1].at("breaks_promise"), false);
  }
  ASSERT_EQ(view({data, "--index", "1", "--method", "accd", "--min-separation", "0.5"}).status, 0);
  const nlohmann::json other = queries("page.html").at(0);
  EXPECT_EQ(other.at("truth").at("toi").at("exact"), "1/2");
  EXPECT_EQ(other.at("answers"), nlohmann::json::array());
  EXPECT_EQ(other.at("notes"),
            nlohmann::json::array({"accd is not asked: it takes straight lines alone."}));
}

TEST_F(ViewCommand, CurvesOfDifferentDegreesAreShownWithoutAnAnswer) {
  const std::string proof =
      write("mixed.cert",
            "touchstone-certificates 2\nquery vertex_face\n"
            "curve 2\npoint 1 1 -3/4\npoint 1 1 5/4\npoint 1 1 -3/4\n"
            "curve 1\npoint 0 0 0\npoint 0 0 0\ncurve 0\npoint 4 0 0\ncurve 0\npoint 0 4 0\n"
            "claim time_of_impact 0x1.fffffffffffffp-3 0x1p-2\n"
            "separate 0 0x1.fffffffffffffp-3 face -\ncontact time 0x1p-2\n"
            "at triangle 0 1 2 z\nend\ncertificates 1\n");
  ASSERT_EQ(view({proof}).status, 0);
  const nlohmann::json query = queries("page.html").at(0);
  EXPECT_EQ(query.at("truth").at("toi").at("exact"), "1/4");
  EXPECT_EQ(query.at("certificate").at("accepted"), true);
  EXPECT_EQ(query.at("answers"), nlohmann::json::array());
  EXPECT_EQ(query.at("notes"),
            nlohmann::json::array(
                {"certified is not asked: the curves differ in degree.",
                 "tight_inclusion is not asked: it takes curves of one degree, 2 or 3."}));
}

TEST_F(ViewCommand, CompressedCertificates) {
  const std::string data = write("vertex-face.csv", row("-2") + row("2"));
  ASSERT_EQ(run({"prove", data, "--out", path("proofs.cert.zst")}).status, 0);
  const tests::Outcome outcome = view({path("proofs.cert.zst")});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json page = queries("page.html");
  ASSERT_EQ(page.size(), 2U);
  for (const nlohmann::json& query : page) {
    EXPECT_EQ(query.at("certificate").at("given"), true);
    EXPECT_EQ(query.at("certificate").at("accepted"), true);
  }
  const std::string bytes = read("proofs.cert.zst");
  write("cut.cert.zst", bytes.substr(0, bytes.size() / 2));
  EXPECT_TRUE(
      contains(view({path("cut.cert.zst")}).err, "cut.cert.zst: its compressed stream is cut"));
  write("plain.cert.zst", "touchstone-certificates 1\n");
  EXPECT_TRUE(
      contains(view({path("plain.cert.zst")}).err, "plain.cert.zst: decompression failed: "));
}

TEST_F(ViewCommand, TheCertificateOfAStepIsRefusedWithTheWayOut) {
  const std::string triangle = "v 0 0 0\nv 4 0 0\nv 0 4 0\n";
  const std::string before = write("0.obj", triangle + "v 1 1 1\nf 1 2 3\np 4\n");
  const std::string after = write("1.obj", triangle + "v 1 1 2\nf 1 2 3\np 4\n");
  for (const std::string name : {"step.cert", "step.cert.zst"}) {
    ASSERT_EQ(run({"step", before, after, "--prove", path(name)}).status, 0);
    const tests::Outcome outcome = view({path(name)});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_TRUE(contains(outcome.err, "certificates of steps, which have no query; view --step"))
        << outcome.err;
  }
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

/// Rows of four queries, of which all but the second collide. The label of the last is wrong.
std::string labelled_rows() {
  std::string text;
  for (const auto& [end, label] : {std::pair("-2", "1"), {"2", "0"}, {"-3", "0"}}) {
    std::istringstream lines(row(end));
    for (std::string line; std::getline(lines, line);) text += line + "," + label + "\n";
  }
  return text;
}

TEST_F(ViewCommand, CertifyShowsExactlyWhatIsWrong) {
  const std::string data = write("vertex-face.csv", labelled_rows());
  const std::vector<std::string> certify{"certify", data, "--view", path("page.html")};
  const auto run_with = [&](std::vector<std::string> words) {
    words.insert(words.begin(), certify.begin(), certify.end());
    return run(words);
  };
  const tests::Outcome outcome =
      run_with({"--method", "certified", "--plugin", tests::plugin_library("always_no")});
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, path("page.html") + ": 2 queries to look at\n"));
  const nlohmann::json page = queries("page.html");
  ASSERT_EQ(page.size(), 2U);
  EXPECT_EQ(page[0].at("label"), data + ":0");
  EXPECT_EQ(page[1].at("label"), data + ":2");
  EXPECT_EQ(page[1].at("coordinates")[14], "-0x1.8p+1");
  EXPECT_EQ(
      page[1].at("notes"),
      nlohmann::json::array({"recorded label: no collision, the truth is collision",
                             "always_no: false negative: no, the truth is collision at 0.25"}));
  for (const nlohmann::json& query : page) {
    ASSERT_EQ(query.at("answers").size(), 2U) << "certified has answered and is not asked again";
    EXPECT_EQ(query.at("answers")[0].at("solver"), "certified");
    EXPECT_EQ(query.at("answers")[0].at("faults"), nlohmann::json::array());
    EXPECT_EQ(query.at("answers")[1].at("faults"), nlohmann::json::array({"false negative"}));
  }

  EXPECT_EQ(run_with({"--plugin", tests::plugin_library("always_yes")}).status, 1);
  const nlohmann::json of_yes = queries("page.html");
  ASSERT_EQ(of_yes.size(), 2U);
  EXPECT_EQ(
      of_yes[0].at("notes"),
      nlohmann::json::array({"always_yes: beyond tolerance: yes, tolerance 0, the truth is no "
                             "collision"}))
      << "a solver that is not exact may say yes, but not that they come so near";
  EXPECT_EQ(of_yes[1].at("notes").size(), 1U) << "the label";
  EXPECT_EQ(run_with({"--plugin", tests::plugin_library("always_yes"), "--exact"}).status, 1);
  const nlohmann::json of_exact = queries("page.html");
  ASSERT_EQ(of_exact.size(), 2U);
  EXPECT_EQ(of_exact[0].at("label"), data + ":1");
  EXPECT_EQ(of_exact[0].at("answers")[0].at("promise"), "exact");

  write("vertex-face.csv", row("2"));
  const tests::Outcome right = run_with({"--method", "certified"});
  EXPECT_EQ(right.status, 0);
  EXPECT_TRUE(contains(right.out, path("page.html") + ": nothing was found to look at\n"));
  EXPECT_EQ(queries("page.html").size(), 0U);
  EXPECT_EQ(run({"certify", data, "--view", data}).status, 2) << "an input is no output";
  EXPECT_EQ(run({"certify", data, "--json", path("x"), "--view", path("x")}).status, 2);
}

TEST_F(ViewCommand, CertifyShowsAtMostAHundred) {
  std::string rows;
  for (int i = 0; i < 120; ++i) rows += row("-" + std::to_string(i + 1));
  const std::string data = write("vertex-face.csv", rows);
  const tests::Outcome outcome =
      run({"certify", data, "--plugin", tests::plugin_library("always_no"), "--view",
           path("page.html")});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(contains(outcome.out, ": the first 100 queries to look at\n")) << outcome.out;
  const nlohmann::json page = queries("page.html");
  ASSERT_EQ(page.size(), 100U);
  EXPECT_EQ(page[99].at("label"), data + ":99");
}

TEST_F(ViewCommand, ReportShowsWhatItsMethodsAnsweredWrongly) {
  const std::string data = write("vertex-face.csv", row("-2") + row("2") + row("-3"));
  const std::vector<std::string> report{"report",           data,
                                        "--method",         "certified",
                                        "--experiment",     "field",
                                        "--repetitions",    "1",
                                        "--method-seconds", "0.01",
                                        "--stability",      "0",
                                        "--view",           path("page.html")};
  const tests::Outcome right = run(report);
  EXPECT_EQ(right.status, 0) << right.err;
  EXPECT_EQ(right.out, path("page.html") + ": nothing was found to look at\n");
  std::vector<std::string> wrong = report;
  wrong.insert(wrong.end(), {"--plugin", tests::plugin_library("always_no")});
  const tests::Outcome outcome = run(wrong);
  EXPECT_EQ(outcome.out, path("page.html") + ": 2 queries to look at\n") << outcome.err;
  const nlohmann::json page = queries("page.html");
  ASSERT_EQ(page.size(), 2U);
  EXPECT_EQ(page[0].at("label"), data + ":0");
  EXPECT_EQ(page[1].at("label"), data + ":2");
  EXPECT_EQ(page[1].at("answers")[0].at("solver"), "always_no");
  EXPECT_EQ(page[1].at("answers")[0].at("faults"), nlohmann::json::array({"false negative"}));
  EXPECT_EQ(page[1].at("answers")[1].at("solver"), "certified");
}

TEST_F(ViewCommand, StepShowsTheFirstStepThatCollides) {
  const std::string triangle = "v 0 0 0\nv 4 0 0\nv 0 4 0\n", rest = "f 1 2 3\np 4\n";
  const auto frame = [&](const std::string& name, const std::string& height) {
    return write(name, triangle + "v 1 1 " + height + "\n" + rest);
  };
  const std::vector<std::string> frames{frame("0.obj", "2"), frame("1.obj", "1"),
                                        frame("2.obj", "-2"), frame("3.obj", "2")};
  const auto step = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "step");
    words.insert(words.end(), {"--view", path("page.html")});
    return run(words);
  };
  for (const std::string question : {"--all", "--earliest", "--free"}) {
    const tests::Outcome outcome = step({frames[0], frames[1], frames[2], frames[3], question});
    EXPECT_EQ(outcome.status, 1) << outcome.err;
    EXPECT_TRUE(contains(outcome.out, path("page.html") + ": 1.obj to 2.obj, 1 collision\n"));
    const nlohmann::json page = queries("page.html");
    ASSERT_EQ(page.size(), 1U);
    EXPECT_EQ(page[0].at("label"), "1.obj to 2.obj: vertex 3, face 0");
    EXPECT_EQ(page[0].at("truth").at("toi").at("exact"), "1/3");
    EXPECT_EQ(page[0].at("answers")[0].at("solver"), "certified");
  }
  const tests::Outcome free = step({frames[0], frames[1]});
  EXPECT_EQ(free.status, 0);
  EXPECT_TRUE(contains(free.out, ": 0.obj to 1.obj, without a collision\n")) << free.out;
  EXPECT_EQ(queries("page.html").size(), 0U);
  EXPECT_TRUE(contains(read("page.html"), R"(id="step_facts")"));
  EXPECT_EQ(step({frames[0], frames[1], "--csv", path("page.html")}).status, 2);
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

TEST_F(ViewCommand, GroupsOfAStepThatAreApartDoNotCollide) {
  const auto frame = [&](const std::string& name, const std::string& height) {
    return write(
        name, "o floor\nv 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\no ball\nv 1 1 " + height + "\np 4\n");
  };
  const std::string before = frame("0.obj", "1"), after = frame("1.obj", "-2");
  const std::string groups = write("groups.txt", "a\na\na\nb\n");
  const auto names = [&](const std::vector<std::string>& words) {
    std::vector<std::string> result;
    for (const std::string command : {"view --step", "step --view"}) {
      std::vector<std::string> all{before, after};
      if (command == "view --step") all.insert(all.begin(), "--step");
      all.insert(all.end(), words.begin(), words.end());
      if (command == "step --view") {
        all.insert(all.begin(), "step");
        all.insert(all.end(), {"--view", path("page.html")});
      }
      const tests::Outcome outcome = command == "step --view" ? run(all) : view(all);
      EXPECT_EQ(outcome.err, "");
      for (const nlohmann::json& query : queries("page.html")) result.push_back(query.at("label"));
    }
    return result;
  };
  const std::string pair = "0.obj to 1.obj: vertex 3, face 0";
  const std::vector<std::string> both{pair, pair}, none;
  EXPECT_EQ(names({}), both);
  EXPECT_EQ(names({"--apart", "ball", "floor"}), none);
  EXPECT_EQ(names({"--apart", "floor", "floor"}), both);
  EXPECT_EQ(names({"--groups", groups}), both);
  EXPECT_EQ(names({"--groups", groups, "--apart", "a", "b"}), none);
  EXPECT_TRUE(contains(view({"--step", before, after, "--apart", "floor", "wall"}).err,
                       R"(no group "wall"; there are: "floor", "ball")"));
  EXPECT_TRUE(contains(view({"--kind", "vertex-face", "--points", falling, "--groups", groups}).err,
                       "--groups and --apart need --step"));
  EXPECT_EQ(run({"view", "--step", before, after, "--groups", groups, "--out", groups}).status, 2);
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
