#pragma once

/// \file
/// The manifest of a store (`touchstone convert`): a folder of shards with the size and the digest
/// of each file, by which an incomplete copy is found before it is judged.

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

namespace touchstone::verify::data {

inline constexpr const char* store_format = "touchstone store 1";
inline constexpr const char* manifest_name = "manifest.json";

/// The SHA-256 of a file. \throws DatasetError if it cannot be read.
[[nodiscard]] std::string digest_of(const std::filesystem::path& file);

/// A file as manifests and records of runs have it: `file` (the given name), `bytes`, `sha256`.
/// \throws as digest_of.
[[nodiscard]] nlohmann::json described(const std::filesystem::path& file, const std::string& name);

/// The SHA-256 digests of all files of a store, by their normal paths; none if the folder is no
/// store.
/// \param datasets that are in the folder
/// \throws DatasetError if the manifest cannot be read, a file that it names is missing or of
/// another size, or it does not name one of the datasets.
[[nodiscard]] std::map<std::filesystem::path, std::string> store_digests(
    const std::filesystem::path& folder, std::span<const std::filesystem::path> datasets);

}  // namespace touchstone::verify::data
