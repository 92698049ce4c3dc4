#include "verify/mesh/moving_mesh.hpp"

#include "touchstone/broad_phase.hpp"
#include "verify/io/dataset_error.hpp"
#include "verify/io/terminal.hpp"
#include "verify/mesh/mesh.hpp"

namespace touchstone::verify::mesh {

MovingMesh read_step(const std::filesystem::path& before, const std::filesystem::path& after) {
  Mesh start = read_mesh(before);
  const Mesh end = read_mesh(after);
  if (!same_elements(start, end)) {
    throw io::DatasetError(after, {}, "is not the same mesh as " + before.string());
  }
  return {.name = before.stem().string() + "-" + after.stem().string(),
          .vertices = fast::MovingVertices(start.vertices, end.vertices),
          .faces = std::move(start.faces),
          .edges = std::move(start.edges)};
}

std::vector<fast::IndexPair> find_candidates(const MovingMesh& mesh, Kind kind, int max_threads,
                                             const Separation& separation,
                                             const std::atomic<bool>* stop) {
  const fast::BroadPhaseOptions options{
      .separation = separation, .max_threads = max_threads, .stop = stop};
  return kind == Kind::vertex_face
             ? fast::vertex_face_candidates(mesh.vertices, mesh.faces, options)
             : fast::edge_edge_candidates(mesh.vertices, mesh.edges, options);
}

fast::Candidates candidates_of(const MovingMesh& mesh, Kind kind,
                               std::span<const fast::IndexPair> pairs) {
  return {.kind = kind, .pairs = pairs, .edges = mesh.edges, .faces = mesh.faces};
}

std::vector<Query> queries_of(const MovingMesh& mesh, const fast::Candidates& candidates) {
  std::vector<Query> queries;
  queries.reserve(candidates.pairs.size());
  for (const fast::IndexPair& pair : candidates.pairs) {
    io::throw_if_interrupted();
    queries.push_back(fast::query_of(mesh.vertices, candidates, pair));
  }
  return queries;
}

}  // namespace touchstone::verify::mesh
