#include "verify/generate/workload.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "touchstone/broad_phase.hpp"
#include "verify/generate/random_stream.hpp"
#include "verify/io/terminal.hpp"

namespace touchstone::verify::generate {
namespace {

using PointRows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

// Lengths in units of a cell's side.
constexpr double jitter = 0.2;        // of a vertex in the patch, on each axis
constexpr double roughness = 0.1;     // of a vertex off the patch
constexpr double gap = 0.6;           // between the bottoms of the bowls at the start
constexpr double approach_way = 2.0;  // way of each patch towards the other
constexpr double slide = 1.6;         // way of each patch sideways
constexpr double perturbation = 0.2;  // of each vertex' way, on each axis

/// Height of the bowl's rim above its bottom, in units of the patch's side.
constexpr double bowl = 0.02;

/// The beginnings and widths of the cells of a side, as multiples of the side.
class Side {
 public:
  explicit Side(const PatchOptions& options) : places_{-0.5} {
    const auto cells = static_cast<double>(options.cells);
    if (options.grading == 1.0) {
      for (int i = 1; i <= options.cells; ++i) places_.push_back(i * (1.0 / cells) - 0.5);
      widths_.assign(places_.size(), 1.0 / cells);
      return;
    }
    // Widths grow by the same factor from cell to cell.
    const double factor = std::pow(options.grading, 1.0 / std::max(cells - 1.0, 1.0));
    double width = (factor - 1.0) / (std::pow(factor, cells) - 1.0);
    for (int i = 0; i < options.cells; ++i, width *= factor) {
      places_.push_back(places_.back() + width);
      widths_.push_back(width);
    }
    widths_.push_back(widths_.back());
  }

  /// From −½ to ½.
  [[nodiscard]] double place(int i) const { return places_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] double width(int i) const { return widths_[static_cast<std::size_t>(i)]; }

 private:
  std::vector<double> places_, widths_;
};

/// One of the two patches. Its own axes are those of the lower one; the upper one is turned by a
/// Pythagorean angle and stands on its head.
class Patch {
 public:
  Patch(const Side& side, bool is_upper, Random& random)
      : side_(&side), is_upper_(is_upper), random_(&random) {}

  [[nodiscard]] Eigen::Vector3d start(int i, int j) {
    const double x = side_->place(i), y = side_->place(j), cell = width(i, j);
    const double height = -0.5 * gap * cell - bowl * (x * x + y * y) * 2.0;
    return placed(
        {x + noise(jitter, cell), y + noise(jitter, cell), height + noise(roughness, cell)});
  }

  [[nodiscard]] Eigen::Vector3d way(int i, int j) {
    const double cell = width(i, j);
    return placed({slide * cell + noise(perturbation, cell), noise(perturbation, cell),
                   approach_way * cell + noise(perturbation, cell)});
  }

 private:
  [[nodiscard]] double width(int i, int j) const {
    return std::min(side_->width(i), side_->width(j));
  }

  [[nodiscard]] double noise(double amplitude, double cell) {
    return amplitude * cell * (2.0 * random_->unit() - 1.0);
  }

  [[nodiscard]] Eigen::Vector3d placed(const Eigen::Vector3d& point) const {
    if (!is_upper_) return point;
    return {0.8 * point.x() - 0.6 * point.y(), -0.6 * point.x() - 0.8 * point.y(), -point.z()};
  }

  const Side* side_;
  bool is_upper_;
  Random* random_;
};

/// Two triangles of a cell, cut along one diagonal or the other.
void add_cell(int corner, int row, bool is_forward, std::vector<fast::Face>& faces) {
  const std::array<std::int32_t, 4> around{corner, corner + 1, corner + row + 1, corner + row};
  const std::size_t first = is_forward ? 0 : 1;
  const auto vertex = [&](std::size_t k) { return around[(first + k) % 4]; };
  faces.push_back({vertex(0), vertex(1), vertex(2)});
  faces.push_back({vertex(0), vertex(2), vertex(3)});
}

void add_faces(int cells, int first_vertex, Random& random, std::vector<fast::Face>& faces) {
  const int row = cells + 1;
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      add_cell(first_vertex + i * row + j, row, random.coin(), faces);
    }
  }
}

/// A coordinate of an end contact.
double coordinate(const EndContactOptions& options, Random& random) {
  if (!options.two_decimals) return options.scale * (2.0 * random.unit() - 1.0);
  // A quotient of whole numbers is rounded like the decimal.
  const double parts = std::round(100.0 / std::min(options.scale, 1.0));
  const auto most = static_cast<std::int64_t>(std::round(options.scale * parts));
  return static_cast<double>(random.between(-most, most)) / parts;
}

}  // namespace

mesh::MovingMesh moving_patches(const PatchOptions& options) {
  if (options.cells < 1) throw std::invalid_argument("a patch must have a cell");
  if (!(options.grading >= 1.0 && options.grading <= 1e9)) {
    throw std::invalid_argument("grading must be from 1 to 1e9");
  }
  const Side side(options);
  const int row = options.cells + 1;
  Random random(mix(options.seed ^ hash("moving patches")));
  PointRows start(2 * row * row, 3), end(2 * row * row, 3);
  std::vector<fast::Face> faces;
  int vertex = 0;
  for (const bool is_upper : {false, true}) {
    add_faces(options.cells, vertex, random, faces);
    Patch patch(side, is_upper, random);
    for (int i = 0; i < row; ++i) {
      io::throw_if_interrupted();
      for (int j = 0; j < row; ++j, ++vertex) {
        start.row(vertex) = patch.start(i, j);
        end.row(vertex) = start.row(vertex) + patch.way(i, j).transpose();
      }
    }
  }
  return {.name = "patches",
          .vertices = fast::MovingVertices(start, end),
          .faces = faces,
          .edges = fast::edges_of(faces)};
}

data::QueryGroup end_contacts(Kind kind, const EndContactOptions& options) {
  Random random(mix(options.seed ^ hash("end contacts")));
  const bool has_face = kind == Kind::vertex_face;
  std::vector<Query> queries(options.count);
  for (Query& query : queries) {
    for (double& x : query.coordinates) x = coordinate(options, random);
    const std::int64_t first = has_face ? 0 : random.between(0, 1);
    const std::int64_t second = has_face ? random.between(1, 3) : random.between(2, 3);
    const auto at_end = [&](std::int64_t point) {
      return query.coordinates.begin() + 3 * (static_cast<std::int64_t>(moving_points) + point);
    };
    std::copy_n(at_end(second), 3, at_end(first));
  }
  return {
      options.two_decimals ? "contact at t=1, two decimals" : "contact at t=1, full significands",
      kind, queries};
}

}  // namespace touchstone::verify::generate
