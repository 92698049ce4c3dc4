#include "verify/data/npz.hpp"

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
  NpzArray array(archive, "x");
  EXPECT_EQ(array.shape(), (std::vector<std::uint64_t>{3, 1}));
  std::vector<double> numbers(2);
  array.take<double, double>(numbers, {"<f8"});
  EXPECT_EQ(numbers, (std::vector<double>{1.0, -2.0}));
  EXPECT_EQ(error_of(folder.path(), [&] { array.take<double, double>(numbers, {"<f8"}); }),
            "a.npz: x: the array ends early");
  EXPECT_EQ(error_of(folder.path(), [&] { array.take<double, float>(numbers, {"<f4"}); }),
            "a.npz: x: dtype \"<f8\", expected <f4");
  EXPECT_EQ(error_of(folder.path(), [&] { (void)NpzArray(archive, "y"); }),
            "a.npz: y: No such file");
}

TEST(Npz, ThatCannotBeOpenedIsAnError) {
  const TemporaryFolder folder;
  EXPECT_EQ(error_of(folder.path(), [&] { (void)Npz(folder.path() / "b.npz"); }),
            "b.npz: cannot open: No such file");
  EXPECT_EQ(error_of(folder.path(), [&] { (void)Npz(folder.file("c.npz", "text")); }),
            "c.npz: cannot open: Not a zip archive");
}

}  // namespace
}  // namespace touchstone::verify::data::npz_test
