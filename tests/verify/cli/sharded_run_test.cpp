#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "tests/support/tool_test.hpp"
#include "verify/io/sha256.hpp"

// Kills of a run in pieces; the rest is in tests/transcripts/{merge,pieces}.md.

namespace touchstone::verify::cli::sharded_run_test {
namespace {

namespace fs = std::filesystem;

class PieceRuns : public tests::ToolTest {
 protected:
  /// The words of a run in pieces, on curves of three degrees and on lines.
  [[nodiscard]] std::vector<std::string> words(const std::string& name) const {
    return {"certify",
            path("curves"),
            path("data"),
            "--resume",
            path(name),
            "--method",
            "cubic",
            "--json",
            path(name + ".json"),
            "--truth",
            path(name + ".csv"),
            "--prove",
            path(name + ".cert")};
  }

  /// The contents of all merged files.
  [[nodiscard]] std::string results(const std::string& name) const {
    return read(name + ".json") + read(name + ".csv") + read(name + ".cert");
  }
};

TEST_F(PieceRuns, AreOfAProgramKnownByItsCommitOrItsDigest) {
  std::string version = run({"--version"}).out;
  version.pop_back();
  ASSERT_EQ(run({"certify", "--count", "1", "--resume", path("one")}).status, 0);
  const bool is_commit = version.ends_with(')') && !version.ends_with("-dirty)");
  const std::string digest = io::sha256_of_file(tests::touchstone_program());
  EXPECT_EQ(json("one/plan.json")["program"],
            is_commit ? version : version + ", SHA-256 " + digest);
}

TEST_F(PieceRuns, ThatAreKilledGoOn) {
  std::vector<std::string> generate{"generate", "--out", path("data"), "--count", "100"};
  for (const char* family : {"hourglass", "contact-at-start", "contact-at-end", "tangential"}) {
    generate.insert(generate.end(), {"--family", family});
  }
  ASSERT_EQ(run(generate).status, 0);
  ASSERT_EQ(run({"generate", "--out", path("curves"), "--count", "4", "--degree", "2", "--degree",
                 "3", "--degree", "rational"})
                .status,
            0);
  ASSERT_EQ(run(words("one")).status, 1);
  const std::string expected = results("one");
  const std::size_t all = json("one/plan.json")["pieces"].size();
  ASSERT_EQ(all, 8U + 104U);
  const auto done = [&] {
    std::size_t count = 0;
    if (!fs::exists(path("killed"))) return count;
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
    const pid_t process = start(words("killed"));
    ASSERT_TRUE(tests::comes_true([&] { return done() >= pieces; }));
    ::usleep(static_cast<useconds_t>(random() % 20'000));
    ::kill(process, SIGKILL);
    static_cast<void>(finish(process));
    EXPECT_GE(done(), most);  // none is lost
    most = done();
    ASSERT_LT(most, all);
  }
  EXPECT_EQ(run(words("killed")).status, 1);
  EXPECT_EQ(results("killed"), expected);
  fs::remove(path("killed.json"));
  EXPECT_EQ(run({"merge", path("killed"), "--json", path("again.json")}).status, 1);
  EXPECT_EQ(read("again.json"), read("one.json"));
}

}  // namespace
}  // namespace touchstone::verify::cli::sharded_run_test
