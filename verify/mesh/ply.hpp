#pragma once

/// \file
/// PLY, the Stanford polygon format: a text header with the elements, their numbers and their
/// properties; then all elements in that order, as text or binary.
///
/// The reader uses x, y, z of `vertex` with any type, the list `vertex_indices` (or `vertex_index`)
/// of `face`, and `vertex1` and `vertex2` of an optional `edge`. A face of more than three vertices
/// is a fan of triangles around its first. Other properties and elements are passed over by their
/// type; other elements with such properties are an error. In text each element is a line; a
/// `float` in text is rounded to the nearest float. Memory is proportional to the data, not to the
/// numbers in the header.

#include <filesystem>
#include <span>

#include "verify/mesh/mesh_file.hpp"

namespace touchstone::verify::mesh {

/// Reads a mesh in any of the formats ascii, binary_little_endian and binary_big_endian 1.0.
/// \throws DatasetError with the line, or with the element and the byte where it begins, if the
/// file cannot be read, the header is malformed or incomplete, there is no vertex, data is missing
/// or left over, a coordinate is not finite, a face has fewer than three vertices, or an index is
/// out of range.
[[nodiscard]] Mesh read_ply(const std::filesystem::path& path);

/// Writes a mesh as binary_little_endian 1.0, coordinates as doubles: reading reproduces them bit
/// by bit. \param edges the edges of no face \throws DatasetError if the file cannot be written.
void write_ply(const std::filesystem::path& path, const Vertices& vertices,
               std::span<const fast::Face> faces, std::span<const fast::Edge> edges = {});

}  // namespace touchstone::verify::mesh
