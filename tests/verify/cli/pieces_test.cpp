#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "tests/support/certificates.hpp"
#include "tests/support/tool_test.hpp"
#include "verify/jobs/pieces.hpp"

// Tests of --shard, --resume and `touchstone merge`, some of which run the tool.

namespace touchstone::verify::cli::pieces_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using tests::contains;
using tests::Outcome;

// ---- Shards -------------------------------------------------------------------------------------

class Shards : public tests::ToolTest {
 protected:
  /// The message about a part that is not there, or another one.
  [[nodiscard]] std::string error_of(const std::string& text) const {
    const Outcome outcome = run({"certify", "--count", "1", "--shard", text});
    return outcome.status == 2 ? outcome.err : "";
  }

  void TearDown() override {
    for (const std::string& name : set_) ::unsetenv(name.c_str());
  }
  void set(const std::string& name, const std::string& value) {
    ::setenv(name.c_str(), value.c_str(), 1);
    set_.push_back(name);
  }

 private:
  std::vector<std::string> set_;
};

TEST_F(Shards, AreCountedFromZero) {
  EXPECT_EQ(error_of("0/1"), "");
  EXPECT_TRUE(
      contains(error_of("5/5"), "--shard: there is no part 5 of 5; parts are counted from 0"));
  for (const std::string bad : {"1", "/", "1/", "/2", "a/b", "1/2/3", "0/0x2", "1 / 2"}) {
    EXPECT_TRUE(contains(error_of(bad), "is not I/N, as 0/4 or 3/4")) << bad;
  }
}

TEST_F(Shards, ComeFromEnginesByTheirVariables) {
  EXPECT_TRUE(contains(error_of("auto"), "neither SLURM_ARRAY_TASK_ID"));
  set("OMPI_COMM_WORLD_RANK", "3");
  set("OMPI_COMM_WORLD_SIZE", "3");
  EXPECT_TRUE(contains(error_of("auto"), "no part 3 of 3"));
  const auto set_array = [&](const std::string& id, const std::string& first,
                             const std::string& last, const std::string& count) {
    set("SLURM_ARRAY_TASK_ID", id);
    set("SLURM_ARRAY_TASK_MIN", first);
    set("SLURM_ARRAY_TASK_MAX", last);
    set("SLURM_ARRAY_TASK_COUNT", count);
    return error_of("auto");
  };
  EXPECT_EQ(set_array("7", "0", "7", "8"), "");
  EXPECT_TRUE(contains(set_array("8", "0", "7", "8"), "no part 8 of 8"));
  // Tasks that are submitted again: one, the first, some, the last ones; and others than 0 to N-1.
  for (const auto& [id, first, last, count] :
       std::vector<std::array<std::string, 4>>{{"5", "5", "5", "1"},
                                               {"0", "0", "0", "1"},
                                               {"3", "3", "7", "2"},
                                               {"6", "6", "7", "2"},
                                               {"4", "0", "12", "4"},
                                               {"1", "1", "8", "8"}}) {
    EXPECT_TRUE(contains(set_array(id, first, last, count), "name it: --shard " + id + "/N")) << id;
  }
}

// ---- Runs ---------------------------------------------------------------------------------------

class PieceRuns : public tests::ToolTest {
 protected:
  void SetUp() override {
    ToolTest::SetUp();
    std::vector<std::string> words{"generate", "--out", path("data"), "--count", "100"};
    for (const char* family : {"hourglass", "contact-at-start", "contact-at-end", "tangential"}) {
      words.insert(words.end(), {"--family", family});
    }
    ASSERT_EQ(run(words).status, 0);
  }

  /// The data as a store of many shards.
  void make_store() const {
    ASSERT_EQ(run({"convert", path("data"), "--out", path("store"), "--shard-size", "8"}).status,
              0);
  }

  [[nodiscard]] bool exists(const std::string& name) const { return fs::exists(path(name)); }

  /// The words of a run in pieces of a command.
  [[nodiscard]] std::vector<std::string> words(const std::string& command, const std::string& name,
                                               const std::string& data = "data") const {
    std::vector<std::string> result{command, path(data), "--resume", path(name)};
    if (command != "prove") result.insert(result.end(), {"--method", "cubic"});
    result.insert(result.end(), {"--json", path(name + ".json")});
    if (command == "certify") {
      result.insert(result.end(),
                    {"--truth", path(name + ".csv"), "--prove", path(name + ".cert")});
    } else {
      result.insert(result.end(), {"--out", path(name + (command == "prove" ? ".cert" : ".csv"))});
    }
    return result;
  }

  /// The contents of all merged files.
  [[nodiscard]] std::string results(const std::string& name) const {
    std::string text;
    for (const std::string ending : {".json", ".csv", ".cert"}) {
      if (exists(name + ending)) text += read(name + ending);
    }
    return text;
  }
};

/// A result without what differs from run to run.
Json without_means(const Json& value) {
  Json result = value;
  if (value.is_structured()) result.clear();
  for (const auto& [key, item] : value.items()) {
    if (value.is_array()) result.push_back(without_means(item));
    if (!value.is_object() || contains(key, "_per_") || key == "file_bytes") continue;
    result[key] = without_means(item);
  }
  return result;
}

TEST_F(PieceRuns, GiveWhatOneRunGives) {
  for (const std::string command : {"certify", "solve", "prove"}) {
    SCOPED_TRACE(command);
    const std::string name = command;
    const Outcome pieces = run(words(command, name));
    std::vector<std::string> plain = words(command, command + "_plain");
    plain.erase(plain.begin() + 2, plain.begin() + 4);
    const Outcome whole = run(plain);
    EXPECT_EQ(pieces.status, whole.status) << pieces.err;
    EXPECT_EQ(without_means(json(name + ".json")), without_means(json(name + "_plain.json")));
    for (const std::string ending : {".csv", ".cert"}) {
      EXPECT_EQ(exists(name + ending), exists(name + "_plain" + ending));
      EXPECT_EQ(read(name + ending), read(name + "_plain" + ending));
    }
    if (!exists(name + ".cert")) continue;
    EXPECT_TRUE(tests::check(read(name + ".cert")).all_accepted());
  }
  EXPECT_TRUE(contains(run({"merge", path("solve")}).out, "no truth: nothing was judged"));
  EXPECT_TRUE(contains(run({"merge", path("certify")}).out, "cubic: 800 judged, "));
}

TEST_F(PieceRuns, OfTheBuiltInSetAreByFamily) {
  const std::vector<std::string> common{"certify", "--count", "20", "--json", path("a.json")};
  std::vector<std::string> in_pieces = common;
  in_pieces.insert(in_pieces.end(), {"--resume", path("run")});
  EXPECT_EQ(run(in_pieces).status, 0);
  const Json total = json("a.json");
  EXPECT_EQ(run(common).status, 0);
  EXPECT_EQ(total, without_means(json("a.json")));
}

TEST_F(PieceRuns, AreOfAProgramKnownByItsCommitOrItsDigest) {
  std::string version = run({"--version"}).out;
  version.pop_back();
  ASSERT_EQ(run(words("solve", "one")).status, 0);
  const bool is_commit = version.ends_with(')') && !version.ends_with("-dirty)");
  const std::string digest = jobs::digest_of(tests::touchstone_program());
  EXPECT_EQ(json("one/plan.json")["program"],
            is_commit ? version : version + ", SHA-256 " + digest);
}

TEST_F(PieceRuns, ByShardsInAnyOrderGiveTheSame) {
  ASSERT_EQ(run(words("certify", "one")).status, 1);
  for (const std::string shard : {"2/3", "0/3", "1/3"}) {
    std::vector<std::string> some = words("certify", "some");
    some.insert(some.end(), {"--shard", shard, "--threads", "1"});
    const Outcome outcome = run(some);
    EXPECT_LE(outcome.status, 1) << outcome.err;
    if (shard != "1/3") {
      EXPECT_TRUE(contains(outcome.out, ": when all are, touchstone merge"));
      EXPECT_EQ(run({"merge", path("some")}).status, 2);
    }
  }
  EXPECT_EQ(results("some"), results("one"));
  // A file that is no piece of the run is no piece that is not done.
  fs::copy(path("some/000000.piece"), path("some/999999.piece"));
  const std::string all = std::to_string(json("some/plan.json")["pieces"].size());
  std::vector<std::string> again = words("certify", "some");
  again.insert(again.end(), {"--shard", "0/3"});
  EXPECT_TRUE(contains(run(again).out, all + " of " + all + " pieces are done, not yet 0"));
  // Without a folder, a shard is a run of its own.
  std::uint64_t queries = 0;
  for (const std::string shard : {"0/2", "1/2"}) {
    ASSERT_EQ(run({"certify", path("data"), "--shard", shard, "--json", path("half.json")}).status,
              0);
    queries += json("half.json")["queries"].get<std::uint64_t>();
  }
  EXPECT_EQ(queries, 800U);
}

TEST_F(PieceRuns, ThatAreKilledGoOn) {
  make_store();
  ASSERT_EQ(run(words("certify", "one", "store")).status, 1);
  const std::string expected = results("one");
  const std::size_t all = json("one/plan.json")["pieces"].size();
  ASSERT_EQ(all, 104U);
  const auto done = [&] {
    std::size_t count = 0;
    if (!exists("killed")) return count;
    for (const auto& entry : fs::directory_iterator(path("killed"))) {
      count += entry.path().extension() == ".piece" ? 1U : 0U;
    }
    return count;
  };
  // At twenty random moments, each up to some pieces after the start and in the work.
  std::mt19937 random(20);
  std::size_t most = 0;
  for (int i = 0; i < 20; ++i) {
    const std::size_t pieces = most + random() % 3;
    const pid_t process = start(words("certify", "killed", "store"));
    ASSERT_TRUE(tests::comes_true([&] { return done() >= pieces; }));
    ::usleep(static_cast<useconds_t>(random() % 20'000));
    ::kill(process, SIGKILL);
    static_cast<void>(finish(process));
    EXPECT_GE(done(), most);  // none is lost
    most = done();
    ASSERT_LT(most, all);
  }
  EXPECT_EQ(run(words("certify", "killed", "store")).status, 1);
  EXPECT_EQ(results("killed"), expected);
  fs::remove(path("killed.json"));
  EXPECT_EQ(run({"merge", path("killed"), "--json", path("again.json")}).status, 1);
  EXPECT_EQ(read("again.json"), read("one.json"));
}

TEST_F(PieceRuns, OfAStoreProveThatTheyCoverItsManifest) {
  make_store();
  const std::string shard = path("store/edge-edge/hourglass-00003.npy");
  std::string text = tests::read_file(shard);
  text.back() = static_cast<char>(text.back() ^ 1);
  std::ofstream(shard, std::ios::binary) << text;
  EXPECT_EQ(run(words("certify", "a", "store")).status, 2);
  EXPECT_TRUE(contains(read("err"), shard + " is not as the manifest of its store says"));
  EXPECT_EQ(run({"merge", path("a")}).status, 2);
  EXPECT_TRUE(contains(read("err"), "1 of 104 pieces: nothing is merged"));
  fs::remove(shard);
  EXPECT_EQ(run(words("certify", "b", "store")).status, 2);
  EXPECT_TRUE(contains(read("err"), shard + ": missing, but the manifest of its store names it"));
}

TEST_F(PieceRuns, AreRefusedWhereTheyMakeNoSense) {
  const std::string data = path("data");
  EXPECT_EQ(run({"certify", data, "--resume", path("a"), "--view", path("a.html")}).status, 2);
  EXPECT_TRUE(contains(read("err"), "--view does not work with --resume"));
  EXPECT_EQ(run({"bench", "--resume", path("a")}).status, 2);
  EXPECT_EQ(run({"certify", data, "--shard", "3/3"}).status, 2);
  EXPECT_EQ(run({"merge", path("data")}).status, 2);
  EXPECT_TRUE(contains(read("err"), "no pieces (there is no plan.json)"));
  ASSERT_EQ(run(words("certify", "one")).status, 1);
  std::vector<std::string> other = words("certify", "one");
  other.emplace_back("--exact");
  EXPECT_EQ(run(other).status, 2);
  EXPECT_TRUE(contains(read("err"), "has the pieces of a run with the options"));
}

TEST_F(PieceRuns, ThatCannotReadAnInputDoTheOthers) {
  const std::string bad = write("data/edge-edge/bad.csv", "1,1\n");
  const Outcome outcome = run(words("certify", "one"));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(contains(outcome.err, bad + ":1: 2 columns")) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "ended with status 2; it is not done")) << outcome.err;
  const Outcome merged = run({"merge", path("one")});
  EXPECT_EQ(merged.status, 2);
  EXPECT_TRUE(contains(merged.err, "bad.csv: missing")) << merged.err;
  EXPECT_TRUE(contains(merged.err, "1 of 9 pieces: nothing is merged")) << merged.err;
}

TEST_F(PieceRuns, OfOtherCommandsStayApart) {
  ASSERT_EQ(run({"fuzz", "--method", "certified", "--queries", "500", "--shard", "1/2", "--resume",
                 path("fuzz")})
                .status,
            0);
  ASSERT_EQ(run({"fuzz", "--method", "certified", "--queries", "500", "--shard", "0/2", "--resume",
                 path("fuzz"), "--json", path("x.json")})
                .status,
            2);  // other outputs
  ASSERT_EQ(run({"fuzz", "--method", "certified", "--queries", "500", "--shard", "0/2", "--resume",
                 path("fuzz")})
                .status,
            0)
      << read("err");
  ASSERT_EQ(run({"merge", path("fuzz"), "--json", path("fuzz.json")}).status, 0);
  const Json total = json("fuzz.json");
  ASSERT_EQ(total["pieces"].size(), 2U);
  EXPECT_EQ(total["pieces"][0]["result"]["seed"], 2021);
  EXPECT_EQ(total["pieces"][1]["result"]["seed"], 2022);
  ASSERT_EQ(run({"generate", "--out", path("frames"), "--patches", "4"}).status, 0);
  ASSERT_EQ(run({"step", path("frames"), "--resume", path("step"), "--csv", path("pairs.csv"),
                 "--json", path("steps.json")})
                .status,
            run({"step", path("frames"), "--csv", path("whole.csv")}).status);
  EXPECT_EQ(read("pairs.csv"), read("whole.csv"));
  EXPECT_EQ(json("steps.json")["pieces"].size(), 1U);
}

}  // namespace
}  // namespace touchstone::verify::cli::pieces_test
