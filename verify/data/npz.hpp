#pragma once

/// \file
/// NumPy's .npz archives, as `savez` and `savez_compressed` write them: a zip of .npy files.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "verify/data/npy.hpp"

struct zip;

namespace touchstone::verify::data {

/// An archive that is open for reading.
class Npz {
 public:
  /// \throws io::DatasetError if it cannot be opened, bytes follow it, or two members have one name.
  explicit Npz(std::filesystem::path path);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] bool has(const std::string& array) const;
  /// The names of all arrays, in the order of the archive.
  [[nodiscard]] std::vector<std::string> names() const;

 private:
  friend class NpyArray;

  std::filesystem::path path_;
  std::shared_ptr<zip> archive_;
};

}  // namespace touchstone::verify::data
