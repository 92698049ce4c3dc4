#include "examples/simulation/recorder.hpp"

#include "touchstone/oracle.hpp"

namespace touchstone::simulation {
namespace {

namespace fs = std::filesystem;

/// The folder, which it makes with one for labels.
fs::path made(const fs::path& folder) {
  fs::create_directories(folder / "mma_bool");
  return folder;
}

}  // namespace

Recorder::File::File(const fs::path& folder, const std::string& name)
    : npy(made(folder) / (name + ".npy")), labels(folder / "mma_bool" / (name + "_mma_bool.json")) {
  labels.write("[");
}

Recorder::Recorder(const fs::path& folder, const std::string& name)
    : files_{{{folder / to_string(ContactKind::vertex_face), name},
              {folder / to_string(ContactKind::edge_edge), name}}} {}

void Recorder::add(ContactKind kind, const Query& query) {
  File& file = files_[kind == ContactKind::edge_edge ? 1 : 0];
  const bool collides = exact::decide(kind, query).collides();
  file.npy.write(query);
  file.labels.write(file.queries++ == 0 ? "" : ",");
  file.labels.write(collides ? "true" : "false");
  if (collides) ++file.collisions;
}

void Recorder::close() {
  for (File& file : files_) {
    file.npy.close();
    file.labels.write("]\n");
    file.labels.close();
  }
}

}  // namespace touchstone::simulation
