#include "examples/simulation/world.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/SparseCore>

#include <array>
#include <cmath>

#include "tests/support/random.hpp"

namespace touchstone::simulation::world_test {
namespace {

using Eigen::VectorXd;

Scene scene_of(Body body) {
  Scene scene;
  scene.bodies = {std::move(body)};
  return scene;
}

Body small_block() {
  return block({2, 1, 1}, [](const Eigen::Vector3d& x) -> Eigen::Vector3d {
    return {x.x(), 0.7 * x.y(), 0.4 * x.z()};
  });
}

Body small_cloth() {
  return cloth({3, 3}, [](const Eigen::Vector3d& x) -> Eigen::Vector3d {
    return {x.x(), 0.8 * x.y(), 0.0};
  });
}

VectorXd random_vector(Eigen::Index size, unsigned seed) {
  tests::Random random(seed);
  VectorXd result(size);
  for (double& x : result) x = random.between(-1000, 1000) / 1000.0;
  return result;
}

class Energies : public testing::TestWithParam<bool> {
 protected:
  World world{scene_of(GetParam() ? small_cloth() : small_block())};
};

INSTANTIATE_TEST_SUITE_P(Bodies, Energies, testing::Bool(),
                         [](const auto& of) { return of.param ? "Cloth" : "Block"; });

TEST_P(Energies, AreNothingAtRestAndAfterARotation) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  VectorXd turned = world.start();
  for (Eigen::Index i = 0; i < turned.size(); i += 3) {
    turned.segment<3>(i) = (turn * turned.segment<3>(i) + Eigen::Vector3d(1, -2, 0.5)).eval();
  }
  for (const VectorXd& x : {world.start(), turned}) {
    Derivatives derivatives(x.size());
    EXPECT_NEAR(world.energy(x, 0.0, &derivatives), 0.0, 1e-8);
    EXPECT_LT(derivatives.gradient.lpNorm<Eigen::Infinity>(), 1e-8);
  }
}

/// The energy along a line is a polynomial of degree at most 6, and seven values determine its
/// derivatives exactly. At rest no eigenvalue of the Hessian is negative.
TEST_P(Energies, HaveTheDerivativesOfThePolynomialsThatTheyAre) {
  for (const unsigned seed : {0U, 1U, 2U, 3U}) {
    const bool is_at_rest = seed == 0;
    const VectorXd x =
        world.start() + (is_at_rest ? 0.0 : 0.1) * random_vector(world.coordinates(), seed);
    const VectorXd direction = random_vector(world.coordinates(), 10 + seed);
    constexpr double step = 0.125;
    std::array<double, 7> values{};
    for (int k = -3; k <= 3; ++k) {
      values[static_cast<std::size_t>(k + 3)] = world.energy(x + k * step * direction, 0.0);
    }
    const double slope =
        (45.0 * (values[4] - values[2]) - 9.0 * (values[5] - values[1]) + values[6] - values[0]) /
        (60.0 * step);
    const double curvature = (2.0 * (values[6] + values[0]) - 27.0 * (values[5] + values[1]) +
                              270.0 * (values[4] + values[2]) - 490.0 * values[3]) /
                             (180.0 * step * step);
    Derivatives derivatives(x.size());
    const double energy = world.energy(x, 0.0, &derivatives);
    EXPECT_NEAR(energy, values[3], 1e-12 * energy);
    EXPECT_NEAR(derivatives.gradient.dot(direction), slope, 1e-9 * values[6]);
    Eigen::SparseMatrix<double> hessian(x.size(), x.size());
    hessian.setFromTriplets(derivatives.hessian.begin(), derivatives.hessian.end());
    EXPECT_LT((hessian - Eigen::SparseMatrix<double>(hessian.transpose())).norm(),
              1e-9 * hessian.norm());
    // Omitting negative eigenvalues can only add.
    const double found = direction.dot(hessian * direction);
    EXPECT_GE(found, curvature - 1e-8 * values[6]);
    if (is_at_rest) {
      EXPECT_NEAR(found, curvature, 1e-9 * curvature);
    }
  }
}

TEST(World, BendsClothThatIsFoldedOnly) {
  // Cloth stays plane under an affine map: the weights of a hinge add up to zero.
  Scene scene = scene_of(small_cloth());
  scene.bodies[0].youngs_modulus = 0.0;
  const World world(scene);
  VectorXd sheared = world.start(), folded = world.start();
  for (Eigen::Index i = 0; i < sheared.size(); i += 3) {
    sheared[i] += 0.5 * sheared[i + 1] + 3.0;
    folded[i + 2] = std::abs(folded[i]);
  }
  EXPECT_NEAR(world.energy(sheared, 0.0), 0.0, 1e-15);
  EXPECT_GT(world.energy(folded, 0.0), 1e-6);
}

TEST(World, PullsPinsWhereTheyAreToBe) {
  Scene scene = scene_of(small_block());
  scene.pins.push_back({0, 0, [](double t) -> Eigen::Vector3d { return {t, 0.0, 0.0}; }});
  const World world(scene);
  Derivatives derivatives(world.coordinates());
  world.energy(world.start(), 2.0, &derivatives);
  const Eigen::Vector3d away = world.start().head<3>() - Eigen::Vector3d(2.0, 0.0, 0.0);
  EXPECT_LT(derivatives.gradient.head<3>().cross(away).norm(), 1e-6);
  EXPECT_GT(derivatives.gradient.head<3>().dot(away), 0.0);
}

}  // namespace
}  // namespace touchstone::simulation::world_test
