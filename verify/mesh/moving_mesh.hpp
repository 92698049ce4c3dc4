#pragma once

/// \file
/// A step of a simulation for benchmarks: the mesh before and after, and the candidates
/// between them.

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "touchstone/any_kind.hpp"
#include "touchstone/mesh.hpp"

namespace touchstone::verify::mesh {

/// A mesh whose vertices move in a step.
struct MovingMesh {
  std::string name;
  fast::Motion vertices;
  std::vector<fast::Face> faces;
  std::vector<fast::Edge> edges;
  std::string note = {};  ///< as Mesh has it
};

/// The step from one mesh file to another.
/// \throws DatasetError if one cannot be read, the meshes differ in more than the positions of
/// their vertices, or they have no face and no edge.
[[nodiscard]] MovingMesh read_step(const std::filesystem::path& before,
                                   const std::filesystem::path& after);

/// The pairs that the broad phase finds as queries, with all that come within the distance on every
/// axis: enough for either norm. \param stop As in the options of the broad phase.
/// \throws io::Interrupted if the user interrupts.
[[nodiscard]] std::vector<Query> candidates_of(const MovingMesh& mesh, ContactKind kind,
                                               const Separation& separation = {},
                                               const std::atomic<bool>* stop = nullptr);

}  // namespace touchstone::verify::mesh
