#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "tests/support/mesh_files.hpp"
#include "verify/data/npy.hpp"

namespace touchstone::verify::mesh::index_file_test {
namespace {

using tests::MeshFolder;

TEST(WriteIndexPairs, WritesMoreThanItsBufferHolds) {
  std::vector<std::array<std::int32_t, 2>> pairs(50'001);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs[i] = {static_cast<std::int32_t>(i), -static_cast<std::int32_t>(i)};
  }
  const MeshFolder folder;
  data::write_index_pairs(folder.path() / "a.npy", pairs);
  const std::string bytes = data::test::contents(folder.path() / "a.npy");
  ASSERT_EQ(bytes.size(), 128 + 8 * pairs.size());
  EXPECT_EQ(bytes.substr(0, 10), std::string("\x93NUMPY\x01\x00\x76\x00", 10));
  EXPECT_TRUE(bytes.substr(10).starts_with(
      "{'descr': '<i4', 'fortran_order': False, 'shape': (50001, 2), } "));
  EXPECT_EQ(bytes[127], '\n');
  EXPECT_EQ(std::memcmp(bytes.data() + 128, pairs.data(), 8 * pairs.size()), 0);
}

}  // namespace
}  // namespace touchstone::verify::mesh::index_file_test
