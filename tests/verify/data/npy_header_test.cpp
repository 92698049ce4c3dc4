#include "verify/data/npy_header.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>

namespace touchstone::verify::data::npy_header_test {
namespace {

/// A reader of a text.
ReadBytes reader(std::string_view& text) {
  return [&text](std::span<char> buffer) {
    const std::size_t count = std::min(buffer.size(), text.size());
    std::ranges::copy(text.substr(0, count), buffer.begin());
    text.remove_prefix(count);
    return count;
  };
}

constexpr std::array<std::uint64_t, 2> eight_by_three{8, 3};

TEST(NpyHeader, ReadsWhatIsWrittenAndNoByteMore) {
  const std::string written = npy_header_text("<f8", 77, eight_by_three) + "data";
  std::string_view rest = written;
  const NpyHeader header = read_npy_header(reader(rest));
  EXPECT_EQ(header.descr, "<f8");
  EXPECT_FALSE(header.fortran_order);
  EXPECT_EQ(header.shape, (std::vector<std::uint64_t>{77, 8, 3}));
  EXPECT_EQ(shape_text(header), "(77, 8, 3)");
  EXPECT_EQ(header.size, written.size() - 4);
  EXPECT_EQ(rest, "data");
}

TEST(NpyHeader, HasOneSizeForEveryCount) {
  for (const std::uint64_t count : {std::uint64_t{0}, UINT64_MAX}) {
    EXPECT_EQ(npy_header_text("<f8", count, eight_by_three).size(), 128U);
  }
}

TEST(NpyHeader, EndsWithTheReasonIfItIsInvalid) {
  const std::string whole = npy_header_text("<i4", 5, {});
  for (std::size_t size = 0; size < whole.size(); ++size) {
    std::string_view rest = std::string_view(whole).substr(0, size);
    EXPECT_THROW(static_cast<void>(read_npy_header(reader(rest))), NpyHeaderError) << size;
  }
}

}  // namespace
}  // namespace touchstone::verify::data::npy_header_test
