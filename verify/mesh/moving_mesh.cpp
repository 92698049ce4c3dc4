#include "verify/mesh/moving_mesh.hpp"

#include <array>

#include "fast/candidates.hpp"
#include "touchstone/broad_phase.hpp"
#include "verify/io/dataset_error.hpp"
#include "verify/io/terminal.hpp"
#include "verify/mesh/frames.hpp"

namespace touchstone::verify::mesh {

MovingMesh read_step(const std::filesystem::path& before, const std::filesystem::path& after) {
  const std::array files{before, after};
  const auto frames = open_frames(frame_files(files));
  const Mesh& mesh = frames->mesh();
  if (mesh.faces.empty() && mesh.edges.empty()) {
    throw io::DatasetError(before, {}, "no face and no edge: candidates are pairs of these");
  }
  const Vertices start = frames->next(), end = frames->next();
  return {.name = before.stem().string() + "-" + after.stem().string(),
          .vertices = fast::Motion(start, end),
          .faces = mesh.faces,
          .edges = mesh.edges,
          .note = mesh.note};
}

std::vector<Query> candidates_of(const MovingMesh& mesh, ContactKind kind,
                                 const Separation& separation, const std::atomic<bool>* stop) {
  const fast::BroadPhaseOptions options{.separation = separation, .stop = stop};
  const std::vector<fast::IndexPair> pairs =
      kind == ContactKind::vertex_face
          ? fast::vertex_face_candidates(mesh.vertices, mesh.faces, options)
          : fast::edge_edge_candidates(mesh.vertices, mesh.edges, options);
  const fast::Candidates candidates{
      .kind = kind, .pairs = pairs, .edges = mesh.edges, .faces = mesh.faces};
  std::vector<Query> queries;
  queries.reserve(pairs.size());
  for (const fast::IndexPair& pair : pairs) {
    io::throw_if_interrupted();
    queries.push_back(fast::query_of(mesh.vertices, candidates, pair));
  }
  return queries;
}

}  // namespace touchstone::verify::mesh
