#include "verify/mesh/index_file.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/support/mesh_files.hpp"

namespace touchstone::verify::mesh::index_file_test {
namespace {

using tests::MeshFolder;

std::string written(const std::vector<std::array<std::int32_t, 2>>& pairs) {
  const MeshFolder folder;
  write_index_pairs(folder.path() / "a.npy", pairs);
  std::ifstream file(folder.path() / "a.npy", std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The header in NumPy's format.
std::string header(const std::string& shape) {
  std::string text("\x93NUMPY\x01\x00\x76\x00", 10);
  text += "{'descr': '<i4', 'fortran_order': False, 'shape': " + shape + ", }";
  return text + std::string(127 - text.size(), ' ') + '\n';
}

TEST(WriteIndexPairs, WritesMoreThanItsBufferHolds) {
  std::vector<std::array<std::int32_t, 2>> pairs(50'001);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs[i] = {static_cast<std::int32_t>(i), -static_cast<std::int32_t>(i)};
  }
  const std::string bytes = written(pairs);
  ASSERT_EQ(bytes.size(), 128 + 8 * pairs.size());
  EXPECT_EQ(bytes.substr(0, 128), header("(50001, 2)"));
  EXPECT_EQ(std::memcmp(bytes.data() + 128, pairs.data(), 8 * pairs.size()), 0);
}

}  // namespace
}  // namespace touchstone::verify::mesh::index_file_test
