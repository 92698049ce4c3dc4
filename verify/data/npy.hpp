#pragma once

/// \file
/// NumPy's .npy files of queries: little-endian float64 of shape (N, 8, 3), in C order.
///
/// Such an array has the layout of N consecutive Query objects, so its bytes *are* the queries,
/// without parsing. An array of no queries, shape (0, 8, 3), is valid.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "touchstone/query.hpp"
#include "verify/io/input_file.hpp"
#include "verify/io/output_file.hpp"

namespace touchstone::verify::data {

/// Reads such a file front to back, a block of queries at a time. The file is not mapped into
/// memory, because the system ends a process that reads mapped pages of a file that was truncated.
class NpyReader {
 public:
  /// \throws DatasetError if the file cannot be read, is not such an array, or its size does not
  /// fit its shape.
  explicit NpyReader(const std::filesystem::path& path);

  /// Number of queries according to the header.
  [[nodiscard]] std::uint64_t count() const { return count_; }

  /// Number of the query that next() returns.
  [[nodiscard]] std::uint64_t position() const { return position_; }

  /// The next query, valid until the next call. Coordinates are not checked for NaN and infinities.
  /// \pre position() < count().
  /// \throws DatasetError if the system reports an error, or the file has become shorter.
  [[nodiscard]] const Query& next();

 private:
  void fill();

  io::InputFile file_;
  std::uint64_t count_ = 0;
  std::uint64_t position_ = 0;
  std::vector<Query> block_;
  std::size_t next_in_block_ = 0;
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
  io::OutputFile file_;
  std::uint64_t count_ = 0;
};

}  // namespace touchstone::verify::data
