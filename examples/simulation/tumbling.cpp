#include "examples/simulation/tumbling.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "touchstone/certified.hpp"
#include "touchstone/step.hpp"
#include "verify/data/npy.hpp"

namespace touchstone::simulation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t degree = 3;
constexpr int corners = 8;
constexpr double time_step = 0.05;
constexpr double spring = 2.0;
constexpr double inertia = 1.0 / 6.0;  // mass and side 1
/// The part of the time up to an impact that is taken.
constexpr double before_impact = 0.9;

struct Cube {
  Vector3d place, velocity;
  Matrix3d turned;
  Vector3d spin;

  [[nodiscard]] Vector3d arm(int corner) const {
    return turned *
           (Vector3d(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1) - Vector3d::Constant(0.5));
  }
  [[nodiscard]] Cube after(double time) const {
    Cube result = *this;
    result.place += time * velocity;
    const double angle = time * spin.norm();
    if (angle > 0.0) {
      result.turned = Eigen::AngleAxisd(angle, spin.normalized()).toRotationMatrix() * turned;
    }
    return result;
  }
  [[nodiscard]] Vector3d velocity_at(const Vector3d& arm) const {
    return velocity + spin.cross(arm);
  }
  [[nodiscard]] double energy() const {
    return 0.5 * velocity.squaredNorm() + 0.5 * inertia * spin.squaredNorm();
  }
  void push(const Vector3d& impulse, const Vector3d& arm) {
    velocity += impulse;
    spin += arm.cross(impulse) / inertia;
  }
};

using Cubes = std::array<Cube, 2>;

Cubes start() {
  return {Cube{{-1.3, 0.1, 0.05}, {0.8, 0, 0}, Matrix3d::Identity(), {0.7, 1.1, -0.4}},
          Cube{{1.3, -0.15, 0.1}, {-0.9, 0.1, 0}, Matrix3d::Identity(), {-0.5, 0.3, 1.6}}};
}

std::vector<fast::Face> cube_faces() {
  // Both triangles of each side, by the bits of their corners.
  static constexpr std::array<std::array<int, 4>, 6> sides{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  std::vector<fast::Face> faces;
  for (int cube = 0; cube < 2; ++cube) {
    for (const auto& [a, b, c, d] : sides) {
      const int first = corners * cube;
      faces.push_back({first + a, first + b, first + c});
      faces.push_back({first + a, first + c, first + d});
    }
  }
  return faces;
}

/// The control points of all corners over a time.
std::vector<double> curves(const Cubes& cubes, double time) {
  std::vector<double> numbers;
  for (const Cube& cube : cubes) {
    const Cube end = cube.after(time);
    for (int i = 0; i < corners; ++i) {
      const Vector3d from = cube.arm(i), to = end.arm(i);
      const Vector3d third_of_start = time / 3.0 * cube.velocity_at(from);
      const Vector3d third_of_end = time / 3.0 * end.velocity_at(to);
      for (const Vector3d& x :
           {Vector3d(cube.place + from), Vector3d(cube.place + from + third_of_start),
            Vector3d(end.place + to - third_of_end), Vector3d(end.place + to)}) {
        numbers.insert(numbers.end(), x.begin(), x.end());
      }
    }
  }
  return numbers;
}

/// The queries of one kind, in a file.
class CurveRecorder {
 public:
  CurveRecorder(const TumblingOptions& options, Kind kind) : kind_(kind) {
    if (options.folder.empty()) return;
    std::filesystem::create_directories(options.folder);
    const std::string name = kind == Kind::vertex_face ? "tumbling-vf.npy" : "tumbling-ee.npy";
    path_ = options.folder / name;
  }

  void add(std::span<const double> vertices, const std::array<std::int32_t, moving_points>& pair) {
    constexpr std::size_t size = 3 * (degree + 1);
    for (std::size_t k = 0; k <= degree; ++k) {
      for (const std::int32_t vertex : pair) {
        const auto point = vertices.subspan(static_cast<std::size_t>(vertex) * size + 3 * k, 3);
        numbers_.insert(numbers_.end(), point.begin(), point.end());
      }
    }
  }

  /// Writes the file. \param result Receives the counts.
  void close(TumblingResult& result) const {
    const Queries queries({.kind = kind_, .degree = degree}, numbers_);
    std::vector<fast::CertifiedResult> answers(queries.size());
    fast::solve(queries, answers);
    const auto index = static_cast<std::size_t>(kind_);
    result.queries.at(index) = queries.size();
    result.collisions.at(index) = static_cast<std::uint64_t>(
        std::ranges::count(answers, fast::Verdict::yes, &fast::CertifiedResult::verdict));
    if (path_.empty()) return;
    verify::data::NpyWriter file(path_, queries);
    for (std::size_t i = 0; i < queries.size(); ++i) file.write(queries.row(i));
    file.close();
  }

 private:
  Kind kind_;
  std::filesystem::path path_;
  std::vector<double> numbers_;
};

/// The corners of a pair at the present, and the nearest points that (u,v) names.
struct Contact {
  std::array<Vector3d, 2> arms;  ///< of the first and the second cube
  Vector3d normal;               ///< from the first to the second cube
};

Contact contact_of(const Cubes& cubes, const fast::StepCollision& hit,
                   const std::array<std::int32_t, moving_points>& vertices) {
  std::array<Vector3d, moving_points> x;
  for (std::size_t i = 0; i < moving_points; ++i) {
    const Cube& cube = cubes.at(static_cast<std::size_t>(vertices.at(i) / corners));
    x.at(i) = cube.place + cube.arm(vertices.at(i) % corners);
  }
  const bool is_vertex_face = hit.kind == fast::PairKind::vertex_face;
  const Vector3d first = is_vertex_face ? x[0] : Vector3d(x[0] + hit.u * (x[1] - x[0]));
  const Vector3d second = is_vertex_face
                              ? Vector3d(x[1] + hit.u * (x[2] - x[1]) + hit.v * (x[3] - x[1]))
                              : Vector3d(x[2] + hit.v * (x[3] - x[2]));
  Vector3d normal = is_vertex_face ? (x[2] - x[1]).cross(x[3] - x[1]).normalized()
                                   : (x[1] - x[0]).cross(x[3] - x[2]).normalized();
  if (normal.dot(second - first) < 0.0) normal = -normal;
  if (vertices[0] < corners) {
    return {{first - cubes[0].place, second - cubes[1].place}, normal};
  }
  return {{second - cubes[0].place, first - cubes[1].place}, -normal};
}

/// An elastic impulse, unless the contact separates by itself.
bool collide(Cubes& cubes, const Contact& contact) {
  const auto& [arms, normal] = contact;
  const double speed = (cubes[1].velocity_at(arms[1]) - cubes[0].velocity_at(arms[0])).dot(normal);
  if (speed >= 0.0) return false;
  const double resistance =
      2.0 + (arms[0].cross(normal).squaredNorm() + arms[1].cross(normal).squaredNorm()) / inertia;
  const Vector3d impulse = -2.0 * speed / resistance * normal;
  cubes[0].push(-impulse, arms[0]);
  cubes[1].push(impulse, arms[1]);
  return true;
}

}  // namespace

TumblingResult tumble(const TumblingOptions& options) {
  TumblingResult result;
  const fast::Mesh elements{.faces = cube_faces()};
  std::vector<std::int32_t> groups(2 * corners, 0);
  std::fill(groups.begin() + corners, groups.end(), 1);
  // In one thread, so that the recorded queries are in the same order every time.
  const fast::StepOptions step_options{
      .max_threads = 1, .groups = {.of_vertices = groups, .apart = {{0, 0}, {1, 1}}}};
  CurveRecorder vertex_face(options, Kind::vertex_face), edge_edge(options, Kind::edge_edge);
  Cubes cubes = start();
  for (int i = 0; i < options.steps; ++i) {
    for (Cube& cube : cubes) cube.velocity -= spring * time_step * cube.place;
    const std::vector<double> numbers = curves(cubes, time_step);
    const fast::CurvedStep step({degree, false, numbers}, elements, step_options);
    step.boxes().candidates([&](const fast::StepCandidates& some) {
      CurveRecorder& recorder = some.kind == fast::PairKind::vertex_face ? vertex_face : edge_edge;
      for (const fast::IndexPair& pair : some.pairs) {
        recorder.add(numbers, step.boxes().vertices_of(some.kind, pair));
      }
    });
    const auto impact = step.earliest();
    const double part = impact ? before_impact * impact->toi_lower : 1.0;
    for (Cube& cube : cubes) cube = cube.after(part * time_step);
    if (!impact) continue;
    const fast::StepCollision& hit = impact->pairs.front();
    const double before = cubes[0].energy() + cubes[1].energy();
    const auto vertices = step.boxes().vertices_of(hit.kind, hit.pair);
    if (collide(cubes, contact_of(cubes, hit, vertices))) ++result.impacts;
    const double after = cubes[0].energy() + cubes[1].energy();
    result.worst_change = std::max(result.worst_change, std::abs(after - before) / before);
  }
  vertex_face.close(result);
  edge_edge.close(result);
  return result;
}

}  // namespace touchstone::simulation
