#include "examples/simulation/recorder.hpp"

#include <tbb/parallel_for.h>

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "touchstone/oracle.hpp"
#include "verify/data/csv_dataset.hpp"
#include "verify/data/npy.hpp"
#include "verify/io/output_file.hpp"

namespace touchstone::simulation {
namespace {

namespace fs = std::filesystem;

/// The number of queries that are decided together, on all cores.
constexpr std::size_t block_size = 8192;

std::size_t index_of(Kind kind) { return kind == Kind::vertex_face ? 0 : 1; }

}  // namespace

/// The queries of one kind.
class Recorder::File {
 public:
  File(Kind kind, const RecorderOptions& options) : kind_(kind) {
    const fs::path folder = options.folder / to_string(kind);
    fs::create_directories(folder / "mma_bool");
    if (options.as_npy) {
      npy_.emplace(folder / (options.name + ".npy"));
      labels_.emplace(folder / "mma_bool" / (options.name + "_mma_bool.json"));
      labels_->write("[");
    } else {
      csv_.emplace(folder / (options.name + ".csv"));
    }
    pending_.reserve(block_size);
  }

  void add(const Query& query) {
    pending_.push_back(query);
    ++queries_;
    if (pending_.size() == block_size) write_pending();
  }

  void close() {
    write_pending();
    if (csv_) csv_->close();
    if (npy_) npy_->close();
    if (!labels_) return;
    labels_->write("]\n");
    labels_->close();
  }

  [[nodiscard]] std::uint64_t queries() const { return queries_; }
  [[nodiscard]] std::uint64_t collisions() const { return collisions_; }

 private:
  void write_pending() {
    // Not bool, because several threads cannot write elements of std::vector<bool> concurrently.
    std::vector<char> collides(pending_.size());
    tbb::parallel_for(std::size_t{0}, pending_.size(), [&](std::size_t i) {
      collides[i] = exact::decide(kind_, pending_[i]).collides() ? 1 : 0;
    });
    for (std::size_t i = 0; i < pending_.size(); ++i) {
      const bool is_collision = collides[i] != 0;
      if (is_collision) ++collisions_;
      if (csv_) {
        csv_->write({kind_, pending_[i]}, is_collision);
      } else {
        npy_->write(pending_[i]);
        labels_->write(is_first_ ? "" : ",");
        labels_->write(is_collision ? "true" : "false");
        is_first_ = false;
      }
    }
    pending_.clear();
  }

  Kind kind_;
  std::vector<Query> pending_;
  std::optional<verify::data::CsvWriter> csv_;
  std::optional<verify::data::NpyWriter> npy_;
  std::optional<verify::io::OutputFile> labels_;
  bool is_first_ = true;
  std::uint64_t queries_ = 0, collisions_ = 0;
};

Recorder::Recorder(RecorderOptions options) : options_(std::move(options)) {
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    files_.at(index_of(kind)) = std::make_unique<File>(kind, options_);
  }
}

Recorder::~Recorder() = default;

void Recorder::add(Kind kind, const Query& query) { files_.at(index_of(kind))->add(query); }

void Recorder::close() {
  for (const auto& file : files_) file->close();
}

std::uint64_t Recorder::queries(Kind kind) const { return files_.at(index_of(kind))->queries(); }
std::uint64_t Recorder::collisions(Kind kind) const {
  return files_.at(index_of(kind))->collisions();
}

}  // namespace touchstone::simulation
