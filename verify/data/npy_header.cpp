#include "verify/data/npy_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <system_error>

#include "verify/io/dataset_error.hpp"

namespace touchstone::verify::data {
namespace {

constexpr std::string_view magic = "\x93NUMPY";
constexpr std::size_t version_1_prefix = 10;
constexpr std::size_t version_2_prefix = 12;

/// The dictionary's entries, as far as they were read.
struct Entries {
  std::optional<std::string> descr;
  std::optional<bool> fortran_order;
  std::optional<std::vector<std::uint64_t>> shape;
};

/// Reads the header's dictionary: of Python's literals only strings without escapes, True, False
/// and tuples of integers.
class HeaderParser {
 public:
  explicit HeaderParser(std::string_view text) : rest_(text) {}

  [[nodiscard]] Entries parse() {
    Entries entries;
    expect('{');
    while (!accept('}')) {
      read_entry(entries);
      if (accept(',')) continue;
      expect('}');
      break;
    }
    skip_space();
    if (!rest_.empty()) throw NpyHeaderError("malformed header");
    return entries;
  }

 private:
  void read_entry(Entries& entries) {
    const std::string key = read_string();
    expect(':');
    if (key == "descr" && !entries.descr) {
      entries.descr = read_descr();
    } else if (key == "fortran_order" && !entries.fortran_order) {
      entries.fortran_order = read_bool();
    } else if (key == "shape" && !entries.shape) {
      entries.shape = read_tuple();
    } else {
      throw NpyHeaderError("unknown or repeated key in the header: " + io::quote(key));
    }
  }

  std::string read_descr() {
    skip_space();
    if (rest_.starts_with('['))
      throw NpyHeaderError("the array has named fields, expected numbers");
    return read_string();
  }

  std::string read_string() {
    skip_space();
    if (!rest_.starts_with('\'') && !rest_.starts_with('"'))
      throw NpyHeaderError("malformed header");
    const std::size_t end = rest_.find(rest_.front(), 1);
    if (end == std::string_view::npos) throw NpyHeaderError("malformed header");
    std::string value(rest_.substr(1, end - 1));
    rest_.remove_prefix(end + 1);
    return value;
  }

  bool read_bool() {
    skip_space();
    for (const bool value : {false, true}) {
      const std::string_view text = value ? "True" : "False";
      if (!rest_.starts_with(text)) continue;
      rest_.remove_prefix(text.size());
      return value;
    }
    throw NpyHeaderError("malformed header");
  }

  std::vector<std::uint64_t> read_tuple() {
    std::vector<std::uint64_t> values;
    expect('(');
    while (!accept(')')) {
      values.push_back(read_integer());
      if (accept(',')) continue;
      expect(')');
      break;
    }
    return values;
  }

  std::uint64_t read_integer() {
    skip_space();
    std::uint64_t value = 0;
    const auto [stop, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc()) throw NpyHeaderError("malformed header");
    rest_.remove_prefix(static_cast<std::size_t>(stop - rest_.data()));
    if (rest_.starts_with('L')) rest_.remove_prefix(1);  // Python 2
    return value;
  }

  void skip_space() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size()));
  }

  bool accept(char c) {
    skip_space();
    if (!rest_.starts_with(c)) return false;
    rest_.remove_prefix(1);
    return true;
  }

  void expect(char c) {
    if (!accept(c)) throw NpyHeaderError("malformed header");
  }

  std::string_view rest_;
};

std::size_t little_endian(std::string_view bytes) {
  std::size_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) {
    value = 256 * value + static_cast<unsigned char>(bytes[i]);
  }
  return value;
}

/// The next `size` bytes of the header.
std::string read_exactly(const ReadBytes& read, std::size_t size) {
  std::string bytes(size, '\0');
  if (read(bytes) < size) throw NpyHeaderError("truncated header");
  return bytes;
}

}  // namespace

NpyHeader read_npy_header(const ReadBytes& read) {
  static constexpr std::size_t longest_header = std::size_t{1} << 20U;
  std::string prefix(version_1_prefix, '\0');
  if (read(prefix) < prefix.size() || !prefix.starts_with(magic)) {
    throw NpyHeaderError("not a NumPy file");
  }
  const auto version = static_cast<unsigned char>(prefix[magic.size()]);
  if (version < 1 || version > 3) {
    throw NpyHeaderError(
        fmt::format("version {} of the NumPy format, expected 1, 2 or 3", version));
  }
  if (version != 1) prefix += read_exactly(read, version_2_prefix - version_1_prefix);
  const std::size_t length = little_endian(std::string_view(prefix).substr(magic.size() + 2));
  if (length > longest_header) throw NpyHeaderError("header longer than 1 MiB");
  Entries entries = HeaderParser(read_exactly(read, length)).parse();
  if (!entries.descr || !entries.fortran_order || !entries.shape) {
    throw NpyHeaderError("the header lacks descr, fortran_order or shape");
  }
  return {.descr = std::move(*entries.descr),
          .fortran_order = *entries.fortran_order,
          .shape = std::move(*entries.shape),
          .size = prefix.size() + length};
}

std::string shape_text(const NpyHeader& header) {
  return fmt::format("({})", fmt::join(header.shape, ", "));
}

std::string npy_header_text(std::string_view descr, std::uint64_t count,
                            std::span<const std::uint64_t> extents) {
  // Room for the largest count; a multiple of 64 in all, as NumPy pads it.
  static constexpr std::size_t total = 128;
  std::string text(magic);
  text += '\x01';
  text += '\x00';
  text += static_cast<char>(total - version_1_prefix);
  text += '\x00';
  text += fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}, {}), }}", descr,
                      count, fmt::join(extents, ", "));
  text.resize(total - 1, ' ');
  return text + '\n';
}

}  // namespace touchstone::verify::data
