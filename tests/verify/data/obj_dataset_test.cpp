#include "verify/data/obj_dataset.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/verify/data/dataset_fixture.hpp"

namespace touchstone::verify::data::obj_dataset_test {
namespace {

using test::error_of;
using test::read_all;
using test::read_survivors;
using test::Survivors;
using test::TemporaryFolder;

DatasetOptions edge_edge() { return {.kind = Kind::edge_edge}; }

/// The vertices of a query: x is the number of the point, y that of the query.
std::string vertices(int query) {
  std::string text;
  for (int i = 0; i < 8; ++i) {
    text += "v " + std::to_string(i) + "\t" + std::to_string(query) + " -0.25 1.0\n";
  }
  return text;
}

TEST(ObjDataset, ReadsEightVerticesAQueryAndNothingElse) {
  const TemporaryFolder folder;
  const auto path = folder.file("a.obj", "\xEF\xBB\xBF# comment\no thing\nvn 0 0 1\n" +
                                             vertices(0) + "f 1 2 3\n" + vertices(1) + "\n");
  ObjDataset source(path, edge_edge());
  const auto records = read_all(source);
  ASSERT_EQ(records.size(), 2U);
  for (std::size_t query = 0; query < 2; ++query) {
    EXPECT_EQ(records[query].index, query);
    EXPECT_FALSE(records[query].collides.has_value());
    for (std::size_t point = 0; point < 8; ++point) {
      const std::size_t at = 3 * point;
      EXPECT_EQ(records[query].query.straight().coordinates.at(at), static_cast<double>(point));
      EXPECT_EQ(records[query].query.straight().coordinates.at(at + 1), static_cast<double>(query));
      EXPECT_EQ(records[query].query.straight().coordinates.at(at + 2), -0.25);
    }
  }
}

TEST(ObjDataset, LocatesFaultsAndGoesOnWithTheNextQuery) {
  const TemporaryFolder folder;
  const auto error_with = [&](const std::string& text) {
    const auto path = folder.file("a.obj", text);
    return error_of(folder.path(), [&] {
      ObjDataset source(path, edge_edge());
      (void)read_all(source);
    });
  };
  std::string bad = vertices(0) + vertices(1) + vertices(2);
  bad.replace(bad.find("v 3\t1"), 5, "v 3\tx");
  EXPECT_EQ(error_with(bad), "a.obj:12:3: not a number: \"x\"");
  EXPECT_EQ(error_with("v 0.1 0 0\n" + vertices(0)),
            "a.obj:1:2: not exactly a double (--round takes the nearest)");
  EXPECT_EQ(error_with("v 1 2\n" + vertices(0)), "a.obj:1:4: not a number: \"\"");
  EXPECT_EQ(error_with("f 1 2 3\n"), "a.obj: no vertices");
  EXPECT_EQ(error_with(vertices(0) + "v 1 2 3\n"), "a.obj: truncated query: 1 of 8 vertices");
  const Survivors kept = read_survivors(folder.file("b_ee.obj", bad), folder.path(), edge_edge());
  ASSERT_EQ(kept.records.size(), 2U);
  EXPECT_EQ(kept.records[1].index, 2U);
  ObjDataset rounded(folder.file("a.obj", "v 0.1" + vertices(0).substr(3)),
                     {.kind = Kind::edge_edge, .round = true});
  EXPECT_EQ(read_all(rounded).front().query.straight().coordinates.front(), 0.1);
  EXPECT_EQ(rounded.rounded(), 1U);
  EXPECT_EQ(kept.skipped, 1U);
}

}  // namespace
}  // namespace touchstone::verify::data::obj_dataset_test
