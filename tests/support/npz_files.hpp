#pragma once

/// \file
/// NumPy archives that a test writes.

#include <gtest/gtest.h>
#include <zip.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "verify/data/npy.hpp"

namespace touchstone::tests {

/// An .npy file of these numbers.
template <class Number>
[[nodiscard]] std::string array(const std::string& descr, std::vector<std::uint64_t> shape,
                                const std::vector<Number>& numbers) {
  const std::uint64_t count = shape.front();
  shape.erase(shape.begin());
  std::string bytes = verify::data::npy_header_text(descr, count, shape);
  const void* const begin = numbers.data();
  return bytes.append(static_cast<const char*>(begin), numbers.size() * sizeof(Number));
}

/// Writes an archive of these members.
[[nodiscard]] inline std::filesystem::path archive(
    const std::filesystem::path& path, const std::map<std::string, std::string>& members,
    bool is_compressed = true) {
  int error = 0;
  zip_t* const zip = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &error);
  for (const auto& [name, bytes] : members) {
    const zip_int64_t index = zip_file_add(
        zip, name.c_str(), zip_source_buffer(zip, bytes.data(), bytes.size(), 0), ZIP_FL_ENC_UTF_8);
    zip_set_file_compression(zip, static_cast<zip_uint64_t>(index),
                             is_compressed ? ZIP_CM_DEFLATE : ZIP_CM_STORE, 0);
  }
  EXPECT_EQ(zip_close(zip), 0);
  return path;
}

}  // namespace touchstone::tests
