#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "exact/checker/checker.hpp"
#include "tests/support/built_files.hpp"
#include "tests/support/tool_test.hpp"
#include "tests/verify/solvers/plugins/misbehaviour.hpp"
#include "verify/data/npy.hpp"

// Tests of the commands (verify/cli/commands.hpp) that run the tool.

namespace touchstone::verify::cli::commands_test {
namespace {

namespace fs = std::filesystem;
using tests::contains;
using tests::Outcome;
using tests::read_file;

class Tool : public tests::ToolTest {
 protected:
  /// Waits until a thread of the tool has a child: the process in which the solver runs.
  static void wait_for_child(pid_t process) {
    const auto has_child = [&] {
      const fs::path threads = "/proc/" + std::to_string(process) + "/task";
      return std::ranges::any_of(fs::directory_iterator(threads), [](const auto& thread) {
        return !read_file(thread.path() / "children").empty();
      });
    };
    EXPECT_TRUE(tests::comes_true(has_child));
  }
};

/// A vertex that falls through a resting triangle (label 1 is true), as rows of the 2021 format.
std::string falling_vertex(const std::string& label, const std::string& end_height = "-3") {
  const auto rows = [&](const std::string& height) {
    return "1,1,1,1," + height + ",1," + label + "\n0,1,0,1,0,1," + label + "\n4,1,0,1,0,1," +
           label + "\n0,1,4,1,0,1," + label + "\n";
  };
  return rows("1") + rows(end_height);
}

/// The subcommands, as the help of the program lists them.
std::vector<std::string> subcommands_in(const std::string& help) {
  std::vector<std::string> names;
  std::istringstream lines(help.substr(help.find("Subcommands:\n")));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line) && line.starts_with("  ")) {
    names.push_back(line.substr(2, line.find(' ', 2) - 2));
  }
  return names;
}

/// The number of lines of a help text, none wider than a screen.
std::ptrdiff_t lines_of(const std::string& help) {
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 102U) << line;
  return std::ranges::count(help, '\n');
}

/// Each command names the fault of bad input.
TEST_F(Tool, RefusesBadInputWithItsReason) {
  fs::create_directories(folder() / "frames");
  for (const char* const name : {"frames/1.obj", "frames/2.obj"}) {
    std::ofstream(path(name)) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  }
  const std::string frames = path("frames"), frame = path("frames/1.obj");
  fs::create_symlink("loop", path("loop"));
  std::ofstream deep(path("deep.json"));
  for (int i = 0; i < 100'000; ++i) deep << R"({"findings":)";
  deep << 1 << std::string(100'000, '}') << std::flush;
  std::ofstream(path("answers.csv")) << "nonsense\n";
  struct Case {
    std::vector<std::string> words;
    std::string message;
  };
  std::vector<Case> cases{
      {{"certfy"}, "no command certfy; did you mean certify?"},
      {{"nonsense"}, "no command nonsense; touchstone --help lists them"},
      {{"view", path("deep.json"), "--out", path("x.html")}, "nested more than 100 deep"},
      {{"certify", path("loop")}, "loop: cannot read: Too many levels of symbolic links"},
      {{"certify", "--truth", path("loop")}, "loop: cannot write: Too many levels"},
      {{"certify", "--results", path("answers.csv"), "--count", "1"},
       "first line must be file,index,kind,verdict,toi_lower,toi_upper,tolerance[,failure]"}};
  for (const char* const option : {"--csv", "--json", "--prove", "--view"}) {
    cases.push_back({{"step", frames, option, frame}, frame + ": named for input and output"});
  }
  for (const auto& [words, message] : cases) {
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.status, 2) << message;
    EXPECT_TRUE(contains(outcome.err, message)) << outcome.err << "instead of " << message;
    EXPECT_EQ(outcome.out, "") << message;
  }
  EXPECT_TRUE(read_file(frame).starts_with("v 0 0 0")) << "a frame is overwritten";
}

TEST_F(Tool, SaysNoTableOfWhatIsNotThere) {
  for (std::vector<std::string> words :
       {std::vector<std::string>{"certify", "--method", "certified"},
        {"bench", "--method", "certified"},
        {"solve", "--method", "certified", "--out", path("a.csv")},
        {"prove", "--out", path("a.cert")}}) {
    const std::string command = words.front();
    words.push_back(path("missing.csv"));
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.status, 2) << command;
    EXPECT_EQ(outcome.out, "") << command;
    EXPECT_TRUE(contains(outcome.err, "missing.csv: does not exist")) << outcome.err;
  }
}

TEST_F(Tool, TruthGoesToStandardOutputWhereADashIsNamed) {
  const Outcome outcome = run({"certify", "--count", "1", "--method", "none", "--truth", "-"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(outcome.out.starts_with("file,index,kind,collides,toi_lower,toi_upper\n"))
      << outcome.out;
  EXPECT_FALSE(fs::exists("-"));
}

TEST_F(Tool, SaysThatFalsePositivesAreNotShown) {
  const Outcome outcome =
      run({"certify", "--count", "2", "--method", "tight_inclusion", "--view", path("found.html")});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "no wrong answer to look at (false positives")) << outcome.out;
}

/// A vertex that falls on a parabola to a face, and one that does not reach it.
TEST_F(Tool, DecidesCurves) {
  std::string text = "degree,2\n";
  for (const std::string middle : {"-1", "0"}) {
    for (const std::string& z : {std::string("1"), middle, std::string("1")}) {
      text += "1,1," + z + "\n0,0,0\n4,0,0\n0,4,0\n";
    }
  }
  std::ofstream(path("curves-vf.csv"), std::ios::binary) << text;
  const Outcome found = run({"curved", path("curves-vf.csv"), "--proof", path("c.cert")});
  EXPECT_EQ(found.status, 0) << found.err;
  EXPECT_TRUE(contains(found.out, "vertex-face, curves of degree 2: 2 queries, 1 collide"))
      << found.out;
  EXPECT_TRUE(contains(found.out, "certified: 0 wrong")) << found.out;
  std::ifstream certificates(path("c.cert"), std::ios::binary);
  EXPECT_EQ(checker::check(certificates).accepted(), 2U);
  const Outcome near = run({"curved", path("curves-vf.csv"), "--min-separation", "0.5"});
  EXPECT_TRUE(contains(near.out, "2 queries, 2 collide")) << near.out;
  EXPECT_EQ(run({"curved", path("none.csv"), "--kind", "edge-edge"}).status, 2);

  // The commands for straight queries take the file, too.
  const std::string file = path("curves-vf.csv");
  const Outcome certified = run({"certify", file, "--truth", path("truth.csv")});
  EXPECT_EQ(certified.status, 0) << certified.err;
  EXPECT_TRUE(contains(certified.out, "2 queries, 1 collide")) << certified.out;
  EXPECT_TRUE(contains(read_file(path("truth.csv")), ",0,vertex-face,1,0.5,0.5\n"));
  EXPECT_TRUE(contains(read_file(path("truth.csv")), ",1,vertex-face,0,,\n"));
  EXPECT_EQ(run({"prove", file, "--out", path("p.cert")}).status, 0);
  EXPECT_EQ(read_file(path("p.cert")), read_file(path("c.cert")));
  for (const std::string method : {"certified", "tight_inclusion"}) {
    const Outcome solved = run({"solve", file, "--method", method, "--out", path("a.csv")});
    EXPECT_EQ(solved.status, 0) << solved.err;
    EXPECT_TRUE(contains(solved.out, "2 queries on curves, 1 yes, 1 no")) << solved.out;
    EXPECT_TRUE(contains(read_file(path("a.csv")), ",0,vertex-face,yes,")) << method;
    EXPECT_TRUE(contains(read_file(path("a.csv")), ",1,vertex-face,no,")) << method;
  }
  const Outcome other = run({"solve", file, "--method", "tccd", "--out", path("a.csv")});
  EXPECT_EQ(other.status, 2);
  EXPECT_TRUE(contains(other.err, "tccd does not answer queries on curves")) << other.err;
  const Outcome option = run({"certify", file, "--view", path("v.html")});
  EXPECT_EQ(option.status, 2);
  EXPECT_TRUE(contains(option.err, "--view does not apply to queries on curves")) << option.err;
  std::ofstream(path("vf.csv"), std::ios::binary) << "0,0,0\n";
  const Outcome mixed = run({"certify", file, path("vf.csv")});
  EXPECT_EQ(mixed.status, 2);
  EXPECT_TRUE(contains(mixed.err, "in another run")) << mixed.err;
}

TEST_F(Tool, HelpBeginsWithAnExampleAndFitsAScreen) {
  const std::string overview = run({"--help"}).out;
  EXPECT_LE(lines_of(overview), 30) << overview;
  const std::vector<std::string> subcommands = subcommands_in(overview);
  EXPECT_EQ(subcommands.size(), 16U) << overview;
  for (const std::string& name : subcommands) {
    const Outcome help = run({name, "--help"});
    EXPECT_EQ(help.status, 0);
    EXPECT_LE(lines_of(help.out), 56) << help.out;
    const std::size_t example = help.out.find("\n\nExample: touchstone " + name);
    EXPECT_LT(example, help.out.find("\n\nUsage: touchstone " + name)) << help.out;
    EXPECT_TRUE(contains(help.out, "\n\nOutput:\n")) << help.out;
    EXPECT_TRUE(contains(help.out, "Exit status: 0 ")) << help.out;
  }
}

TEST_F(Tool, WithoutASubcommandItListsThem) {
  const Outcome bare = run({});
  EXPECT_EQ(bare.status, 2);
  EXPECT_EQ(bare.out, "");
  EXPECT_EQ(bare.err, run({"--help"}).out);
}

TEST_F(Tool, UsageErrorsExitWithTwo) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"nonsense"},
        {"certify", "--nonsense"},
        {"certify", "--kind", "face-face"},
        {"certify", "--count", "0"},
        {"certify", "--seed", "-1"},
        {"certify", "--threads", "x"},
        {"certify", "--method", "nonsense"},
        {"certify", "--plugin", path("missing.so")},
        {"certify", "--results", path("missing.csv")},
        {"certify", "--query-limit", "-1"},
        {"certify", "--tolerance", "0"},
        {"solve", "--out", path("x")},
        {"certify", path("x.csv"), "--exact"},
        {"certify", path("x.csv"), "--max-checks", "5"},
        {"solve", "--method", "tight_inclusion"},
        {"solve", "--method", "tight_inclusion", "--count", "1", "--out", ""},
        {"solve", "--method", "none", "--out", path("x")},
        {"solve", "--method", "nonsense", "--out", path("x")},
        {"solve", "--plugin", tests::plugin_library("box_overlap"), "--method", "tight_inclusion",
         "--out", path("x")},
        {"solve", "--plugin", tests::plugin_library("box_overlap"), "--out", path("x"), "--t-max",
         "2"},
        {"generate"},
        {"generate", "--out", path("x"), "--family", "nonsense"}}) {
    const Outcome usage = run(arguments);
    EXPECT_EQ(usage.status, 2) << testing::PrintToString(arguments);
    EXPECT_NE(usage.err, "") << testing::PrintToString(arguments);
  }
}

TEST_F(Tool, CertifyAcceptsTrueLabels) {
  const std::string file =
      write("vertex-face/true.csv", falling_vertex("1") + falling_vertex("0", "1"));
  const Outcome certify =
      run({"certify", file, "--json", path("result.json"), "--truth", path("truth.csv")});
  EXPECT_EQ(certify.status, 0) << certify.err;
  EXPECT_EQ(certify.err, "");
  const nlohmann::json result = json("result.json");
  EXPECT_EQ(result.at("queries"), 2);
  EXPECT_EQ(result.at("collisions"), 1);
  EXPECT_EQ(result.at("label_mismatches"), 0);
  EXPECT_EQ(result.at("skipped"), 0);
  EXPECT_GT(result.at("us_per_query"), 0.0);
  EXPECT_EQ(read_file(path("truth.csv")), "file,index,kind,collides,toi_lower,toi_upper\n" + file +
                                              ",0,vertex-face,1,0.25,0.25\n" + file +
                                              ",1,vertex-face,0,,\n");
}

TEST_F(Tool, CertifyExitsWithOneForAWrongLabelAndListsIt) {
  const std::string file = write("wrong_vf.csv", falling_vertex("1") + falling_vertex("0"));
  const Outcome certify = run({"certify", file, "--json", path("result.json")});
  EXPECT_EQ(certify.status, 1);
  EXPECT_TRUE(contains(certify.out, "mismatch: " + file +
                                        ": vertex-face query 1: recorded label no collision, truth "
                                        "collision"))
      << certify.out;
  EXPECT_EQ(json("result.json").at("mismatches")[0].at("index"), 1);
}

TEST_F(Tool, CertifyExitsWithTwoForABadRowAndKeepsWhatItHas) {
  const std::string file = write("bad_vf.csv", falling_vertex("1") + "1,0,1,1,1,1,1\n");
  const Outcome certify = run({"certify", file, "--json", path("result.json")});
  EXPECT_EQ(certify.status, 2);
  EXPECT_TRUE(contains(certify.err, file + ":9:2: ")) << certify.err;
  EXPECT_EQ(json("result.json").at("queries"), 1);
}

TEST_F(Tool, KeepGoingSkipsNamesAndCountsAndStillExitsWithTwo) {
  const std::string bad = falling_vertex("1", "1/0");
  write("data/a_vf.csv", falling_vertex("1") + bad + falling_vertex("1"));
  write("data/b.csv", falling_vertex("1"));
  write("data/c_vf.csv", falling_vertex("1"));
  const Outcome certify =
      run({"certify", path("data"), "--keep-going", "--json", path("result.json")});
  EXPECT_EQ(certify.status, 2);
  EXPECT_TRUE(contains(certify.err, path("data/a_vf.csv") + ":13:5: ")) << certify.err;
  EXPECT_TRUE(contains(certify.err, path("data/b.csv") + ": ")) << certify.err;
  EXPECT_EQ(json("result.json").at("queries"), 3);
  EXPECT_EQ(json("result.json").at("skipped"), 1);
}

TEST_F(Tool, KeepGoingDecidesNoQueryThatIsPutTogetherOfTwo) {
  std::string second = falling_vertex("1");
  second.insert(second.find('\n') + 1, "\n");
  const std::string file =
      write("a_vf.csv", falling_vertex("1") + second + falling_vertex("1") + falling_vertex("1"));
  const Outcome certify = run({"certify", file, "--keep-going", "--truth", path("truth.csv"),
                               "--json", path("result.json")});
  EXPECT_EQ(certify.status, 2);
  EXPECT_TRUE(contains(certify.err, file + ":10: blank line inside a query; the rest of the file"))
      << certify.err;
  EXPECT_EQ(json("result.json").at("queries"), 1);
  EXPECT_EQ(json("result.json").at("skipped"), 1);
  EXPECT_EQ(read_file(path("truth.csv")), "file,index,kind,collides,toi_lower,toi_upper\n" + file +
                                              ",0,vertex-face,1,0.25,0.25\n");
}

TEST_F(Tool, AnArrayThatBecomesShorterIsNamedAndWhatIsDoneIsWritten) {
  constexpr std::size_t queries = 16000, left = 12000;
  const fs::path array = path("a_vf.npy");
  data::NpyWriter writer(array);
  for (std::size_t i = 0; i < queries; ++i) {
    writer.write(Query{{1, 1, 1,  0, 0, 0, 4, 0, 0, 0, 4, 0,  //
                        1, 1, -3, 0, 0, 0, 4, 0, 0, 0, 4, 0}});
  }
  writer.close();
  ASSERT_EQ(::mkfifo(path("truth").c_str(), 0600), 0);
  const pid_t process = start({"certify", array.string(), "--threads", "1", "--truth",
                               path("truth"), "--json", path("result.json")});
  // At most two blocks of 2,048 queries are in progress, and the pipe holds the truth of a few
  // thousand: when its first bytes arrive, the array is being read, and not near the cut.
  const int truth = ::open(path("truth").c_str(), O_RDONLY);
  std::array<char, 4096> buffer{};
  ssize_t count = ::read(truth, buffer.data(), buffer.size());
  ASSERT_GT(count, 0);
  fs::resize_file(array, 128 + left * sizeof(Query));
  std::size_t lines = 0;
  for (; count > 0; count = ::read(truth, buffer.data(), buffer.size())) {
    lines += static_cast<std::size_t>(std::count(buffer.begin(), buffer.begin() + count, '\n'));
  }
  ::close(truth);
  const Outcome certify = finish(process);
  EXPECT_EQ(certify.status, 2);
  EXPECT_TRUE(contains(certify.err, array.string() +
                                        ": has become shorter while it was read: query 12000 of "
                                        "16000 is missing"))
      << certify.err;
  EXPECT_EQ(lines, left + 1);
  EXPECT_EQ(json("result.json").at("queries"), left);
  EXPECT_TRUE(contains(certify.out, "total")) << certify.out;
}

TEST_F(Tool, AnArrayOfNoQueriesIsADataset) {
  data::NpyWriter(path("none_vf.npy")).close();
  const std::string file = path("none_vf.npy");
  const Outcome certify =
      run({"certify", file, "--method", "certified", "--json", path("result.json")});
  EXPECT_EQ(certify.status, 0) << certify.err;
  EXPECT_EQ(certify.err, "");
  EXPECT_FALSE(contains(certify.out, "nan")) << certify.out;
  EXPECT_EQ(json("result.json").at("queries"), 0);
  EXPECT_EQ(json("result.json").at("errors"), 0);
  EXPECT_EQ(run({"solve", file, "--method", "certified", "--out", path("answers.csv")}).status, 0);
  EXPECT_EQ(read_file(path("answers.csv")),
            "file,index,kind,verdict,toi_lower,toi_upper,tolerance,failure\n");
  EXPECT_EQ(run({"prove", file, "--out", path("proofs.cert")}).status, 0);
}

TEST_F(Tool, WrongAnswersOutrankBadInput) {
  const std::string file = write("wrong_vf.csv", falling_vertex("0") + "1,2,3\n");
  EXPECT_EQ(run({"certify", file}).status, 1);
}

TEST_F(Tool, KindOptionServesWhereThePathDoesNot) {
  const std::string file = write("queries.csv", falling_vertex("1"));
  EXPECT_EQ(run({"certify", file}).status, 2);
  EXPECT_EQ(run({"certify", file, "--kind", "vertex-face"}).status, 0);
}

TEST_F(Tool, DecimalsAreReadAndTheErrorSaysHowToRoundThem) {
  const std::string rows =
      "-0.00058163201902061701,1,-0.057847701013088226,1,-0.65621602535247803,1\n"
      "0.25,1,0.5,1,1e0,1\n4,1,0,1,0,1\n0,1,4,1,0,1\n";
  const std::string file = write("decimals_vf.csv", rows + rows);
  const Outcome strict = run({"certify", file});
  EXPECT_EQ(strict.status, 2);
  EXPECT_TRUE(contains(strict.err, file + ":1:1: not exactly a double (--round takes the nearest)"))
      << strict.err;
  EXPECT_EQ(run({"certify", file, "--round", "--json", path("result.json")}).status, 0);
  EXPECT_EQ(json("result.json").at("queries"), 1);
  EXPECT_EQ(json("result.json").at("rounded"), 6);
}

TEST_F(Tool, UnwritableOutputIsAnErrorBeforeTheWork) {
  const Outcome certify = run({"certify", "--count", "1", "--json", path("no/such/folder.json")});
  EXPECT_EQ(certify.status, 2);
  EXPECT_TRUE(contains(certify.err, "no/such/folder.json: cannot")) << certify.err;
  EXPECT_EQ(certify.out, "");
}

TEST_F(Tool, OutputsMustNotBeInputsNorEachOther) {
  const std::string file = write("queries_vf.csv", falling_vertex("1"));
  const std::string text = read_file(file);
  for (const std::string option : {"--truth", "--json"}) {
    const Outcome certify = run({"certify", file, option, path("./queries_vf.csv")});
    EXPECT_EQ(certify.status, 2);
    EXPECT_TRUE(contains(certify.err, "named for input and output")) << certify.err;
  }
  const std::string plugin = tests::plugin_library("box_overlap");
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"certify", file, "--json", path("x"), "--truth", path("x")},
        {"solve", file, "--plugin", plugin, "--out", file},
        {"solve", file, "--plugin", plugin, "--out", path("x"), "--json", path("x")},
        {"solve", file, "--plugin", plugin, "--out", "/dev/full"}}) {
    EXPECT_EQ(run(words).status, 2) << testing::PrintToString(words);
  }
  EXPECT_EQ(read_file(file), text);
}

TEST_F(Tool, OutputsMustNotBeWhatAccompaniesInputsNorPlugins) {
  const std::string file = write("queries/a_vf.csv", falling_vertex("1"));
  const std::string tois = write("toi/a_vf_toi.csv", "query,toi\n0,0.25\n");
  const std::string labels = write("mma_bool/a_vf_mma_bool.json", "[true]\n");
  const std::string plugin =
      write("box_overlap.so", read_file(tests::plugin_library("box_overlap")));
  for (const std::string& victim : {tois, labels, plugin}) {
    const std::string before = read_file(victim);
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"certify", file, "--plugin", plugin, "--truth", victim},
          {"certify", file, "--plugin", plugin, "--json", victim},
          {"solve", file, "--plugin", plugin, "--out", victim},
          {"solve", file, "--plugin", plugin, "--out", path("x"), "--json", victim}}) {
      const Outcome refused = run(words);
      EXPECT_EQ(refused.status, 2) << testing::PrintToString(words);
      EXPECT_TRUE(contains(refused.err, "named for input and output")) << refused.err;
      EXPECT_EQ(read_file(victim), before);
    }
  }
}

TEST_F(Tool, OutputsGoWhereSymbolicLinksPoint) {
  const std::string file = write("queries_vf.csv", falling_vertex("1"));
  write("target.json", "older");
  fs::create_symlink("target.json", path("link.json"));
  fs::create_symlink("new.csv", path("dangling.csv"));
  EXPECT_EQ(
      run({"certify", file, "--json", path("link.json"), "--truth", path("dangling.csv")}).status,
      0);
  EXPECT_TRUE(fs::is_symlink(path("link.json")));
  EXPECT_TRUE(fs::is_symlink(path("dangling.csv")));
  EXPECT_EQ(json("target.json").at("queries"), 1);
  EXPECT_TRUE(read_file(path("new.csv")).starts_with("file,index,"));
  EXPECT_EQ(
      run({"certify", file, "--json", path("link.json"), "--truth", path("target.json")}).status, 2)
      << "one file by two names";
}

TEST_F(Tool, AnswersOnStandardOutputAreNothingButAnswers) {
  const std::string file = write("queries_vf.csv", falling_vertex("1"));
  const Outcome solve = run(
      {"solve", file, "--plugin", tests::plugin_library("box_overlap"), "--out", "/dev/stdout"});
  EXPECT_EQ(solve.status, 0) << solve.err;
  EXPECT_EQ(solve.out,
            std::string("file,index,kind,verdict,toi_lower,toi_upper,tolerance,failure\n") + file +
                ",0,vertex-face,yes,0,,,\n");
  EXPECT_TRUE(contains(solve.err, "box_overlap: 1 queries")) << solve.err;
  const Outcome certify = run({"certify", file, "--json", "/dev/stdout"});
  EXPECT_EQ(certify.status, 0);
  EXPECT_EQ(nlohmann::json::parse(certify.out).at("queries"), 1);
  EXPECT_TRUE(contains(certify.err, "total")) << certify.err;
}

TEST_F(Tool, AFailedRunLeavesOlderResultsAlone) {
  write("result.json", "older");
  const Outcome certify =
      run({"certify", "--count", "1", "--json", path("result.json"), "--truth", path("no/truth")});
  EXPECT_EQ(certify.status, 2);
  EXPECT_EQ(read_file(path("result.json")), "older");
}

TEST_F(Tool, FailedWritesAreReportedAndCostNothingElse) {
  const std::string file = write("queries_vf.csv", falling_vertex("1"));
  const Outcome certify =
      run({"certify", file, "--truth", "/dev/full", "--json", path("result.json")});
  EXPECT_EQ(certify.status, 2);
  EXPECT_TRUE(contains(certify.err, "/dev/full")) << certify.err;
  EXPECT_EQ(json("result.json").at("queries"), 1);
  EXPECT_TRUE(contains(certify.out, "total")) << certify.out;
}

TEST_F(Tool, KeepGoingGoesOnPastPathsThatCannotBeRead) {
  const std::string file = write("queries_vf.csv", falling_vertex("1"));
  const Outcome certify =
      run({"certify", path("missing"), file, file, "--keep-going", "--json", path("result.json")});
  EXPECT_EQ(certify.status, 2);
  const nlohmann::json result = json("result.json");
  EXPECT_EQ(result.at("queries"), 1) << "a file named twice counts once";
  EXPECT_EQ(result.at("errors"), 1);
  EXPECT_TRUE(contains(result.at("files")[0].at("error"), "does not exist")) << result.dump();
}

TEST_F(Tool, FileNamesNeedNotBeUtf8) {
  const std::string file = write("\xff_vf.csv", falling_vertex("1"));
  EXPECT_EQ(run({"certify", file, "--json", path("result.json")}).status, 0);
  EXPECT_EQ(json("result.json").at("queries"), 1);
}

TEST_F(Tool, ArraysAreNotWrittenBesideTheTruthOfOtherQueries) {
  const std::vector<std::string> generate{"generate", "--out",    path("set"), "--count",
                                          "3",        "--family", "hourglass"};
  ASSERT_EQ(run(generate).status, 0);
  std::vector<std::string> as_array = generate;
  as_array.insert(as_array.end(), {"--npy", "--seed", "2"});
  const Outcome second = run(as_array);
  EXPECT_EQ(second.status, 2);
  EXPECT_TRUE(contains(second.err, "choose another folder")) << second.err;
}

TEST_F(Tool, BuiltInSetIsCertified) {
  const Outcome certify =
      run({"certify", "--count", "10", "--method", "none", "--json", path("result.json")});
  EXPECT_EQ(certify.status, 0) << certify.out << certify.err;
  EXPECT_GE(json("result.json").at("files").size(), 40U);
  EXPECT_EQ(json("result.json").at("labels"), json("result.json").at("queries"));
}

TEST_F(Tool, GeneratedFilesAreCertifiedLikeTheBuiltInSet) {
  const Outcome generate =
      run({"generate", "--out", path("set"), "--count", "20", "--json", path("files.json")});
  ASSERT_EQ(generate.status, 0) << generate.err;
  const Outcome files = run({"certify", path("set"), "--json", path("files_result.json")});
  EXPECT_EQ(files.status, 0) << files.out << files.err;
  EXPECT_EQ(run({"certify", "--count", "20", "--method", "none", "--json", path("set_result.json")})
                .status,
            0);
  const nlohmann::json from_files = json("files_result.json"), from_set = json("set_result.json");
  EXPECT_EQ(json("files.json").size(), from_set.at("files").size());
  for (const char* field : {"queries", "collisions", "labels", "tois"}) {
    EXPECT_EQ(from_files.at(field), from_set.at(field)) << field;
  }
}

TEST_F(Tool, GenerateWritesArraysToo) {
  ASSERT_EQ(
      run({"generate", "--out", path("set"), "--count", "20", "--npy", "--family", "hourglass"})
          .status,
      0);
  ASSERT_EQ(
      run({"generate", "--out", path("csv"), "--count", "20", "--family", "hourglass"}).status, 0);
  ASSERT_EQ(run({"certify", path("set"), "--json", path("npy.json")}).status, 0);
  ASSERT_EQ(run({"certify", path("csv"), "--json", path("csv.json")}).status, 0);
  EXPECT_EQ(json("npy.json").at("labels"), 0);
  EXPECT_EQ(json("npy.json").at("collisions"), json("csv.json").at("collisions"));
}

TEST_F(Tool, GenerateIsAFunctionOfTheSeed) {
  const auto generate = [&](const std::string& folder, const std::string& seed) {
    EXPECT_EQ(run({"generate", "--out", path(folder), "--count", "5", "--seed", seed}).status, 0);
    return read_file(path(folder + "/vertex-face/interior-dyadic.csv"));
  };
  const std::string first = generate("first", "7");
  EXPECT_NE(first, "");
  EXPECT_EQ(first, generate("second", "7"));
  EXPECT_NE(first, generate("third", "8"));
}

TEST_F(Tool, AnInterruptKeepsWhatIsDone) {
  using namespace std::chrono_literals;
  const Outcome certify =
      run_interrupted({"certify", "--count", "100000000", "--method", "none", "--json",
                       path("result.json"), "--truth", path("truth.csv")},
                      [&] { return has_grown("truth.csv"); });
  EXPECT_EQ(certify.status, 130);
  const nlohmann::json result = json("result.json");
  EXPECT_EQ(result.at("interrupted"), true);
  EXPECT_GT(result.at("queries"), 0);
  const std::string truth = read_file(path("truth.csv"));
  EXPECT_EQ(std::count(truth.begin(), truth.end(), '\n'), result.at("queries").get<long>() + 1);
}

// ---- Solvers ------------------------------------------------------------------------------------

/// The header of solve; files may omit the last column.
const std::string full_header = "file,index,kind,verdict,toi_lower,toi_upper,tolerance,failure\n";
const std::string answers_header = "file,index,kind,verdict,toi_lower,toi_upper,tolerance\n";

/// A vertex-face file of a collision at t=1/4, and of a query without one whose boxes overlap too.
std::string hit_and_miss() {
  std::string no_collision = falling_vertex("0", "-3");
  for (std::size_t at = no_collision.find("1,1,1,1,"); at != std::string::npos;
       at = no_collision.find("1,1,1,1,")) {
    no_collision.replace(at, 8, "3,1,3,1,");
  }
  return falling_vertex("1") + no_collision;
}

TEST_F(Tool, RecordedAnswersAreJudgedInEveryColumn) {
  const std::string file = write("queries_vf.csv", hit_and_miss());
  struct Case {
    std::string collision, no_collision, column;
    int status;
  };
  for (const auto& [collision, no_collision, column, status] :
       {Case{"yes,0.25,0.25,0", "no,,,", "", 0}, Case{"yes,,,", "no,,,", "", 0},
        Case{"no,,,", "no,,,", "false_negatives", 1},
        Case{"yes,0,1,", "yes,0,1,", "false_positives", 0},
        Case{"yes,0.25000000000000006,0.5,", "no,,,", "late_toi", 1},
        Case{"yes,0,0.24999999999999997,", "no,,,", "early_toi_upper", 1},
        Case{"undecided,,,", "no,,,", "undecided", 0}, Case{"error,,,", "no,,,", "errors", 1}}) {
    std::string rows = answers_header;
    rows.append(file).append(",0,vertex-face,").append(collision).append("\n");
    rows.append(file).append(",1,vertex-face,").append(no_collision).append("\n");
    const std::string answers = write("answers.csv", rows);
    const Outcome certify =
        run({"certify", file, "--results", answers, "--json", path("result.json")});
    EXPECT_EQ(certify.status, status) << collision << no_collision << certify.err << certify.out;
    ASSERT_EQ(json("result.json").at("methods").size(), 1U);
    const nlohmann::json method = json("result.json").at("methods")[0];
    EXPECT_EQ(method.at("name"), answers);
    EXPECT_EQ(method.at("queries"), 2);
    for (const char* field : {"false_negatives", "false_positives", "late_toi", "early_toi_upper",
                              "undecided", "errors"}) {
      EXPECT_EQ(method.at(field), field == column ? 1 : 0)
          << field << ": " << collision << no_collision;
    }
  }
}

TEST_F(Tool, ExactHoldsToFalsePositives) {
  const std::string file = write("queries_vf.csv", hit_and_miss());
  const std::vector<std::string> lenient{"certify", file, "--plugin",
                                         tests::plugin_library("box_overlap")};
  EXPECT_EQ(run(lenient).status, 0);
  std::vector<std::string> strict = lenient;
  strict.emplace_back("--exact");
  const Outcome certify = run(strict);
  EXPECT_EQ(certify.status, 1);
  EXPECT_TRUE(contains(certify.out, "false positive: box_overlap: " + file +
                                        ": vertex-face query 1: answer yes, truth no collision"))
      << certify.out;
}

TEST_F(Tool, MissingAnswersAreBadInputAndNamed) {
  const std::string file = write("queries_vf.csv", hit_and_miss());
  const std::string answers = write("answers.csv", full_header + file + ",0,vertex-face,yes,,,,\n" +
                                                       file + ",7,vertex-face,yes,,,,\n");
  const Outcome certify =
      run({"certify", file, "--results", answers, "--json", path("result.json")});
  EXPECT_EQ(certify.status, 2);
  EXPECT_TRUE(
      contains(certify.err, "no answer to 1 queries, first to vertex-face query 1 of " + file))
      << certify.err;
  EXPECT_TRUE(contains(certify.err, answers + ":3: 1 answers refer to unknown queries"))
      << certify.err;
  EXPECT_EQ(json("result.json").at("methods")[0].at("missing"), 1);
  EXPECT_EQ(json("result.json").at("methods")[0].at("queries"), 1);
}

TEST_F(Tool, AnswersMustNotBeOutputs) {
  const std::string answers = write("answers.csv", answers_header);
  EXPECT_EQ(run({"certify", "--count", "1", "--results", answers, "--json", answers}).status, 2);
  EXPECT_EQ(read_file(answers), answers_header);
}

/// A query whose first coordinate tells the plugin its action, and puts the vertex beside the
/// triangle.
std::string misbehave(tests::Misbehaviour what) {
  return falling_vertex("0").replace(0, 1, std::to_string(static_cast<int>(what)));
}

TEST_F(Tool, KindsOfFailureAreDistinguished) {
  using tests::Misbehaviour;
  std::string text;
  for (const auto what :
       {Misbehaviour::writes_to_null, Misbehaviour::exits_with_3, Misbehaviour::throws,
        Misbehaviour::leaves_answer_alone, Misbehaviour::infinite_toi_lower, Misbehaviour::hangs,
        Misbehaviour::is_undecided, Misbehaviour::says_no}) {
    text += misbehave(what);
  }
  const std::string file = write("queries_vf.csv", text);
  const std::vector<std::string> failures{"crash: SIGSEGV",
                                          "exit: status 3",
                                          "exception: thrown by a plugin",
                                          "no_verdict",
                                          "not_finite: toi_lower -inf",
                                          "hang"};
  const Outcome solve =
      run({"solve", file, "--plugin", tests::plugin_library("misbehaving"), "--query-limit", "0.3",
           "--out", path("answers.csv"), "--json", path("summary.json")});
  const std::string answers = read_file(path("answers.csv"));
  for (const std::string& failure : failures) {
    EXPECT_TRUE(contains(answers, "," + failure + "\n")) << answers;
  }
  const Outcome certify = run({"certify", file, "--plugin", tests::plugin_library("misbehaving"),
                               "--query-limit", "0.3", "--json", path("result.json")});
  EXPECT_EQ(certify.status, 1);
  EXPECT_TRUE(contains(certify.out,
                       "no answer: misbehaving: 1 crash, 1 exit, 1 exception, 1 no_verdict, 1 "
                       "not_finite, 1 hang, 1 undecided\n"))
      << certify.out;
  // A hang counts as a collision, and not as a wrong answer.
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_TRUE(contains(certify.out, "answer " + failures[i] + ", truth")) << certify.out;
  }
  const nlohmann::json counts{{"crash", 1},      {"exit", 1}, {"exception", 1}, {"no_verdict", 1},
                              {"not_finite", 1}, {"hang", 1}, {"undecided", 1}};
  EXPECT_EQ(json("summary.json").at("failures"), counts);
  EXPECT_EQ(json("result.json").at("methods")[0].at("failures"), counts);
  EXPECT_EQ(json("result.json").at("methods")[0].at("errors"), 5);
  // The same as a file of answers.
  const Outcome again =
      run({"certify", file, "--results", path("answers.csv"), "--json", path("again.json")});
  EXPECT_EQ(again.status, 1);
  EXPECT_EQ(json("again.json").at("methods")[0].at("failures"), counts);
}

TEST_F(Tool, APluginThatEndsItsProcessOnLoadingIsBadInput) {
  const std::string file = write("queries_vf.csv", falling_vertex("1"));
  for (const std::string how : {"constructor exits", "version exits", "name crashes"}) {
    ASSERT_EQ(::setenv("TOUCHSTONE_TEST_LOADING", how.c_str(), 1), 0);
    for (const std::vector<std::string>& command : {std::vector<std::string>{"certify", file},
                                                    {"solve", file, "--out", path("answers.csv")},
                                                    {"bench", file},
                                                    {"stability", "--count", "1"},
                                                    {"fuzz", "--queries", "1"}}) {
      std::vector<std::string> words = command;
      words.insert(words.end(), {"--plugin", tests::plugin_library("bad_loading")});
      const Outcome outcome = run(words);
      EXPECT_EQ(outcome.status, 2) << how << " " << command.front();
      EXPECT_TRUE(contains(outcome.err, "bad_loading.so: cannot load: ")) << outcome.err;
    }
  }
  ::unsetenv("TOUCHSTONE_TEST_LOADING");
}

TEST_F(Tool, OutputOfAPluginIsKeptApart) {
  const std::string file = write("queries_vf.csv", misbehave(tests::Misbehaviour::prints));
  const std::vector<std::string> certify{"certify", file, "--plugin",
                                         tests::plugin_library("misbehaving")};
  const Outcome quiet = run(certify);
  EXPECT_FALSE(contains(quiet.out + quiet.err, "printed by a plugin")) << quiet.out;
  EXPECT_TRUE(contains(quiet.err, "misbehaving printed 38 bytes; --show-output shows them"))
      << quiet.err;
  std::vector<std::string> shown = certify;
  shown.emplace_back("--show-output");
  const Outcome loud = run(shown);
  EXPECT_FALSE(contains(loud.out, "printed by a plugin")) << loud.out;
  EXPECT_TRUE(contains(loud.err, "misbehaving: printed by a plugin\\x1b[31m\n")) << loud.err;
  EXPECT_TRUE(contains(loud.err, "misbehaving: and as error\n")) << loud.err;
}

TEST_F(Tool, APluginWritesIntoAFolderOfItsOwn) {
  const std::string file = write("queries_vf.csv", misbehave(tests::Misbehaviour::writes_a_file));
  EXPECT_EQ(run({"solve", file, "--plugin", tests::plugin_library("misbehaving"), "--out",
                 path("answers.csv")})
                .status,
            0);
  EXPECT_TRUE(contains(read_file(path("answers.csv")), ",no,"));
  EXPECT_FALSE(std::filesystem::exists("written_by_a_plugin"));
}

/// The plugin's work is bounded: without a limit it makes few processes and allocates little.
TEST_F(Tool, APluginThatForksOrAllocatesWithoutEndCostsAQuery) {
  using tests::Misbehaviour;
  const std::string file =
      write("queries_vf.csv", misbehave(Misbehaviour::forks) + misbehave(Misbehaviour::allocates) +
                                  misbehave(Misbehaviour::says_no));
  const std::vector<std::string> solve{"solve",    file,
                                       "--plugin", tests::plugin_library("misbehaving"),
                                       "--out",    path("answers.csv")};
  std::vector<std::string> limited = solve;
  limited.insert(limited.end(), {"--memory-limit", "0.25"});
  EXPECT_EQ(run(limited).status, 0);
  const std::string answers = read_file(path("answers.csv"));
  EXPECT_TRUE(contains(answers, ",error,,,,exception: fork is refused\n")) << answers;
#ifndef TOUCHSTONE_SANITIZED
  EXPECT_TRUE(contains(answers, ",error,,,,exception: std::bad_alloc\n")) << answers;
#endif
  EXPECT_TRUE(contains(answers, ",2,vertex-face,no,")) << answers;
  std::vector<std::string> free = solve;
  free.insert(free.end(), {"--memory-limit", "0", "--allow-processes"});
  EXPECT_EQ(run(free).status, 0);
  EXPECT_FALSE(contains(read_file(path("answers.csv")), "error"));
}

/// The plugin says yes with tolerance 0 to a query that never is in contact.
TEST_F(Tool, AYesIsJudgedByItsTolerance) {
  const std::string file =
      write("queries_vf.csv", misbehave(tests::Misbehaviour::yes_with_tolerance_0));
  const Outcome certify = run({"certify", file, "--plugin", tests::plugin_library("misbehaving"),
                               "--json", path("result.json")});
  EXPECT_EQ(certify.status, 1) << certify.out;
  EXPECT_EQ(json("result.json").at("methods")[0].at("beyond_tolerance"), 1);
  EXPECT_TRUE(contains(certify.out, "beyond tolerance: misbehaving: ")) << certify.out;
  EXPECT_TRUE(contains(certify.out, "answer yes, tolerance 0, truth no collision")) << certify.out;
  // A file of answers is judged in the same way.
  write("answers.csv", answers_header + file + ",0,vertex-face,yes,0,,0\n");
  EXPECT_EQ(run({"certify", file, "--results", path("answers.csv")}).status, 1);
  write("far.csv", answers_header + file + ",0,vertex-face,yes,0,,1000\n");
  EXPECT_EQ(run({"certify", file, "--results", path("far.csv")}).status, 0);
}

TEST_F(Tool, ACrashThatDoesNotRepeatIsReportedAndIsAnError) {
  using tests::Misbehaviour;
  std::string text;
  for (int i = 0; i < 2048; ++i) text += misbehave(Misbehaviour::dies_at_call_1500);
  const std::string file = write("queries_vf.csv", text);
  const std::string said = "misbehaving ended its process 1 times, not at a particular query";
  // One thread, so that there is one process.
  const Outcome solve =
      run({"solve", file, "--plugin", tests::plugin_library("misbehaving"), "--threads", "1",
           "--out", path("answers.csv"), "--json", path("summary.json")});
  EXPECT_EQ(solve.status, 0);
  EXPECT_TRUE(contains(solve.err, said)) << solve.err;
  EXPECT_EQ(json("summary.json").at("no"), 2048);
  EXPECT_EQ(json("summary.json").at("unplaced_crashes"), 1);
  const Outcome certify = run({"certify", file, "--plugin", tests::plugin_library("misbehaving"),
                               "--threads", "1", "--json", path("result.json")});
  EXPECT_EQ(certify.status, 1);
  EXPECT_TRUE(contains(certify.err, said)) << certify.err;
  EXPECT_EQ(json("result.json").at("methods")[0].at("errors"), 1);
}

TEST_F(Tool, OurOwnAnswersCanBeReadBack) {
  ASSERT_EQ(run({"solve", "--count", "4", "--max-checks", "20", "--method", "tight_inclusion",
                 "--out", path("answers.csv")})
                .status,
            0);
  ASSERT_TRUE(contains(read_file(path("answers.csv")), ",inf,\n")) << "what this test is about";
  const Outcome certify = run({"certify", "--count", "4", "--results", path("answers.csv")});
  EXPECT_EQ(certify.status, 0) << certify.err << certify.out;
  EXPECT_EQ(certify.err, "");
}

TEST_F(Tool, SolversOfOneNameAreDistinguishedAndNamedEvenWithoutQueries) {
  const Outcome certify =
      run({"certify", path("missing"), "--plugin", tests::plugin_library("box_overlap"), "--plugin",
           tests::plugin_library("box_overlap"), "--json", path("result.json")});
  EXPECT_EQ(certify.status, 2);
  const nlohmann::json methods = json("result.json").at("methods");
  ASSERT_EQ(methods.size(), 2U);
  EXPECT_EQ(methods[0].at("name"), "box_overlap");
  EXPECT_EQ(methods[1].at("name"), "box_overlap (2)");
  EXPECT_EQ(methods[0].at("queries"), 0);
}

TEST_F(Tool, SolvedAnswersAreJudgedAsTheirSolverIs) {
  for (const bool built_in : {true, false}) {
    std::vector<std::string> sources{"--count", "8"};
    if (!built_in) {
      ASSERT_EQ(run({"generate", "--out", path("set"), "--count", "8"}).status, 0);
      sources = {path("set")};
    }
    const auto with = [&](std::vector<std::string> words) {
      words.insert(words.end(), sources.begin(), sources.end());
      return words;
    };
    ASSERT_EQ(run(with({"solve", "--plugin", tests::plugin_library("box_overlap"), "--out",
                        path("answers.csv"), "--json", path("summary.json")}))
                  .status,
              0);
    const Outcome certify =
        run(with({"certify", "--plugin", tests::plugin_library("box_overlap"), "--results",
                  path("answers.csv"), "--json", path("result.json")}));
    EXPECT_EQ(certify.status, 0) << certify.err;
    EXPECT_EQ(certify.err, "");
    const nlohmann::json methods = json("result.json").at("methods");
    ASSERT_EQ(methods.size(), 2U);
    EXPECT_EQ(methods[0].at("name"), "box_overlap");
    EXPECT_EQ(methods[0].at("queries"), json("summary.json").at("queries"));
    EXPECT_GT(methods[0].at("false_positives"), 0);
    EXPECT_GT(methods[0].at("ns_per_query"), 0.0);
    for (const char* field : {"queries", "false_positives", "false_negatives", "toi_error"}) {
      EXPECT_EQ(methods[0].at(field), methods[1].at(field)) << field;
    }
  }
}

TEST_F(Tool, MethodsAreJudgedUnaskedOnTheBuiltInSetOnly) {
  const std::string file = write("queries_vf.csv", falling_vertex("1"));
  const auto judged = [&](const std::vector<std::string>& words) {
    std::vector<std::string> all{"certify", "--json", path("result.json"), "--max-checks", "1000"};
    all.insert(all.end(), words.begin(), words.end());
    EXPECT_EQ(run(all).status, 0);
    return json("result.json").at("methods").size();
  };
  EXPECT_GE(judged({"--count", "1"}), 1U);
  EXPECT_EQ(judged({"--count", "1", "--method", "none"}), 0U);
  EXPECT_EQ(run({"certify", "--json", path("result.json"), file}).status, 0);
  EXPECT_EQ(json("result.json").at("methods").size(), 0U);
  EXPECT_EQ(judged({file, "--method", "tight_inclusion"}), 1U);
  EXPECT_EQ(judged({"--method", "tight_inclusion", file, "--query-limit", "10"}), 1U);
}

TEST_F(Tool, SolveKeepsWhatItHasWhenARowIsBad) {
  const std::string file = write("bad_vf.csv", falling_vertex("1") + "1,0,1,1,1,1,1\n");
  const Outcome solve = run({"solve", file, "--plugin", tests::plugin_library("box_overlap"),
                             "--out", path("answers.csv")});
  EXPECT_EQ(solve.status, 2);
  EXPECT_TRUE(contains(solve.err, file + ":9:2: ")) << solve.err;
  EXPECT_EQ(read_file(path("answers.csv")), full_header + file + ",0,vertex-face,yes,0,,,\n");
}

TEST_F(Tool, AFullDeviceEndsSolveEarly) {
  const Outcome solve = run({"solve", "--count", "100000000", "--plugin",
                             tests::plugin_library("box_overlap"), "--out", "/dev/full"});
  EXPECT_EQ(solve.status, 2) << solve.err;
  EXPECT_TRUE(contains(solve.err, "/dev/full: cannot write")) << solve.err;
}

TEST_F(Tool, AnInterruptIsObeyedWhileASolverHangs) {
  using tests::Misbehaviour;
  std::string text =
      falling_vertex("0").replace(0, 1, std::to_string(static_cast<int>(Misbehaviour::hangs)));
  const std::string file = write("queries_vf.csv", text);
  for (const std::string command : {"solve", "certify"}) {
    std::vector<std::string> words{command,    file,
                                   "--plugin", tests::plugin_library("misbehaving"),
                                   "--json",   path("result.json")};
    if (command == "solve") words.insert(words.end(), {"--out", path("answers.csv")});
    const pid_t process = start(words);
    // The plugin is loaded in a child too, but before the outputs are opened.
    EXPECT_TRUE(tests::comes_true([&] {
      return std::ranges::any_of(fs::directory_iterator(folder()), [](const auto& entry) {
        return entry.path().filename().string().starts_with("result.json");
      });
    }));
    wait_for_child(process);
    kill(process, SIGINT);
    const Outcome outcome = finish(process);
    EXPECT_EQ(outcome.status, 130) << command << outcome.err;
    EXPECT_EQ(json("result.json").at("interrupted"), true);
    EXPECT_EQ(json("result.json").at("queries"), 0);
    fs::remove(path("result.json"));
  }
}

TEST_F(Tool, AnInterruptOfSolveKeepsWhatIsDone) {
  using namespace std::chrono_literals;
  const Outcome solve = run_interrupted(
      {"solve", "--count", "100000000", "--plugin", tests::plugin_library("box_overlap"), "--out",
       path("answers.csv"), "--json", path("summary.json")},
      [&] { return has_grown("answers.csv"); });
  EXPECT_EQ(solve.status, 130);
  EXPECT_EQ(json("summary.json").at("interrupted"), true);
  const std::string answers = read_file(path("answers.csv"));
  EXPECT_GT(json("summary.json").at("queries"), 0);
  EXPECT_EQ(std::count(answers.begin(), answers.end(), '\n'),
            json("summary.json").at("queries").get<long>() + 1);
}

}  // namespace
}  // namespace touchstone::verify::cli::commands_test
