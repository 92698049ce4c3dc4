#pragma once

/// \file
/// SHA-256 (FIPS 180-4, section 6.2): the digest by which files are known to be the same.

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace touchstone::verify::io {

/// The digest of bytes that come in parts.
class Sha256 {
 public:
  void add(std::string_view bytes);
  /// The digest of all bytes in 64 hexadecimal digits. Must be the last call.
  [[nodiscard]] std::string hexadecimal();

 private:
  static constexpr std::size_t block_size = 64;

  void add_block(const char* block);

  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<char, block_size> rest_{};
  std::uint64_t size_ = 0;
};

[[nodiscard]] std::string sha256(std::string_view bytes);

/// \throws DatasetError if the file cannot be read.
[[nodiscard]] std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace touchstone::verify::io
