#include "verify/fuzz/finding_page.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/folder_test.hpp"
#include "tests/support/queries.hpp"
#include "tests/verify/data/dataset_fixture.hpp"

namespace touchstone::verify::fuzz::finding_page_test {
namespace {

FuzzReport sample() {
  FuzzReport report{.solver = {.method = "mi|ne", .options = {.tolerance = 0.25, .max_checks = 9}},
                    .result = {}};
  Finding finding;
  finding.what = judge::Fault::false_negative;
  finding.method = "mi|ne";
  finding.simplest = {.query = tests::over_triangle(1, 1, 0.1, -2).query,
                      .answer = {.verdict = fast::Verdict::no},
                      .collides = true,
                      .toi = {{0.5, 0.5}},
                      .truth = "collision at 0.5",
                      .detail = "no, but they collide",
                      .certificate = "the certificate\n"};
  finding.original = finding.simplest;
  finding.scales.end_above = 3;
  report.result.findings = {finding};
  report.result.groups = {{.count = 17, .best = 0}};
  report.result.all_findings = 17;
  return report;
}

TEST(FindingPage, SaysAllThatAMaintainerNeeds) {
  const FuzzReport report = sample();
  const std::string page =
      as_page(report, report.result.groups.front(), CallInterface::ticcd, "1-false_negative");
  for (const std::string part :
       {"# mi|ne misses a collision\n", "| answer | no, but they collide |",
        "| truth | collision at 0.5 |", "| findings of this sort | 17 |",
        "wrong while the greatest coordinate is below 2^3", "tolerance 0.25, at most 9 checks",
        "v   at t=0  (1, 1, 0.1) = (0x1p+0, 0x1p+0, 0x1.999999999999ap-4)",
        "```cpp\n// Against github.com/Continuous-Collision-Detection/Tight-Inclusion.\n",
        "`touchstone-check 1-false_negative.cert`", "```\nthe certificate\n```", "```sh\ncat > ",
        "touchstone certify "}) {
    EXPECT_NE(page.find(part), std::string::npos) << part << '\n' << page;
  }
}

TEST(FindingPage, DoesWithoutACertificate) {
  FuzzReport report = sample();
  report.result.findings.front().simplest.certificate.clear();
  const std::string page =
      as_page(report, report.result.groups.front(), CallInterface::plugin, "1-false_negative");
  EXPECT_NE(page.find("beyond the limits of certificates"), std::string::npos);
  EXPECT_EQ(page.find("touchstone-check"), std::string::npos);
}

class Pages : public tests::FolderTest {};

TEST_F(Pages, AreFilesOfAFolder) {
  const FuzzReport report = sample();
  const std::filesystem::path folder = path("a/b");
  const auto pages = write_pages(report, CallInterface::plugin, folder);
  ASSERT_EQ(pages.size(), 1U);
  EXPECT_EQ(pages.front(), folder / "1-false_negative.md");
  const auto text = [&](const std::string& name) {
    return data::test::contents((folder / name).string());
  };
  EXPECT_EQ(text("1-false_negative.md"), as_page(report, report.result.groups.front(),
                                                 CallInterface::plugin, "1-false_negative"));
  EXPECT_EQ(text("1-false_negative.cert"), "the certificate\n");
  EXPECT_NE(text("1-false_negative.cpp").find("dlopen"), std::string::npos);
  const nlohmann::json json = nlohmann::json::parse(text("findings.json"));
  EXPECT_EQ(json.at("groups").at(0).at("count"), 17);
  EXPECT_EQ(json.at("groups").at(0).at("scale"), "ends near 1");
  EXPECT_TRUE(json.at("groups").at(0).at("kind").is_null());
  EXPECT_EQ(json.at("findings").at(0).at("wrong_until").at("above"), 3);
  EXPECT_TRUE(json.at("findings").at(0).at("wrong_until").at("below").is_null());
}

TEST_F(Pages, AreNotWrittenWithoutFindings) {
  EXPECT_TRUE(
      write_pages({.solver = {.method = "mine"}, .result = {}}, CallInterface::plugin, path("none"))
          .empty());
  EXPECT_TRUE(std::filesystem::exists(path("none/findings.json")));
}

}  // namespace
}  // namespace touchstone::verify::fuzz::finding_page_test
