#include "verify/mesh/frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "verify/data/npy.hpp"
#include "verify/io/dataset_error.hpp"
#include "verify/io/output_file.hpp"

namespace touchstone::verify::mesh {
namespace {

namespace fs = std::filesystem;

// ---- Files ----

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Takes a number, such as 12, 0.25 or 1e-3, which begins with a digit.
double take_number(std::string_view& text) {
  double number = std::numeric_limits<double>::infinity();  // where it is out of range
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
  return number;
}

/// Names in the order of the numbers in them: "2.ply" before "10.ply", "0.25.ply" before "0.5.ply".
bool is_before(std::string_view a, std::string_view b) {
  while (!a.empty() && !b.empty()) {
    if (is_digit(a.front()) && is_digit(b.front())) {
      const double x = take_number(a), y = take_number(b);
      if (x != y) return x < y;
    } else {
      if (a.front() != b.front()) return a.front() < b.front();
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
  }
  return a.size() < b.size();
}

/// Errors are left to the reader of the file.
bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

std::vector<fs::path> mesh_files_in(const fs::path& folder, std::vector<fs::path>* left_out) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file() && is_mesh_file(entry.path())) {
      files.push_back(entry.path());
    } else if (left_out != nullptr && !io::is_partial(entry.path())) {
      left_out->push_back(entry.path());
    }
  }
  if (files.empty()) {
    throw io::DatasetError(folder, {},
                           fmt::format("no .ply or .obj file in this folder; {}", way_of_others));
  }
  std::ranges::sort(files, [](const fs::path& a, const fs::path& b) {
    const std::string x = a.filename().string(), y = b.filename().string();
    return is_before(x, y) || (!is_before(y, x) && x < y);
  });
  return files;
}

class FileFrames : public Frames {
 public:
  explicit FileFrames(std::vector<fs::path> files)
      : files_(std::move(files)), mesh_(read_mesh(files_.front())) {
    require_elements(mesh_, files_.front());
  }

  [[nodiscard]] const Mesh& mesh() const override { return mesh_; }
  [[nodiscard]] std::size_t count() const override { return files_.size(); }
  [[nodiscard]] std::string name(std::size_t i) const override {
    return files_.at(i).filename().string();
  }

  [[nodiscard]] Vertices next() override {
    const fs::path& file = files_.at(next_++);
    if (next_ == 1) return mesh_.vertices;
    Mesh mesh = read_mesh(file);
    if (!same_elements(mesh, mesh_)) {
      throw io::DatasetError(file, {}, "is not the same mesh as " + files_.front().string());
    }
    return std::move(mesh.vertices);
  }

 private:
  std::vector<fs::path> files_;
  Mesh mesh_;
  std::size_t next_ = 0;
};

// ---- Archives ----

class ArchivedFrames : public Frames {
 public:
  explicit ArchivedFrames(const fs::path& path) : archive_(path) {
    if (!archive_.has("V")) {
      throw io::DatasetError(path, {}, "no array V of positions, of shape (T, n, 3)");
    }
    vertices_.emplace(archive_, "V");
    constexpr std::array<std::uint64_t, 1> axes{3};
    vertices_->require_shape(3, axes, "(T, n, 3)");
    count_ = vertices_->shape()[0];
    vertex_count_ = vertices_->shape()[1];
    if (count_ == 0 || vertex_count_ == 0) vertices_->fail("no frame, or no vertex");
    if (vertex_count_ > std::numeric_limits<std::int32_t>::max())
      vertices_->fail("more than 2^31-1 vertices");
    const std::vector<fast::Edge> edges = elements<2>("E", "(k, 2)");
    mesh_ = make_mesh({}, elements<3>("F", "(m, 3)"), edges, elements<1>("P", "(p,) or (p, 1)"));
    mesh_.tetrahedra = elements<4>("T", "(q, 4)");
    mesh_.vertices = read_frame(0);
    std::vector<std::string> others = archive_.names();
    std::erase_if(others, [](const std::string& name) {
      return name == "V" || name == "F" || name == "E" || name == "P" || name == "T";
    });
    std::ranges::for_each(others, [](std::string& name) { name.insert(0, "array "); });
    mesh_.note = note_of(0, others);
    require_elements(mesh_, path);
  }

  [[nodiscard]] const Mesh& mesh() const override { return mesh_; }
  [[nodiscard]] std::size_t count() const override { return count_; }
  [[nodiscard]] std::string name(std::size_t i) const override { return std::to_string(i); }
  [[nodiscard]] Vertices next() override {
    return next_++ == 0 ? mesh_.vertices : read_frame(next_ - 1);
  }

 private:
  Vertices read_frame(std::size_t number) {
    // Grown as data follows, not as the header says.
    std::vector<double> numbers;
    constexpr std::size_t part = std::size_t{1} << 16U;
    for (std::size_t left = 3 * vertex_count_; left > 0;) {
      const std::size_t count = std::min(part, left);
      numbers.resize(numbers.size() + count);
      vertices_->take<double, float, double>(std::span(numbers).last(count), {"<f4", "<f8"});
      left -= count;
    }
    if (!std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); })) {
      vertices_->fail(fmt::format("frame {}: a coordinate must be finite", number));
    }
    return Eigen::Map<const Vertices>(numbers.data(), static_cast<Eigen::Index>(vertex_count_), 3);
  }

  template <std::size_t corners>
  std::vector<std::array<std::int32_t, corners>> elements(const std::string& name,
                                                          std::string_view expected) {
    std::vector<std::array<std::int32_t, corners>> result;
    if (!archive_.has(name)) return result;
    data::NpyArray array(archive_, name);
    constexpr std::array<std::uint64_t, 1> last{corners};
    const bool is_list = corners == 1 && array.shape().size() == 1;
    array.require_shape(is_list ? 1 : 2, std::span(last).first(is_list ? 0 : 1), expected);
    for (std::uint64_t i = 0; i < array.shape()[0]; ++i) {
      std::array<std::int64_t, corners> element{};
      array.take<std::int64_t, std::int8_t, std::uint8_t, std::int16_t, std::uint16_t, std::int32_t,
                 std::uint32_t, std::int64_t, std::uint64_t>(
          element, {"|i1", "|u1", "<i2", "<u2", "<i4", "<u4", "<i8", "<u8"});
      for (std::size_t k = 0; k < corners; ++k) {
        if (element[k] < 0 || element[k] >= static_cast<std::int64_t>(vertex_count_)) {
          array.fail(fmt::format("row {}: vertex {}, but there are {}, counted from 0", i,
                                 element[k], vertex_count_));
        }
      }
      result.emplace_back();
      std::ranges::transform(element, result.back().begin(),
                             [](std::int64_t x) { return static_cast<std::int32_t>(x); });
    }
    return result;
  }

  data::Npz archive_;
  std::optional<data::NpyArray> vertices_;
  std::size_t count_ = 0;
  std::size_t vertex_count_ = 0;
  std::size_t next_ = 0;
  Mesh mesh_;
};

}  // namespace

std::vector<fs::path> frame_files(std::span<const fs::path> paths,
                                  std::vector<fs::path>* left_out) {
  if (paths.size() == 1 && is_folder(paths.front())) return mesh_files_in(paths.front(), left_out);
  for (const fs::path& path : paths) {
    if (paths.size() > 1 && (path.extension() == ".npz" || is_folder(path))) {
      throw io::DatasetError(path, {}, "pass either one archive, one folder, or a list of files");
    }
  }
  return {paths.begin(), paths.end()};
}

std::unique_ptr<Frames> open_frames(std::vector<fs::path> files) {
  if (files.front().extension() == ".npz") return std::make_unique<ArchivedFrames>(files.front());
  return std::make_unique<FileFrames>(std::move(files));
}

}  // namespace touchstone::verify::mesh
