#include "examples/simulation/simulated_scene.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <utility>

namespace touchstone::simulation {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

/// The cell's corner (i, j, k) is corner i + 2j + 4k. Each tetrahedron is a path from corner 0 to
/// corner 7 along the axes in one of their six orders, so that neighbouring cells cut their common
/// square along the same diagonal.
constexpr std::array<std::array<std::size_t, 4>, 6> cell_tetrahedra{
    {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};

/// The faces of one tetrahedron alone, outside to the front.
std::vector<fast::Face> surface_of(const std::vector<Tetrahedron>& tetrahedra) {
  std::map<fast::Face, std::pair<fast::Face, int>> seen;
  for (const auto& [a, b, c, d] : tetrahedra) {
    for (const fast::Face& face : {fast::Face{a, c, b}, {a, b, d}, {b, c, d}, {a, d, c}}) {
      fast::Face key = face;
      std::ranges::sort(key);
      const auto entry = seen.try_emplace(key, face, 0).first;
      ++entry->second.second;
    }
  }
  std::vector<fast::Face> result;
  for (const auto& [key, face] : seen) {
    if (face.second == 1) result.push_back(face.first);
  }
  return result;
}

Vertices rows(const std::vector<Vector3d>& points) {
  Vertices result(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    result.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
  }
  return result;
}

}  // namespace

Body block(const std::array<int, 3>& cells, const Map& map, bool is_ring) {
  const int layers = is_ring ? cells[0] : cells[0] + 1;
  const auto number = [&](int i, int j, int k) {
    return ((i % layers) * (cells[1] + 1) + j) * (cells[2] + 1) + k;
  };
  Body body;
  std::vector<Vector3d> points;
  const auto coordinate = [](int i, int of) { return 2.0 * i / of - 1.0; };
  for (int i = 0; i < layers; ++i) {
    for (int j = 0; j <= cells[1]; ++j) {
      for (int k = 0; k <= cells[2]; ++k) {
        points.push_back(
            map({coordinate(i, cells[0]), coordinate(j, cells[1]), coordinate(k, cells[2])}));
      }
    }
  }
  body.vertices = rows(points);
  for (int i = 0; i < cells[0]; ++i) {
    for (int j = 0; j < cells[1]; ++j) {
      for (int k = 0; k < cells[2]; ++k) {
        for (const auto& corners : cell_tetrahedra) {
          Tetrahedron& added = body.tetrahedra.emplace_back();
          std::ranges::transform(corners, added.begin(), [&](std::size_t corner) {
            const int c = static_cast<int>(corner);
            return number(i + (c & 1), j + ((c >> 1) & 1), k + ((c >> 2) & 1));
          });
        }
      }
    }
  }
  body.faces = surface_of(body.tetrahedra);
  return body;
}

Body cone(const Vector3d& tip, double radius, double base_height, int points) {
  std::vector<Vector3d> vertices{tip};
  Body body;
  for (std::int32_t i = 0; i < points; ++i) {
    const double angle = 2.0 * pi * i / points;
    vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), base_height);
    body.faces.push_back({0, 1 + i, 1 + (i + 1) % points});
  }
  body.vertices = rows(vertices);
  return body;
}

namespace {

/// The cube [−1,1]³ with its layers rounded most of the way to spheres, of radius about 1. In a
/// whole ball the elements along the cube's edges would be flat.
Vector3d rounded_cube(const Vector3d& point) {
  const Vector3d s = point.cwiseAbs2();
  const auto stretch = [](double a, double b) {
    return std::sqrt(1.0 - a / 2.0 - b / 2.0 + a * b / 3.0);
  };
  const Vector3d ball{point.x() * stretch(s.y(), s.z()), point.y() * stretch(s.z(), s.x()),
                      point.z() * stretch(s.x(), s.y())};
  return 0.65 * ball + 0.3 * point;
}

Body moved(Body body, const Vector3d& translation) {
  body.vertices.rowwise() += translation.transpose();
  return body;
}

/// A ball with bumps and dimples, which fade towards the middle.
Body ball(double radius, const std::function<double(const Vector3d&)>& height) {
  // An odd number of cells has no vertex in the middle.
  return block({7, 7, 7}, [&](const Vector3d& x) -> Vector3d {
    const Vector3d place = rounded_cube(x);
    const double norm = place.norm(), depth = x.lpNorm<Eigen::Infinity>();
    const double bump = depth * depth * height(place / norm);
    return radius * (1.0 + bump) * place;
  });
}

Body torus(double radius, double thickness) {
  return block(
      {24, 3, 3},
      [&](const Vector3d& x) -> Vector3d {
        const Vector3d round = rounded_cube({0.0, x.y(), x.z()});
        const double angle = pi * (x.x() + 1.0), distance = radius + thickness * round.y();
        return {distance * std::cos(angle), distance * std::sin(angle), thickness * round.z()};
      },
      true);
}

Body rotated(Body body, double angle, const Vector3d& axis) {
  body.vertices =
      (body.vertices * Eigen::AngleAxisd(angle, axis).toRotationMatrix().transpose()).eval();
  return body;
}

/// A square obstacle at height 0.
Body floor_of(double size, int cells) {
  Body body;
  std::vector<Vector3d> points;
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j <= cells; ++j) {
      points.emplace_back((2.0 * i / cells - 1.0) * size / 2.0,
                          (2.0 * j / cells - 1.0) * size / 2.0, 0.0);
      if (i == cells || j == cells) continue;
      const std::int32_t a = i * (cells + 1) + j, b = a + cells + 1, c = b + 1, d = a + 1;
      // Diagonals in turns.
      if ((i + j) % 2 == 0) {
        body.faces.insert(body.faces.end(), {{a, b, c}, {a, c, d}});
      } else {
        body.faces.insert(body.faces.end(), {{a, b, d}, {b, c, d}});
      }
    }
  }
  body.vertices = rows(points);
  return body;
}

Scene two_heads() {
  Scene scene;
  const auto face = [](const Vector3d& x) {
    const auto bump = [&](const Vector3d& at, double height, double width) {
      return height * std::exp(-(x - at.normalized()).squaredNorm() / (width * width));
    };
    return bump({1, 0, 0}, 0.35, 0.25) + bump({0.2, 1, 0.2}, 0.2, 0.3) +
           bump({0.2, -1, 0.2}, 0.2, 0.3) - bump({1, 0.4, 0.4}, 0.1, 0.2) -
           bump({1, -0.4, 0.4}, 0.1, 0.2);
  };
  Body left = moved(ball(0.1, face), {-0.16, 0.0, 0.0});
  left.velocity = {4.0, 0.0, 0.0};
  Body right = moved(rotated(ball(0.1, face), pi, Vector3d::UnitZ()), {0.16, 0.011, 0.007});
  right.velocity = {-4.0, 0.0, 0.0};
  scene.bodies = {std::move(left), std::move(right)};
  scene.gravity.setZero();
  scene.time_step = 0.0025;
  return scene;
}

Scene chain_of_rings() {
  Scene scene;
  for (int i = 0; i < 5; ++i) {
    Body link = rotated(torus(0.1, 0.025), pi / 2.0, Vector3d::UnitX());
    if (i % 2 == 1) link = rotated(std::move(link), pi / 2.0, Vector3d::UnitZ());
    link = moved(std::move(link), {0.0, 0.0, -0.13 * i});
    link.youngs_modulus = 5e5;
    if (i == 0) link.tetrahedra.clear();  // an obstacle
    scene.bodies.push_back(std::move(link));
  }
  return scene;
}

Scene twisting_mat() {
  Scene scene;
  constexpr int cells = 20;
  Body mat = block({cells, cells, 1}, [](const Vector3d& x) -> Vector3d {
    return {0.25 * x.x(), 0.25 * x.y(), 0.005 * x.z()};
  });
  mat.youngs_modulus = 2e5;
  for (Eigen::Index i = 0; i < mat.vertices.rows(); ++i) {
    const Vector3d start = mat.vertices.row(i).transpose();
    if (std::abs(start.x()) < 0.249) continue;
    const double speed = start.x() > 0.0 ? pi : -pi;
    scene.pins.push_back({static_cast<std::int32_t>(i), [start, speed](double t) -> Vector3d {
                            return Eigen::AngleAxisd(speed * t, Vector3d::UnitX()) * start;
                          }});
  }
  scene.bodies = {std::move(mat)};
  scene.gravity.setZero();
  scene.time_step = 0.02;
  scene.steps = 100;
  return scene;
}

Scene dimpled_ball() {
  Scene scene;
  Body golf = moved(ball(0.021,
                         [](const Vector3d& x) {
                           return -0.06 * std::pow(std::cos(7.0 * x.x()) * std::cos(7.0 * x.y()) *
                                                       std::cos(7.0 * x.z()),
                                                   2.0);
                         }),
                    {0.0, 0.0, 0.023});
  golf.velocity = {3.0, 0.0, -60.0};
  golf.youngs_modulus = 1e7;
  golf.density = 1150.0;
  scene.bodies = {std::move(golf), floor_of(0.2, 8)};
  scene.time_step = 2e-5;
  scene.activation_distance = 1e-4;
  return scene;
}

Scene torus_on_cone() {
  Scene scene;
  Body soft = moved(rotated(torus(0.1, 0.03), 0.2, Vector3d::UnitY()), {0.01, 0.0, 0.26});
  soft.youngs_modulus = 5e4;
  scene.bodies = {std::move(soft), cone({0.0, 0.0, 0.25}, 0.15, 0.0, 24)};
  return scene;
}

}  // namespace

const std::vector<SceneDescription>& scenes() {
  static const std::vector<SceneDescription> all{
      {"two-heads", "two soft heads collide", two_heads},
      {"chain-of-rings", "a chain of soft rings falls and hangs", chain_of_rings},
      {"twisting-mat", "a mat is twisted at both ends", twisting_mat},
      {"dimpled-ball", "a golf ball hits a wall at 60 m/s", dimpled_ball},
      {"torus-on-cone", "a soft torus falls on a cone", torus_on_cone},
  };
  return all;
}

}  // namespace touchstone::simulation
