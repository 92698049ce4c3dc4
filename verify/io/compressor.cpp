#include "verify/io/compressor.hpp"

#include <zstd.h>

#include <stdexcept>

namespace touchstone::verify::io {
namespace {

ZSTD_CCtx* as_context(void* pointer) { return static_cast<ZSTD_CCtx*>(pointer); }

void require(std::size_t result) {
  if (ZSTD_isError(result) == 0) return;
  throw std::runtime_error(std::string("compression failed: ") + ZSTD_getErrorName(result));
}

}  // namespace

void Compressor::Free::operator()(void* context) const { ZSTD_freeCCtx(as_context(context)); }

Compressor::Compressor() : context_(ZSTD_createCCtx()) {
  if (!context_) throw std::runtime_error("compression failed: no memory");
  require(ZSTD_CCtx_setParameter(as_context(context_.get()), ZSTD_c_checksumFlag, 1));
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
    const std::size_t left = ZSTD_compressStream2(as_context(context_.get()), &out, &in,
                                                  last ? ZSTD_e_end : ZSTD_e_continue);
    require(left);
    done = last ? left == 0 : in.pos == in.size;
    result.resize(out.pos);
  }
  return result;
}

}  // namespace touchstone::verify::io
