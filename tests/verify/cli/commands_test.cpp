#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

// The commands (verify/cli/commands.hpp) are tested as users meet them: by running the tool.

namespace touchstone::verify::cli {
namespace {

namespace fs = std::filesystem;

std::string read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

struct Outcome {
  int status;
  std::string out;
  std::string err;
};

class Tool : public ::testing::Test {
 public:
  Tool(const Tool&) = delete;
  Tool& operator=(const Tool&) = delete;
  Tool(Tool&&) = delete;
  Tool& operator=(Tool&&) = delete;

 protected:
  Tool() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(::testing::TempDir()) /
              (std::string("touchstone_cli_") + test->name() + "_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  ~Tool() override { fs::remove_all(folder_); }

  /// Starts the tool with its output in files of the test's folder.
  [[nodiscard]] pid_t start(const std::vector<std::string>& arguments) const {
    std::vector<std::string> words{TOUCHSTONE_TOOL};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions{};
    posix_spawn_file_actions_init(&actions);
    static constexpr int flags = O_WRONLY | O_CREAT | O_TRUNC;
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, path("stdout").c_str(), flags, 0600);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, path("stderr").c_str(), flags, 0600);
    pid_t process = 0;
    const int error =
        posix_spawn(&process, TOUCHSTONE_TOOL, &actions, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    EXPECT_EQ(error, 0);
    return process;
  }

  /// Waits for the end; the status of a process that a signal ended is minus the signal.
  [[nodiscard]] Outcome finish(pid_t process) const {
    int status = 0;
    waitpid(process, &status, 0);
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    return {code, read_file(path("stdout")), read_file(path("stderr"))};
  }

  [[nodiscard]] Outcome run(const std::vector<std::string>& arguments) const {
    return finish(start(arguments));
  }

  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_ / name).string();
  }

  [[nodiscard]] nlohmann::json json(const std::string& name) const {
    return nlohmann::json::parse(read_file(path(name)));
  }

  std::string write(const std::string& name, const std::string& text) const {
    fs::create_directories(fs::path(path(name)).parent_path());
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }

 private:
  fs::path folder_;
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A vertex that falls through a resting triangle (label 1 is true), as rows of the 2021 format.
std::string falling_vertex(const std::string& label, const std::string& end_height = "-3") {
  const auto rows = [&](const std::string& height) {
    return "1,1,1,1," + height + ",1," + label + "\n0,1,0,1,0,1," + label + "\n4,1,0,1,0,1," +
           label + "\n0,1,4,1,0,1," + label + "\n";
  };
  return rows("1") + rows(end_height);
}

TEST_F(Tool, HelpHasAnExampleEverywhere) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--help"}, {"certify", "--help"}, {"generate", "--help"}}) {
    const Outcome help = run(arguments);
    EXPECT_EQ(help.status, 0);
    EXPECT_TRUE(contains(help.out, "Example: touchstone ")) << help.out;
  }
}

TEST_F(Tool, UsageErrorsExitWithTwo) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{},
        {"nonsense"},
        {"certify", "--nonsense"},
        {"certify", "--kind", "face-face"},
        {"certify", "--count", "0"},
        {"certify", "--seed", "-1"},
        {"certify", "--threads", "x"},
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

TEST_F(Tool, WrongAnswersOutrankBadInput) {
  const std::string file = write("wrong_vf.csv", falling_vertex("0") + "1,2,3\n");
  EXPECT_EQ(run({"certify", file}).status, 1);
}

TEST_F(Tool, KindOptionServesWhereThePathDoesNot) {
  const std::string file = write("queries.csv", falling_vertex("1"));
  EXPECT_EQ(run({"certify", file}).status, 2);
  EXPECT_EQ(run({"certify", file, "--kind", "vertex-face"}).status, 0);
}

TEST_F(Tool, RoundAcceptsAndCountsWhatIsNoDouble) {
  std::string text = falling_vertex("1");
  text.replace(0, 3, "1,3");
  const std::string file = write("thirds_vf.csv", text);
  const Outcome strict = run({"certify", file});
  EXPECT_EQ(strict.status, 2);
  EXPECT_TRUE(contains(strict.err, file + ":1:1: ")) << strict.err;
  EXPECT_EQ(run({"certify", file, "--round", "--json", path("result.json")}).status, 0);
  EXPECT_EQ(json("result.json").at("rounded"), 1);
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
  EXPECT_EQ(run({"certify", file, "--json", path("x"), "--truth", path("x")}).status, 2);
  EXPECT_EQ(read_file(file), text);
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

TEST_F(Tool, MissingInputIsAnErrorWithItsName) {
  const Outcome certify = run({"certify", path("missing.csv")});
  EXPECT_EQ(certify.status, 2);
  EXPECT_TRUE(contains(certify.err, path("missing.csv"))) << certify.err;
}

TEST_F(Tool, BuiltInSetIsCertified) {
  const Outcome certify = run({"certify", "--count", "10", "--json", path("result.json")});
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
  EXPECT_EQ(run({"certify", "--count", "20", "--json", path("set_result.json")}).status, 0);
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
  const pid_t process = start({"certify", "--count", "100000000", "--json", path("result.json"),
                               "--truth", path("truth.csv")});
  // Wait until the work is under way: the truth grows, still under its temporary name.
  const auto truth_so_far = [&] {
    std::uintmax_t size = 0;
    for (const auto& entry : fs::directory_iterator(path(""))) {
      if (entry.path().filename().string().starts_with("truth.csv")) size = entry.file_size();
    }
    return size;
  };
  for (int i = 0; i < 600 && truth_so_far() == 0; ++i) std::this_thread::sleep_for(50ms);
  kill(process, SIGINT);
  const Outcome certify = finish(process);
  EXPECT_EQ(certify.status, 130);
  const nlohmann::json result = json("result.json");
  EXPECT_EQ(result.at("interrupted"), true);
  EXPECT_GT(result.at("queries"), 0);
  const std::string truth = read_file(path("truth.csv"));
  EXPECT_EQ(std::count(truth.begin(), truth.end(), '\n'), result.at("queries").get<long>() + 1);
}

}  // namespace
}  // namespace touchstone::verify::cli
