#include "examples/simulation/recorder.hpp"

#include <tbb/parallel_for.h>

#include <cstddef>

#include "touchstone/oracle.hpp"

namespace touchstone::simulation {
namespace {

namespace fs = std::filesystem;

/// The number of queries that are decided together, on all cores.
constexpr std::size_t block_size = 8192;

/// The folder, which it makes with one for labels.
fs::path made(const fs::path& folder) {
  fs::create_directories(folder / "mma_bool");
  return folder;
}

}  // namespace

Recorder::File::File(Kind kind_of, const fs::path& folder, const std::string& name)
    : kind(kind_of),
      npy(made(folder / to_string(kind)) / (name + ".npy")),
      labels(folder / to_string(kind) / "mma_bool" / (name + "_mma_bool.json")) {
  labels.write("[");
}

void Recorder::File::write_pending() {
  // Not bool, because several threads cannot write elements of std::vector<bool> concurrently.
  std::vector<char> collides(pending.size());
  tbb::parallel_for(std::size_t{0}, pending.size(), [&](std::size_t i) {
    collides[i] = exact::decide(kind, pending[i]).collides() ? 1 : 0;
  });
  for (std::size_t i = 0; i < pending.size(); ++i) {
    npy.write(pending[i]);
    labels.write(queries++ == 0 ? "" : ",");
    labels.write(collides[i] != 0 ? "true" : "false");
    if (collides[i] != 0) ++collisions;
  }
  pending.clear();
}

Recorder::Recorder(const fs::path& folder, const std::string& name)
    : files_{{{Kind::vertex_face, folder, name}, {Kind::edge_edge, folder, name}}} {}

void Recorder::add(Kind kind, const Query& query) {
  File& file = files_[kind == Kind::edge_edge ? 1 : 0];
  file.pending.push_back(query);
  if (file.pending.size() == block_size) file.write_pending();
}

void Recorder::close() {
  for (File& file : files_) {
    file.write_pending();
    file.npy.close();
    file.labels.write("]\n");
    file.labels.close();
  }
}

}  // namespace touchstone::simulation
