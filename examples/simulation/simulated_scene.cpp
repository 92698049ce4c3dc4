#include "examples/simulation/simulated_scene.hpp"

#include <Eigen/Geometry>

#include <cmath>
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

}  // namespace touchstone::simulation
