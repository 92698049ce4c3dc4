#include "verify/data/npy.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/npz_files.hpp"
#include "tests/verify/data/dataset_fixture.hpp"

namespace touchstone::verify::data::npz_test {
namespace {

using test::error_of;
using test::TemporaryFolder;

TEST(Npz, GivesItsArraysByName) {
  const TemporaryFolder folder;
  const auto path = tests::archive(
      folder.path() / "a.npz", {{"x.npy", tests::array<double>("<f8", {3, 1}, {1.0, -2.0, 0.5})}});
  const Npz archive(path);
  EXPECT_TRUE(archive.has("x"));
  EXPECT_FALSE(archive.has("y"));
  EXPECT_EQ(archive.names(), std::vector<std::string>{"x"});
  NpyArray array(archive, "x");
  EXPECT_EQ(array.shape(), (std::vector<std::uint64_t>{3, 1}));
  std::vector<double> numbers(2);
  array.take_numbers(numbers);
  EXPECT_EQ(numbers, (std::vector<double>{1.0, -2.0}));
  EXPECT_EQ(error_of(folder.path(), [&] { array.take<double, float>(numbers, {"<f4"}); }),
            "a.npz: x: dtype \"<f8\", expected <f4");
  EXPECT_EQ(error_of(folder.path(), [&] { (void)NpyArray(archive, "y"); }),
            "a.npz: y: no such array; the archive has: x");
}

/// A bit of each byte of the member's data is changed in turn. Some bits of compressed data mean
/// nothing.
TEST(Npz, WithABitThatFlippedIsAnErrorOrHasTheSameNumbers) {
  const TemporaryFolder folder;
  const std::vector<double> written{1.0, -2.0, 0.5};
  for (const bool is_compressed : {false, true}) {
    const auto path = tests::archive(folder.path() / "a.npz",
                                     {{"x.npy", tests::array("<f8", {3}, written)}}, is_compressed);
    const std::string whole = test::contents(path);
    const std::size_t begin = whole.find("x.npy") + 5, end = whole.find("PK\1\2");
    std::size_t errors = 0;
    for (std::size_t at = begin; at < end; ++at) {
      std::string flipped = whole;
      flipped[at] = static_cast<char>(flipped[at] ^ 1);
      const auto file = folder.file("b.npz", flipped);
      std::vector<double> numbers(3);
      const std::string error =
          error_of(folder.path(), [&] { NpyArray(Npz(file), "x").take_numbers(numbers); });
      errors += error.starts_with("b.npz: ") ? 1U : 0U;
      EXPECT_TRUE(error.starts_with("b.npz: ") || numbers == written) << at;
    }
    EXPECT_GT(errors + 3, end - begin);
  }
}

}  // namespace
}  // namespace touchstone::verify::data::npz_test
