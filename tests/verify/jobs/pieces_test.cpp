#include "verify/jobs/pieces.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/messages.hpp"
#include "tests/support/tool_test.hpp"
#include "verify/io/sha256.hpp"

namespace touchstone::verify::jobs::pieces_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// A run of three pieces whose outputs are written by hand.
class Pieces : public tests::ToolTest {
 protected:
  void SetUp() override {
    ToolTest::SetUp();
    plan_ = {.program = "1",
             .command = "certify",
             .options = {"--method=x"},
             .uses = {},
             .outputs = {{"--json", "a.json"}, {"--truth", "a.csv"}},
             .pieces = {}};
    begin();
  }

  /// Begins anew, with the inputs as they were.
  void begin() {
    fs::remove_all(path("run"));
    plan_.pieces.clear();
    for (int i = 0; i < 3; ++i) {
      const std::string name = "input" + std::to_string(i);
      const std::string file = write(name, name);
      plan_.pieces.push_back({.name = name, .files = {file}, .arguments = {file}});
    }
  }

  [[nodiscard]] PieceFolder open() const { return {path("run"), plan_}; }

  /// \param meanwhile what happens after the outputs are written
  int do_piece(
      const PieceFolder& run, std::size_t i, int status = 0,
      const std::function<void(const fs::path& folder)>& meanwhile = [](const fs::path&) {}) const {
    return run.finish(i, [&](const std::map<std::string, fs::path>& outputs) {
      Json result{{"queries", 10 + i},
                  {"us_per_query", 0.5 * static_cast<double>(i)},
                  {"interrupted", false},
                  {"late", {{"greatest", 0.25 * static_cast<double>(i)}, {"beyond", {1, i}}}},
                  {"files", {{{"file", plan_.pieces[i].name}}}}};
      std::ofstream(outputs.at("--json")) << result;
      std::ofstream(outputs.at("--truth")) << "header\nrow " << i << "\n";
      meanwhile(outputs.at("--json").parent_path());
      return status;
    });
  }

  [[nodiscard]] PieceFolder all_done() const {
    const PieceFolder run = open();
    for (const std::size_t i : {2U, 0U, 1U}) do_piece(run, i, i == 1 ? 1 : 0);
    return run;
  }

  [[nodiscard]] static std::string text_of(const PieceFolder& run) {
    std::string text;
    run.merged_text("--truth", [&](std::string_view part) { text += part; });
    return text;
  }

  Plan plan_;
};

// Merged files are compared with those of one run in tests/transcripts/merge.md.

TEST_F(Pieces, AreMergedInTheOrderOfThePlan) {
  const PieceFolder run = all_done();
  EXPECT_EQ(run.status(), 1);
  EXPECT_EQ(text_of(run), "header\nrow 0\nrow 1\nrow 2\n");
  const Json total = run.merged_json();
  EXPECT_EQ(total["queries"], 33);
  EXPECT_EQ(total["late"], (Json{{"greatest", 0.5}, {"beyond", {3, 3}}}));
  EXPECT_EQ(total["files"].size(), 3U);
  EXPECT_FALSE(total.contains("us_per_query"));
}

TEST_F(Pieces, OfAnotherPlanAreRefused) {
  (void)open();
  const auto error_with = [&](const std::function<void(Plan&)>& change) {
    Plan other = plan_;
    change(other);
    return tests::message_of<std::runtime_error>(
        [&] { const PieceFolder run(path("run"), other); });
  };
  const std::vector<std::pair<std::string, std::function<void(Plan&)>>> changes{
      {"of version 1, not 2", [](Plan& plan) { plan.program = "2"; }},
      {"of certify, not solve", [](Plan& plan) { plan.command = "solve"; }},
      {"of other inputs", [](Plan& plan) { plan.pieces.pop_back(); }},
      {"with other output files", [](Plan& plan) { plan.outputs.erase("--truth"); }},
      {"with other contents of a file that an option names",
       [](Plan& plan) { plan.uses["x.so"] = "0"; }}};
  for (const auto& [difference, change] : changes) {
    EXPECT_EQ(error_with(change),
              path("run") + ": has the pieces of a run " + difference + "; choose another folder");
  }
  EXPECT_EQ(error_with([](Plan&) {}), "");
}

/// The folder of a piece's results.
fs::path results(const fs::path& run, int piece) {
  for (const auto& entry : fs::directory_iterator(run)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_directory() && name.starts_with("00000" + std::to_string(piece))) return entry;
  }
  return {};
}

/// Changes a byte of a file.
void flip(const fs::path& file, std::size_t place) {
  std::string text = tests::read_file(file);
  text.at(place) = static_cast<char>(text.at(place) ^ 1);
  std::ofstream(file, std::ios::binary) << text;
}

/// Replaces a text in a file.
void replace(const fs::path& file, const std::string& from, const std::string& to) {
  std::string text = tests::read_file(file);
  text.replace(text.find(from), from.size(), to);
  std::ofstream(file, std::ios::binary) << text;
}

/// What is done to a complete run and its inputs, and the fault that the merge then names.
TEST_F(Pieces, ThatAreDamagedAreNamed) {
  const std::string run = path("run"), input = path("input");
  const auto take_foreign_piece = [&](const std::function<void(Plan&)>& change) {
    Plan other = plan_;
    change(other);
    fs::remove_all(path("other"));
    do_piece({path("other"), other}, 0);
    fs::copy_file(path("other/000000.piece"), run + "/000000.piece",
                  fs::copy_options::overwrite_existing);
  };
  const std::vector<std::pair<std::string, std::function<void()>>> damages{
      {"000001.piece: piece 1, input1: missing", [&] { fs::remove(run + "/000001.piece"); }},
      {"input1: piece 2 is also there under this number",
       [&] {
         fs::copy_file(run + "/000002.piece", run + "/000001.piece",
                       fs::copy_options::overwrite_existing);
       }},
      {"000003.piece: no piece of this run has that name",
       [&] { fs::copy_file(run + "/000002.piece", run + "/000003.piece"); }},
      {"piece 0, input0: its record is damaged", [&] { flip(run + "/000000.piece", 30); }},
      {"piece 1, input1: its record is damaged",
       [&] { replace(run + "/000001.piece", "\"status\": 1", "\"status\": 0"); }},
      {"piece 0, input0: its results have changed since",
       [&] { flip(results(run, 0) / "truth", 9); }},
      {"No such file or directory", [&] { fs::remove(results(run, 2) / "json"); }},
      {"piece 2, input2: its input has changed since", [&] { flip(input + "2", 0); }},
      {"input0: of another run",
       [&] { take_foreign_piece([](Plan& plan) { plan.options.clear(); }); }},
      {"input0: made by version \"0.9\", not 1",
       [&] { take_foreign_piece([](Plan& plan) { plan.program = "0.9"; }); }}};
  for (const auto& [fault, act] : damages) {
    begin();
    const PieceFolder done = all_done();
    act();
    ASSERT_EQ(done.faults().size(), 1U) << fault;
    EXPECT_TRUE(tests::contains(done.faults()[0], fault)) << done.faults()[0];
  }
}

/// What happens to the files of a piece in work, and why it is not done.
TEST_F(Pieces, WhoseFilesChangeInWorkAreNotDone) {
  const std::vector<std::array<std::string, 2>> changes{
      {"input1b", "an input has changed while it was read"},
      {"x.so", "x.so: has changed since the run began"},
      {"", "x.so: cannot open"}};
  for (const auto& [changed, reason] : changes) {
    begin();
    const std::string library = write("x.so", "library");
    plan_.pieces[1].files.emplace_back(write("input1b", "companion"));
    plan_.uses[library] = io::sha256_of_file(library);
    const PieceFolder run = open();
    const auto change = [&, &name = changed](const fs::path&) {
      if (name.empty()) {
        fs::remove(library);
      } else {
        write(name, "x");
      }
    };
    const std::string error =
        tests::message_of<std::exception>([&] { do_piece(run, 1, 0, change); });
    EXPECT_TRUE(tests::contains(error, reason)) << error;
    EXPECT_EQ(run.fault(1), "missing");
    EXPECT_EQ(results(path("run"), 1), "") << "results of nobody are left";
  }
}

/// A process that was killed, and its child, which writes on.
TEST_F(Pieces, AreNotWhatALaterChildOfAKilledProcessWrites) {
  const PieceFolder run = open();
  fs::path old;
  (void)do_piece(run, 0, 1, [&](const fs::path& folder) {
    // The same piece is done again meanwhile.
    old = folder;
    (void)do_piece(open(), 0);
  });
  EXPECT_EQ(run.fault(0), "");
  (void)do_piece(open(), 0);
  std::ofstream(old / "truth") << "header\nrow of old\n";
  for (const std::size_t i : {1U, 2U}) (void)do_piece(run, i);
  EXPECT_TRUE(run.faults().empty());
  EXPECT_EQ(text_of(run), "header\nrow 0\nrow 1\nrow 2\n");
}

TEST_F(Pieces, ThatContradictEachOtherAreNotAdded) {
  const PieceFolder run = all_done();
  std::ofstream(results(path("run"), 2) / "json") << R"({"queries": 1, "interrupted": true})";
  const std::string error = tests::message_of<std::runtime_error>([&] { (void)run.merged_json(); });
  EXPECT_TRUE(tests::contains(error, "interrupted is true, elsewhere false")) << error;
}

// ---- The program of a piece ---------------------------------------------------------------------

/// The program is this test program. (Its exit statuses are in tests/transcripts/merge.md.)
class OwnProgram : public ::testing::Test {
 protected:
  void SetUp() override {
    // A shard of the tests is none of the child's.
    for (const char* name : {"GTEST_TOTAL_SHARDS", "GTEST_SHARD_INDEX"}) ::unsetenv(name);
  }
};

TEST_F(OwnProgram, SaysWhichSignalEndedIt) {
  EXPECT_EQ(run_own_program({"x", "--gtest_filter=OwnProgram.DISABLED_Killed",
                             "--gtest_also_run_disabled_tests"}),
            128 + SIGKILL);
}

TEST_F(OwnProgram, DiesWithTheProcessThatRunsIt) {
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe(pipe.data()), 0);
  // The last copy of this end is that of the program, from the time at which it says so.
  ::setenv("TOUCHSTONE_TEST_PIPE", std::to_string(pipe[1]).c_str(), 1);
  const pid_t parent = ::fork();
  if (parent == 0) {
    ::_exit(run_own_program({"x", "--gtest_filter=OwnProgram.DISABLED_SaysSoAndWaits",
                             "--gtest_also_run_disabled_tests"}));
  }
  ::close(pipe[1]);
  char letter = 0;
  ASSERT_EQ(::read(pipe[0], &letter, 1), 1);
  ::kill(parent, SIGKILL);
  ::waitpid(parent, nullptr, 0);
  EXPECT_EQ(::read(pipe[0], &letter, 1), 0) << "it lives on";
  ::close(pipe[0]);
}

TEST_F(OwnProgram, DISABLED_SaysSoAndWaits) {
  const int pipe = std::stoi(std::getenv("TOUCHSTONE_TEST_PIPE"));
  ASSERT_EQ(::write(pipe, "x", 1), 1);
  ::sleep(60);
  static_cast<void>(::write(pipe, "y", 1));
}

TEST_F(OwnProgram, DISABLED_Killed) { std::raise(SIGKILL); }

}  // namespace
}  // namespace touchstone::verify::jobs::pieces_test
