#include "verify/io/compressor.hpp"

#include <gtest/gtest.h>
#include <zstd.h>

#include <string>

#include "tests/support/random.hpp"

namespace touchstone::verify::io::compressor_test {
namespace {

/// By the library's other interface, the one for whole buffers and known sizes.
std::string decompress(const std::string& bytes, std::size_t size) {
  std::string result(size + 1, '\0');
  const std::size_t length =
      ZSTD_decompress(result.data(), result.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(length) != 0) return ZSTD_getErrorName(length);
  result.resize(length);
  return result;
}

TEST(Compressor, GivesBackWhatItTook) {
  tests::Random random(1);
  for (const std::size_t size : {0U, 1U, 1000U, 3000000U}) {
    std::string text;
    while (text.size() < size) text += "point " + std::to_string(random.bits() % 1000U) + "\n";
    text.resize(size);
    Compressor compressor;
    std::string bytes;
    for (std::size_t at = 0; at < size;) {
      const std::size_t count = 1 + random.bits() % 100000U;
      bytes += compressor.compress(std::string_view(text).substr(at, count));
      at += count;
    }
    bytes += compressor.finish();
    EXPECT_EQ(decompress(bytes, size), text);
    EXPECT_LT(bytes.size(), size / 3 + 1000);
  }
}

TEST(Compressor, ItsFrameHasAChecksum) {
  Compressor compressor;
  std::string bytes = compressor.compress(std::string(1000, 'x') + "y");
  bytes += compressor.finish();
  bytes[bytes.size() - 1] = static_cast<char>(bytes[bytes.size() - 1] ^ 1);
  EXPECT_EQ(decompress(bytes, 1001), "Restored data doesn't match checksum");
}

}  // namespace
}  // namespace touchstone::verify::io::compressor_test
