#pragma once

/// \file
/// NumPy's .npz archives, as `savez` and `savez_compressed` write them: a zip of .npy files.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "verify/data/npy_header.hpp"

struct zip;
struct zip_file;

namespace touchstone::verify::data {

/// An archive that is open for reading.
class Npz {
 public:
  /// \throws io::DatasetError if it cannot be opened.
  explicit Npz(std::filesystem::path path);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] bool has(const std::string& array) const;
  /// The names of all arrays, in the order of the archive.
  [[nodiscard]] std::vector<std::string> names() const;

 private:
  friend class NpzArray;
  struct Close {
    void operator()(zip* archive) const;
  };

  std::filesystem::path path_;
  std::unique_ptr<zip, Close> archive_;
};

/// An array of an archive, read front to back; valid as long as the archive.
class NpzArray {
 public:
  /// \throws io::DatasetError if it is no array of numbers in C order.
  NpzArray(const Npz& archive, std::string name);

  [[nodiscard]] const std::vector<std::uint64_t>& shape() const { return header_.shape; }

  /// The next numbers, of the type that the header names: one of `Stored`, by `names`.
  /// \throws io::DatasetError if the type is another, or the array ends before.
  template <class Number, class... Stored>
  void take(std::span<Number> numbers,
            const std::array<std::string_view, sizeof...(Stored)>& names) {
    std::size_t i = 0;
    const bool found =
        ((header_.descr == names[i++] && (take_stored<Stored>(numbers), true)) || ...);
    if (!found) fail_for_type(names);
  }

  /// \throws io::DatasetError unless the shape has so many extents, the last ones as given.
  void require_shape(std::size_t extents, std::span<const std::uint64_t> last,
                     std::string_view expected) const;

  /// \throws io::DatasetError with the archive, the array and this reason.
  [[noreturn]] void fail(const std::string& reason) const;

 private:
  struct Close {
    void operator()(zip_file* member) const;
  };

  [[nodiscard]] std::size_t read(std::span<char> buffer);
  /// Fills the buffer. \throws io::DatasetError if the array ends before.
  void read_all(std::span<char> buffer);
  [[noreturn]] void fail_for_type(std::span<const std::string_view> names) const;

  template <class Stored, class Number>
  void take_stored(std::span<Number> numbers) {
    // A bounded part at a time: what the header announces is believed as far as data follows.
    std::array<Stored, 4096> part{};
    while (!numbers.empty()) {
      const std::size_t count = std::min(part.size(), numbers.size());
      read_all({static_cast<char*>(static_cast<void*>(part.data())), count * sizeof(Stored)});
      for (std::size_t i = 0; i < count; ++i) numbers[i] = static_cast<Number>(part[i]);
      numbers = numbers.subspan(count);
    }
  }

  std::filesystem::path path_;
  std::string name_;
  std::unique_ptr<zip_file, Close> member_;
  NpyHeader header_;
};

}  // namespace touchstone::verify::data
