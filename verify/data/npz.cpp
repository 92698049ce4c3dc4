#include "verify/data/npz.hpp"

#include <fmt/format.h>
#include <zip.h>

#include <array>
#include <utility>

#include "verify/io/dataset_error.hpp"

namespace touchstone::verify::data {
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
