#include "verify/cli/sources.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "verify/generate/families.hpp"

namespace touchstone::verify::cli::sources_test {
namespace {

namespace fs = std::filesystem;

/// A folder with two files of one query each.
class Sources : public ::testing::Test {
 public:
  Sources(const Sources&) = delete;
  Sources& operator=(const Sources&) = delete;
  Sources(Sources&&) = delete;
  Sources& operator=(Sources&&) = delete;

 protected:
  Sources()
      : folder(fs::path(::testing::TempDir()) /
               (std::string("touchstone_sources_") +
                ::testing::UnitTest::GetInstance()->current_test_info()->name() + "_" +
                std::to_string(getpid()))) {
    fs::create_directories(folder);
    for (const char* name : {"a_vf.csv", "b_ee.csv"}) write(name);
    handlers = {
        .title = "test",
        .use =
            [this](data::QuerySource& source, const std::function<void(double)>& progress) {
              used.emplace_back(source.name(), source.kind());
              for (auto query = source.next(); query; query = source.next()) ++queries;
              progress(1.0);
            },
        .fail = [this](const fs::path& path, const data::DatasetError&) { failed.push_back(path); },
        .stopped = [this] { return used.size() + failed.size() >= most; }};
  }
  ~Sources() override { fs::remove_all(folder); }

  void write(const std::string& name) const {
    std::ofstream file(folder / name);
    for (int row = 0; row < 8; ++row) file << row << ",1,2,1,3,1\n";
  }

  fs::path folder;
  SourceHandlers handlers;
  std::vector<std::pair<std::string, Kind>> used;
  std::vector<fs::path> failed;
  std::uint64_t queries = 0;
  std::size_t most = 1000;
  Files files;
};

TEST_F(Sources, WithASeparationTheBuiltInSetHasItsFamiliesToo) {
  SourceArguments arguments;
  arguments.count = 1;
  arguments.separation.distance = 0.5;
  for_each_source(arguments, files, handlers);
  EXPECT_EQ(used.back(),
            std::pair(std::string(generate::separation_families().back().name), Kind::edge_edge));
  arguments.separation.distance = 0x1p-1070;
  used.clear();
  for_each_source(arguments, files, handlers);
  EXPECT_EQ(used.back().first, generate::families().back().name) << "they cannot double that";
}

TEST_F(Sources, WhatIsRecordedIsAskedUnlessTheUserSaysOtherwise) {
  std::ofstream(folder / "separation.json") << R"({"min_separation": "0.5", "norm": "l2"})";
  SourceArguments arguments;
  arguments.paths = {folder};
  std::vector<Separation> asked;
  handlers.use = [&](data::QuerySource& source, const std::function<void(double)>&) {
    asked.push_back(separation_for(arguments, source));
  };
  constexpr Separation recorded{.distance = 0.5, .norm = Norm::l2};
  for_each_source(arguments, files, handlers);
  EXPECT_EQ(asked, (std::vector<Separation>{recorded, recorded}));
  arguments.separation = {.distance = 0.5, .norm = Norm::l2};
  for_each_source(arguments, files, handlers);
  EXPECT_TRUE(failed.empty());
  arguments.separation = {.distance = std::nullopt, .norm = Norm::linf};
  for_each_source(arguments, files, handlers);
  EXPECT_EQ(failed.size(), 2U);
  EXPECT_EQ(asked.size(), 4U);
}

TEST_F(Sources, WithoutPathsAreTheBuiltInSet) {
  SourceArguments arguments;
  arguments.count = 2;
  for_each_source(arguments, files, handlers);
  std::vector<std::pair<std::string, Kind>> expected;
  for (const generate::Family& family : generate::families()) {
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      if (generate::supports(family, kind)) expected.emplace_back(family.name, kind);
    }
  }
  EXPECT_EQ(used, expected);
  EXPECT_EQ(queries, 2 * expected.size());
}

TEST_F(Sources, FilesComeOnceAndInOrder) {
  SourceArguments arguments;
  const fs::path b = folder / "b_ee.csv";
  arguments.paths = {b, folder};
  for_each_source(arguments, files, handlers);
  ASSERT_EQ(used.size(), 2U);
  EXPECT_EQ(used[0], std::pair(b.string(), Kind::edge_edge));
  EXPECT_EQ(used[1], std::pair((folder / "a_vf.csv").string(), Kind::vertex_face));
  EXPECT_EQ(queries, 2U);
}

TEST_F(Sources, WhatCannotBeOpenedFailsAndTheRestGoesOn) {
  write("kindless.csv");
  SourceArguments arguments;
  arguments.paths = {folder / "missing", folder};
  for_each_source(arguments, files, handlers);
  EXPECT_EQ(failed, (std::vector<fs::path>{folder / "missing", folder / "kindless.csv"}));
  EXPECT_EQ(used.size(), 2U);
}

TEST_F(Sources, WhatASearchLeavesOutIsNamedUpToALimit) {
  for (char letter = 'a'; letter <= 'j'; ++letter) write(std::string(1, letter) + ".txt");
  SourceArguments arguments;
  arguments.paths = {folder};
  ::testing::internal::CaptureStderr();
  for_each_source(arguments, files, handlers);
  const std::string errors = ::testing::internal::GetCapturedStderr();
  for (char letter = 'a'; letter <= 'h'; ++letter) {
    const std::string path = (folder / (std::string(1, letter) + ".txt")).string();
    EXPECT_NE(errors.find(path + ": left out: no dataset (.csv, .npy)\n"), std::string::npos)
        << errors;
  }
  EXPECT_NE(errors.find("left out: 2 more\n"), std::string::npos) << errors;
  EXPECT_EQ(errors.find("i.txt"), std::string::npos) << errors;
  EXPECT_EQ(used.size(), 2U);
}

TEST_F(Sources, AStopLeavesTheRestAlone) {
  most = 1;
  SourceArguments arguments;
  for_each_source(arguments, files, handlers);
  EXPECT_EQ(used.size(), 1U);
  used.clear();
  arguments.paths = {folder / "missing", folder};
  for_each_source(arguments, files, handlers);
  EXPECT_TRUE(used.empty());
  EXPECT_EQ(failed.size(), 1U);
}

TEST_F(Sources, AnInputMustBeNoOutput) {
  files.add_output(folder / "b_ee.csv");
  SourceArguments arguments;
  arguments.paths = {folder};
  EXPECT_THROW(for_each_source(arguments, files, handlers), std::runtime_error);
  EXPECT_TRUE(used.empty()) << "before anything is done";
}

TEST_F(Sources, OptionsFillTheArguments) {
  CLI::App app;
  SourceArguments arguments;
  add_source_options(app, arguments);
  std::vector<std::string> words{"x",        "--keep-going", "--seed", "3",       "--count",
                                 "5",        "--threads",    "2",      "--round", "--kind",
                                 "edge-edge"};
  std::ranges::reverse(words);
  app.parse(std::move(words));
  EXPECT_EQ(arguments.paths, (std::vector<fs::path>{"x"}));
  EXPECT_TRUE(arguments.keep_going);
  EXPECT_TRUE(arguments.round);
  EXPECT_EQ(arguments.kind, "edge-edge");
  EXPECT_EQ(arguments.seed, 3U);
  EXPECT_EQ(arguments.count, 5U);
  EXPECT_EQ(arguments.threads, 2U);
  EXPECT_FALSE(arguments.built_in_set());
}

}  // namespace
}  // namespace touchstone::verify::cli::sources_test
