#include "verify/io/compressor.hpp"

#include <gtest/gtest.h>
#include <zstd.h>

#include <stdexcept>
#include <string>
#include <string_view>

#include "tests/support/random.hpp"

namespace touchstone::verify::io::compressor_test {
namespace {

/// Decompresses by the library's other interface, for whole buffers of known sizes.
std::string decompress(const std::string& bytes, std::size_t size) {
  std::string result(size + 1, '\0');
  const std::size_t length =
      ZSTD_decompress(result.data(), result.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(length) != 0) return ZSTD_getErrorName(length);
  result.resize(length);
  return result;
}

/// The contents of a stream, read through small buffers in parts of `piece` bytes.
std::string read_back(std::string_view bytes, std::size_t piece, bool& is_complete) {
  Decompressor decompressor;
  std::string text, buffer(977, '\0');
  while (!bytes.empty() || !decompressor.is_complete()) {
    std::string_view some = bytes.substr(0, piece);
    const std::size_t before = some.size();
    const std::size_t count = decompressor.decompress(some, buffer);
    text += buffer.substr(0, count);
    bytes.remove_prefix(before - some.size());
    if (bytes.empty() && count == 0) break;
  }
  is_complete = decompressor.is_complete();
  return text;
}

/// Texts compressed in parts, decompressed by ours in parts, and by the library's other interface.
TEST(Compressor, GivesBackWhatItTook) {
  tests::Random random(1);
  bool is_complete = false;
  std::string text, bytes;
  for (const std::size_t size : {0U, 1U, 1000U, 3000000U, 300000U}) {
    text.clear();
    while (text.size() < size) text += "point " + std::to_string(random.bits() % 1000U) + "\n";
    text.resize(size);
    Compressor compressor;
    bytes.clear();
    for (std::size_t at = 0; at < size;) {
      const std::size_t count = 1 + random.bits() % 100000U;
      bytes += compressor.compress(std::string_view(text).substr(at, count));
      at += count;
    }
    bytes += compressor.finish();
    EXPECT_EQ(decompress(bytes, size), text);
    EXPECT_LT(bytes.size(), size / 3 + 1000);
    for (const std::size_t piece : {1U, 1000U, 1000000U}) {
      EXPECT_EQ(read_back(bytes, piece, is_complete), text);
      EXPECT_TRUE(is_complete);
    }
  }
  EXPECT_EQ(read_back(bytes + bytes, 1000, is_complete), text + text) << "two frames";
  static_cast<void>(read_back(bytes.substr(0, bytes.size() - 1), 1000, is_complete));
  EXPECT_FALSE(is_complete);
  EXPECT_THROW(static_cast<void>(read_back("point 1\n", 1000, is_complete)), std::runtime_error);
  bytes.back() = static_cast<char>(bytes.back() ^ 1);
  EXPECT_THROW(static_cast<void>(read_back(bytes, 1000, is_complete)), std::runtime_error);
}

}  // namespace
}  // namespace touchstone::verify::io::compressor_test
