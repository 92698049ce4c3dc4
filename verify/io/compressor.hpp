#pragma once

/// \file
/// Compression of a stream as it is written, and back as it is read (Zstandard, RFC 8878 [rfc8878]).

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace touchstone::verify::io {

/// One frame, with a checksum. What compress() and finish() return, in order, is the compressed
/// stream.
class Compressor {
 public:
  /// \throws std::runtime_error if there is no memory for it.
  Compressor();

  /// Takes bytes; returns what is ready, which may be nothing.
  /// \throws std::runtime_error if the library fails.
  [[nodiscard]] std::string compress(std::string_view bytes);

  /// All that is left. To be called once, as the last call.
  /// \throws std::runtime_error if the library fails.
  [[nodiscard]] std::string finish();

 private:
  struct Free {
    void operator()(void* context) const;
  };
  std::string run(std::string_view bytes, bool last);

  std::unique_ptr<void, Free> context_;
};

/// Any number of frames. Memory is bounded, whatever a frame says of itself.
class Decompressor {
 public:
  /// \throws std::runtime_error if there is no memory for it.
  Decompressor();

  /// Takes compressed bytes, which it removes from the front, and writes what they stand for. Returns how many bytes
  /// it has written; if they fill the room there may be more.
  /// \throws std::runtime_error with the reason if the bytes are no such stream.
  [[nodiscard]] std::size_t decompress(std::string_view& bytes, std::span<char> room);

  /// Is all that was begun complete?
  [[nodiscard]] bool is_complete() const { return is_complete_; }

 private:
  struct Free {
    void operator()(void* context) const;
  };

  std::unique_ptr<void, Free> context_;
  bool is_complete_ = true;
};

}  // namespace touchstone::verify::io
