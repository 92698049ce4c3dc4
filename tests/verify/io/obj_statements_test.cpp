#include "verify/io/obj_statements.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/verify/data/dataset_fixture.hpp"

namespace touchstone::verify::io::obj_statements_test {
namespace {

using data::test::error_of;
using data::test::TemporaryFolder;
using Texts = std::vector<std::string>;

/// The statements as "line keyword|words", then what was passed over.
Texts statements_of(const std::string& text) {
  const TemporaryFolder folder;
  ObjStatements statements(folder.file("a.obj", text));
  Texts result;
  while (const auto statement = statements.next()) {
    result.push_back(std::to_string(statement->line) + ' ' + std::string(statement->keyword) + '|' +
                     std::string(statement->words));
  }
  for (const std::string& name : statements.passed_over()) result.push_back(name);
  return result;
}

std::string error(const std::string& text) {
  const TemporaryFolder folder;
  return error_of(folder.path(), [&] {
    ObjStatements statements(folder.file("a.obj", text));
    while (statements.next()) {
    }
  });
}

TEST(ObjStatements, AreReturnedOrCounted) {
  EXPECT_EQ(
      statements_of(
          "\xEF\xBB\xBFv 1 2 3 # a point\r\n\n# all\n\tf\t1 2#3 #\nvt 0 0\ng a #1 b\nfo 1\n"
          "vn 0 0 1\nvt 1 1\nusemtl\n"),
      (Texts{"1 v| 1 2 3 ", "4 f|\t1 2#3 ", "6 g| a #1 b", "7 f| 1", "usemtl 1", "vn 1", "vt 2"}));
}

TEST(ObjStatements, GoOnBehindABackslash) {
  EXPECT_EQ(statements_of("f 1 \\\n2\\\r\n 3/4\\\n/5 \\\n\\\n6\nl 1 2 \\"),
            (Texts{"1 f| 1 2 3/4/5 6", "7 l| 1 2 "}));
  // A comment does not go on.
  EXPECT_EQ(statements_of("# C:\\\nv 1 2 3 # C:\\\nv 4 5 6"), (Texts{"2 v| 1 2 3 ", "3 v| 4 5 6"}));
  EXPECT_EQ(error("f 1\\\n2 3"),
            "a.obj:2: begins within a word, or with a new one: put a blank in front of the "
            "backslash before");
  EXPECT_EQ(error("usemtl a\\\nv 1 2 3"),
            "a.obj:2: begins with \"v\", but the line before goes on, as it ends in a backslash");
  EXPECT_EQ(error("# " + std::string(2'000'000, 'x')), "a.obj:1: line longer than 1 MiB");
  const std::string half(LineReader::longest_line / 2, ' ');
  EXPECT_EQ(error("f" + half + "\\\n" + half + "\\\n1"), "a.obj:2: line longer than 1 MiB");
}

TEST(ObjStatements, AreOfKnownKeywords) {
  for (const std::string keyword : {"V", "F", "f\u00A0", "vertices", "1,1", "t", "PK\x03"}) {
    EXPECT_TRUE(error("v 1 2 3\n" + keyword + " 1 2 3\n").starts_with("a.obj:2: \"")) << keyword;
  }
  EXPECT_EQ(error("surf 0 1 0 1 1 2 3 4"),
            "a.obj:1: \"surf\" may add to the mesh and is not read: write its faces (f)");
}

}  // namespace
}  // namespace touchstone::verify::io::obj_statements_test
