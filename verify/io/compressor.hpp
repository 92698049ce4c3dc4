#pragma once

/// \file
/// Compression of a stream while writing, and decompression while reading (Zstandard, RFC
/// 8878 [rfc8878]).

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

struct ZSTD_CCtx_s;
struct ZSTD_DCtx_s;

namespace touchstone::verify::io {

/// One frame, with a checksum. What compress() and finish() return, in order, is the compressed
/// stream.
class Compressor {
 public:
  /// \throws std::runtime_error if there is no memory for it.
  Compressor();

  /// Consumes bytes; returns the finished output, which may be empty.
  /// \throws std::runtime_error if the library fails.
  [[nodiscard]] std::string compress(std::string_view bytes);

  /// The rest of the output. Must be called once, as the last call.
  /// \throws std::runtime_error if the library fails.
  [[nodiscard]] std::string finish();

 private:
  std::string run(std::string_view bytes, bool last);

  std::unique_ptr<ZSTD_CCtx_s, std::size_t (*)(ZSTD_CCtx_s*)> context_;
};

/// Any number of frames, in bounded memory, independent of the sizes that frames declare.
class Decompressor {
 public:
  /// \throws std::runtime_error if there is no memory for it.
  Decompressor();

  /// Consumes compressed bytes from the front, and writes the decompressed ones. Returns the number
  /// of bytes written; if they fill the buffer there may be more.
  /// \throws std::runtime_error with the reason if the bytes are no such stream.
  [[nodiscard]] std::size_t decompress(std::string_view& bytes, std::span<char> buffer);

  /// True if every frame is complete.
  [[nodiscard]] bool is_complete() const { return is_complete_; }

 private:
  std::unique_ptr<ZSTD_DCtx_s, std::size_t (*)(ZSTD_DCtx_s*)> context_;
  bool is_complete_ = true;
};

}  // namespace touchstone::verify::io
