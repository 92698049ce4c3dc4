#include "verify/generate/workload.hpp"

#include <array>
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

/// One of the two patches. Its own axes are those of the lower one; the upper one is turned by a
/// Pythagorean angle and stands on its head.
class Patch {
 public:
  /// \param cells along a side, whose length is 1
  Patch(int cells, bool is_upper, Random& random)
      : cell_(1.0 / cells), is_upper_(is_upper), random_(&random) {}

  [[nodiscard]] Eigen::Vector3d start(int i, int j) {
    const double x = i * cell_ - 0.5, y = j * cell_ - 0.5;
    const double height = -0.5 * gap * cell_ - bowl * (x * x + y * y) * 2.0;
    return placed({x + noise(jitter), y + noise(jitter), height + noise(roughness)});
  }

  [[nodiscard]] Eigen::Vector3d way() {
    return placed({slide * cell_ + noise(perturbation), noise(perturbation),
                   approach_way * cell_ + noise(perturbation)});
  }

 private:
  [[nodiscard]] double noise(double amplitude) {
    return amplitude * cell_ * (2.0 * random_->unit() - 1.0);
  }

  [[nodiscard]] Eigen::Vector3d placed(const Eigen::Vector3d& point) const {
    if (!is_upper_) return point;
    return {0.8 * point.x() - 0.6 * point.y(), -0.6 * point.x() - 0.8 * point.y(), -point.z()};
  }

  double cell_;
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

}  // namespace

mesh::MovingMesh moving_patches(const PatchOptions& options) {
  if (options.cells < 1) throw std::invalid_argument("a patch must have a cell");
  const int row = options.cells + 1;
  Random random(mix(options.seed ^ hash("moving patches")));
  PointRows start(2 * row * row, 3), end(2 * row * row, 3);
  std::vector<fast::Face> faces;
  int vertex = 0;
  for (const bool is_upper : {false, true}) {
    add_faces(options.cells, vertex, random, faces);
    Patch patch(options.cells, is_upper, random);
    for (int i = 0; i < row; ++i) {
      io::throw_if_interrupted();
      for (int j = 0; j < row; ++j, ++vertex) {
        start.row(vertex) = patch.start(i, j);
        end.row(vertex) = start.row(vertex) + patch.way().transpose();
      }
    }
  }
  return {.name = "patches",
          .vertices = fast::Motion(start, end),
          .faces = faces,
          .edges = fast::edges_of(faces)};
}

}  // namespace touchstone::verify::generate
