#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <zstd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/certificates.hpp"
#include "tests/support/tool_test.hpp"

// Tests of `touchstone prove` (verify/cli/prove_command.cpp) and `certify --prove` that run the
// tool.

namespace touchstone::verify::cli::prove_command_test {
namespace {

namespace fs = std::filesystem;
using tests::contains;
using tests::read_file;

std::string decompress(const std::string& bytes) {
  static constexpr std::size_t most = 100000000;
  std::string result(most, '\0');
  const std::size_t length =
      ZSTD_decompress(result.data(), result.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(length) != 0) return ZSTD_getErrorName(length);
  result.resize(length);
  return result;
}

class ProveCommand : public tests::ToolTest {
 protected:
  [[nodiscard]] int run(const std::vector<std::string>& arguments) const {
    return ToolTest::run(arguments).status;
  }

  [[nodiscard]] std::string out() const { return read("out"); }
  [[nodiscard]] std::string err() const { return read("err"); }
};

/// A vertex that falls from height 1 to `end` on a resting triangle, onto the middle of its face.
std::string falling_vertex(const std::string& end) {
  const std::string triangle = "0,1,0,1,0,1\n4,1,0,1,0,1\n0,1,4,1,0,1\n";
  return "1,1,1,1,1,1\n" + triangle + "1,1,1,1," + end + ",1\n" + triangle;
}

TEST_F(ProveCommand, ProvesADatasetForTheChecker) {
  const std::string data = write("vertex-face.csv", falling_vertex("-3") + falling_vertex("2"));
  EXPECT_EQ(run({"prove", data, "--out", path("a.cert"), "--json", path("a.json")}), 0) << err();
  const std::string text = read_file(path("a.cert"));
  EXPECT_TRUE(text.starts_with("touchstone-certificates 2\nquery vertex_face\nlabel " + data +
                               ":0\npoint 0x1p+0 0x1p+0 0x1p+0\n"));
  EXPECT_TRUE(contains(text, "claim time_of_impact 0x1.fffffffffffffp-3 1/4\n"));
  EXPECT_TRUE(contains(text, "\nlabel " + data + ":1\n"));
  EXPECT_TRUE(text.ends_with("\nend\ncertificates 2\n"));
  const checker::Report report = tests::check(text);
  EXPECT_TRUE(report.all_accepted());
  EXPECT_EQ(report.no_collision, 1U);
  EXPECT_EQ(report.time_of_impact, 1U);
  EXPECT_TRUE(contains(out(), "total                       2\n"));
  EXPECT_TRUE(contains(out(), "1                           2\n"));
  const auto json = nlohmann::json::parse(read_file(path("a.json")));
  EXPECT_EQ(json["certificates"], 2);
  EXPECT_EQ(json["no_collision"], 1);
  EXPECT_EQ(json["time_of_impact"], 1);
  EXPECT_EQ(json["subintervals"]["1"], 2);
  EXPECT_EQ(json["file_bytes"], text.size());
  EXPECT_EQ(json["interrupted"], false);
}

TEST_F(ProveCommand, CompressesWhereTheNameSaysSo) {
  const std::vector<std::string> common{"--count", "5", "--seed", "9"};
  std::string plain;
  for (const std::string threads : {"1", "2"}) {
    for (const std::string name : {"x.cert", "x.cert.zst"}) {
      std::vector<std::string> arguments{"prove", "--threads", threads, "--out", path(name)};
      arguments.insert(arguments.end(), common.begin(), common.end());
      ASSERT_EQ(run(arguments), 0) << err();
    }
    const std::string text = read_file(path("x.cert"));
    const std::string compressed = read_file(path("x.cert.zst"));
    EXPECT_EQ(decompress(compressed), text);
    EXPECT_LT(compressed.size(), text.size() / 3);
    if (plain.empty()) plain = text;
    EXPECT_EQ(text, plain);
  }
  const checker::Report report = tests::check(plain);
  EXPECT_TRUE(report.all_accepted());
  EXPECT_EQ(report.accepted(), 310U);
}

TEST_F(ProveCommand, ClaimsAndWidthsAreOptions) {
  const std::string data = write("vertex-face.csv", falling_vertex("-2"));
  EXPECT_EQ(run({"prove", data, "--claim", "collision", "--out", path("a")}), 0);
  EXPECT_EQ(tests::check(read_file(path("a"))).collision, 1U);
  EXPECT_EQ(run({"prove", data, "--width", "1e-3", "--out", path("a")}), 0);
  EXPECT_TRUE(contains(read_file(path("a")), "claim time_of_impact 997/3000 1/3\n"));
  EXPECT_EQ(tests::check(read_file(path("a"))).time_of_impact, 1U);
  for (const std::string width : {"0", "-1", "x"}) {
    EXPECT_EQ(run({"prove", data, "--width=" + width, "--out", path("b")}), 2) << width;
  }
  EXPECT_EQ(run({"prove", data, "--claim", "no_collision", "--out", path("b")}), 2);
  EXPECT_FALSE(fs::exists(path("b")));
}

TEST_F(ProveCommand, RefusesBadUsageAndInput) {
  const std::string data = write("vertex-face.csv", falling_vertex("-3"));
  EXPECT_EQ(run({"prove", data}), 2);
  EXPECT_EQ(run({"prove", data, "--out", ""}), 2);
  EXPECT_EQ(run({"prove", data, "--out", data}), 2);
  EXPECT_EQ(run({"prove", data, "--out", path("x"), "--json", path("x")}), 2);
  EXPECT_EQ(run({"prove", data, "--out", path("no/such/folder")}), 2);
  EXPECT_EQ(run({"prove", path("missing"), "--out", path("x")}), 2);
  EXPECT_EQ(run({"prove", data, "--out", "/dev/full"}), 2);
  EXPECT_TRUE(contains(err(), "cannot write"));
  EXPECT_EQ(read_file(data), falling_vertex("-3"));
}

TEST_F(ProveCommand, KeepsWhatItHasWhenARowIsBad) {
  const std::string data = write("vertex-face.csv", falling_vertex("-3") + "1,1,x\n");
  EXPECT_EQ(run({"prove", data, "--out", path("a")}), 2);
  EXPECT_TRUE(contains(err(), "vertex-face.csv"));
  EXPECT_EQ(tests::check(read_file(path("a"))).accepted(), 1U);
}

TEST_F(ProveCommand, StandardOutputIsNothingButCertificates) {
  const std::string data = write("vertex-face.csv", falling_vertex("-3"));
  EXPECT_EQ(run({"prove", data, "--out", "/dev/stdout"}), 0);
  EXPECT_EQ(tests::check(out()).accepted(), 1U);
  EXPECT_TRUE(tests::check(out()).all_accepted());
  EXPECT_TRUE(contains(err(), "total                       1\n"));
}

// The finished part has another name, and no checker accepts it as the whole.
TEST_F(ProveCommand, AnInterruptKeepsWholeCertificates) {
  for (const std::string name : {"i.cert", "i.cert.zst"}) {
    write(name, "an older proof");
    EXPECT_EQ(run_interrupted({"prove", "--count", "100000", "--out", path(name)},
                              [&] { return has_grown(name + ".touchstone"); })
                  .status,
              130)
        << err();
    EXPECT_EQ(read_file(path(name)), "an older proof");
    EXPECT_TRUE(contains(err(), name + ".incomplete: not complete"));
    std::string text = read_file(path(name + ".incomplete"));
    if (name.ends_with(".zst")) text = decompress(text);
    const checker::Report report = tests::check(text);
    EXPECT_EQ(report.rejected, 1U);
    EXPECT_TRUE(report.rejections.at(0).reason.starts_with("the stream is cut: "));
    EXPECT_GT(report.accepted(), 0U);
    EXPECT_TRUE(contains(out(), "total "));
  }
}

TEST_F(ProveCommand, CertifyWritesTheSame) {
  const std::string data = write("vertex-face.csv", falling_vertex("-3") + falling_vertex("2"));
  EXPECT_EQ(run({"prove", data, "--out", path("a")}), 0);
  EXPECT_EQ(run({"certify", data, "--prove", path("b")}), 0) << err();
  EXPECT_EQ(read_file(path("a")), read_file(path("b")));
  EXPECT_TRUE(contains(out(), "wrong labels"));
  EXPECT_TRUE(contains(out(), "total                       2\n"));
  EXPECT_EQ(run({"certify", data, "--prove", path("c.zst")}), 0);
  EXPECT_EQ(decompress(read_file(path("c.zst"))), read_file(path("a")));
  EXPECT_EQ(run({"certify", data, "--prove", data}), 2);
  EXPECT_EQ(run({"certify", data, "--prove", path("d"), "--truth", path("d")}), 2);
  EXPECT_EQ(run({"certify", data, "--prove", path("d"), "--json", path("d")}), 2);
  EXPECT_EQ(run({"certify", data, "--prove", "/dev/full"}), 2);
}

}  // namespace
}  // namespace touchstone::verify::cli::prove_command_test
