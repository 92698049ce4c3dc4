#include "examples/simulation/simulated_scene.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace touchstone::simulation {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

Body ball(int cells, double radius, const std::function<double(const Vector3d&)>& height = {}) {
  return block({cells, cells, cells}, [&](const Vector3d& x) -> Vector3d {
    const Vector3d place = rounded_cube(x);
    // Bumps and dimples fade towards the middle.
    const double norm = place.norm(), depth = x.lpNorm<Eigen::Infinity>();
    const double bump = height && norm > 0.0 ? depth * depth * height(place / norm) : 0.0;
    return radius * (1.0 + bump) * place;
  });
}

Body box(const std::array<int, 3>& cells, const Vector3d& size) {
  return block(cells, [&](const Vector3d& x) -> Vector3d { return 0.5 * x.cwiseProduct(size); });
}

Body torus(int around, double radius, double thickness) {
  return ring({around, 3, 3}, [&](const Vector3d& x) -> Vector3d {
    const Vector3d round = rounded_cube({0.0, x.y(), x.z()});
    const double angle = pi * (x.x() + 1.0), distance = radius + thickness * round.y();
    return {distance * std::cos(angle), distance * std::sin(angle), thickness * round.z()};
  });
}

Body rotated(Body body, double angle, const Vector3d& axis) {
  body.vertices =
      (body.vertices * Eigen::AngleAxisd(angle, axis).toRotationMatrix().transpose()).eval();
  return body;
}

Body floor_at(double height, double size, int cells) {
  Body body = cloth({cells, cells}, [&](const Vector3d& x) -> Vector3d {
    return {x.x() * size / 2.0, x.y() * size / 2.0, height};
  });
  body.kind = BodyKind::obstacle;
  return body;
}

std::vector<Vector3d> circle(double radius, double height, int points) {
  std::vector<Vector3d> result;
  for (int i = 0; i < points; ++i) {
    const double angle = 2.0 * pi * i / points;
    result.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height);
  }
  return result;
}

// ---- The paper's ----

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
  Body left = moved(ball(7, 0.1, face), {-0.16, 0.0, 0.0});
  left.velocity = {4.0, 0.0, 0.0};
  Body right = moved(rotated(ball(7, 0.1, face), pi, Vector3d::UnitZ()), {0.16, 0.011, 0.007});
  right.velocity = {-4.0, 0.0, 0.0};
  scene.bodies = {std::move(left), std::move(right)};
  scene.gravity.setZero();
  scene.time_step = 0.0025;
  return scene;
}

Scene chain_of_rings() {
  Scene scene;
  for (int i = 0; i < 5; ++i) {
    Body link = rotated(torus(24, 0.1, 0.025), pi / 2.0, Vector3d::UnitX());
    if (i % 2 == 1) link = rotated(std::move(link), pi / 2.0, Vector3d::UnitZ());
    link = moved(std::move(link), {0.0, 0.0, -0.13 * i});
    link.youngs_modulus = 5e5;
    if (i == 0) {
      link.kind = BodyKind::obstacle;
      link.tetrahedra.clear();
    }
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
    scene.pins.push_back({0, static_cast<std::int32_t>(i), [start, speed](double t) -> Vector3d {
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
  Body golf = moved(ball(7, 0.021,
                         [](const Vector3d& x) {
                           return -0.06 * std::pow(std::cos(7.0 * x.x()) * std::cos(7.0 * x.y()) *
                                                       std::cos(7.0 * x.z()),
                                                   2.0);
                         }),
                    {0.0, 0.0, 0.023});
  golf.velocity = {3.0, 0.0, -60.0};
  golf.youngs_modulus = 1e7;
  golf.density = 1150.0;
  scene.bodies = {std::move(golf), floor_at(0.0, 0.2, 8)};
  scene.time_step = 2e-5;
  scene.activation_distance = 1e-4;
  return scene;
}

Scene torus_on_cone() {
  Scene scene;
  Body soft = moved(rotated(torus(24, 0.1, 0.03), 0.2, Vector3d::UnitY()), {0.01, 0.0, 0.26});
  soft.youngs_modulus = 5e4;
  scene.bodies = {std::move(soft), fan({0.0, 0.0, 0.25}, circle(0.15, 0.0, 24))};
  return scene;
}

Scene body_on_plane() {
  Scene scene;
  Body star = moved(ball(8, 0.1,
                         [](const Vector3d& x) {
                           const double a = x.x() * x.x(), b = x.y() * x.y();
                           return 0.3 * (a * a - 6.0 * a * b + b * b);
                         }),
                    {0.0, 0.0, 0.2});
  star.youngs_modulus = 2e4;
  scene.bodies = {rotated(std::move(star), 0.7, Vector3d::UnitX()), floor_at(-0.05, 0.8, 10)};
  return scene;
}

Scene draped_cloth() {
  Scene scene;
  Body sheet = cloth({30, 30}, [](const Vector3d& x) -> Vector3d {
    return {0.2 * x.x() + 0.001, 0.2 * x.y() + 0.002, 0.11};
  });
  Body support = ball(8, 0.1);
  support.kind = BodyKind::obstacle;
  support.tetrahedra.clear();
  scene.bodies = {std::move(sheet), std::move(support)};
  return scene;
}

// ---- Erleben's ----

/// A soft box over an obstacle, whose highest point is at height 0.
Scene box_over(Body below, const Vector3d& start, const Vector3d& velocity = Vector3d::Zero()) {
  Scene scene;
  Body falling = moved(box({4, 4, 4}, {0.1, 0.1, 0.1}), start + Vector3d(0.0, 0.0, 0.055));
  falling.velocity = velocity;
  scene.bodies = {std::move(falling), std::move(below)};
  scene.steps = 40;
  return scene;
}

Scene spike() { return box_over(fan({0.0, 0.0, 0.0}, circle(0.03, -0.2, 4)), {0.003, 0.002, 0.0}); }
Scene wedge() {
  return box_over(extruded({{-0.05, -0.2}, {0.0, 0.0}, {0.05, -0.2}}, 0.3, 1), {0.002, 0.0, 0.0});
}
Scene cliff_edge() {
  return box_over(extruded({{-0.3, 0.0}, {0.0, 0.0}, {0.0, -0.4}, {0.3, -0.4}}, 0.4, 1),
                  {-0.01, 0.0, 0.0}, {0.5, 0.0, 0.0});
}
Scene internal_edges() {
  return box_over(floor_at(0.0, 0.6, 13), {-0.1, 0.0, 0.0}, {1.0, 0.3, 0.0});
}
Scene crack() {
  return box_over(
      extruded({{-0.3, 0.0}, {-0.004, 0.0}, {0.0, -0.1}, {0.004, 0.0}, {0.3, 0.0}}, 0.4, 1),
      {0.0, 0.0, 0.0}, {0.2, 0.0, 0.0});
}
Scene hole() {
  // A plate with a square hole, through which the box would just not fit.
  constexpr double in = 0.045, out = 0.3, deep = -0.1;
  std::vector<Vector3d> points;
  for (const auto& [half, z] : {std::pair{out, 0.0}, {in, 0.0}, {in, deep}}) {
    points.insert(points.end(),
                  {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}});
  }
  std::vector<fast::Face> faces;
  for (std::int32_t level = 0; level < 2; ++level) {
    for (std::int32_t i = 0; i < 4; ++i) {
      const std::int32_t a = 4 * level + i, b = 4 * level + (i + 1) % 4;
      faces.insert(faces.end(), {{a, b, b + 4}, {a, b + 4, a + 4}});
    }
  }
  return box_over(obstacle(points, std::move(faces)), {0.0, 0.0, 0.0});
}

}  // namespace

const std::vector<SceneDescription>& scenes() {
  static const std::vector<SceneDescription> all{
      {"two-heads", "two soft heads collide", two_heads},
      {"chain-of-rings", "a chain of soft rings falls and hangs", chain_of_rings},
      {"twisting-mat", "a mat is twisted at both ends", twisting_mat},
      {"dimpled-ball", "a golf ball hits a wall at 60 m/s", dimpled_ball},
      {"torus-on-cone", "a soft torus falls on a cone", torus_on_cone},
      {"body-on-plane", "a soft star falls on a triangulated plane", body_on_plane},
      {"draped-cloth", "a cloth falls over a ball", draped_cloth},
      {"spike", "a box falls on a spike", spike},
      {"wedge", "a box falls on a wedge", wedge},
      {"cliff-edge", "a box slides over the edge of a cliff", cliff_edge},
      {"internal-edges", "a box slides over the inner edges of a plane", internal_edges},
      {"crack", "a box slides over a crack", crack},
      {"hole", "a box falls on a hole that is too small for it", hole},
  };
  return all;
}

Scene make_scene(std::string_view name) {
  std::string names;
  for (const SceneDescription& scene : scenes()) {
    if (scene.name == name) {
      Scene made = scene.make();
      made.name = name;
      return made;
    }
    names += (names.empty() ? "" : ", ") + std::string(scene.name);
  }
  throw std::invalid_argument("there is no scene \"" + std::string(name) + "\"; there are " +
                              names);
}

namespace {

using Eigen::Vector3d;

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

Body grid(const std::array<int, 3>& cells, const Map& map, bool is_closed) {
  const int layers = is_closed ? cells[0] : cells[0] + 1;
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

}  // namespace

Body block(const std::array<int, 3>& cells, const Map& map) { return grid(cells, map, false); }
Body ring(const std::array<int, 3>& cells, const Map& map) { return grid(cells, map, true); }

Body cloth(const std::array<int, 2>& cells, const Map& map) {
  Body body;
  body.kind = BodyKind::cloth;
  body.density = 0.3;
  body.youngs_modulus = 500.0;
  std::vector<Vector3d> points;
  for (int i = 0; i <= cells[0]; ++i) {
    for (int j = 0; j <= cells[1]; ++j) {
      points.push_back(map({2.0 * i / cells[0] - 1.0, 2.0 * j / cells[1] - 1.0, 0.0}));
    }
  }
  body.vertices = rows(points);
  const auto number = [&](int i, int j) { return i * (cells[1] + 1) + j; };
  for (int i = 0; i < cells[0]; ++i) {
    for (int j = 0; j < cells[1]; ++j) {
      const std::int32_t a = number(i, j), b = number(i + 1, j), c = number(i + 1, j + 1),
                         d = number(i, j + 1);
      // Diagonals in turns, so that no direction is stiffer than its mirror image.
      if ((i + j) % 2 == 0) {
        body.faces.insert(body.faces.end(), {{a, b, c}, {a, c, d}});
      } else {
        body.faces.insert(body.faces.end(), {{a, b, d}, {b, c, d}});
      }
    }
  }
  return body;
}

Body obstacle(const std::vector<Vector3d>& vertices, std::vector<fast::Face> faces) {
  Body body;
  body.kind = BodyKind::obstacle;
  body.vertices = rows(vertices);
  body.faces = std::move(faces);
  return body;
}

Body extruded(const std::vector<std::array<double, 2>>& profile, double width, int strips) {
  std::vector<Vector3d> points;
  for (const auto& [x, z] : profile) {
    for (int j = 0; j <= strips; ++j) points.emplace_back(x, width * j / strips - width / 2.0, z);
  }
  std::vector<fast::Face> faces;
  const auto number = [&](std::size_t i, int j) {
    return static_cast<std::int32_t>(i) * (strips + 1) + j;
  };
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    for (int j = 0; j < strips; ++j) {
      faces.push_back({number(i, j), number(i + 1, j), number(i + 1, j + 1)});
      faces.push_back({number(i, j), number(i + 1, j + 1), number(i, j + 1)});
    }
  }
  return obstacle(points, std::move(faces));
}

Body fan(const Vector3d& tip, const std::vector<Vector3d>& rim) {
  std::vector<Vector3d> points{tip};
  points.insert(points.end(), rim.begin(), rim.end());
  std::vector<fast::Face> faces;
  const auto count = static_cast<std::int32_t>(rim.size());
  for (std::int32_t i = 0; i < count; ++i) faces.push_back({0, 1 + i, 1 + (i + 1) % count});
  return obstacle(points, std::move(faces));
}

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

}  // namespace touchstone::simulation
