#pragma once

/// \file
/// Compression of a stream as it is written (Zstandard, RFC 8878 [rfc8878]).

#include <memory>
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

}  // namespace touchstone::verify::io
