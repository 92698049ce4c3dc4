#include "verify/dataset/dataset.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <system_error>

#include "verify/dataset/csv_dataset.hpp"
#include "verify/dataset/npy_dataset.hpp"

namespace touchstone::verify {
namespace {

namespace fs = std::filesystem;

bool is_companion_folder(const fs::path& path) {
  static constexpr std::array<std::string_view, 4> names{"toi", "mma_bool", "boxes", "frames"};
  return std::find(names.begin(), names.end(), path.filename().string()) != names.end();
}

bool is_dataset_name(const fs::path& path) {
  const std::string name = path.filename().string();
  return path.extension() == ".npy" || (path.extension() == ".csv" && !name.ends_with("_toi.csv"));
}

std::vector<fs::path> datasets_below(const fs::path& folder) {
  std::vector<fs::path> found;
  try {
    for (fs::recursive_directory_iterator entry(folder), end; entry != end; ++entry) {
      if (entry->is_directory() && is_companion_folder(entry->path())) {
        entry.disable_recursion_pending();
      } else if (entry->is_regular_file() && is_dataset_name(entry->path())) {
        found.push_back(entry->path());
      }
    }
  } catch (const fs::filesystem_error& error) {
    const fs::path& where = error.path1().empty() ? folder : error.path1();
    throw DatasetError(where, {}, "cannot read: " + error.code().message());
  }
  if (found.empty()) throw DatasetError(folder, {}, "no dataset (.csv, .npy) in this folder");
  std::sort(found.begin(), found.end());
  return found;
}

/// The kind that the deepest part naming one names.
std::optional<Kind> kind_from_parts(const fs::path& path) {
  std::optional<Kind> kind;
  for (const fs::path& part : path) {
    const std::string name = part.string();
    const bool vertex_face = name.find(to_string(Kind::vertex_face)) != std::string::npos;
    const bool edge_edge = name.find(to_string(Kind::edge_edge)) != std::string::npos;
    if (vertex_face && edge_edge) {
      throw DatasetError(path, {}, quote(name) + " names both kinds; pass --kind");
    }
    if (vertex_face || edge_edge) kind = vertex_face ? Kind::vertex_face : Kind::edge_edge;
  }
  return kind;
}

}  // namespace

std::vector<fs::path> find_datasets(std::span<const fs::path> paths) {
  std::vector<fs::path> found;
  for (const fs::path& path : paths) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (status.type() == fs::file_type::not_found) throw DatasetError(path, {}, "does not exist");
    if (error) throw DatasetError(path, {}, "cannot read: " + error.message());
    if (status.type() == fs::file_type::directory) {
      const std::vector<fs::path> below = datasets_below(path);
      found.insert(found.end(), below.begin(), below.end());
    } else {
      found.push_back(path);
    }
  }
  return found;
}

Kind kind_from_path(const fs::path& path) {
  if (const auto kind = kind_from_parts(path)) return *kind;
  const std::string stem = path.stem().string();
  if (stem.ends_with("vf")) return Kind::vertex_face;
  if (stem.ends_with("ee")) return Kind::edge_edge;
  if (const auto kind = kind_from_parts(fs::absolute(path).lexically_normal())) return *kind;
  throw DatasetError(path, {},
                     "the path does not say whether its queries are vertex-face or edge-edge; "
                     "pass --kind");
}

std::unique_ptr<QuerySource> open_dataset(const fs::path& path, const DatasetOptions& options) {
  const fs::path extension = path.extension();
  if (extension == ".csv") return std::make_unique<CsvDataset>(path, options);
  if (extension == ".npy") return std::make_unique<NpyDataset>(path, options);
  throw DatasetError(path, {}, "unknown format: only .csv and .npy are datasets");
}

}  // namespace touchstone::verify
