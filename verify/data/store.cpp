#include "verify/data/store.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <system_error>

#include "verify/io/dataset_error.hpp"
#include "verify/io/input_file.hpp"
#include "verify/io/json.hpp"
#include "verify/io/sha256.hpp"

namespace touchstone::verify::data {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t longest_manifest = std::size_t{1} << 30U;

void check_size(const fs::path& file, std::uint64_t expected) {
  std::error_code error;
  const std::uint64_t size = fs::file_size(file, error);
  if (error) throw io::DatasetError(file, {}, "missing, but the manifest of its store names it");
  if (size == expected) return;
  throw io::DatasetError(
      file, {}, fmt::format("{} bytes, but the manifest of its store says {}", size, expected));
}

}  // namespace

std::string digest_of(const fs::path& file) {
  io::InputFile input(file);
  io::Sha256 digest;
  std::string chunk(std::size_t{1} << 16U, '\0');
  while (const std::size_t count = input.read(chunk)) digest.add({chunk.data(), count});
  return digest.hexadecimal();
}

json described(const fs::path& file, const std::string& name) {
  return {{"file", name}, {"bytes", fs::file_size(file)}, {"sha256", digest_of(file)}};
}

std::map<fs::path, std::string> store_digests(const fs::path& folder,
                                              std::span<const fs::path> datasets) {
  const fs::path manifest = folder / manifest_name;
  std::map<fs::path, std::string> digests;
  if (!fs::exists(manifest)) return digests;
  try {
    const json store = io::read_json(manifest, longest_manifest);
    if (!store.is_object() || store.value("format", "") != store_format) return digests;
    for (const json& shard : store.at("shards")) {
      for (const json& file : shard.at("files")) {
        const fs::path path = (folder / file.at("file").get<std::string>()).lexically_normal();
        check_size(path, file.at("bytes"));
        digests[path] = file.at("sha256");
      }
    }
  } catch (const json::exception& error) {
    throw io::DatasetError(manifest, {}, "not the manifest of a store: " + io::reason_of(error));
  }
  for (const fs::path& dataset : datasets) {
    if (digests.contains(dataset.lexically_normal())) continue;
    throw io::DatasetError(
        dataset, {},
        "the manifest of its store does not name it (a conversion that was cut short?)");
  }
  return digests;
}

}  // namespace touchstone::verify::data
