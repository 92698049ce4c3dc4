#pragma once

/// \file
/// The header of NumPy's .npy files: "\x93NUMPY", two bytes of version (1 to 3), the length of the
/// dictionary (2 bytes in version 1, else 4, little-endian) and the dictionary, of exactly descr,
/// fortran_order and shape; then the data. NumPy of Python 2 wrote extents as "8L".

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone::verify::data {

/// The error for a file without such a header, or with that of another array; what() is the reason.
class NpyHeaderError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The contents of the header.
struct NpyHeader {
  std::string descr;           ///< the type: "<f8" is little-endian float64
  bool fortran_order = false;  ///< the first index fastest
  std::vector<std::uint64_t> shape;
  /// Bytes before the data.
  std::size_t size = 0;
};

/// Fills the buffer, or a part of it at the end of the file; returns the number of bytes.
using ReadBytes = std::function<std::size_t(std::span<char>)>;

/// Reads the header and no byte more.
/// \throws NpyHeaderError and the exceptions of `read`.
[[nodiscard]] NpyHeader read_npy_header(const ReadBytes& read);

/// "(3, 8, 3)"
[[nodiscard]] std::string shape_text(const NpyHeader& header);

/// The header of an array in C order whose first extent is `count`, always 128 bytes, so that it
/// can be rewritten when the number is known.
/// \param descr the type \param extents the further extents
[[nodiscard]] std::string npy_header_text(std::string_view descr, std::uint64_t count,
                                          std::span<const std::uint64_t> extents);

}  // namespace touchstone::verify::data
