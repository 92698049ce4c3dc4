#include "verify/io/compressor.hpp"

#include <zstd.h>

#include <stdexcept>

namespace touchstone::verify::io {
namespace {

void require(std::size_t result) {
  if (ZSTD_isError(result) == 0) return;
  throw std::runtime_error(std::string("compression failed: ") + ZSTD_getErrorName(result));
}

}  // namespace

Compressor::Compressor() : context_(ZSTD_createCCtx(), ZSTD_freeCCtx) {
  if (!context_) throw std::runtime_error("compression failed: no memory");
  require(ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_checksumFlag, 1));
}

std::string Compressor::compress(std::string_view bytes) { return run(bytes, false); }

std::string Compressor::finish() { return run({}, true); }

std::string Compressor::run(std::string_view bytes, bool last) {
  std::string result;
  ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
  for (bool done = false; !done;) {
    const std::size_t before = result.size();
    result.resize(before + ZSTD_CStreamOutSize());
    ZSTD_outBuffer out{result.data(), result.size(), before};
    const std::size_t left =
        ZSTD_compressStream2(context_.get(), &out, &in, last ? ZSTD_e_end : ZSTD_e_continue);
    require(left);
    done = last ? left == 0 : in.pos == in.size;
    result.resize(out.pos);
  }
  return result;
}

Decompressor::Decompressor() : context_(ZSTD_createDCtx(), ZSTD_freeDCtx) {
  if (!context_) throw std::runtime_error("decompression failed: no memory");
}

std::size_t Decompressor::decompress(std::string_view& bytes, std::span<char> buffer) {
  ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
  ZSTD_outBuffer out{buffer.data(), buffer.size(), 0};
  const std::size_t left = ZSTD_decompressStream(context_.get(), &out, &in);
  if (ZSTD_isError(left) != 0) {
    throw std::runtime_error(std::string("decompression failed: ") + ZSTD_getErrorName(left));
  }
  is_complete_ = left == 0;
  bytes.remove_prefix(in.pos);
  return out.pos;
}

}  // namespace touchstone::verify::io
