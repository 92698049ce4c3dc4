#include "verify/data/npy.hpp"

#include <fmt/format.h>

#include <zip.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "verify/io/dataset_error.hpp"
#include "verify/io/input_file.hpp"
#include "verify/io/number_text.hpp"

namespace touchstone::verify::data {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are read as they are stored");

constexpr std::string_view query_descr = "<f8";

/// The bytes of a number of the header's type; 0 for any other type.
std::size_t size_of_number(const NpyHeader& header) {
  const std::string_view descr = header.descr;
  if (descr.size() < 3 || std::string_view("biufc").find(descr[1]) == std::string_view::npos) {
    return 0;
  }
  return io::number_from_text<std::size_t>(descr.substr(2)).value_or(0);
}

/// The numbers of an array in Fortran order, the first index fastest, in C order.
std::string in_c_order(const std::string& bytes, const NpyHeader& header, std::size_t size) {
  std::vector<std::size_t> strides, place(header.shape.size());
  std::size_t stride = size;
  for (const std::uint64_t extent : header.shape) {
    strides.push_back(stride);
    stride *= extent;
  }
  std::string result;
  result.reserve(bytes.size());
  for (std::size_t from = 0; result.size() < bytes.size();) {
    result.append(bytes, from, size);
    for (std::size_t k = place.size(); k-- > 0;) {
      from += strides[k];
      if (++place[k] < header.shape[k]) break;
      from -= strides[k] * std::exchange(place[k], 0);
    }
  }
  return result;
}

/// Reads a text from its beginning on.
ReadBytes reader_of(std::string text) {
  return [text = std::move(text), at = std::size_t{0}](std::span<char> buffer) mutable {
    const std::size_t count = text.copy(buffer.data(), buffer.size(), at);
    at += count;
    return count;
  };
}

// ---- The header ---------------------------------------------------------------------------------

constexpr std::string_view magic = "\x93NUMPY";
constexpr std::size_t version_1_prefix = 10;
constexpr std::size_t version_2_prefix = 12;

/// The error for a file without such a header; what() is the reason.
class HeaderError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// True if a text begins with the end of a tuple or dictionary, which a comma may precede.
bool closes(std::string_view text) {
  const std::size_t next = text.find_first_not_of(" \t\n");
  return next != std::string_view::npos && (text[next] == ')' || text[next] == '}');
}

/// The dictionary as JSON. Of Python's literals strings without escapes, True, False and tuples of
/// whole numbers become JSON.
std::string json_of(std::string_view dictionary) {
  std::string json;
  while (!dictionary.empty()) {
    const char c = dictionary.front();
    dictionary.remove_prefix(1);
    const bool is_suffix = c == 'L' && !json.empty() && std::isdigit(json.back()) != 0;
    if (is_suffix || (c == ',' && closes(dictionary))) continue;
    const bool is_boolean = dictionary.starts_with("rue") || dictionary.starts_with("alse");
    json += c == '\''                ? '"'
            : c == '('               ? '['
            : c == ')'               ? ']'
            : is_boolean && c == 'T' ? 't'
            : is_boolean && c == 'F' ? 'f'
                                     : c;
  }
  return json;
}

/// The contents of the dictionary.
NpyHeader parsed(std::string_view dictionary) {
  static constexpr const char* malformed = "malformed header";
  try {
    const nlohmann::json json = nlohmann::json::parse(json_of(dictionary));
    if (!json.is_object()) throw HeaderError(malformed);
    if (json.size() != 3 || !json.contains("descr") || !json.contains("fortran_order") ||
        !json.contains("shape")) {
      throw HeaderError("the header must have descr, fortran_order and shape, and nothing else");
    }
    if (json["descr"].is_array()) {
      throw HeaderError("the array has named fields, expected numbers");
    }
    NpyHeader header{.descr = json["descr"].get<std::string>(),
                     .fortran_order = json["fortran_order"].get<bool>(),
                     .shape = {},
                     .size = 0};
    if (!json["shape"].is_array()) throw HeaderError(malformed);
    for (const nlohmann::json& extent : json["shape"]) {
      if (!extent.is_number_unsigned()) throw HeaderError(malformed);
      header.shape.push_back(extent.get<std::uint64_t>());
    }
    return header;
  } catch (const nlohmann::json::exception&) {
    throw HeaderError(malformed);
  }
}

/// The next `size` bytes of the header.
std::string read_exactly(const ReadBytes& read, std::size_t size) {
  std::string bytes(size, '\0');
  if (read(bytes) < size) throw HeaderError("truncated header");
  return bytes;
}

/// Reads the header and no byte more. \throws HeaderError and the exceptions of `read`.
NpyHeader read_header(const ReadBytes& read) {
  static constexpr std::size_t longest_header = std::size_t{1} << 20U;
  std::string prefix(version_1_prefix, '\0');
  if (read(prefix) < prefix.size() || !prefix.starts_with(magic)) {
    throw HeaderError("not a NumPy file");
  }
  const auto version = static_cast<unsigned char>(prefix[magic.size()]);
  if (version < 1 || version > 3) {
    throw HeaderError(fmt::format("version {} of the NumPy format, expected 1, 2 or 3", version));
  }
  if (version != 1) prefix += read_exactly(read, version_2_prefix - version_1_prefix);
  std::size_t length = 0;  // little-endian
  for (std::size_t i = prefix.size(); i-- > magic.size() + 2;) {
    length = 256 * length + static_cast<unsigned char>(prefix[i]);
  }
  if (length > longest_header) throw HeaderError("header longer than 1 MiB");
  NpyHeader header = parsed(read_exactly(read, length));
  header.size = prefix.size() + length;
  return header;
}

std::string shape_text(const NpyHeader& header) {
  return fmt::format("({})", fmt::join(header.shape, ", "));
}

}  // namespace

NpyArray::NpyArray(const std::filesystem::path& path) : path_(path) {
  const auto file = std::make_shared<io::InputFile>(path);
  open([file](std::span<char> buffer) { return file->read_all(buffer); }, file->size());
}

void NpyArray::open(ReadBytes read, std::uint64_t size) {
  read_ = std::move(read);
  try {
    header_ = read_header(read_);
  } catch (const HeaderError& error) {
    fail(error.what());
  }
  const std::uint64_t data_size = size - std::min<std::uint64_t>(size, header_.size);
  check_size(data_size);
  if (!header_.fortran_order || size_of_number(header_) == 0) return;
  std::string bytes(data_size, '\0');
  read_all(bytes);
  read_ = reader_of(in_c_order(bytes, header_, size_of_number(header_)));
}

void NpyArray::check_size(std::uint64_t data_size) const {
  const std::size_t size = size_of_number(header_);
  std::uint64_t expected = size;
  bool fits = true;
  for (const std::uint64_t extent : header_.shape) {
    fits = !__builtin_mul_overflow(expected, extent, &expected) && fits;
  }
  if (size == 0 || (fits && expected == data_size)) return;
  fail(fmt::format("{} bytes of data do not fit shape {} of dtype {}", data_size,
                   shape_text(header_), io::quote(header_.descr)));
}

void NpyArray::require_shape(std::size_t extents, std::span<const std::uint64_t> last,
                             std::string_view expected) const {
  const std::vector<std::uint64_t>& shape = header_.shape;
  if (shape.size() == extents &&
      std::equal(last.begin(), last.end(),
                 shape.end() - static_cast<std::ptrdiff_t>(last.size()))) {
    return;
  }
  fail_for_shape(expected);
}

void NpyArray::fail_for_shape(std::string_view expected) const {
  fail("shape " + shape_text(header_) + ", expected " + std::string(expected));
}

void NpyArray::fail(const std::string& reason) const {
  throw io::DatasetError(path_, {}, name_.empty() ? reason : name_ + ": " + reason);
}

void NpyArray::read_all(std::span<char> buffer) {
  while (!buffer.empty()) {
    const std::size_t count = read_(buffer);
    if (count == 0) fail("the array ends early: it has become shorter while it was read");
    buffer = buffer.subspan(count);
  }
}

void NpyArray::fail_for_type(std::span<const std::string_view> names) const {
  fail(fmt::format("dtype {}, expected {}", io::quote(header_.descr), fmt::join(names, " or ")));
}

NpyWriter::NpyWriter(std::filesystem::path path, const AnyShape& shape)
    : file_(std::move(path)), extents_{query_points, 3} {
  if (!shape.is_straight()) {
    extents_ = {shape.degree + 1, moving_points, shape.numbers_of_point()};
  }
  file_.write(npy_header_text(query_descr, 0, extents_));
}

void NpyWriter::write(std::span<const double> numbers) {
  if (!is_finite(numbers)) throw std::invalid_argument("a coordinate must be finite");
  const void* const bytes = numbers.data();
  file_.write({static_cast<const char*>(bytes), numbers.size_bytes()});
  ++count_;
}

void NpyWriter::close() {
  file_.overwrite(0, npy_header_text(query_descr, count_, extents_));
  file_.close();
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

namespace {

constexpr std::string_view extension = ".npy";

/// The meaning of libzip's error, and the way out.
std::string reason_of(int error) {
  if (error == ZIP_ER_CRC)
    return "its checksum is wrong: the file is damaged; copy or write it anew";
  if (error == ZIP_ER_EXISTS) return "two members have one name; write it anew";
  if (error == ZIP_ER_INCONS) {
    return "bytes follow the archive, or its directory is damaged; write it anew";
  }
  zip_error_t reason;
  zip_error_init_with_code(&reason, error);
  std::string text = zip_error_strerror(&reason);
  zip_error_fini(&reason);
  return text;
}

/// A member that is open for reading, and its archive, which has to stay open as long.
struct OpenMember {
  std::shared_ptr<zip> archive;
  zip_file* file;

  explicit OpenMember(std::shared_ptr<zip> of, const std::string& name)
      : archive(std::move(of)), file(zip_fopen(archive.get(), name.c_str(), 0)) {}
  OpenMember(const OpenMember&) = delete;
  OpenMember& operator=(const OpenMember&) = delete;
  OpenMember(OpenMember&&) = delete;
  OpenMember& operator=(OpenMember&&) = delete;
  ~OpenMember() {
    if (file != nullptr) zip_fclose(file);
  }
};

/// Reads a member from its first byte on.
ReadBytes reader_of(const std::shared_ptr<zip>& archive, const std::filesystem::path& path,
                    const std::string& name) {
  const auto member = std::make_shared<OpenMember>(archive, name + std::string(extension));
  if (member->file == nullptr) {
    throw io::DatasetError(path, {}, name + ": " + zip_strerror(archive.get()));
  }
  return [member, path, name](std::span<char> buffer) {
    const zip_int64_t count = zip_fread(member->file, buffer.data(), buffer.size());
    if (count >= 0) return static_cast<std::size_t>(count);
    throw io::DatasetError(
        path, {}, name + ": " + reason_of(zip_error_code_zip(zip_file_get_error(member->file))));
  };
}

}  // namespace

Npz::Npz(std::filesystem::path path) : path_(std::move(path)) {
  int error = 0;
  // The flag also refuses bytes behind the archive and names that come twice.
  archive_ = {zip_open(path_.c_str(), ZIP_RDONLY | ZIP_CHECKCONS, &error), [](zip* archive) {
                if (archive != nullptr) zip_discard(archive);
              }};
  if (!archive_) throw io::DatasetError(path_, {}, "cannot open: " + reason_of(error));
}

bool Npz::has(const std::string& array) const {
  return zip_name_locate(archive_.get(), (array + std::string(extension)).c_str(), 0) >= 0;
}

std::vector<std::string> Npz::names() const {
  std::vector<std::string> result;
  const zip_int64_t count = zip_get_num_entries(archive_.get(), 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* const text = zip_get_name(archive_.get(), static_cast<zip_uint64_t>(i), 0);
    std::string_view name = text == nullptr ? "" : text;
    if (!name.ends_with(extension)) continue;
    name.remove_suffix(extension.size());
    result.emplace_back(name);
  }
  return result;
}

NpyArray::NpyArray(const Npz& archive, const std::string& name)
    : path_(archive.path()), name_(name) {
  if (!archive.has(name)) {
    fail(fmt::format("no such array; the archive has: {}", fmt::join(archive.names(), ", ")));
  }
  const auto reader = [&] { return reader_of(archive.archive_, path_, name); };
  // libzip compares the checksum where the member ends.
  std::array<char, 1U << 16U> part{};
  std::uint64_t size = 0;
  const ReadBytes whole = reader();
  while (const std::size_t count = whole(part)) size += count;
  open(reader(), size);
}

}  // namespace touchstone::verify::data
