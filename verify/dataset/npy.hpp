#pragma once

/// \file
/// NumPy's .npy files of queries: little-endian float64 of shape (N, 8, 3), in C order.
///
/// Such an array has the layout of N consecutive Query objects, so a mapped file *is* the queries:
/// nothing is parsed or copied. The file begins with "\x93NUMPY", two bytes of version (1 to 3),
/// the length of the header (2 bytes in version 1, else 4, little-endian) and the header: a Python
/// dictionary of exactly descr, fortran_order and shape.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "exact/query.hpp"
#include "verify/dataset/output_file.hpp"

namespace touchstone::verify {

/// A .npy file mapped into memory, read-only. Holds for as long as the file is not shortened by
/// somebody else: the system ends a process that reads mapped pages that are gone.
class NpyFile {
 public:
  /// \throws DatasetError if the file cannot be read, is not such an array, has no queries, or its
  /// size does not fit its shape.
  explicit NpyFile(const std::filesystem::path& path);
  NpyFile(const NpyFile&) = delete;
  NpyFile& operator=(const NpyFile&) = delete;
  NpyFile(NpyFile&& other) noexcept;
  NpyFile& operator=(NpyFile&& other) noexcept;
  ~NpyFile();

  /// The file's own memory. Coordinates are as they are in the file: not checked for NaN and
  /// infinities.
  [[nodiscard]] std::span<const Query> queries() const { return queries_; }

  /// Takes the pages that lie wholly before this query out of the process's memory. They stay
  /// readable (the system fetches them again); this only keeps memory small in one pass.
  void release_before(std::size_t query) const;

 private:
  /// The whole file; unmaps it at the end.
  std::span<std::byte> mapping_;
  std::span<const Query> queries_;
};

/// Writes such a file as a stream; the number of queries is filled in at the end.
class NpyWriter {
 public:
  /// \throws DatasetError if no file can be made there.
  explicit NpyWriter(std::filesystem::path path);

  /// Appends a query.
  /// \throws DatasetError if it cannot be written.
  /// \throws std::invalid_argument if a coordinate is not finite; nothing is written then.
  void write(const Query& query);

  /// Completes the file and gives it its name; without this call there is no file.
  /// \throws DatasetError if it cannot be written.
  void close();

 private:
  OutputFile file_;
  std::uint64_t count_ = 0;
};

}  // namespace touchstone::verify
