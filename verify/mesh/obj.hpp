#pragma once

/// \file
/// Wavefront OBJ: a text of lines, each a keyword and its words.
///
/// Read are `v x y z` (what follows, a weight or a colour, is not), `f a b c`, `l a b …` and `p a …`. A
/// corner is the number of a vertex, counted from 1, or from the last vertex before it backwards
/// (−1); numbers of a texture and of a normal may follow after '/'. `o` and `g` begin a group with the
/// name that the rest of the line is: a vertex is in the group of the faces, lines and points that have it, or, where
/// it is in none, in the group of its own line. All else is passed over.

#include <filesystem>

#include "verify/mesh/mesh.hpp"

namespace touchstone::verify::mesh {

/// Reads a mesh.
/// \throws DatasetError with the line, if the file cannot be read, it has no vertex, a coordinate is
/// no finite number, a face has not three corners, or a corner is no vertex.
[[nodiscard]] Mesh read_obj(const std::filesystem::path& path);

}  // namespace touchstone::verify::mesh
