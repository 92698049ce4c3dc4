#pragma once

/// \file
/// The public simulation steps with their labels, pair by pair: meshes before and after a
/// step, and the truth of the pairs that a conservative solver reported. Every other pair of the
/// step does not collide.
///
/// The dataset numbers vertices first, then edges, then faces, and edges as fast::edges_of does.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fast/candidates.hpp"
#include "tests/support/public_data.hpp"
#include "touchstone/mesh.hpp"
#include "touchstone/query.hpp"
#include "verify/mesh/mesh_file.hpp"

namespace touchstone::tests {

/// Pairs of one kind, each with its label.
struct LabelledPairs {
  std::vector<fast::IndexPair> pairs;  ///< vertex and face, or two edges, the smaller index first
  std::vector<bool> collides;
};

/// A step of a simulation.
struct SimulationStep {
  std::string scene;
  fast::Motion vertices;
  std::vector<fast::Edge> edges;
  std::vector<fast::Face> faces;
  LabelledPairs vertex_face;
  LabelledPairs edge_edge;

  [[nodiscard]] const LabelledPairs& labelled(ContactKind kind) const {
    return kind == ContactKind::vertex_face ? vertex_face : edge_edge;
  }

  /// Pairs with the arrays of their indices; refers to both.
  [[nodiscard]] fast::Candidates candidates(ContactKind kind,
                                            const std::vector<fast::IndexPair>& pairs) const {
    return {.kind = kind, .pairs = pairs, .edges = edges, .faces = faces};
  }
};

/// The folder of the public simulation steps; empty, with a message, if they are missing.
[[nodiscard]] inline std::filesystem::path simulation_folder() {
  const std::filesystem::path data = public_data_folder();
  return data.empty() ? data : data / "simulation";
}

/// The files of a folder with this ending, in order.
[[nodiscard]] inline std::vector<std::filesystem::path> files_ending(
    const std::filesystem::path& folder, std::string_view ending) {
  std::vector<std::filesystem::path> result;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().filename().string().ends_with(ending)) result.push_back(entry.path());
  }
  std::ranges::sort(result);
  return result;
}

/// Reads boxes/NAME.json and its labels. \param first_of_kind of the ids of first and second
/// \throws std::runtime_error if there are not as many labels as pairs.
[[nodiscard]] inline LabelledPairs read_labelled_pairs(
    const std::filesystem::path& scene, std::string_view kind,
    const std::array<std::size_t, 2>& first_of_kind) {
  const std::filesystem::path boxes =
      files_ending(scene / "boxes", std::string(kind) + ".json").at(0);
  const auto parsed = [](const std::filesystem::path& path) {
    std::ifstream file(path);
    return nlohmann::json::parse(file);
  };
  LabelledPairs result;
  for (auto ids : parsed(boxes).get<std::vector<std::array<std::size_t, 2>>>()) {
    std::ranges::sort(ids);
    result.pairs.push_back({static_cast<std::int32_t>(ids[0] - first_of_kind[0]),
                            static_cast<std::int32_t>(ids[1] - first_of_kind[1])});
  }
  const std::string labels = boxes.stem().string() + "_mma_bool.json";
  result.collides = parsed(scene / "mma_bool" / labels).get<std::vector<bool>>();
  if (result.collides.size() != result.pairs.size()) {
    throw std::runtime_error(boxes.string() + ": not as many labels as pairs");
  }
  return result;
}

/// Loads the step of a scene: its two frames and its labelled pairs.
/// \param folder from simulation_folder
/// \throws std::exception if a file is unreadable.
[[nodiscard]] inline SimulationStep load_simulation_step(const std::filesystem::path& folder,
                                                         std::string_view scene_name) {
  const std::filesystem::path scene = folder / scene_name;
  const auto frames = files_ending(scene / "frames", ".ply");
  verify::mesh::Mesh before = verify::mesh::read_mesh(frames.at(0));
  const verify::mesh::Mesh after = verify::mesh::read_mesh(frames.at(1));
  if (before.faces != after.faces) throw std::runtime_error(scene.string() + ": faces differ");
  const auto vertices = static_cast<std::size_t>(before.vertices.rows());
  const std::size_t first_face = vertices + before.edges.size();
  return {
      .scene = std::string(scene_name),
      .vertices = fast::Motion(before.vertices, after.vertices),
      .edges = std::move(before.edges),
      .faces = std::move(before.faces),
      .vertex_face = read_labelled_pairs(scene, "vf", {0, first_face}),
      .edge_edge = read_labelled_pairs(scene, "ee", {vertices, vertices}),
  };
}

}  // namespace touchstone::tests
