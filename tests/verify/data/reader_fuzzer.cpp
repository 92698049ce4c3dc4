/// \file
/// libFuzzer on all readers of foreign bytes: no file makes a reader crash, hang, access other
/// memory, or throw anything but its documented errors. Accepted data must be valid: finite
/// coordinates, indices in range, and text that reads back as the same numbers.
///
/// The environment variable TOUCHSTONE_READER selects the reader by one of the names below. All
/// readers start from the files of corpus/, also from those of other formats. The bytes are in a
/// file that exists only in memory.

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "touchstone/number.hpp"
#include "touchstone/query.hpp"
#include "verify/data/csv_dataset.hpp"
#include "verify/data/dataset.hpp"
#include "verify/data/ground_truth_files.hpp"
#include "verify/data/npy_dataset.hpp"
#include "verify/io/coordinate_text.hpp"
#include "verify/io/dataset_error.hpp"
#include "verify/mesh/mesh_file.hpp"
#include "verify/mesh/obj.hpp"
#include "verify/mesh/ply.hpp"
#include "verify/solvers/answers.hpp"

namespace {

namespace fs = std::filesystem;
using touchstone::ContactKind;
using touchstone::Query;
using touchstone::verify::io::DatasetError;

void require(bool holds) {
  if (!holds) std::abort();
}

/// A file in memory with the given bytes.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(memfd_create("fuzzed", 0)) { require(descriptor_ >= 0); }

  [[nodiscard]] fs::path holding(const std::uint8_t* data, std::size_t size) const {
    require(ftruncate(descriptor_, 0) == 0);
    require(pwrite(descriptor_, data, size, 0) == static_cast<ssize_t>(size));
    return "/proc/self/fd/" + std::to_string(descriptor_);
  }

 private:
  int descriptor_;
};

/// Checks that a query is finite and reads back from its text.
void check_query(const touchstone::verify::base::AnyQuery& query) {
  for (const double x : query.numbers()) {
    require(std::isfinite(x));
    std::string text;
    touchstone::verify::io::append_coordinate(text, x);
    const std::size_t comma = text.find(',');
    const auto parsed =
        touchstone::verify::io::parse_coordinate(text.substr(0, comma), text.substr(comma + 1));
    require(parsed.exact && parsed.value == x);
  }
}

/// Reads a dataset to its end. With keep_going there is no error on the way.
template <class Dataset>
void read_dataset(const fs::path& path, bool keep_going) {
  touchstone::verify::data::DatasetOptions options;
  options.kind = ContactKind::edge_edge;
  options.round = keep_going;
  options.keep_going = keep_going;
  std::optional<Dataset> source;
  try {
    source.emplace(path, options);
  } catch (const DatasetError&) {
    return;
  }
  std::uint64_t least = 0;
  const auto read_all = [&] {
    while (const auto query = source->next()) {
      require(query->index >= least);
      least = query->index + 1;
      check_query(query->query);
    }
  };
  if (keep_going) {
    read_all();
    return;
  }
  try {
    read_all();
  } catch (const DatasetError& error) {
    require(!std::string_view(error.what()).empty());
  }
}

void read_csv(const fs::path& path) {
  read_dataset<touchstone::verify::data::CsvDataset>(path, false);
  read_dataset<touchstone::verify::data::CsvDataset>(path, true);
}

void read_npy(const fs::path& path) {
  read_dataset<touchstone::verify::data::NpyDataset>(path, false);
  read_dataset<touchstone::verify::data::NpyDataset>(path, true);
}

void read_answers(const fs::path& path) {
  const auto answers = touchstone::verify::solvers::load_answers(path);
  for (const auto& group : answers.groups()) {
    require(group.unasked == group.answers);
    for (std::uint64_t index = 0; index < 10; ++index) {
      const auto recorded = answers.answer_to(group.file, group.kind, index);
      if (!recorded) continue;
      const touchstone::fast::Answer& answer = recorded->answer;
      require(!std::isinf(answer.toi_lower) && !std::isinf(answer.toi_upper));
      require(!(answer.tolerance < 0.0));
      require(answer.verdict == touchstone::fast::Verdict::yes || std::isnan(answer.toi_lower));
    }
  }
}

void check_mesh(const touchstone::verify::mesh::Mesh& mesh) {
  const auto is_vertex = [&](int i) { return i >= 0 && i < mesh.vertices.rows(); };
  require(mesh.vertices.rows() > 0 && mesh.vertices.allFinite());
  for (const auto& face : mesh.faces) require(std::ranges::all_of(face, is_vertex));
  for (const auto& edge : mesh.edges) {
    require(std::ranges::all_of(edge, is_vertex) && edge[0] != edge[1]);
  }
}

void read_obj_file(const fs::path& path) { check_mesh(touchstone::verify::mesh::read_obj(path)); }

void read_ply_file(const fs::path& path) { check_mesh(touchstone::verify::mesh::read_ply(path)); }

/// Reads the labels or times of some queries.
template <class Reader>
void read_truth(const fs::path& path) {
  Reader truth(path);
  std::uint64_t index = 0;
  for (; index < 100; index += 1 + index % 3) {
    try {
      static_cast<void>(truth.at(index));
    } catch (const DatasetError&) {  // One may be faulty and the next one valid.
    }
  }
  truth.end(index);
}

void read_separation_file(const fs::path& path) {
  require(touchstone::is_valid(touchstone::verify::data::read_separation(path)));
}

struct Reader {
  std::string_view name;
  void (*read)(const fs::path& path);
};

constexpr std::array<Reader, 8> readers{{{"csv", read_csv},
                                         {"npy", read_npy},
                                         {"answers", read_answers},
                                         {"obj", read_obj_file},
                                         {"ply", read_ply_file},
                                         {"labels", read_truth<touchstone::verify::data::Labels>},
                                         {"tois", read_truth<touchstone::verify::data::ToiReader>},
                                         {"separation", read_separation_file}}};

const Reader& chosen_reader() {
  const char* const name = std::getenv("TOUCHSTONE_READER");
  const auto* const found =
      std::ranges::find(readers, std::string_view(name == nullptr ? "" : name), &Reader::name);
  require(found != readers.end());
  return *found;
}

}  // namespace

// The name is libFuzzer's.
// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Reader& reader = chosen_reader();
  static MemoryFile file;
  try {
    reader.read(file.holding(data, size));
  } catch (const DatasetError& error) {
    require(!std::string_view(error.what()).empty());
  }
  return 0;
}
