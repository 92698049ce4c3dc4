#include "verify/io/input_file.hpp"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "tests/verify/data/dataset_fixture.hpp"
#include "verify/io/output_file.hpp"

namespace touchstone::verify::io::input_file_test {
namespace {

using data::test::contents;
using data::test::error_of;
using data::test::TemporaryFolder;

struct OwnedLine {
  std::string text;
  std::uint64_t number;

  friend bool operator==(const OwnedLine&, const OwnedLine&) = default;
};

std::vector<OwnedLine> lines_of(const std::string& text) {
  const TemporaryFolder folder;
  LineReader reader(folder.file("text", text));
  std::vector<OwnedLine> lines;
  while (const auto line = reader.next()) {
    lines.push_back({std::string(line->text), line->number});
  }
  EXPECT_TRUE(reader.at_end());
  return lines;
}

TEST(InputFile, AReadErrorIsReportedOnceAndEndsTheFile) {
  // Address 0 is never mapped, so the system answers the first read of this file with an error.
  InputFile file("/proc/self/mem");
  std::array<char, 8> buffer{};
  EXPECT_EQ(error_of("", [&] { (void)file.read(buffer); }),
            "/proc/self/mem: cannot read: Input/output error");
  EXPECT_EQ(file.read(buffer), 0U);
}

TEST(InputFile, IsReadWholeUpToALimit) {
  const TemporaryFolder folder;
  const std::string text(200'000, 'x');
  const auto path = folder.file("text", text);
  EXPECT_EQ(read_file(path, text.size()), text);
  EXPECT_EQ(error_of(folder.path(), [&] { (void)read_file(path, text.size() - 1); }),
            "text: has more than 199999 bytes");
  EXPECT_EQ(error_of("", [] { (void)read_file("/dev/zero", 10); }),
            "/dev/zero: has more than 10 bytes");
}

TEST(LineReader, ReadsAllLineEndsBehindAByteOrderMark) {
  const std::string mark = "\xEF\xBB\xBF";
  for (const std::string text : {"a\nb\n", "a\nb", "a\r\nb\r\n", "a\r\nb\r"}) {
    const std::vector<OwnedLine> expected{{"a", 1}, {"b", 2}};
    EXPECT_EQ(lines_of(text), expected);
    EXPECT_EQ(lines_of(mark + text), expected);
  }
  EXPECT_EQ(lines_of("a\n" + mark), (std::vector<OwnedLine>{{"a", 1}, {mark, 2}}));
  EXPECT_TRUE(lines_of(mark).empty());
  const TemporaryFolder folder;
  LineReader peeked(folder.file("text", mark + "1,2\n"));
  EXPECT_EQ(peeked.peek(4), "1,2\n");
}

/// UTF-16, and carriage returns that end lines alone.
TEST(LineReader, EndsAtWhatItDoesNotRead) {
  const std::string wide = "UTF-16 text; UTF-8 is read: iconv -f UTF-16 -t UTF-8";
  const std::string alone =
      "a carriage return within the line: lines end in LF or CR LF (from CR: tr '\\r' '\\n' <OLD "
      ">NEW)";
  const std::string longest(LineReader::longest_line, 'x');
  const TemporaryFolder folder;
  for (const auto& [text, error] : std::vector<std::pair<std::string, std::string>>{
           {"\xFF\xFE" + std::string("a\0\n\0", 4), "1: " + wide},
           {"\xFE\xFF" + std::string("a\0\n\0", 4), "1: " + wide},
           {"a\rb\r", "1: " + alone},
           {"a\r\r\n", "1: " + alone},
           {"a\nb\rc\nd\n", "2: " + alone},
           {longest + "\r" + longest, "1: " + alone}}) {
    LineReader reader(folder.file("text", text));
    const auto read_all = [&] {
      while (reader.next()) continue;
    };
    EXPECT_EQ(error_of(folder.path(), read_all), "text:" + error);
    EXPECT_TRUE(reader.at_end()) << "it has ended";
  }
}

TEST(LineReader, BlankLinesCountExceptAtTheEnd) {
  EXPECT_TRUE(lines_of("").empty());
  EXPECT_TRUE(lines_of("\n \t\n\r\n").empty());
  const std::vector<OwnedLine> expected{{"", 1}, {"a", 2}, {"", 3}, {"", 4}, {"b", 5}};
  EXPECT_EQ(lines_of("\na\n \n\t\r\nb\n\n  \n"), expected);
}

TEST(LineReader, LinesAcrossChunksStayWhole) {
  std::string text;
  for (std::size_t i = 0; i < 3000; ++i)
    text += std::string(i % 211, 'x') + std::to_string(i) + "\n";
  const std::vector<OwnedLine> lines = lines_of(text);
  ASSERT_EQ(lines.size(), 3000U);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_EQ(lines[i], (OwnedLine{std::string(i % 211, 'x') + std::to_string(i), i + 1}));
  }
}

TEST(LineReader, RefusesLinesBeyondTheLimitAndNoOthers) {
  const std::string longest(LineReader::longest_line, 'x');
  const TemporaryFolder folder;
  for (const std::string end : {"\n", "\r\n"}) {
    EXPECT_EQ(lines_of(longest + end + "b"), (std::vector<OwnedLine>{{longest, 1}, {"b", 2}}));
    LineReader reader(folder.file("text", "b\n" + longest + "x" + end + "b"));
    EXPECT_EQ(reader.next().value().text, "b");
    EXPECT_EQ(error_of(folder.path(), [&] { (void)reader.next(); }),
              "text:2: line longer than 1 MiB");
    EXPECT_TRUE(reader.at_end());
  }
  LineReader without_end("/dev/zero");
  EXPECT_EQ(error_of("", [&] { (void)without_end.next(); }), "/dev/zero:1: line longer than 1 MiB");
}

TEST(OutputFile, HasItsNameAndAllItsBytesAfterClose) {
  const TemporaryFolder folder;
  OutputFile file(folder.path() / "out.csv");
  std::string expected;
  for (int i = 0; i < 50000; ++i) {
    const std::string text = std::to_string(i) + "\n";
    file.write(text);
    expected += text;
  }
  const std::string large(300000, 'x');
  file.write(large);
  file.overwrite(2, "AB");
  file.write("end");
  file.close();
  expected.replace(2, 2, "AB");
  EXPECT_EQ(contents(folder.path() / "out.csv"), expected + large + "end");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"out.csv"});
}

TEST(OutputFile, LeavesTheOldFileUntilCloseAndNothingWithoutIt) {
  const TemporaryFolder folder;
  const auto path = folder.file("out.csv", "old");
  {
    OutputFile file(path);
    file.write("new");
    EXPECT_EQ(contents(path), "old");
    for (const std::string& name : folder.names()) {
      EXPECT_TRUE(name == "out.csv" || !name.ends_with(".csv")) << name;
    }
    EXPECT_EQ(folder.names().size(), 2U);
  }
  EXPECT_EQ(contents(path), "old");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"out.csv"});
  OutputFile file(path);
  file.write("new");
  file.close();
  EXPECT_EQ(contents(path), "new");
}

TEST(OutputFile, LeavesThatOfAnotherProcessAlone) {
  const TemporaryFolder folder;
  // The number of no process.
  const std::string old = "out.csv.touchstone.partial-999999999";
  (void)folder.file(old, "x");
  OutputFile first(folder.path() / "out.csv"), second(folder.path() / "out.csv");
  second.write("second");
  second.close();
  first.write("first");
  first.close();
  EXPECT_EQ(contents(folder.path() / "out.csv"), "first");
  EXPECT_EQ(contents(folder.path() / old), "x");
  EXPECT_EQ(folder.names().size(), 2U);
}

TEST(OutputFile, NamesTheTargetWhereNoFileCanBeRenamed) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "taken");
  EXPECT_EQ(error_of(folder.path(), [&] { OutputFile(folder.path() / "taken").close(); }),
            "taken: cannot write: Is a directory");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"taken"});
}

}  // namespace
}  // namespace touchstone::verify::io::input_file_test
