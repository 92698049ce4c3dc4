#include "verify/dataset/npy.hpp"

#include <fmt/core.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "verify/dataset/dataset_error.hpp"
#include "verify/dataset/input_file.hpp"

namespace touchstone::verify {
namespace {

static_assert(std::endian::native == std::endian::little, "queries are mapped as they are stored");

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
  if (shape[0] == 0) throw HeaderError{"no queries"};
  return shape[0];
}

std::size_t little_endian(std::string_view bytes) {
  std::size_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) {
    value = 256 * value + static_cast<unsigned char>(bytes[i]);
  }
  return value;
}

/// Offset of the data, after the header at the start of the file; `header` is set to its text.
std::size_t data_offset(std::string_view file, std::string_view& header) {
  if (!file.starts_with(magic) || file.size() < version_1_prefix) {
    throw HeaderError{"not a NumPy file"};
  }
  const auto version = static_cast<unsigned char>(file[magic.size()]);
  if (version < 1 || version > 3) {
    throw HeaderError{fmt::format("version {} of the NumPy format, expected 1, 2 or 3", version)};
  }
  const std::size_t prefix = version == 1 ? version_1_prefix : version_2_prefix;
  const std::size_t length_at = magic.size() + 2;
  if (file.size() < prefix) throw HeaderError{"truncated header"};
  const std::size_t length = little_endian(file.substr(length_at, prefix - length_at));
  if (file.size() - prefix < length) throw HeaderError{"truncated header"};
  header = file.substr(prefix, length);
  return prefix + length;
}

/// The queries inside the bytes of a whole file.
std::span<const Query> locate_queries(std::span<const std::byte> bytes) {
  const std::string_view file(static_cast<const char*>(static_cast<const void*>(bytes.data())),
                              bytes.size());
  std::string_view header;
  const std::size_t offset = data_offset(file, header);
  const std::uint64_t count = query_count(HeaderParser(header).parse());
  if (offset % alignof(double) != 0) {
    throw HeaderError{fmt::format("data at offset {}, expected a multiple of 8", offset)};
  }
  const std::size_t data_size = bytes.size() - offset;
  if (data_size % sizeof(Query) != 0 || data_size / sizeof(Query) != count) {
    throw HeaderError{fmt::format("{} bytes of data, but the shape says {} queries of {} bytes",
                                  data_size, count, sizeof(Query))};
  }
  const void* const data = bytes.subspan(offset).data();
  return {static_cast<const Query*>(data), count};
}

void unmap(std::span<std::byte> mapping) {
  if (!mapping.empty()) ::munmap(mapping.data(), mapping.size());
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

NpyFile::NpyFile(const std::filesystem::path& path) {
  const InputFile file(path);
  if (file.size() == 0) throw DatasetError(path, {}, "not a NumPy file");
  void* const memory = ::mmap(nullptr, file.size(), PROT_READ, MAP_PRIVATE, file.descriptor(), 0);
  if (memory == MAP_FAILED) {
    throw DatasetError(path, {}, "cannot map: " + std::generic_category().message(errno));
  }
  mapping_ = {static_cast<std::byte*>(memory), file.size()};
  ::madvise(memory, file.size(), MADV_SEQUENTIAL);
  try {
    queries_ = locate_queries(mapping_);
  } catch (const HeaderError& error) {
    unmap(mapping_);
    throw DatasetError(path, {}, error.reason);
  }
}

NpyFile::NpyFile(NpyFile&& other) noexcept
    : mapping_(std::exchange(other.mapping_, {})), queries_(std::exchange(other.queries_, {})) {}

NpyFile& NpyFile::operator=(NpyFile&& other) noexcept {
  std::swap(mapping_, other.mapping_);
  std::swap(queries_, other.queries_);
  return *this;
}

NpyFile::~NpyFile() { unmap(mapping_); }

void NpyFile::release_before(std::size_t query) const {
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  const std::size_t offset = mapping_.size() - queries_.size_bytes() + query * sizeof(Query);
  ::madvise(mapping_.data(), offset / page * page, MADV_DONTNEED);
}

NpyWriter::NpyWriter(std::filesystem::path path) : file_(std::move(path)) {
  file_.write(header_text(0));
}

void NpyWriter::write(const Query& query) {
  const auto& coordinates = query.coordinates;
  if (!std::all_of(coordinates.begin(), coordinates.end(),
                   [](double x) { return std::isfinite(x); })) {
    throw std::invalid_argument("a coordinate must be finite");
  }
  const void* const bytes = &query;
  file_.write({static_cast<const char*>(bytes), sizeof(Query)});
  ++count_;
}

void NpyWriter::close() {
  file_.overwrite(0, header_text(count_));
  file_.close();
}

}  // namespace touchstone::verify
