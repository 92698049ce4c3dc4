#include "verify/data/npy.hpp"

#include <fmt/format.h>

#include <bit>
#include <memory>
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

}  // namespace

NpyArray::NpyArray(const std::filesystem::path& path) : path_(path) {
  const auto file = std::make_shared<io::InputFile>(path);
  open([file](std::span<char> buffer) { return file->read_all(buffer); }, file->size());
}

void NpyArray::open(ReadBytes read, std::uint64_t size) {
  read_ = std::move(read);
  try {
    header_ = read_npy_header(read_);
  } catch (const NpyHeaderError& error) {
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

NpyWriter::NpyWriter(std::filesystem::path path, const QueryShape& shape)
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

}  // namespace touchstone::verify::data
