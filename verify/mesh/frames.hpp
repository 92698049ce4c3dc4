#pragma once

/// \file
/// A mesh over time: frames with the same elements and other positions of the vertices.
///
/// They come from mesh files (.ply, .obj; a file each, or all of a folder in the order of the
/// numbers in their names), or from one .npz archive as NumPy's `savez` and `savez_compressed`
/// write it: `V`, float32 or float64 of shape (T, n, 3); `F`, faces, of any type of whole numbers
/// and of shape (m, 3); `E`, edges of their own, of shape (k, 2); `P`, points, of shape (p,) or (p,
/// 1); and `T`, tetrahedra, of shape (q, 4). All of these but one may be missing. One frame of `V`
/// is in memory at a time, unless it is in Fortran order.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "verify/mesh/mesh_file.hpp"

namespace touchstone::verify::mesh {

/// A sequence of frames, read from the first to the last.
class Frames {
 public:
  Frames() = default;
  Frames(const Frames&) = delete;
  Frames& operator=(const Frames&) = delete;
  Frames(Frames&&) = delete;
  Frames& operator=(Frames&&) = delete;
  virtual ~Frames() = default;

  /// The elements of all frames, and the vertices of the first.
  [[nodiscard]] virtual const Mesh& mesh() const = 0;
  /// At least 1.
  [[nodiscard]] virtual std::size_t count() const = 0;
  /// The name of frame `i` for users: its file's name without a folder, or its number.
  [[nodiscard]] virtual std::string name(std::size_t i) const = 0;
  /// The vertices of the next frame, the first one first. \pre it was called less than count()
  /// times.
  /// \throws io::DatasetError if it cannot be read, or its mesh is another.
  [[nodiscard]] virtual Vertices next() = 0;
};

/// The files that hold the frames: those of the folder where one is named.
/// \param left_out receives the other entries of that folder, in no order
/// \throws io::DatasetError if a folder has no mesh, or a folder or an archive is not named alone.
[[nodiscard]] std::vector<std::filesystem::path> frame_files(
    std::span<const std::filesystem::path> paths,
    std::vector<std::filesystem::path>* left_out = nullptr);

/// Opens mesh files, or one archive: the result of frame_files. \throws io::DatasetError that names
/// the error, also if nothing in the mesh could collide.
[[nodiscard]] std::unique_ptr<Frames> open_frames(std::vector<std::filesystem::path> files);

}  // namespace touchstone::verify::mesh
