#include "verify/data/npz.hpp"

#include <fmt/format.h>
#include <zip.h>

#include <bit>
#include <utility>

#include "verify/io/dataset_error.hpp"

namespace touchstone::verify::data {

static_assert(std::endian::native == std::endian::little, "arrays are read as they are stored");

void Npz::Close::operator()(zip* archive) const { zip_discard(archive); }

Npz::Npz(std::filesystem::path path) : path_(std::move(path)) {
  int error = 0;
  archive_.reset(zip_open(path_.c_str(), ZIP_RDONLY, &error));
  if (archive_) return;
  zip_error_t reason;
  zip_error_init_with_code(&reason, error);
  const std::string text = zip_error_strerror(&reason);
  zip_error_fini(&reason);
  throw io::DatasetError(path_, {}, "cannot open: " + text);
}

bool Npz::has(const std::string& array) const {
  return zip_name_locate(archive_.get(), (array + ".npy").c_str(), 0) >= 0;
}

std::vector<std::string> Npz::names() const {
  static constexpr std::string_view extension = ".npy";
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

void NpzArray::Close::operator()(zip_file* member) const { zip_fclose(member); }

NpzArray::NpzArray(const Npz& archive, std::string name)
    : path_(archive.path()),
      name_(std::move(name)),
      member_(zip_fopen(archive.archive_.get(), (name_ + ".npy").c_str(), 0)) {
  if (!member_) fail(zip_strerror(archive.archive_.get()));
  try {
    header_ = read_npy_header([this](std::span<char> buffer) { return read(buffer); });
    require_c_order(header_);
  } catch (const NpyHeaderError& error) {
    fail(error.what());
  }
}

void NpzArray::require_shape(std::size_t extents, std::span<const std::uint64_t> last,
                             std::string_view expected) const {
  const std::vector<std::uint64_t>& shape = header_.shape;
  if (shape.size() == extents &&
      std::equal(last.begin(), last.end(),
                 shape.end() - static_cast<std::ptrdiff_t>(last.size()))) {
    return;
  }
  fail("shape " + shape_text(header_) + ", expected " + std::string(expected));
}

void NpzArray::fail(const std::string& reason) const {
  throw io::DatasetError(path_, {}, name_ + ": " + reason);
}

std::size_t NpzArray::read(std::span<char> buffer) {
  const zip_int64_t count = zip_fread(member_.get(), buffer.data(), buffer.size());
  if (count < 0) fail(zip_file_strerror(member_.get()));
  return static_cast<std::size_t>(count);
}

void NpzArray::read_all(std::span<char> buffer) {
  while (!buffer.empty()) {
    const std::size_t count = read(buffer);
    if (count == 0) fail("the array ends early");
    buffer = buffer.subspan(count);
  }
}

void NpzArray::fail_for_type(std::span<const std::string_view> names) const {
  fail(fmt::format("dtype {}, expected {}", io::quote(header_.descr), fmt::join(names, " or ")));
}

}  // namespace touchstone::verify::data
