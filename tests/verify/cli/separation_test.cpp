#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/built_files.hpp"
#include "tests/support/tool_test.hpp"

// Tests of --min-separation and --norm that run the tool.

namespace touchstone::verify::cli::separation_test {
namespace {

namespace fs = std::filesystem;
using tests::contains;

constexpr char subcommand[] = "";

class SeparationOptions : public tests::ShellTest<subcommand> {
 protected:
  [[nodiscard]] std::string to_json() const { return " --json " + quoted("json"); }
};

/// A vertex over (or at the corner of) the resting triangle (0,0,0), (-4,0,0), (0,-4,0), from one
/// place to another, "x,1,y,1,z,1" each, with or without a label.
std::string vertex_moves(const std::string& from, const std::string& to,
                         const std::string& label = "") {
  const std::string end = (label.empty() ? "" : "," + label) + "\n";
  const std::string face = "0,1,0,1,0,1" + end + "-4,1,0,1,0,1" + end + "0,1,-4,1,0,1" + end;
  return from + end + face + to + end + face;
}

/// A fall from height 1 to the face: within ½ from t = ½ on.
std::string falls(const std::string& label = "") {
  return vertex_moves("-1,1,-1,1,1,1", "-1,1,-1,1,0,1", label);
}

/// A fall from height 1 to ¾: never within ½.
std::string stays_away(const std::string& label = "") {
  return vertex_moves("-1,1,-1,1,1,1", "-1,1,-1,1,3,4", label);
}

/// A vertex at rest at (⅜, ⅜, 0) beside the corner: within ½ on every axis, but not in L2.
std::string beside_corner() { return vertex_moves("3,8,3,8,0,1", "3,8,3,8,0,1"); }

const std::string half = " --min-separation 0x1p-1";
constexpr const char* answers_header = "file,index,kind,verdict,toi_lower,toi_upper,tolerance\n";

TEST_F(SeparationOptions, BadValuesAreUsageErrors) {
  const std::string file = write("a_vf.csv", falls());
  for (const std::string& command :
       {"certify " + file, "solve " + file + " --method tight_inclusion --out " + quoted("o"),
        "bench " + file, "prove " + file + " --out " + quoted("o"),
        "generate --count 1 --out " + quoted("set")}) {
    for (const char* bad :
         {" --min-separation -1", " --min-separation=-1", " --min-separation nan",
          " --min-separation inf", " --min-separation 1e999", " --min-separation 1e-999",
          " --min-separation 1x", " --min-separation ''", " --norm l3",
          " --min-separation 1 --norm L2"}) {
      EXPECT_EQ(run(command + bad), 2) << command << bad;
      EXPECT_NE(read("err"), "") << command << bad;
    }
  }
}

TEST_F(SeparationOptions, AtDistanceZeroNothingChanges) {
  const std::string file = write("a_vf.csv", falls("1") + stays_away("0"));
  const auto result = [&](const std::string& options) {
    EXPECT_EQ(run("certify " + file + " --method tight_inclusion" + options + to_json()), 0);
    nlohmann::json all = json();
    for (const char* time : {"us_per_query"}) {
      all.erase(time);
      all.at("files")[0].erase(time);
    }
    all.at("methods")[0].erase("ns_per_query");
    all.at("files")[0].at("methods")[0].erase("ns_per_query");
    EXPECT_FALSE(contains(read("out"), "separation"));
    return all.dump();
  };
  const std::string plain = result("");
  EXPECT_FALSE(contains(plain, "separation"));
  for (const char* zero : {" --min-separation 0", " --min-separation=-0.0 --norm l2", " --norm l2",
                           " --min-separation 0x0p0"}) {
    EXPECT_EQ(result(zero), plain) << zero;
  }
}

TEST_F(SeparationOptions, TheTruthIsAboutThemInTheirNorm) {
  const std::string file = write("a_vf.csv", falls() + stays_away() + beside_corner());
  const std::string certify = "certify " + file + to_json() + " --truth " + quoted("truth") + half;
  ASSERT_EQ(run(certify), 0) << read("err");
  const auto row = [&](const std::string& rest) { return path("a_vf.csv") + "," + rest + "\n"; };
  const std::string first_rows = "file,index,kind,collides,toi_lower,toi_upper\n" +
                                 row("0,vertex-face,1,0.5,0.5") + row("1,vertex-face,0,,");
  EXPECT_EQ(read("truth"), first_rows + row("2,vertex-face,1,0,0"));
  EXPECT_EQ(json().at("separation").dump(), R"({"min_separation":0.5,"norm":"linf"})");
  EXPECT_TRUE(contains(read("out"), "minimum separation 0.5 (linf)\n")) << read("out");
  ASSERT_EQ(run(certify + " --norm l2"), 0) << read("err");
  EXPECT_EQ(read("truth"), first_rows + row("2,vertex-face,0,,"));
  EXPECT_EQ(json().at("files")[0].at("separation").at("norm"), "l2");
}

TEST_F(SeparationOptions, PlantedWrongAnswersAreCaught) {
  const std::string file = write("a_vf.csv", falls() + stays_away());
  struct Case {
    std::string collision, no_collision, column;
    int status;
  };
  for (const auto& [collision, no_collision, column, status] :
       {Case{"yes,0.5,0.5,0", "no,,,", "", 0}, Case{"no,,,", "no,,,", "false_negatives", 1},
        Case{"yes,0.5,0.5,", "yes,0.5,0.5,", "false_positives", 1},
        Case{"yes,0.5000000000000001,1,", "no,,,", "late_toi", 1},
        Case{"yes,0,0.49999999999999994,", "no,,,", "early_toi_upper", 1}}) {
    std::string rows = answers_header;
    rows.append(path("a_vf.csv")).append(",0,vertex-face,").append(collision).append("\n");
    rows.append(path("a_vf.csv")).append(",1,vertex-face,").append(no_collision).append("\n");
    const std::string answers = write("answers.csv", rows);
    EXPECT_EQ(run("certify " + file + half + " --exact --results " + answers + to_json()), status)
        << collision << no_collision << read("out");
    const nlohmann::json method = json().at("methods")[0];
    for (const char* field :
         {"false_negatives", "false_positives", "late_toi", "early_toi_upper", "errors"}) {
      EXPECT_EQ(method.at(field), field == column ? 1 : 0)
          << field << ": " << collision << no_collision;
    }
  }
}

TEST_F(SeparationOptions, OfAnswersAboutContactOnlyWhatFollowsIsCompared) {
  // A query without contact that comes within ½, and one with contact.
  const std::string near_miss = vertex_moves("-1,1,-1,1,1,1", "-1,1,-1,1,1,4", "0");
  const std::string file = write("data/a_vf.csv", near_miss + falls("1"));
  const auto with_toi = [&](const std::string& toi) {
    (void)write("data/toi/a_vf_toi.csv", "query,toi\n1," + toi + "\n");
    return run("certify " + file + half + to_json());
  };
  EXPECT_EQ(with_toi("1"), 0) << read("out");
  EXPECT_EQ(json().at("labels"), 1) << "the miss says nothing";
  EXPECT_EQ(json().at("tois"), 1);
  EXPECT_EQ(json().at("files")[0].at("compared"), "collisions");
  EXPECT_TRUE(contains(read("out"), "only their collisions are compared")) << read("out");
  EXPECT_EQ(with_toi("0.5"), 0) << read("out");
  EXPECT_EQ(with_toi("0.4999"), 1) << "contact is never before coming near";
  EXPECT_EQ(json().at("toi_mismatches"), 1);
  const std::string wrong = write("wrong_vf.csv", stays_away("1"));
  EXPECT_EQ(run("certify " + wrong + half + to_json()), 1);
  EXPECT_EQ(json().at("label_mismatches"), 1);
}

TEST_F(SeparationOptions, GeneratedSetsSayWhatTheyAreAbout) {
  const std::string set = quoted("set");
  const std::string families =
      " --family separation-tilted --family separation-grazing --family interior-dyadic ";
  ASSERT_EQ(run("generate --count 6 --min-separation 1e-8 --norm l2 --out " + set + families), 0)
      << read("err");
  EXPECT_TRUE(contains(read("out"), "minimum separation 1e-08 (l2)")) << read("out");
  ASSERT_EQ(run("certify " + set + to_json()), 0) << read("out") << read("err");
  EXPECT_EQ(json().at("separation").dump(), R"({"min_separation":1e-08,"norm":"l2"})");
  EXPECT_EQ(json().at("queries"), 3 * 2 * 6);
  EXPECT_EQ(json().at("labels"), 2 * 2 * 6) << "the family about contact has none";
  EXPECT_GT(json().at("tois"), 8);
  ASSERT_EQ(run("certify " + set + " --min-separation 1e-8"), 0) << "the norm is recorded";
  for (const char* contradiction :
       {" --min-separation 1e-7", " --min-separation 0", " --norm linf"}) {
    EXPECT_EQ(run("certify " + set + contradiction), 2) << contradiction;
    EXPECT_TRUE(contains(read("err"), "1e-08 (l2)")) << read("err");
  }
}

TEST_F(SeparationOptions, TheBuiltInSetHasItsFamiliesAndWhatFollowsForTheOthers) {
  const std::string certify = "certify --count 2 --method none --min-separation 1e-8" + to_json();
  ASSERT_EQ(run(certify), 0) << read("out");
  std::uint64_t compared = 0;
  const nlohmann::json result = json();
  for (const nlohmann::json& file : result.at("files")) {
    const bool is_about_it = contains(file.at("file"), "separation-");
    EXPECT_EQ(file.at("compared"), is_about_it ? "all" : "collisions");
    if (is_about_it) {
      EXPECT_EQ(file.at("labels"), 2);
    } else {
      compared += file.at("labels").get<std::uint64_t>();
    }
  }
  EXPECT_GT(compared, 50U);
}

TEST_F(SeparationOptions, SetsAboutDifferentSeparationsAreKeptApart) {
  const std::string generate = "generate --count 1 --family separation-side --out " + quoted("set");
  EXPECT_EQ(run(generate), 2) << "the family needs a separation";
  ASSERT_EQ(run(generate + half), 0) << read("err");
  ASSERT_EQ(run(generate + half), 0) << "the same again";
  for (const char* other : {" --min-separation 0.25", " --min-separation 0.5 --norm l2"}) {
    EXPECT_EQ(run(generate + other), 2);
    EXPECT_TRUE(contains(read("err"), "choose another folder")) << read("err");
  }
  EXPECT_EQ(run("generate --count 1 --family hourglass --out " + quoted("set")), 2);
  ASSERT_EQ(run("generate --count 1 --family hourglass --out " + quoted("plain")), 0);
  EXPECT_EQ(run("generate --count 1 --family hourglass --out " + quoted("plain") + half), 2);
  EXPECT_FALSE(fs::exists(path("plain/separation.json")));
}

TEST_F(SeparationOptions, AFalseLabelOfASetIsFound) {
  const std::string file = write("set/a_vf.csv", falls("1") + stays_away("1"));
  (void)write("set/separation.json", R"({"min_separation": "0.5", "norm": "l2"})");
  EXPECT_EQ(run("certify " + file + to_json()), 1);
  EXPECT_EQ(json().at("mismatches")[0].at("index"), 1);
}

TEST_F(SeparationOptions, TightInclusionIsJudgedByItsTolerance) {
  for (const char* norm : {"linf", "l2"}) {
    EXPECT_EQ(run("certify --count 3 --max-checks 1000 --method tight_inclusion --min-separation "
                  "1e-8 --norm " +
                  std::string(norm) + to_json()),
              0)
        << read("out");
    EXPECT_EQ(json().at("methods")[0].at("beyond_tolerance"), 0);
    EXPECT_EQ(json().at("methods")[0].at("false_negatives"), 0);
    EXPECT_TRUE(contains(read("out"), "beyond tol")) << read("out");
  }
}

TEST_F(SeparationOptions, SolveWritesWhatCertifyComparesUnderTheSameOptions) {
  const std::string file = write("a_vf.csv", falls() + stays_away() + beside_corner());
  const std::string answers = quoted("answers.csv");
  ASSERT_EQ(run("solve " + file + half + " --method tight_inclusion --out " + answers + to_json()),
            0)
      << read("err");
  EXPECT_EQ(json().at("yes"), 2);
  EXPECT_EQ(json().at("separation").at("min_separation"), 0.5);
  EXPECT_TRUE(contains(read("out"), "minimum separation 0.5 (linf)\n")) << read("out");
  EXPECT_EQ(run("certify " + file + half + " --exact --results " + answers), 0) << read("out");
  EXPECT_EQ(run("certify " + file + half + " --norm l2 --exact --results " + answers), 1);
  EXPECT_EQ(run("certify " + file + " --exact --results " + answers), 1);
}

TEST_F(SeparationOptions, ProofsAreAboutThem) {
  const std::string file = write("a_vf.csv", falls() + stays_away() + beside_corner());
  const std::string prove = "prove " + file + half + " --out " + quoted("proof") + to_json();
  ASSERT_EQ(run(prove + " --norm l2"), 0) << read("err");
  EXPECT_EQ(json().at("no_collision"), 2);
  EXPECT_EQ(json().at("time_of_impact"), 1);
  EXPECT_EQ(json().at("separation").at("norm"), "l2");
  EXPECT_TRUE(contains(read("proof"), "separation")) << read("proof");
  ASSERT_EQ(run(prove), 0) << read("err");
  EXPECT_EQ(json().at("no_collision"), 1);
  EXPECT_EQ(json().at("time_of_impact"), 2);
}

TEST_F(SeparationOptions, BenchJudgesUnderThem) {
  const std::string file = write("a_vf.csv", falls() + stays_away() + beside_corner());
  ASSERT_EQ(run("bench " + file + " --method tight_inclusion --repetitions 1 --seconds 0.01" +
                half + " --norm l2" + to_json()),
            0)
      << read("err");
  const nlohmann::json group = json().at("groups")[0];
  EXPECT_EQ(group.at("collisions"), 1);
  EXPECT_EQ(group.at("methods")[0].at("false_positives"), 1);
  EXPECT_EQ(group.at("separation").at("norm"), "l2");
  EXPECT_TRUE(contains(read("out"), "minimum separation 0.5 (l2)")) << read("out");
}

}  // namespace
}  // namespace touchstone::verify::cli::separation_test
