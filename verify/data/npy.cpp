#include "verify/data/npy.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "verify/data/dataset_error.hpp"

namespace touchstone::verify::data {
namespace {

static_assert(std::endian::native == std::endian::little, "queries are read as they are stored");

constexpr std::string_view magic = "\x93NUMPY";
constexpr std::size_t version_1_prefix = 10;
constexpr std::size_t version_2_prefix = 12;

/// A header that is none, or of another array.
struct HeaderError {
  std::string reason;
};

struct Header {
  std::optional<std::string> descr;
  std::optional<bool> fortran_order;
  std::optional<std::vector<std::uint64_t>> shape;
};

/// Reads the header's dictionary: of Python's literals only strings without escapes, True, False
/// and tuples of integers.
class HeaderParser {
 public:
  explicit HeaderParser(std::string_view text) : rest_(text) {}

  [[nodiscard]] Header parse() {
    Header header;
    expect('{');
    while (!accept('}')) {
      read_entry(header);
      if (accept(',')) continue;
      expect('}');
      break;
    }
    skip_space();
    if (!rest_.empty()) throw HeaderError{"malformed header"};
    return header;
  }

 private:
  void read_entry(Header& header) {
    const std::string key = read_string();
    expect(':');
    if (key == "descr" && !header.descr) {
      header.descr = read_descr();
    } else if (key == "fortran_order" && !header.fortran_order) {
      header.fortran_order = read_bool();
    } else if (key == "shape" && !header.shape) {
      header.shape = read_tuple();
    } else {
      throw HeaderError{"unknown or repeated key in the header: " + quote(key)};
    }
  }

  std::string read_descr() {
    skip_space();
    if (rest_.starts_with('[')) throw HeaderError{"the array has named fields, expected float64"};
    return read_string();
  }

  std::string read_string() {
    skip_space();
    if (!rest_.starts_with('\'') && !rest_.starts_with('"')) throw HeaderError{"malformed header"};
    const std::size_t end = rest_.find(rest_.front(), 1);
    if (end == std::string_view::npos) throw HeaderError{"malformed header"};
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
    throw HeaderError{"malformed header"};
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
    if (error != std::errc()) throw HeaderError{"malformed header"};
    rest_.remove_prefix(static_cast<std::size_t>(stop - rest_.data()));
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
    if (!accept(c)) throw HeaderError{"malformed header"};
  }

  std::string_view rest_;
};

/// Number of queries that the header announces.
std::uint64_t query_count(const Header& header) {
  if (!header.descr || !header.fortran_order || !header.shape) {
    throw HeaderError{"the header lacks descr, fortran_order or shape"};
  }
  if (*header.descr != "<f8") {
    throw HeaderError{"dtype " + quote(*header.descr) +
                      ", expected \"<f8\" (little-endian float64)"};
  }
  if (*header.fortran_order) throw HeaderError{"Fortran order, expected C order"};
  const std::vector<std::uint64_t>& shape = *header.shape;
  if (shape.size() != 3 || shape[1] != query_points || shape[2] != 3) {
    std::string text;
    for (const std::uint64_t extent : shape)
      text += (text.empty() ? "" : ", ") + std::to_string(extent);
    throw HeaderError{"shape (" + text + "), expected (N, 8, 3)"};
  }
  return shape[0];
}

std::size_t little_endian(std::string_view bytes) {
  std::size_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) {
    value = 256 * value + static_cast<unsigned char>(bytes[i]);
  }
  return value;
}

/// As many bytes as there are, up to the size of the buffer.
std::size_t read_bytes(io::InputFile& file, std::span<char> buffer) {
  std::size_t done = 0;
  while (done < buffer.size()) {
    const std::size_t count = file.read(buffer.subspan(done));
    if (count == 0) break;
    done += count;
  }
  return done;
}

/// The next `size` bytes of the header.
std::string read_header_bytes(io::InputFile& file, std::size_t size) {
  std::string bytes(size, '\0');
  if (read_bytes(file, bytes) < size) throw HeaderError{"truncated header"};
  return bytes;
}

/// Reads all that stands before the data and returns the number of queries.
std::uint64_t read_header(io::InputFile& file) {
  static constexpr std::size_t longest_header = std::size_t{1} << 20U;
  if (file.size() < version_1_prefix) throw HeaderError{"not a NumPy file"};
  std::string prefix = read_header_bytes(file, version_1_prefix);
  if (!prefix.starts_with(magic)) throw HeaderError{"not a NumPy file"};
  const auto version = static_cast<unsigned char>(prefix[magic.size()]);
  if (version < 1 || version > 3) {
    throw HeaderError{fmt::format("version {} of the NumPy format, expected 1, 2 or 3", version)};
  }
  if (version != 1) prefix += read_header_bytes(file, version_2_prefix - version_1_prefix);
  const std::size_t length = little_endian(std::string_view(prefix).substr(magic.size() + 2));
  if (file.size() - prefix.size() < length) throw HeaderError{"truncated header"};
  if (length > longest_header) throw HeaderError{"header longer than 1 MiB"};
  const std::string header = read_header_bytes(file, length);
  const std::uint64_t count = query_count(HeaderParser(header).parse());
  const std::uint64_t data_size = file.size() - prefix.size() - length;
  if (data_size % sizeof(Query) != 0 || data_size / sizeof(Query) != count) {
    throw HeaderError{fmt::format("{} bytes of data, but the shape says {} queries of {} bytes",
                                  data_size, count, sizeof(Query))};
  }
  return count;
}

std::string header_text(std::uint64_t count) {
  // Room for the largest count; a multiple of 64 in all, as NumPy pads it.
  static constexpr std::size_t total = 128;
  std::string text(magic);
  text += '\x01';
  text += '\x00';
  text += static_cast<char>(total - version_1_prefix);
  text += '\x00';
  text += fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, {}, 3), }}", count,
                      query_points);
  text.resize(total - 1, ' ');
  return text + '\n';
}

}  // namespace

NpyReader::NpyReader(const std::filesystem::path& path) : file_(path) {
  try {
    count_ = read_header(file_);
  } catch (const HeaderError& error) {
    throw DatasetError(path, {}, error.reason);
  }
}

const Query& NpyReader::next() {
  if (next_in_block_ == block_.size()) fill();
  ++position_;
  return block_[next_in_block_++];
}

void NpyReader::fill() {
  // 96 KiB: a system call is not felt, and the block stays in the processor's cache.
  static constexpr std::uint64_t block_size = 512;
  block_.resize(std::min(block_size, count_ - position_));
  next_in_block_ = 0;
  void* const bytes = block_.data();
  const std::size_t size =
      read_bytes(file_, {static_cast<char*>(bytes), block_.size() * sizeof(Query)});
  block_.resize(size / sizeof(Query));
  if (!block_.empty()) return;
  throw DatasetError(file_.path(), {},
                     fmt::format("has become shorter while it was read: query {} of {} is missing",
                                 position_, count_));
}

NpyWriter::NpyWriter(std::filesystem::path path) : file_(std::move(path)) {
  file_.write(header_text(0));
}

void NpyWriter::write(const Query& query) {
  if (!is_finite(query)) throw std::invalid_argument("a coordinate must be finite");
  const void* const bytes = &query;
  file_.write({static_cast<const char*>(bytes), sizeof(Query)});
  ++count_;
}

void NpyWriter::close() {
  file_.overwrite(0, header_text(count_));
  file_.close();
}

}  // namespace touchstone::verify::data
