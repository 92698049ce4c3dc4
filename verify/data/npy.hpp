#pragma once

/// \file
/// Arrays in NumPy's format: .npy files, and the members of .npz archives.
///
/// An array of float64 in C order has the layout of N consecutive Query objects, or of Queries: its
/// bytes *are* the queries, without parsing. NpyWriter writes this form.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "touchstone/any_kind.hpp"
#include "verify/io/output_file.hpp"

struct zip;

namespace touchstone::verify::data {

class Npz;

// The header of NumPy's .npy files: "\x93NUMPY", two bytes of version (1 to 3), the length of the
// dictionary (2 bytes in version 1, else 4, little-endian) and the dictionary, of exactly descr,
// fortran_order and shape; then the data. NumPy of Python 2 wrote extents as "8L".

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

/// The header of an array in C order whose first extent is `count`, always 128 bytes, so that it
/// can be rewritten when the number is known.
/// \param descr the type \param extents the further extents
[[nodiscard]] std::string npy_header_text(std::string_view descr, std::uint64_t count,
                                          std::span<const std::uint64_t> extents);

/// An array that is read front to back, a part at a time; only one in Fortran order is in memory as
/// a whole. A file is not mapped into memory, because the system ends a process that reads mapped
/// pages of a file that was truncated.
class NpyArray {
 public:
  /// A .npy file.
  /// \throws io::DatasetError if it cannot be read, is no array, or its size does not fit its
  /// shape.
  explicit NpyArray(const std::filesystem::path& path);
  /// An array of an archive, which is read once as a whole for its checksum, before it is used.
  /// \throws io::DatasetError if there is none, its checksum is wrong, or as above.
  NpyArray(const Npz& archive, const std::string& name);

  [[nodiscard]] const std::vector<std::uint64_t>& shape() const { return header_.shape; }

  /// The next numbers, of the type that the header names: one of `Stored`, by `names`.
  /// \throws io::DatasetError if the type is another, or the file has become shorter.
  template <class Number, class... Stored>
  void take(std::span<Number> numbers,
            const std::array<std::string_view, sizeof...(Stored)>& names) {
    std::size_t i = 0;
    const bool found =
        ((header_.descr == names[i++] && (take_stored<Stored>(numbers), true)) || ...);
    if (!found) fail_for_type(names);
  }

  /// The next numbers of an array of doubles or floats. \throws io::DatasetError as take().
  void take_numbers(std::span<double> numbers) {
    take<double, float, double>(numbers, {"<f4", "<f8"});
  }

  /// \throws io::DatasetError unless the shape has this number of extents, the last ones as given.
  void require_shape(std::size_t extents, std::span<const std::uint64_t> last,
                     std::string_view expected) const;
  [[noreturn]] void fail_for_shape(std::string_view expected) const;

  /// \throws io::DatasetError with the file, the array's name in it and this reason.
  [[noreturn]] void fail(const std::string& reason) const;

 private:
  /// Reads the header. \param size of header and data
  void open(ReadBytes read, std::uint64_t size);
  void check_size(std::uint64_t data_size) const;
  /// Fills the buffer. \throws io::DatasetError if the array ends before.
  void read_all(std::span<char> buffer);
  [[noreturn]] void fail_for_type(std::span<const std::string_view> names) const;

  template <class Number>
  static std::span<char> bytes_of(std::span<Number> numbers) {
    return {static_cast<char*>(static_cast<void*>(numbers.data())), numbers.size_bytes()};
  }

  template <class Stored, class Number>
  void take_stored(std::span<Number> numbers) {
    if constexpr (std::is_same_v<Stored, Number>) {
      read_all(bytes_of(numbers));
      return;
    }
    std::array<Stored, 4096> part{};
    while (!numbers.empty()) {
      const std::size_t count = std::min(part.size(), numbers.size());
      read_all(bytes_of(std::span(part).first(count)));
      // NOLINTNEXTLINE(bugprone-signed-char-misuse): an int8 is a number here
      for (std::size_t i = 0; i < count; ++i) numbers[i] = static_cast<Number>(part[i]);
      numbers = numbers.subspan(count);
    }
  }

  std::filesystem::path path_;
  std::string name_;  ///< empty if the file is the array
  ReadBytes read_;
  NpyHeader header_;
};

/// Writes a .npy file of queries as a stream; the number of queries is filled in at the end.
class NpyWriter {
 public:
  /// \param shape of all its queries; the kind does not matter
  /// \throws DatasetError if no file can be made there.
  explicit NpyWriter(std::filesystem::path path, const AnyShape& shape = {});

  /// Appends a query, given by its numbers. \pre as many as the shape has
  /// \throws DatasetError if it cannot be written.
  /// \throws std::invalid_argument if a number is not finite; nothing is written then.
  void write(std::span<const double> numbers);
  void write(const Query& query) { write(query.coordinates); }

  /// Completes the file and gives it its name; without this call there is no file.
  /// \throws DatasetError if it cannot be written.
  void close();

 private:
  io::OutputFile file_;
  std::vector<std::uint64_t> extents_;
  std::uint64_t count_ = 0;
};

// NumPy's .npz archives, as `savez` and `savez_compressed` write them: a zip of .npy files.

/// An archive that is open for reading.
class Npz {
 public:
  /// \throws io::DatasetError if it cannot be opened, bytes follow it, or two members have one
  /// name.
  explicit Npz(std::filesystem::path path);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] bool has(const std::string& array) const;
  /// The names of all arrays, in the order of the archive.
  [[nodiscard]] std::vector<std::string> names() const;

 private:
  friend class NpyArray;

  std::filesystem::path path_;
  std::shared_ptr<zip> archive_;
};

}  // namespace touchstone::verify::data
