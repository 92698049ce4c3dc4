#pragma once

/// \file
/// Pairs of indices as NumPy's .npy files: little-endian int32 of shape (N, 2), in C order.
/// They identify the primitives of a mesh in each query.

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>

namespace touchstone::verify::mesh {

/// Writes such a file, which appears completely or not at all.
/// \throws DatasetError if it cannot be written, Interrupted (terminal.hpp) if the user interrupts.
void write_index_pairs(const std::filesystem::path& path,
                       std::span<const std::array<std::int32_t, 2>> pairs);

}  // namespace touchstone::verify::mesh
