#pragma once

/// \file
/// Wavefront OBJ: lines of text, each a keyword and its words.
///
/// The reader uses `v x y z` (the weight 1 or three numbers of a colour may follow), `f a b c …`,
/// `l a b …` and `p a …`. A corner is the number of a vertex, counted from 1, or backwards from the
/// last vertex before it (−1); numbers of a texture and of a normal may follow after '/'. A face of
/// more than three corners is a fan of triangles around its first. `o` and `g` begin a group whose
/// name is the rest of the line: a vertex is in the group of the faces, lines and points that use
/// it, or, without any, in the group of its own line. obj_statements.hpp lists the statements that
/// are ignored, and the errors.

#include <filesystem>

#include "verify/mesh/mesh_file.hpp"

namespace touchstone::verify::mesh {

/// Reads a mesh.
/// \throws DatasetError with the line, if the file cannot be read, it has no vertex, a coordinate
/// is not a finite number, an element has too few corners, a corner is not a vertex, or a statement
/// is not known.
[[nodiscard]] Mesh read_obj(const std::filesystem::path& path);

}  // namespace touchstone::verify::mesh
