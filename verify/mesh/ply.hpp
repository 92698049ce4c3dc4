#pragma once

/// \file
/// PLY, the Stanford polygon format: a text header that names elements, how many there are of each
/// and what properties one has; then all elements in that order, as text or binary.
///
/// Read are of `vertex` x, y, z of any type, of `face` the list `vertex_indices` (or `vertex_index`)
/// and of `edge`, where there is one, `vertex1` and `vertex2`. All else is passed over by its type.
/// In text each element is a line; a `float` in text is the float nearest to it. What the header
/// announces is believed only as far as data follows: memory is proportional to the file.

#include <filesystem>
#include <span>

#include "verify/mesh/mesh.hpp"

namespace touchstone::verify::mesh {

/// Reads a mesh in any of the formats ascii, binary_little_endian and binary_big_endian 1.0.
/// \throws DatasetError with the line, or with the element and the byte where it begins, if the
/// file cannot be read, the header is malformed or lacks what is read, there is no vertex, data is missing or left over,
/// a coordinate is not finite, a face has not three vertices, or an index is no vertex's.
[[nodiscard]] Mesh read_ply(const std::filesystem::path& path);

/// Writes a mesh as binary_little_endian 1.0, coordinates as doubles: reading it gives them bit by bit.
/// \param edges those that are in no face \throws DatasetError if the file cannot be written.
void write_ply(const std::filesystem::path& path, const Vertices& vertices,
               std::span<const fast::Face> faces, std::span<const fast::Edge> edges = {});

}  // namespace touchstone::verify::mesh
